"""The part of "seatlook wrinkle" that is about shells of other programs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, Protocol

from cyclopts import Parameter

from seatlook.cli._options import Names
from seatlook.cli._output import print_rows, progress, say, show_json, table
from seatlook.errors import InputError

if TYPE_CHECKING:
    from seatlook.chain.shells.states import AssessedStates, ShellCriteria
    from seatlook.model import CurvatureMode, FloatArray, ShellResult, StrainMeasure

_MM = 1e-3
_SHOWN = ("w1", "w2", "w2_p95", "w2_area_share", "w_stretch", "w_compression")


class _Asked(Protocol):
    """Criteria that the command line gives, see ``cli._wrinkle.Asked``."""

    @property
    def curvature(self) -> CurvatureMode | None: ...
    @property
    def threshold(self) -> float | None: ...
    @property
    def bending_radius(self) -> float | None: ...
    @property
    def strain_measure(self) -> StrainMeasure | None: ...


class _Outputs(Protocol):
    """Where the answer goes, see ``cli._wrinkle.Outputs``."""

    @property
    def out(self) -> Path | None: ...
    @property
    def export(self) -> tuple[Path, ...]: ...
    @property
    def json(self) -> bool: ...


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


def check_no_options(file: Path, shells: ShellOptions | None) -> None:
    """Refuse options of shells beside a result."""
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


def assess_file(file: Path, options: ShellOptions, asked: _Asked, outputs: _Outputs) -> None:
    """Assess all states of a file; draw some, export the last of them, print the figures."""
    from seatlook.chain.shells.states import assess_states
    from seatlook.io import read_shells

    criteria = _criteria(options, asked)
    result = read_shells(
        file,
        parts=options.part or None,
        thickness=None if options.thickness_mm is None else options.thickness_mm * _MM,
        length_unit=options.length_unit or "mm",
        strain_axes=options.strain_axes or "global",
        reference=options.reference,
    )
    states = assess_states(file, result, criteria, drawn=options.state or (len(result) - 1,))
    say(*(f"{file}: {note}" for note in result.notes))
    if outputs.out is not None or outputs.export:
        _draw(file, result, states, options.material or "black-leather", criteria, outputs)
    if outputs.json:
        data = {
            "file": str(file),
            "curvature": criteria.curvature,
            "c_threshold_per_mm": criteria.threshold * _MM,
            "criterion": criteria.words(),
            "shells": len(result.shells),
            "notes": list(result.notes),
            "states": states.figures,
        }
        show_json(data)
    else:
        _print_states(states.figures, criteria.words())


def _criteria(options: ShellOptions, asked: _Asked) -> ShellCriteria:
    from seatlook.chain.shells.states import ShellCriteria
    from seatlook.model.criteria import threshold_of_radius

    mode, threshold = asked.curvature or "paper", asked.threshold
    if asked.bending_radius is not None:
        threshold = float(threshold_of_radius(asked.bending_radius, mode))
    return ShellCriteria(
        curvature=mode,
        c_threshold=threshold,
        facing=None if options.facing is None else _direction(options.facing),
        strain_measure=asked.strain_measure,
    )


def _draw(
    file: Path,
    result: ShellResult,
    states: AssessedStates,
    material: str,
    criteria: ShellCriteria,
    outputs: _Outputs,
) -> None:
    """Draw the states, each into a folder of its own; export the last of them."""
    from seatlook import io
    from seatlook.chain.case import export
    from seatlook.chain.run_folder import run_folder
    from seatlook.chain.shells.maps import assess_shells, draw_state
    from seatlook.report.shell_page import write_shell_page
    from seatlook.shells.cover import shell_cover

    look = io.read_material(material)
    criteria_shown = {
        "mode": criteria.curvature,
        "c_threshold_per_mm": f"{criteria.threshold * _MM:g}",
        "strain": criteria.strain_measure or "as in the file",
    }
    for number, (state, wrinkles) in states.states.items():
        cover = shell_cover(result.shells, state, wrinkles, look)
        assessment = assess_shells(cover, wrinkles, criteria)
        if outputs.out is None:
            continue
        with run_folder(outputs.out / f"state-{number}", page=True) as folder:
            with progress() as show:
                drawn = draw_state(
                    result.shells, wrinkles, cover, assessment, folder, top=states.top,
                    progress=show,
                )  # fmt: skip
            page = write_shell_page(
                drawn,
                states.figures[number],
                title=f"{file.name}, state {number}",
                asked=criteria_shown,
                notes=result.notes,
            )
        say(f"gallery: {page}")
    if cover.projected:
        say(
            f"no flat undeformed state: {', '.join(cover.projected)}; textures are laid on along "
            "the world's axes, and the distortion of the texture is left out"
        )
    for path in outputs.export:
        export(assessment, path)


def _print_states(figures: Sequence[Mapping[str, Any]], criterion: str) -> None:
    """Print one row per state, and one per part where there are several."""
    curvatures = ("c", "c_min", "c_max")
    heads = ("time", *curvatures, *_SHOWN, "h_mm", "source")
    table(
        (
            "state",
            *(f"{head}_per_mm" if head in curvatures else head for head in heads),
            "criterion",
        ),
        [(k, *(row[h] for h in heads), criterion) for k, row in enumerate(figures)],
        json=False,
    )
    if len(figures[0]["parts"]) > 1:
        print_rows(
            [
                {
                    "state": k,
                    "part": p["part"],
                    "name": p["name"],
                    **{h: p[h] for h in _SHOWN},
                    "criterion": criterion,
                }
                for k, row in enumerate(figures)
                for p in row["parts"]
            ]
        )


def _direction(facing: tuple[float, float, float]) -> FloatArray:
    import numpy as np

    if not any(facing):
        raise InputError.single("--facing", got="0 0 0", expected="a direction")
    return np.array(facing)
