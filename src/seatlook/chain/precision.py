"""Zone means to a tolerance: mesh and time steps chosen before, the error measured after."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from seatlook.assembly import with_mesh
from seatlook.chain.case import Case
from seatlook.chain.companions import (
    ZoneMean,
    compare_means,
    mesh_errors,
    observed_order,
    scatter,
    with_companions,
)
from seatlook.errors import InputError
from seatlook.model import Scene, Solution
from seatlook.model.progress import Progress, silent
from seatlook.results.resolution import CURVATURE_ERROR, PER_WAVE, Resolution, resolution
from seatlook.solver import SolverSettings, foam_wavelength

_COARSEST = 1.0 / PER_WAVE  # of lambda, for the shape itself
_RATIO = math.sqrt(2.0)  # of neighbouring element sizes: half the work
_STEP = 0.02  # s, of the process, which errs by _STEP_ERROR
_STEP_ERROR = 0.02  # the demo at 20 mm: 4 % between 0.04 and 0.02 s, 0.4 % between 0.02 and 0.01
_MOST_VERTICES = 60_000
_SEEDS = 5  # of the coarsest mesh


@dataclass(frozen=True, slots=True)
class Plan:
    """What a tolerance asks for.

    Parameters
    ----------
    element_size : float [m]
    dt : float [s]            time step of the process
    wavelength : float [m]    shortest wrinkle of the scene's fabrics on its foam
    """

    element_size: float
    dt: float
    wavelength: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Precise:
    """A solution and how far its zone means can be trusted.

    Parameters
    ----------
    solution : with the companions of every zone among its figures
    coarse : on a mesh coarser by the root of two
    others : on a mesh coarser by two, one of each seed
    zones : means and errors, zone by zone
    orders : kind of zone -> order at which its means converge
    error : over all zones, root of the area-weighted mean square mesh error over the mean W2
    tolerance : what was asked for
    """

    plan: Plan
    solution: Solution
    coarse: Solution
    others: tuple[Solution, ...]
    zones: tuple[ZoneMean, ...]
    orders: MappingProxyType[str, float]
    error: float
    tolerance: float

    @property
    def reached(self) -> bool:
        """Whether the solution is resolved within the tolerance and the coarser ones converged."""
        return self.resolution.resolved and not self.unconverged

    @property
    def unconverged(self) -> tuple[str, ...]:
        """Why coarser meshes are not at rest, one sentence each."""
        coarser = (self.coarse, *self.others)
        return tuple(
            f"elements of {1e3 * s.cover.element_size:.3g} mm, seed {s.cover.seed}: {s.reason}"
            for s in coarser
            if s.status != "converged"
        )

    @property
    def resolution(self) -> Resolution:
        """What is to be thought of the solution, its measured error included."""
        return resolution(self.solution).measured(self.error, self.tolerance)


def plan(scene: Scene, tolerance: float) -> Plan:
    """Choose element size and time step for a relative error of the zone means of W2.

    Parameters
    ----------
    tolerance : float [1] in (0, 1)

    Notes
    -----
    The index is a curvature, whose error on a wave of lambda is 3.9 (h / lambda)^2; backward Euler
    errs in proportion to its step. Half the tolerance goes to each.

    Raises
    ------
    InputError
        Not a share, or a mesh of more than 60,000 vertices would be needed.
    """
    if not 0.0 < tolerance < 1.0:
        raise InputError.single("tolerance", got=tolerance, expected="a share between 0 and 1")
    fabrics = [material.fabric for material in scene.materials.values()]
    wave = min(foam_wavelength(fabric, scene.foam.material) for fabric in fabrics)
    size = wave * min(math.sqrt(0.5 * tolerance / CURVATURE_ERROR), _COARSEST)
    area = sum(_area(panel.outline) for panel in scene.pattern.panels)
    vertices = area / (size**2 * math.sqrt(0.75))
    if vertices > _MOST_VERTICES:
        possible = 2.0 * CURVATURE_ERROR * area / (_MOST_VERTICES * math.sqrt(0.75) * wave**2)
        raise InputError.single(
            "tolerance", got=tolerance, expected=f"{possible:.2g} or more",
            hint=f"{1e3 * size:.2g} mm elements would make {vertices:,.0f} vertices",
        )  # fmt: skip
    return Plan(size, _STEP * min(1.0, 0.5 * tolerance / _STEP_ERROR), wave)


def solve_to(
    scene: Scene, tolerance: float, *, seeds: int = _SEEDS, progress: Progress = silent
) -> Precise:
    """Solve on the planned mesh, on one coarser by the root of two, and some coarser by two.

    The three sizes tell at which order the means converge; the two finer ones then tell the mesh
    error of each zone, see ``chain.companions``. Seeds are solved cold on the coarsest mesh: begun
    from a shape at rest, a cover stays in the folds that it has.

    Parameters
    ----------
    seeds : of the coarsest mesh, 2 or more

    Raises
    ------
    InputError    as ``plan``; fewer than two seeds; and what ``solve`` raises
    """
    if seeds < 2:
        raise InputError.single("seeds", got=seeds, expected="2 or more")
    chosen = plan(scene, tolerance)
    fine, coarse = (
        Case(with_mesh(scene, element_size=size))
        for size in (chosen.element_size, _RATIO * chosen.element_size)
    )
    others = [
        Case(with_mesh(scene, element_size=_RATIO**2 * chosen.element_size, seed=scene.seed + k))
        for k in range(seeds)
    ]
    for case in (fine, coarse, *others):
        case.solve(settings=SolverSettings(dt=chosen.dt), progress=progress)
    rows = [case.assessment.zones for case in (fine, coarse, *others)]
    kinds = _kinds([row.zone for row in rows[0]], hooked_zones(scene))
    orders = {
        kind: observed_order(rows[0], rows[1], rows[2:], _RATIO, zones)
        for kind, zones in kinds.items()
    }
    by_zone = {zone: orders[kind] for kind, zones in kinds.items() for zone in zones}
    errors = mesh_errors(rows[0], rows[1], rows[2:], _RATIO, by_zone)
    zones = tuple(
        ZoneMean(row.zone, row["w2_mean"], errors[row.zone], scatter(rows[2:], row), row.criterion)
        for row in rows[0]
    )
    _, error = compare_means(rows[0], rows[1], errors)
    return Precise(
        plan=chosen,
        solution=with_companions(fine.solution, zones, seeds),
        coarse=coarse.solution,
        others=tuple(case.solution for case in others),
        zones=zones,
        orders=MappingProxyType(orders),
        error=error,
        tolerance=tolerance,
    )


def hooked_zones(scene: Scene) -> frozenset[str]:
    """Names of the bands of seams that a hook pulls down: they have a kink on the wire."""
    return frozenset(f"seam {line}" for hook in scene.hooks for line in hook.lines)


def _kinds(zones: Sequence[str], hooked: frozenset[str]) -> Mapping[str, tuple[str, ...]]:
    """Zones by how their means converge; kinds without a zone are left out."""
    kinds: dict[str, list[str]] = {}
    for zone in zones:
        kind = "hooked seams" if zone in hooked else "seams" if zone[:5] == "seam " else "interiors"
        kinds.setdefault(kind, []).append(zone)
    return {kind: tuple(names) for kind, names in kinds.items()}


def _area(outline: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> float:
    x, y = outline.T
    return float(0.5 * abs(x @ np.roll(y, -1) - y @ np.roll(x, -1)))
