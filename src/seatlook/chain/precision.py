"""Zone means to a tolerance: mesh and time steps chosen before, the error measured after."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from seatlook.assembly import with_mesh
from seatlook.chain.case import Case
from seatlook.errors import InputError
from seatlook.model import Scene, Solution
from seatlook.model.progress import Progress, silent
from seatlook.results.resolution import CURVATURE_ERROR, PER_WAVE, Resolution, resolution
from seatlook.solver import SolverSettings, foam_wavelength
from seatlook.wrinkle import ZoneRow

_RATIO = math.sqrt(2.0)  # of the two element sizes: half the work, and an error of second order
_STEP = 0.02  # s, of the process, which errs by _STEP_ERROR
_STEP_ERROR = 0.02  # the demo at 20 mm: 4 % between 0.04 and 0.02 s, 0.4 % between 0.02 and 0.01
_MOST_VERTICES = 60_000


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


@dataclass(frozen=True, slots=True)
class ZoneMean:
    """Mean W2 of a zone on the finer mesh, and its difference from the coarser one [1]."""

    zone: str
    w2_mean: float
    error: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Precise:
    """A solution and how far its zone means can be trusted.

    Parameters
    ----------
    zones : means and errors, zone by zone
    error : over all zones, root of the area-weighted mean square error over the mean W2
    tolerance : what was asked for
    """

    plan: Plan
    solution: Solution
    coarse: Solution
    zones: tuple[ZoneMean, ...]
    error: float
    tolerance: float

    @property
    def reached(self) -> bool:
        """Whether the solution is resolved within the tolerance and the coarser one converged."""
        return self.resolution.resolved and self.coarse.status == "converged"

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
    size = wave * min(math.sqrt(0.5 * tolerance / CURVATURE_ERROR), 1.0 / PER_WAVE)
    area = sum(_area(panel.outline) for panel in scene.pattern.panels)
    vertices = area / (size**2 * math.sqrt(0.75))
    if vertices > _MOST_VERTICES:
        possible = 2.0 * CURVATURE_ERROR * area / (_MOST_VERTICES * math.sqrt(0.75) * wave**2)
        raise InputError.single(
            "tolerance", got=tolerance, expected=f"{possible:.2g} or more",
            hint=f"{1e3 * size:.2g} mm elements would make {vertices:,.0f} vertices",
        )  # fmt: skip
    return Plan(size, _STEP * min(1.0, 0.5 * tolerance / _STEP_ERROR), wave)


def solve_to(scene: Scene, tolerance: float, *, progress: Progress = silent) -> Precise:
    """Solve on the planned mesh and on one coarser by the root of two, and compare zone means.

    For a method of second order the difference between the two meshes is the error of the finer.
    Where wrinkles choose another pattern on the other mesh it holds that as well.

    Raises
    ------
    InputError    as ``plan``; and what ``solve`` raises
    """
    chosen = plan(scene, tolerance)
    fine, coarse = (
        Case(with_mesh(scene, element_size=size))
        for size in (chosen.element_size, _RATIO * chosen.element_size)
    )
    for case in (fine, coarse):
        case.solve(settings=SolverSettings(dt=chosen.dt), progress=progress)
    rows = [case.assessment.zones for case in (fine, coarse)]
    zones, error = compare_means(*rows)
    return Precise(
        plan=chosen,
        solution=fine.solution,
        coarse=coarse.solution,
        zones=zones,
        error=error,
        tolerance=tolerance,
    )


def compare_means(
    fine: Sequence[ZoneRow], coarse: Sequence[ZoneRow]
) -> tuple[tuple[ZoneMean, ...], float]:
    """Return the mean W2 of every zone with its error, and the error over all zones.

    A zone without a face on the coarser mesh has no error: nan, and does not count.
    """
    other = {row.zone: row["w2_mean"] for row in coarse}
    zones = tuple(
        ZoneMean(row.zone, row["w2_mean"], abs(row["w2_mean"] - other.get(row.zone, math.nan)))
        for row in fine
    )
    area = np.array([row.area for row in fine])
    mean = float(np.array([row["w2_mean"] for row in fine]) @ area / area.sum())
    errors = np.array([zone.error for zone in zones])
    known = np.isfinite(errors)
    square = float(errors[known] ** 2 @ area[known] / area[known].sum())
    return zones, math.sqrt(square) / mean if mean > 0.0 else 0.0


def _area(outline: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> float:
    x, y = outline.T
    return float(0.5 * abs(x @ np.roll(y, -1) - y @ np.roll(x, -1)))
