"""The command that assesses wrinkles: of a result, or of a finite-element calculation."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

from cyclopts import Parameter

from seatlook.cli._evaluate import print_zones
from seatlook.cli._options import Preview, exit_code_of, result_of, seat_of
from seatlook.cli._output import Json, print_rows, progress, show_json
from seatlook.cli._shells import ShellOptions, assess_file, check_no_options
from seatlook.errors import InputError

if TYPE_CHECKING:
    from seatlook.chain.assess import Assessment
    from seatlook.model import Camera, CurvatureMode, Solution, StrainMeasure
    from seatlook.results.resolution import Resolution

Files = Annotated[tuple[Path, ...], Parameter(negative=())]
_MEASURES: dict[str, StrainMeasure] = {"green": "green", "log": "logarithmic"}
_MM = 1e-3


@dataclass(frozen=True, kw_only=True)
class Asked:
    """Criteria that the command line gives; [1/m], [m], None where it does not."""

    curvature: CurvatureMode | None
    threshold: float | None
    bending_radius: float | None
    strain_measure: StrainMeasure | None


@dataclass(frozen=True, kw_only=True)
class Outputs:
    """Where the answer goes."""

    out: Path | None
    export: tuple[Path, ...]
    json: bool


def wrinkle(
    file: Annotated[
        Path,
        Parameter(help="Result (.npz), the scene it lies beside, d3plot, or keyword deck."),
    ],
    /,
    *,
    mode: Literal["paper", "tensor"] | None = None,
    strain: Literal["green", "log"] | None = None,
    c_threshold_per_mm: float | None = None,
    bending_radius_mm: float | None = None,
    scene: Path | None = None,
    against: Path | None = None,
    out: Path | None = None,
    export: Files = (),
    shells: Annotated[ShellOptions | None, Parameter(name="*")] = None,
    preview: Preview = False,
    json: Json = False,
) -> int:
    """Print the wrinkle indices of a result or of LS-DYNA shells; nothing is solved.

    Ends with 3 if a result is not converged or not resolved by its mesh.

    With --out also maps, pictures, the worst wrinkles with a section across each, and tables.

    Example: seatlook wrinkle seat.npz --out wrinkles

    Example: seatlook wrinkle run/d3plot --part insert --facing 0 0 1 --out wrinkles --json

    Parameters
    ----------
    mode
        "paper" evaluates equation 1 as printed, "tensor" the whole curvature. If not given: as the
        result carries it, and paper for shells.
    strain
        Strain measure of the equations. If not given: green for a result, and that of the file for
        shells.
    c_threshold_per_mm
        Curvature at which a wrinkle counts. If not given: as the result carries it, and for shells
        0.01 in paper mode and 0.02 in tensor mode.
    bending_radius_mm
        The same as the radius at which the material shows its first wrinkle (VDA 230-205).
    scene
        Scene of a result, whose criteria and view are taken instead.
    against
        Second result, to be compared: maps with the same range, their difference, zones.
    out
        Folder to write to.
    export
        File with strains and indices per element for other programs: .vtp, .csv, .glb, .k, a
        dynain deck (.radioss.k for OpenRadioss), or .npz, a result for "seatlook render" and
        "score". May be given more than once.
    """
    if c_threshold_per_mm is not None and bending_radius_mm is not None:
        raise InputError.single(
            "--bending-radius-mm", got="--c-threshold-per-mm as well", expected="one of them"
        )
    asked = Asked(
        curvature=mode,
        threshold=None if c_threshold_per_mm is None else c_threshold_per_mm / _MM,
        bending_radius=None if bending_radius_mm is None else bending_radius_mm * _MM,
        strain_measure=_MEASURES[strain] if strain else None,
    )
    outputs = Outputs(out=out, export=export, json=json)
    file = result_of(file)
    if _is_result(file):
        check_no_options(file, shells)
        found = _assess_result(file, scene, against, asked, outputs)
        names = [str(path) for path in (file, against) if path is not None]
        return exit_code_of(*found, names=names, preview=preview)
    if against is not None or scene is not None:
        option = "--against" if against is not None else "--scene"
        raise InputError.single(option, got=str(file), expected="a result of seatlook (.npz)")
    assess_file(file, shells or ShellOptions(), asked, outputs)
    return 0


def _is_result(file: Path) -> bool:
    try:
        with file.open("rb") as stream:
            return stream.read(4) == b"PK\x03\x04" or file.suffix == ".npz"
    except FileNotFoundError:
        # The reader of the format says what is wrong.
        return file.suffix == ".npz"


def _assess_result(
    file: Path, scene: Path | None, against: Path | None, asked: Asked, outputs: Outputs
) -> list[Resolution]:
    """Print a result's wrinkles; return what is to be thought of it, and of the other one."""
    from seatlook import io
    from seatlook.chain.case import export
    from seatlook.chain.result_maps import (
        assess_other,
        compared_zones,
        draw_difference,
        draw_result,
    )
    from seatlook.chain.run_folder import run_folder

    assessment, camera = _assessed(io.read_result(file), scene, asked)
    other = None
    if against is not None:
        other = assess_other(io.read_result(against), assessment.criteria)
    for path in outputs.export:
        export(assessment, path)
    if outputs.out is not None:
        with run_folder(outputs.out), progress() as show:
            draw_result(assessment, outputs.out, camera=camera, progress=show)
            if other is not None:
                draw_difference(assessment, other, outputs.out, camera=camera, progress=show)
    compared = [] if other is None else compared_zones(assessment, other)
    _print(file, assessment, compared, json=outputs.json)
    return [one.resolution for one in (assessment, other) if one is not None]


def _assessed(
    solution: Solution, scene: Path | None, asked: Asked
) -> tuple[Assessment, Camera | None]:
    """Assess a result by its own criteria or its scene's, changed as asked."""
    from seatlook.chain.assess import assess
    from seatlook.chain.case import Case
    from seatlook.chain.result_maps import other_criteria

    if scene is None:
        base, camera = assess(solution).criteria, None
    else:
        case = Case(seat_of(scene).scene, solution=solution)
        base, camera = case.criteria, case.camera(None)
    return assess(solution, other_criteria(base, solution, **vars(asked))), camera


def _print(
    file: Path, assessment: Assessment, compared: list[dict[str, str | float]], *, json: bool
) -> None:
    from seatlook.chain.files import advice_rows, stretch_rows, wrinkle_rows

    worst, seams = wrinkle_rows(assessment), stretch_rows(assessment)
    advice = advice_rows(assessment)
    if json:
        data: dict[str, Any] = {
            "file": str(file),
            "status": assessment.resolution.status,
            "reason": assessment.resolution.reason,
            "curvature": assessment.criteria.curvature,
            "c_threshold_per_mm": [_MM * v for v in assessment.criteria.thresholds],
            "criterion": assessment.criteria.words(),
            "zones": [row.values() for row in assessment.zones],
            "worst": worst,
            "seam_excess": seams,
            "advice": advice,
            "distortion": [asdict(row) for row in assessment.distortion_rows],
            "difference": compared,
        }
        show_json(data)
        return
    print_zones(assessment.zones, assessment.resolution, json=False)
    for rows in (worst, seams, advice, compared):
        print_rows(rows)
