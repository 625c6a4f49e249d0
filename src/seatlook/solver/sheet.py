"""Equilibrium of a bare sheet: any flat mesh, fabric, supports and loads in one call."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.sparse.linalg import splu

from seatlook.errors import InputError, SolverError
from seatlook.model import Fabric, FloatArray, IntArray
from seatlook.solver.element.elastic import ElasticSheet
from seatlook.solver.element.loads import DeadLoad, Pressure
from seatlook.solver.energy import Energy
from seatlook.solver.methods.choice import MethodName, method_of
from seatlook.solver.methods.explicit import Explicit, UnstableStepError
from seatlook.solver.methods.newton import Equilibrium, Potential
from seatlook.solver.process.statics import equilibrium


@dataclass(frozen=True, slots=True)
class SheetSolution:
    """Equilibrium of a sheet.

    Parameters
    ----------
    positions : (n, 3) float64 [m]
    sheet : ElasticSheet        gives ``strains(positions)`` and ``curvatures(positions)``
    reactions : (n, 3) float64 [N]   what the supports push on the sheet; zero where it is free
    converged : bool            residual within the tolerance, and stable
    residual : float [1]        largest force out of balance over the mean elastic nodal force
    energy : (k,) float64 [J]   potential after every accepted step of the last load step
    peaks : (m, 2) float64 [1]  largest warp and weft strains so far, None if the fabric unloads the
        way it was loaded
    """

    positions: FloatArray
    sheet: ElasticSheet
    reactions: FloatArray
    converged: bool
    reason: str
    residual: float
    iterations: int
    kicks: int
    energy: FloatArray
    peaks: FloatArray | None


class SheetError(SolverError):
    """No equilibrium was reached; ``solution`` is the last state."""

    def __init__(self, reason: str, solution: SheetSolution) -> None:
        super().__init__(reason)
        self.solution = solution


def solve_sheet(
    rest: FloatArray,
    faces: IntArray,
    fabric: Fabric,
    *,
    positions: FloatArray | None = None,
    fixed: npt.NDArray[np.bool_] | None = None,
    clamped: npt.NDArray[np.bool_] | None = None,
    prescribed: FloatArray | None = None,
    loads: FloatArray | None = None,
    pressure: float = 0.0,
    gravity: Sequence[float] = (0.0, 0.0, 0.0),
    supports: Sequence[Energy] = (),
    peaks: FloatArray | None = None,
    steps: int = 1,
    method: MethodName | Explicit = "newton",
    tolerance: float = 1e-3,
    max_iterations: int | None = None,
    strict: bool = False,
) -> SheetSolution:
    """Find the stable equilibrium of a sheet under loads and supports.

    Parameters
    ----------
    rest : (n, 2) float64 [m]; faces : (m, 3) int64   flat, counter-clockwise, warp along axis 0
    positions : (n, 3) float64 [m]   where the search starts; the flat sheet if not given
    fixed : (n,) or (n, 3) bool      vertices, or single components, that are held
    clamped : (n,) bool              fixed vertices between which free edges keep their direction
    prescribed : (n, 3) float64 [m]  where fixed components are taken to
    loads : (n, 3) float64 [N]       forces of constant direction
    pressure : float [Pa]            along the face normals; needs a rim that is held all round
    gravity : (3,) [m/s2]            acts on the fabric's mass
    supports : further energies, such as a foundation
    peaks : (m, 2) float64 [1]       of an earlier solution, where the fabric has unloading curves
    steps : loads and prescribed movements are applied in this many equal steps; strains count as
        history only at the end of each
    method : "newton" (with a softened membrane first where the sheet is thin), "lbfgs" with a
        prefactored matrix, or "explicit" (damped, with masses that make all waves equally slow;
        ``Explicit(time_step=...)`` moves in real time with the sheet's own mass).
        With each the exact Hessian is looked at last: an equilibrium that is unstable is left.
    tolerance : residual that counts as converged
    max_iterations : 300 for Newton, 10,000 for L-BFGS, 4,000 times 50 steps for explicit
    strict : raise instead of returning what has not converged

    Raises
    ------
    SheetError                          ``strict`` and not converged; with the explicit method
        always, where the time step is not stable
    InputError, InvertedElementError    the mesh is no flat oriented sheet

    Examples
    --------
    >>> from seatlook.model import Curve
    >>> stretch, bend = Curve.linear(1000.0), {"bending_warp": 1e-4, "bending_weft": 1e-4}
    >>> fabric = Fabric(thickness=1e-3, density=0.3, warp=stretch, weft=stretch,
    ...                 shear=Curve.linear(500.0), bending_twist=5e-5, **bend)
    >>> rest = np.array([[0, 0], [0.1, 0], [0.1, 0.1], [0, 0.1]])
    >>> faces = np.array([[0, 1, 2], [0, 2, 3]])
    >>> pull = np.array([[0, 0, 0], [0.5, 0, 0], [0.5, 0, 0], [0, 0, 0]])
    >>> end = np.array([True, False, False, True])
    >>> solved = solve_sheet(rest, faces, fabric, fixed=end, loads=pull)
    >>> round(float(solved.sheet.strains(solved.positions)[1][0, 0, 0]), 4)
    0.0099
    """
    chosen = method_of(method)
    start = np.pad(np.asarray(rest, dtype=np.float64), ((0, 0), (0, 1)))
    if positions is not None:
        start = np.array(positions, dtype=np.float64, order="C")
    held = _held(len(rest), fixed, clamped)
    panel = np.zeros(len(faces), dtype=np.int64)
    sheet = ElasticSheet(rest, faces, panel, [fabric], clamped=clamped, positions=start)
    if peaks is not None:
        sheet.membrane.remember(peaks)
    target = start if prescribed is None else np.where(held, prescribed, start)
    force = np.outer(sheet.mass, gravity)
    if loads is not None:
        force += loads
    if pressure:
        _check_rim(sheet, held)
    if steps < 1:
        raise InputError.single("steps", got=steps, expected="1 or more")
    x = start
    for share in np.arange(1, steps + 1) / steps:
        others: list[Energy] = [DeadLoad(share * force), *supports]
        if pressure:
            others.append(Pressure(sheet.faces, share * pressure))
        potential = Potential(sheet.energies, others, ~held)
        x = _moved(sheet, x, start + share * (target - start), held)
        try:
            found = equilibrium(
                sheet, potential, x, chosen, tolerance=tolerance, max_iterations=max_iterations
            )
        except UnstableStepError as error:
            found = Equilibrium(x, np.inf, np.zeros(0), 0, -1, 0)
            raise SheetError(str(error), _report(sheet, found, potential, tolerance)) from error
        x = found.x
        sheet.membrane.wear(x)
    solution = _report(sheet, found, potential, tolerance)
    if strict and not solution.converged:
        raise SheetError(solution.reason, solution)
    return solution


def _check_rim(sheet: ElasticSheet, held: npt.NDArray[np.bool_]) -> None:
    """Refuse a pressure that has no potential."""
    rim = np.unique(sheet.edges.ends[sheet.edges.free])
    loose = int((~held[rim]).any(axis=1).sum())
    if loose:
        raise InputError.single(
            "pressure", got=f"{loose} rim vertices that can move", expected="a rim held all round"
        )


def _held(
    count: int, fixed: npt.NDArray[np.bool_] | None, clamped: npt.NDArray[np.bool_] | None
) -> npt.NDArray[np.bool_]:
    held = np.zeros((count, 3), dtype=bool)
    for name, mask in (("fixed", fixed), ("clamped", clamped)):
        if mask is None:
            continue
        mask = np.asarray(mask)
        if mask.dtype != bool or mask.shape not in ((count,), (count, 3)):
            raise InputError.single(
                name, got=f"{mask.dtype} {mask.shape}", expected=f"bool ({count},) or ({count}, 3)"
            )
        held |= mask if mask.ndim == 2 else mask[:, None]
    return held


def _moved(
    sheet: ElasticSheet, x: FloatArray, target: FloatArray, held: npt.NDArray[np.bool_]
) -> FloatArray:
    """Take held components to ``target``; the free ones follow as a soap film would."""
    move = np.where(held, target - x, 0.0)
    if not move.any():
        return x
    matrix = sheet.stiffness()
    for axis in range(3):
        free = np.flatnonzero(~held[:, axis])
        if not len(free) or not move[:, axis].any():
            continue
        inner = matrix[free][:, free].tocsc()
        move[free, axis] = splu(inner).solve(-(matrix @ move[:, axis])[free])
    return x + move


def _report(
    sheet: ElasticSheet, found: Equilibrium, potential: Potential, tolerance: float
) -> SheetSolution:
    _, gradient = potential.value(found.x)
    reasons = []
    if not found.residual <= tolerance:
        reasons.append(f"residual {found.residual:.2e} above {tolerance:.2e}")
    elif not found.stable:
        reasons.append(f"unstable: {found.downhill} directions lead downhill")
    return SheetSolution(
        positions=found.x,
        sheet=sheet,
        reactions=np.where(potential.free, 0.0, gradient),
        converged=not reasons,
        reason=", ".join(reasons),
        residual=found.residual,
        iterations=found.iterations,
        kicks=found.kicks,
        energy=found.energy,
        peaks=sheet.membrane.peaks,
    )
