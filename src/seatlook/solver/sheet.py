"""Equilibrium of a bare sheet: any flat mesh, fabric, support and load in one call."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt
from scipy.sparse.linalg import splu

from seatlook.errors import InputError, SolverError
from seatlook.model import Fabric, FloatArray, IntArray
from seatlook.solver.element.elastic import ElasticSheet
from seatlook.solver.element.loads import DeadLoad, EdgeMoment, Pressure
from seatlook.solver.element.shell import Shell
from seatlook.solver.energy import Energy
from seatlook.solver.methods.choice import method_of
from seatlook.solver.methods.explicit import UnstableStepError
from seatlook.solver.methods.newton import Equilibrium, Potential
from seatlook.solver.process.settings import SheetSettings
from seatlook.solver.process.statics import equilibrium

BoolArray = npt.NDArray[np.bool_]


@dataclass(frozen=True, slots=True, eq=False)
class Sheet:
    """A sheet that was cut flat, or a shell.

    Parameters
    ----------
    rest : (n, 2) float64 [m]     flat, warp along axis 0
    faces : (m, 3) int64          counter-clockwise
    fabric : what it is made of
    natural : (n, 3) float64 [m]  shape in space in which it is free of stress; the flat sheet if
        not given. ``rest`` is a map of that shape: true to length where the shape can be unrolled
        (a cylinder, a cone), else any smooth map that keeps angles nearly; stiffness, mass and
        strains are those of the shape.
    """

    rest: FloatArray
    faces: IntArray
    fabric: Fabric
    natural: FloatArray | None = None

    def at_rest(self) -> FloatArray:
        """Positions (n, 3) [m] without stress."""
        if self.natural is not None:
            return np.array(self.natural, dtype=np.float64, order="C")
        return np.pad(np.asarray(self.rest, dtype=np.float64), ((0, 0), (0, 1)))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Support:
    """What holds a sheet.

    Parameters
    ----------
    fixed : (n,) or (n, 3) bool      vertices, or single components, that are held
    clamped : (n,) bool              fixed vertices between which free edges keep their direction
    guided : (n,) bool               the same, of vertices that may move: with the component across
        it in ``fixed``, an edge in a plane of symmetry
    prescribed : (n, 3) float64 [m]  where fixed components are taken to
    foundation : further energies that carry the sheet
    """

    fixed: BoolArray | None = None
    clamped: BoolArray | None = None
    guided: BoolArray | None = None
    prescribed: FloatArray | None = None
    foundation: Sequence[Energy] = ()

    def held(self, count: int) -> BoolArray:
        """Return the components (count, 3) that are held.

        Raises
        ------
        InputError   a mask of another shape
        """
        held = np.zeros((count, 3), dtype=bool)
        for name, mask in (("fixed", self.fixed), ("clamped", self.clamped)):
            if mask is None:
                continue
            mask = np.asarray(mask)
            if mask.dtype != bool or mask.shape not in ((count,), (count, 3)):
                raise InputError.single(
                    name,
                    got=f"{mask.dtype} {mask.shape}",
                    expected=f"bool ({count},) or ({count}, 3)",
                )
            held |= mask if mask.ndim == 2 else mask[:, None]
        return held

    def directed(self, count: int) -> BoolArray | None:
        """Return the vertices (count,) between which free edges keep their direction, if any.

        Raises
        ------
        InputError   a mask of another shape
        """
        masks = [mask for mask in (self.clamped, self.guided) if mask is not None]
        for mask in masks:
            if np.asarray(mask).dtype != bool or np.shape(mask) != (count,):
                raise InputError.single(
                    "clamped, guided", got=str(np.shape(mask)), expected=f"bool ({count},)"
                )
        return np.any(masks, axis=0) if masks else None


@dataclass(frozen=True, slots=True, eq=False)
class Moment:
    """A moment along a free edge, about an axis that keeps its direction.

    Parameters
    ----------
    edge : (n,) bool                 vertices; the free edges between them bear the moment
    per_length : (3,) float64 [N]    moment per length, as a vector along its axis
    """

    edge: BoolArray
    per_length: Sequence[float]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Load:
    """What pulls and presses on a sheet.

    Parameters
    ----------
    forces : (n, 3) float64 [N]      of constant direction
    pressure : float [Pa]            along the face normals, wherever they turn
    gravity : (3,) [m/s2]            acts on the fabric's mass
    moments : along free edges; in one step an edge turns by less than three quarters of a turn
    """

    forces: FloatArray | None = None
    pressure: float = 0.0
    gravity: Sequence[float] = (0.0, 0.0, 0.0)
    moments: Sequence[Moment] = ()

    def turned(self, count: int) -> BoolArray | None:
        """Return the vertices (count,) along whose free edges moments act, if any.

        Raises
        ------
        InputError   a mask or a moment of another shape
        """
        for moment in self.moments:
            if np.asarray(moment.edge).dtype != bool or np.shape(moment.edge) != (count,):
                raise InputError.single(
                    "moments", got=str(np.shape(moment.edge)), expected=f"bool ({count},)"
                )
            if np.shape(moment.per_length) != (3,) or not np.any(moment.per_length):
                raise InputError.single(
                    "moments", got=str(moment.per_length), expected="three numbers, not all 0"
                )
        return np.any([m.edge for m in self.moments], axis=0) if self.moments else None


# How often what a pressure does to a free rim is taken up anew.
_ROUNDS = 40
_FREE, _UNLOADED, _DEFAULT = Support(), Load(), SheetSettings()


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
    peaks : (m, 2 or 3) float64 [1]  largest warp and weft strains so far, and the shear at which
        friction rests where there is some; None if the fabric unloads the way it was loaded
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
    sheet: Sheet,
    *,
    support: Support = _FREE,
    load: Load = _UNLOADED,
    start: FloatArray | SheetSolution | None = None,
    settings: SheetSettings = _DEFAULT,
    strict: bool = False,
) -> SheetSolution:
    """Find the stable equilibrium of a sheet under loads and supports.

    Parameters
    ----------
    start : (n, 3) float64 [m], or an earlier solution of the sheet, with the history of its strains
        where the fabric does not unload as it was loaded; the sheet at rest if not given
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
    >>> solved = solve_sheet(Sheet(rest, faces, fabric), support=Support(fixed=end),
    ...                      load=Load(forces=pull))
    >>> round(float(solved.sheet.strains(solved.positions)[1][0, 0, 0]), 4)
    0.0099
    """
    first, peaks = _start(sheet, start)
    held = support.held(len(first))
    elastic = Shell(
        sheet.rest,
        sheet.faces,
        sheet.fabric,
        natural=sheet.natural,
        turned=load.turned(len(first)),
        clamped=support.directed(len(first)),
        positions=first,
    )
    if peaks is not None:
        elastic.membrane.remember(peaks)
    _check_moments(elastic, load, support)
    target = first if support.prescribed is None else np.where(held, support.prescribed, first)
    state = Equilibrium(first, np.inf, np.zeros(0), 0, -1, 0)
    for share in np.arange(1, settings.steps + 1) / settings.steps:
        x = _moved(elastic, state.x, first + share * (target - first), held)
        loads = [*_outer(elastic, load, share, x), *support.foundation]
        state, potential = _balanced(elastic, loads, ~held, x, settings)
        elastic.membrane.wear(state.x)
    solution = _report(elastic, state, potential, settings.tolerance)
    if strict and not solution.converged:
        raise SheetError(solution.reason, solution)
    return solution


def _balanced(
    elastic: ElasticSheet,
    loads: list[Energy],
    free: BoolArray,
    x: FloatArray,
    settings: SheetSettings,
) -> tuple[Equilibrium, Potential]:
    """Equilibrium under ``loads`` from ``x``, and the potential that it is one of.

    What a pressure does to a rim that moves has no potential: it is held while the rest comes to
    balance, and taken up anew until that no longer matters.
    """
    pressures = [load for load in loads if isinstance(load, Pressure)]
    rim = _rim_force(elastic, pressures, x, free)
    for _ in range(_ROUNDS):
        potential = Potential(elastic.energies, [*loads, DeadLoad(rim)], free)
        try:
            state = equilibrium(
                elastic,
                potential,
                x,
                method_of(settings.method, first="newton"),
                tolerance=settings.tolerance,
                max_iterations=settings.max_iterations,
            )
        except UnstableStepError as error:
            state = Equilibrium(x, np.inf, np.zeros(0), 0, -1, 0)
            last = _report(elastic, state, potential, settings.tolerance)
            raise SheetError(str(error), last) from error
        x, rim = state.x, _rim_force(elastic, pressures, state.x, free)
        if not rim.any() or state.residual > settings.tolerance:
            break
        potential = Potential(elastic.energies, [*loads, DeadLoad(rim)], free)
        residual = potential.residual(x, potential.value(x)[1])
        state = replace(state, residual=residual)
        if residual <= settings.tolerance:
            break
    return state, potential


def _rim_force(
    elastic: ElasticSheet, pressures: list[Pressure], x: FloatArray, free: BoolArray
) -> FloatArray:
    """Force (n, 3) [N] of pressures on what is free of the rim."""
    rim = elastic.edges.ends[elastic.edges.free]
    total = sum((pressure.rim_force(x, rim) for pressure in pressures), np.zeros_like(x))
    return np.where(free, total, 0.0)


def _start(
    sheet: Sheet, start: FloatArray | SheetSolution | None
) -> tuple[FloatArray, FloatArray | None]:
    """Positions (n, 3) in which the search starts, and the largest strains before."""
    if start is None:
        return sheet.at_rest(), None
    if isinstance(start, SheetSolution):
        return start.positions.copy(), start.peaks
    return np.array(start, dtype=np.float64, order="C"), None


def _outer(sheet: Shell, load: Load, share: float, x: FloatArray) -> list[Energy]:
    """Energies of a share of the load, on a sheet that now lies at ``x``."""
    force = np.outer(sheet.mass, load.gravity)
    if load.forces is not None:
        force += load.forces
    energies: list[Energy] = [DeadLoad(share * force)]
    if load.pressure:
        energies.append(Pressure(sheet.faces, share * load.pressure))
    for moment in load.moments:
        edges = sheet.rim_edges(moment.edge)
        per_length = share * np.asarray(moment.per_length, dtype=np.float64)
        slopes = sheet.slopes_across(edges)
        energies.append(EdgeMoment(slopes, sheet.edges.length[edges], per_length, x))
    return energies


def _check_moments(sheet: Shell, load: Load, support: Support) -> None:
    """Refuse a moment that acts on no edge, or on one whose direction is held."""
    directed = support.directed(len(sheet.mass))
    for moment in load.moments:
        edges = sheet.rim_edges(moment.edge)
        held = np.zeros(0) if directed is None else np.intersect1d(edges, sheet.rim_edges(directed))
        if len(held) or not len(edges):
            got = f"{len(held)} edges that are clamped or guided" if len(held) else "no free edge"
            raise InputError.single("moments", got=got, expected="free edges between its vertices")


def _moved(sheet: ElasticSheet, x: FloatArray, target: FloatArray, held: BoolArray) -> FloatArray:
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
    sheet: ElasticSheet, state: Equilibrium, potential: Potential, tolerance: float
) -> SheetSolution:
    _, gradient = potential.value(state.x)
    reasons = []
    if not state.residual <= tolerance:
        reasons.append(f"residual {state.residual:.2e} above {tolerance:.2e}")
    elif not state.stable:
        reasons.append(f"unstable: negative stiffness in {state.downhill} directions")
    return SheetSolution(
        positions=state.x,
        sheet=sheet,
        reactions=np.where(potential.free, 0.0, gradient),
        converged=not reasons,
        reason=", ".join(reasons),
        residual=state.residual,
        iterations=state.iterations,
        kicks=state.kicks,
        energy=state.energy,
        peaks=sheet.membrane.peaks,
    )
