"""The command that judges wrinkles: of a result, or of a finite-element calculation."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

from cyclopts import Parameter

from seatlook.cli._output import Json, progress, say, show_json, table
from seatlook.cli._run import load, print_zones
from seatlook.errors import InputError

if TYPE_CHECKING:
    from seatlook.model import FloatArray, Scene, ShellResult, Solution, WrinkleMap
    from seatlook.model.scene import CurvatureMode
    from seatlook.shells.states import JudgedStates
    from seatlook.wrinkle.equations import StrainMeasure

Files = Annotated[tuple[Path, ...], Parameter(negative=())]
Names = Annotated[tuple[str, ...], Parameter(negative=())]
_MEASURES: dict[str, StrainMeasure] = {"green": "green", "log": "logarithmic"}
_MM = 1e-3
_SHOWN = ("w1", "w2", "w2_p95", "w2_area_share", "w_stretch", "w_compression")


@dataclass(frozen=True, kw_only=True)
class ShellOptions:
    """How a d3plot or keyword deck is read.

    Parameters
    ----------
    part
        Part to evaluate, by number or title; may be given more than once. All shells if not given.
    state
        Number of a state to draw, from 0; may be given more than once. The last if not given.
        Figures are of all states.
    thickness_mm
        Thickness of the shells, where the file does not hold it.
    length_unit
        Unit of length of the calculation; mm if not given.
    facing
        Direction in which the visible side looks, such as 0 0 1. The file's normals decide if not
        given.
    reference
        Undeformed deck with the same nodes, for a deck.
    strain_axes
        "element" for a d3plot written with CMPFLG=1; global if not given.
    material
        Supplied material or file for the picture; black-leather if not given.
    """

    part: Names = ()
    state: Annotated[tuple[int, ...], Parameter(negative=())] = ()
    thickness_mm: float | None = None
    length_unit: Literal["mm", "cm", "m", "inch"] | None = None
    facing: Annotated[tuple[float, float, float] | None, Parameter(negative=())] = None
    reference: Path | None = None
    strain_axes: Literal["global", "element"] | None = None
    material: str | None = None


def wrinkle(
    file: Annotated[Path, Parameter(help="Result (.npz), d3plot, or keyword deck (dynain).")],
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
    json: Json = False,
) -> None:
    """Print the wrinkle indices of a result or of LS-DYNA shells; nothing is solved.

    With --out also maps, pictures, the worst wrinkles with a section across each, and tables.

    Example: seatlook wrinkle seat.npz --scene seat.toml --out wrinkles

    Example: seatlook wrinkle run/d3plot --part insert --facing 0 0 1 --out wrinkles --json

    Parameters
    ----------
    mode
        "paper" evaluates equation 1 as printed, "tensor" the whole curvature. The scene's if one
        is given, else paper.
    strain
        Strain measure of the equations. If not given: green for a result, and that of the file for
        shells.
    c_threshold_per_mm
        Curvature at which a wrinkle counts; 0.01 in paper mode and 0.02 in tensor mode if not
        given, and the materials' own for a result.
    bending_radius_mm
        The same as the radius at which the material shows its first wrinkle (VDA 230-205).
    scene
        Scene of a result, for curvature mode, thresholds and view.
    against
        Second result, to be compared: maps with the same range, their difference, zones.
    out
        Folder to write to.
    export
        File with strains and indices per element for other programs: .vtp, .csv, .glb, .k, a
        dynain deck, or .npz, a result for "seatlook render" and "score". May be given more than
        once.
    """
    read = None if scene is None else load(scene)
    chosen: CurvatureMode = mode or (read.curvature if read else "paper")
    threshold = _threshold(c_threshold_per_mm, bending_radius_mm, chosen)
    question = _Question(chosen, strain and _MEASURES[strain], threshold, out, export, json)
    if _is_result(file):
        _only_for_shells(file, shells)
        _judge_result(file, read, against, question)
    elif against is not None or read is not None:
        option = "--against" if against is not None else "--scene"
        raise InputError.single(option, got=str(file), expected="a result of seatlook (.npz)")
    else:
        _judge_shells(file, shells or ShellOptions(), question)


@dataclass(frozen=True)
class _Question:
    """What is asked of either kind of file; ``threshold`` [1/m] is None where none is given."""

    mode: CurvatureMode
    strain: StrainMeasure | None
    threshold: float | None
    out: Path | None
    export: tuple[Path, ...]
    json: bool

    def asked(self) -> dict[str, str]:
        """Return what a page says was asked, under the names of the options."""
        return {
            "mode": self.mode,
            "c_threshold_per_mm": "" if self.threshold is None else f"{self.threshold * _MM:g}",
            "strain": self.strain or "as in the file",
        }


def _threshold(per_mm: float | None, radius_mm: float | None, mode: CurvatureMode) -> float | None:
    from seatlook.wrinkle import threshold_of_radius

    if per_mm is not None and radius_mm is not None:
        raise InputError.single(
            "--bending-radius-mm", got="--c-threshold-per-mm as well", expected="one of them"
        )
    if radius_mm is not None:
        return float(threshold_of_radius(radius_mm * _MM, mode))
    return None if per_mm is None else per_mm / _MM


def _is_result(file: Path) -> bool:
    try:
        with file.open("rb") as stream:
            return stream.read(4) == b"PK\x03\x04" or file.suffix == ".npz"
    except FileNotFoundError:
        # The reader of the format says what is wrong.
        return file.suffix == ".npz"


def _only_for_shells(file: Path, shells: ShellOptions | None) -> None:
    given = asdict(shells) if shells else {}
    problems = [
        InputError.single(
            f"--{name.replace('_', '-')}", got=str(value), file=file,
            expected="nothing: it is for a d3plot or a keyword deck",
        ).problems[0]
        for name, value in given.items()
        if value not in (None, ())
    ]  # fmt: skip
    if problems:
        raise InputError(problems)


def _judge_result(
    file: Path, scene: Scene | None, against: Path | None, question: _Question
) -> None:
    from seatlook import io
    from seatlook.chain import result_maps as study
    from seatlook.chain.findings import find, worst_row

    asked = study.Question(
        mode=question.mode,
        strain=question.strain or "green",
        threshold=question.threshold,
        default=scene.c_threshold if scene and question.mode == scene.curvature else None,
        camera=scene.cameras[0] if scene else None,
    )
    judged = study.judge(io.read_result(file), asked)
    other = None if against is None else study.judge(io.read_result(against), asked)
    findings = find(judged.solution, judged.indices)
    _export(judged.solution, judged.indices, question.export)
    if question.out is not None:
        with progress() as show:
            study.draw_result(judged, findings, asked, question.out, say=show)
            if other is not None:
                study.draw_difference(judged, other, asked, question.out, say=show)
    worst = [worst_row(k, w) for k, w in enumerate(findings.worst, 1)]
    compared = [] if other is None else study.compared_zones(judged, other)
    if question.json:
        data = {
            "file": str(file),
            "curvature": question.mode,
            "zones": [asdict(row) for row in judged.zones],
            "worst": worst,
            "distortion": [asdict(row) for row in findings.distortion_rows],
            "difference": compared,
        }
        show_json(data)
        return
    print_zones(judged.zones, json=False)
    _print_rows(worst)
    _print_rows(compared)


def _judge_shells(file: Path, options: ShellOptions, question: _Question) -> None:
    from seatlook.io.lsdyna.shells import read_shells
    from seatlook.shells.states import judged_states
    from seatlook.shells.strains import DEFAULT_THRESHOLD

    result = read_shells(
        file,
        parts=options.part or None,
        thickness=None if options.thickness_mm is None else options.thickness_mm * _MM,
        length_unit=options.length_unit or "mm",
        strain_axes=options.strain_axes or "global",
        reference=options.reference,
    )
    threshold = question.threshold or DEFAULT_THRESHOLD[question.mode]
    question = replace(question, threshold=threshold)
    judged = judged_states(
        file,
        result,
        kept=options.state or (len(result) - 1,),
        curvature=question.mode,
        c_threshold=threshold,
        facing=None if options.facing is None else _direction(options.facing),
        strain_measure=question.strain,
    )
    say(*(f"{file}: {note}" for note in result.notes))
    if question.out is not None or question.export:
        _draw_shells(file, result, judged, options.material or "black-leather", question)
    if question.json:
        data = {
            "file": str(file),
            "curvature": question.mode,
            "c_threshold_per_mm": threshold * _MM,
            "shells": len(result.shells),
            "notes": list(result.notes),
            "states": judged.figures,
        }
        show_json(data)
    else:
        _print_states(judged.figures)


def _print_states(figures: Sequence[Mapping[str, Any]]) -> None:
    """Print one row per state, and one per part where there are several."""
    heads = ("time", "c", "c_min", "c_max", *_SHOWN, "h_mm", "source")
    table(
        ("state", *heads),
        [(k, *(row[h] for h in heads)) for k, row in enumerate(figures)],
        json=False,
    )
    if len(figures[0]["parts"]) > 1:
        _print_rows(
            [
                {"state": k, "part": p["part"], "name": p["name"], **{h: p[h] for h in _SHOWN}}
                for k, row in enumerate(figures)
                for p in row["parts"]
            ]
        )


def _draw_shells(
    file: Path, result: ShellResult, judged: JudgedStates, material: str, question: _Question
) -> None:
    """Draw the states, each into a folder of its own; export the last of them."""
    from seatlook import io
    from seatlook.chain.shell_maps import draw_state, on_faces
    from seatlook.report.shell_page import write_shell_page
    from seatlook.shells.cover import shell_cover

    look = io.read_material(material)
    for number, (state, wrinkles) in judged.states.items():
        made = shell_cover(result.shells, state, wrinkles, look)
        if question.out is not None:
            folder = question.out / f"state-{number}"
            with progress() as show:
                drawn = draw_state(
                    result.shells, wrinkles, made, folder, top=judged.top, say=show
                )  # fmt: skip
            page = write_shell_page(
                drawn,
                judged.figures[number],
                title=f"{file.name}, state {number}",
                asked=question.asked(),
                notes=result.notes,
            )
            say(f"gallery: {page}")
    if made.projected:
        say(
            f"no flat undeformed state: {', '.join(made.projected)}; textures are laid on along "
            "the world's axes, and the distortion of the texture is not known"
        )
    _export(made.solution, on_faces(wrinkles.indices, made), question.export)


def _direction(facing: tuple[float, float, float]) -> FloatArray:
    import numpy as np

    if not any(facing):
        raise InputError.single("--facing", got="0 0 0", expected="a direction")
    return np.array(facing)


def _export(solution: Solution, indices: WrinkleMap, paths: tuple[Path, ...]) -> None:
    from seatlook import io, pbr

    for path in paths:
        # A viewer knows no grain by formula.
        drawn = path.suffix.lower() == ".glb"
        io.export_cover(pbr.bake_grain(solution) if drawn else solution, indices, path)


def _print_rows(rows: Sequence[Mapping[str, Any]]) -> None:
    """Print a further table, after an empty line; nothing where there is none."""
    if rows:
        sys.stdout.write("\n")
        table(tuple(rows[0]), [tuple(row.values()) for row in rows], json=False)
