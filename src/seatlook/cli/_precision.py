"""The command that solves to a tolerance."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from seatlook.cli._options import SceneFile, Seed, checked_result_name, exit_code_of, seat_of
from seatlook.cli._output import Json, progress, say, table


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
    foam. Two coarser meshes tell the error, some seeds of the coarsest the scatter. Ends with 3 if
    the tolerance is missed. The result carries both for "seatlook compare".

    Example: seatlook precision seat.toml --tolerance 0.1 --out seat.npz

    Parameters
    ----------
    tolerance
        Relative error of the zone means of W2.
    """
    from seatlook import io

    if out is not None:
        checked_result_name(out)
    with progress() as show:
        seat = seat_of(scene, seed)
        precise = seat.precision(tolerance, progress=show)
    if out is not None:
        io.write_result(precise.solution, out)
    table(
        ("zone", "w2_mean", "w2_mesh_error", "w2_scatter", "criterion", "status"),
        [
            (
                zone.zone,
                zone.w2_mean,
                zone.error,
                zone.scatter,
                zone.criterion,
                precise.resolution.status,
            )
            for zone in precise.zones
        ],
        json=json,
    )
    size, wave = 1e3 * precise.plan.element_size, 1e3 * precise.plan.wavelength
    say(f"elements of {size:.3g} mm, {wave / size:.3g} to a wave of {wave:.3g} mm; "
        f"error {precise.error:.2g}, asked for {tolerance:.2g}")  # fmt: skip
    orders = ", ".join(f"{kind} {order:.2g}" for kind, order in precise.orders.items())
    say(f"observed orders: {orders}; scatter from {len(precise.others)} seeds")
    say(*(f"a coarser mesh is not converged: {reason}" for reason in precise.unconverged))
    return exit_code_of(precise.resolution) or (0 if precise.reached else 3)
