"""The command that makes the cover, in one go or stage by stage."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from seatlook.cli._options import (
    Changes,
    ElementSize,
    Preview,
    ResultOut,
    SceneFile,
    Seed,
    TolerancePercent,
    checked_result_name,
    exit_code_of,
    note_coarse,
    seat_of,
)
from seatlook.cli._output import Json, Say, note, progress, table
from seatlook.errors import InputError

if TYPE_CHECKING:
    from seatlook.model import Solution
    from seatlook.results.resolution import Resolution
    from seatlook.seat import Seat


def solve(
    scene: SceneFile,
    /,
    *,
    out: ResultOut,
    seed: Seed = None,
    element_size_mm: ElementSize = None,
    tolerance_percent: TolerancePercent = None,
    changes: Changes = (),
    stages: Annotated[bool, Parameter(negative=())] = False,
    again_from: Annotated[str | None, Parameter(name="--from")] = None,
    resume: Annotated[bool, Parameter(negative=())] = False,
    preview: Preview = False,
    json: Json = False,
) -> int:
    """Sew, hook and cover a scene, and keep the result; nothing is drawn.

    A result that is not converged, or not resolved by its mesh, is written as well, says so, and
    ends with 3.

    Example: seatlook solve seat.toml --out seat.npz

    Example: seatlook solve seat.toml --out seat.npz --from hook

    Parameters
    ----------
    stages
        Keep the state at the end of every stage, or group of stages, as well, in a folder beside
        the result: seat.stages/1-sew.npz, 2-hook.npz, ...
    again_from
        Stage or group to do again, with all after it, from the state kept before it: a changed
        hook does not sew again. Keeps stages.
    resume
        Go on after the last stage kept of this very scene, so that a run that was stopped ends as
        if it had not been. Keeps stages.
    """
    checked_result_name(out)
    if again_from is not None and resume:
        raise InputError.single("--from", got="--resume as well", expected="one of them")
    seat = seat_of(scene, seed, element_size_mm, changes, tolerance_percent)
    note_coarse(seat)
    with progress() as show:
        if stages or resume or again_from is not None:
            _in_stages(seat, out.with_suffix(".stages"), again_from, resume, show)
        seat.solve(out, progress=show)
    solution, found = seat.solution, seat.resolution
    if json:
        rows = [("status", found.status), ("reason", found.reason)]
        table(("what", "value"), [*rows, *solution.figures.items()], json=True)
    else:
        _print_summary(solution, found)
    return exit_code_of(found, preview=preview)


def _print_summary(solution: Solution, found: Resolution) -> None:
    """Print status and reason first, then what it was reached with, with units."""
    from seatlook.model.table import number
    from seatlook.results.conditions import conditions

    cover = solution.cover
    rows: list[tuple[str, str, str]] = [("status", found.status, "")]
    if found.reason:
        rows.append(("reason", found.reason, ""))
    for held in conditions(solution, found):
        unit = f" {held.unit}" if held.unit else ""
        limit = f"at most {number(held.limit)}{unit}"
        rows.append((held.meaning, f"{number(held.value)}{unit}", limit))
    rows += [
        ("mesh", f"{len(cover.rest)} vertices, {1e3 * cover.element_size:.3g} mm", ""),
        ("CPU time", f"{solution.figures['cpu_seconds']:.1f} s", ""),
    ]
    table(("what", "value", "limit"), rows, json=False)


def _in_stages(seat: Seat, folder: Path, again_from: str | None, resume: bool, show: Say) -> None:
    """Solve and say on stderr with which stage it begins and where the stages are."""
    begun: set[str] = set()

    def tell(name: str, /, **figures: float | str) -> None:
        stage = str(figures.get("stage", ""))
        if stage and stage not in begun:
            begun.add(stage)
            note(f"stage: {stage}")
        show(name, **figures)

    seat.solve_in_stages(folder, again_from=again_from, resume=resume, progress=tell)
    note(f"stages: {folder}")
