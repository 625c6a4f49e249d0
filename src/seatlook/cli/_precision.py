"""The command that solves to a tolerance."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from seatlook.cli._output import Json, progress, say, table
from seatlook.cli._run import SceneFile, Seed, load
from seatlook.errors import InputError


def precision(
    scene: SceneFile,
    /,
    *,
    tolerance: float = 0.1,
    out: Annotated[Path | None, Parameter(help="Result file to write (.npz).")] = None,
    seed: Seed = None,
    json: Json = False,
) -> int:
    """Solve a scene no finer than asked, and print the error that was reached, zone by zone.

    Element size and time step follow from the tolerance and the wavelength of the fabric on its
    foam; a second, coarser mesh tells the error. Ends with 3 if it is missed.

    Example: seatlook precision seat.toml --tolerance 0.1 --out seat.npz

    Parameters
    ----------
    tolerance
        Relative error of the zone means of W2.
    """
    from seatlook import io
    from seatlook.chain.precision import solve_to

    if out is not None and out.suffix != ".npz":
        raise InputError.single("--out", got=out.name, expected="a name that ends in .npz")
    with progress() as show:
        found = solve_to(
            load(scene, seed), tolerance, progress=lambda **figures: show("solve", **figures)
        )
    if out is not None:
        io.write_result(found.solution, out)
    table(
        ("zone", "w2_mean", "error"),
        [(zone.zone, zone.w2_mean, zone.error) for zone in found.zones],
        json=json,
    )
    size, wave = 1e3 * found.plan.element_size, 1e3 * found.plan.wavelength
    say(f"elements of {size:.3g} mm, {wave / size:.3g} to a wave of {wave:.3g} mm; "
        f"error {found.error:.2g}, asked for {tolerance:.2g}")  # fmt: skip
    for solution in (found.solution, found.coarse):
        if solution.reason:
            say(f"not converged: {solution.reason}")
    return 0 if found.reached else 3
