"""The command that makes the cover, in one go or stage by stage."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from seatlook.cli._output import Json, Say, note, progress, table
from seatlook.cli._run import Changes, ElementSize, SceneFile, Seed, exit_code_of, load
from seatlook.errors import InputError

if TYPE_CHECKING:
    from seatlook.model import Cover, Solution


def solve(
    scene: SceneFile,
    /,
    *,
    out: Annotated[Path, Parameter(help="Result file to write (.npz).")],
    seed: Seed = None,
    element_size_mm: ElementSize = None,
    changes: Changes = (),
    stages: Annotated[bool, Parameter(negative=())] = False,
    again_from: Annotated[str | None, Parameter(name="--from")] = None,
    resume: Annotated[bool, Parameter(negative=())] = False,
    json: Json = False,
) -> int:
    """Sew, hook and cover a scene, and keep the result; nothing is drawn.

    A result that is not converged is written as well, says so, and ends with 3.

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
    from seatlook import io
    from seatlook.assembly import assemble

    if out.suffix != ".npz":
        raise InputError.single("--out", got=out.name, expected="a name that ends in .npz")
    if again_from is not None and resume:
        raise InputError.single("--from", got="--resume as well", expected="one of them")
    cover = assemble(load(scene, seed, element_size_mm, changes))
    with progress() as show:
        if stages or resume or again_from is not None:
            solution = _in_stages(cover, out.with_suffix(".stages"), again_from, resume, show)
        else:
            from seatlook.solver import solve as run_solver

            solution = run_solver(cover, progress=lambda **figures: show("solve", **figures))
    io.write_result(solution, out)
    table(
        ("what", "value"),
        [("status", solution.status), ("reason", solution.reason), *solution.figures.items()],
        json=json,
    )
    return exit_code_of(solution)


def _in_stages(
    cover: Cover, folder: Path, again_from: str | None, resume: bool, show: Say
) -> Solution:
    """Solve and say on stderr with which stage it begins and where the stages are."""
    from seatlook.chain.timeline import solve_in_stages

    seen: list[str] = []

    def tell(
        *, stage: str, step: int, steps: int, energy: float, residual: float, gap: float
    ) -> None:
        if stage not in seen:
            seen.append(stage)
            note(f"stage: {stage}")
        show(
            "solve", stage=stage, step=step, steps=steps, energy=energy, residual=residual, gap=gap
        )

    solution = solve_in_stages(cover, folder, again_from=again_from, resume=resume, progress=tell)
    note(f"stages: {folder}")
    return solution
