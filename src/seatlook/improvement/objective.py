"""One smooth number for how far a cover is from good, and its derivative by the shape."""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass
from typing import Self

import numpy as np

from seatlook.chain.assess import Assessment
from seatlook.model import Cover, FloatArray, Scene, Solution
from seatlook.model.zones import FREE_EDGE
from seatlook.solver.element.elastic import ElasticSheet
from seatlook.solver.foam.distance import DistanceField, distance_field

# Class of the box that a face is in -> weight; faces in no box count as A.
CLASS_WEIGHTS = {"A": 1.0, "B": 0.5, "C": 0.2}
# Share of its unit by which a kink is rounded; of W2, and of strains and gaps in their own units.
_ROUND = 0.05
_TINY = 1e-12  # that nothing is divided by 0
_SAME = 0.02  # of the threshold: principal curvatures so near are taken as one


@dataclass(frozen=True, slots=True, kw_only=True)
class Goal:
    """What a good cover keeps; beyond it, each unit counts as much as W2 = 1 does.

    Parameters
    ----------
    w2 : net W2 up to which nothing counts
    strain : smallest and largest principal strain [1]: taut, and not torn
    strain_unit : float [1]     beyond the window
    gap : float [m]             of the cover over its foam
    gap_unit : float [m]
    """

    w2: float = 0.1
    strain: tuple[float, float] = (-0.015, 0.06)
    strain_unit: float = 0.05
    gap: float = 2e-3
    gap_unit: float = 4e-3


@dataclass(frozen=True, slots=True, kw_only=True)
class Parts:
    """Value of the objective and its parts, all [1]."""

    w2: float
    strain: float
    gap: float

    @property
    def total(self) -> float:
        """Their sum."""
        return self.w2 + self.strain + self.gap


class Objective:
    """Mean over the area of what W2, strains and gaps are beyond their goals.

    Minimum, absolute value and equal eigenvalues are rounded here; what is reported is not.

    Parameters
    ----------
    solution : at rest
    net : (m, 2, 2) float64 [1/m]    its net curvature; what the design asks for is the rest, and
        stays the same for every change
    c_threshold, weight : (m,) float64
    """

    def __init__(
        self,
        solution: Solution,
        *,
        net: FloatArray,
        c_threshold: FloatArray,
        weight: FloatArray,
        goal: Goal,
    ) -> None:
        cover = solution.cover
        self.goal, self._threshold = goal, c_threshold
        self._round, self._same = _ROUND, _SAME
        self._field = _field_of(cover)
        self._asked = _sheet_of(cover).recovered_curvatures(solution.positions) - net
        self._weight = weight * cover.rest_area / (weight * cover.rest_area).sum()
        corners, count = cover.faces.ravel(), len(cover.rest)
        self._vertex_weight = np.bincount(corners, np.repeat(self._weight / 3.0, 3), count)
        below = np.bincount(corners, np.repeat(0.5 * cover.thickness, 3), count)
        self._below = below / np.maximum(np.bincount(corners, minlength=count), 1)

    def parts(self, sheet: ElasticSheet, x: FloatArray) -> Parts:
        """Evaluate it for a sheet, which may be of another cut, at positions ``x``."""
        w2, strain = self.faces(sheet, x)
        gap, _ = self._gaps(x)
        return Parts(w2=float(w2.sum()), strain=float(strain.sum()), gap=float(gap.sum()))

    def of(self, solution: Solution) -> Parts:
        """Evaluate it for a solved cover of the same mesh, on its own foam."""
        return self.over(solution.cover).parts(_sheet_of(solution.cover), solution.positions)

    def over(self, cover: Cover) -> Self:
        """The same on the foam of another cover of this mesh."""
        other = copy(self)
        other._field = _field_of(cover)
        return other

    def literal(self) -> Self:
        """The same with sharp kinks: 0 where nothing is beyond its goal; it has no gradient."""
        other = copy(self)
        other._round = other._same = 0.0
        return other

    def faces(self, sheet: ElasticSheet, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """What every face adds by W2 and by strain, (m,) each."""
        w2, _ = self._wrinkles(sheet.recovered_curvatures(x))
        strain, _ = self._strains(sheet.membrane.strain(x))
        return w2, strain

    def gradient(self, sheet: ElasticSheet, x: FloatArray) -> FloatArray:
        """Derivative (n, 3) [1/m] by the positions."""
        _, curvature = self._wrinkles(sheet.recovered_curvatures(x))
        _, strain = self._strains(sheet.membrane.strain(x))
        _, gap = self._gaps(x)
        return sheet.curvature_back(x, curvature) + sheet.membrane.back(x, strain) + gap

    def rise(self, x: FloatArray, height: FloatArray) -> float:
        """Derivative where the foam below the vertices rises by ``height`` (n,) [m]."""
        distance, _ = self._distances(x)
        _, rate = self._beyond((distance - self.goal.gap) / self.goal.gap_unit)
        return -float((self._vertex_weight * rate / self.goal.gap_unit) @ height)

    def _wrinkles(self, recovered: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Mean of net W2 beyond its goal, and derivative by the curvature (m, 2, 2)."""
        net = (recovered - self._asked) / self._threshold[:, None, None]
        least, slope = _least(net, self._same)
        value, rate = self._beyond(-least - self.goal.w2)
        pull = (-self._weight * rate / self._threshold)[:, None, None] * slope
        return self._weight * value, pull

    def _strains(self, E: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Mean of principal strains outside their window, and derivative by (E11, E22, 2 E12)."""
        tensor = np.stack([E[:, 0], 0.5 * E[:, 2], 0.5 * E[:, 2], E[:, 1]], axis=1)
        unit, (low, high) = self.goal.strain_unit, self.goal.strain
        scaled = tensor.reshape(-1, 2, 2) / unit
        least, down = _least(scaled, self._same)
        most, up = _least(-scaled, self._same)
        slack, slack_rate = self._beyond(low / unit - least)
        torn, torn_rate = self._beyond(-most - high / unit)
        slope = torn_rate[:, None, None] * up - slack_rate[:, None, None] * down
        slope *= (self._weight / unit)[:, None, None]
        pull = np.stack([slope[:, 0, 0], slope[:, 1, 1], slope[:, 0, 1]], axis=1)
        return self._weight * (slack + torn), pull

    def _gaps(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """What gaps beyond their goal add at every vertex, and the derivative by the positions."""
        gap, direction = self._distances(x)
        value, rate = self._beyond((gap - self.goal.gap) / self.goal.gap_unit)
        pull = (self._vertex_weight * rate / self.goal.gap_unit)[:, None] * direction
        return self._vertex_weight * value, pull

    def _beyond(self, value: FloatArray) -> tuple[FloatArray, FloatArray]:
        """What is above 0, its kink rounded, and the slope of that."""
        root = np.maximum(np.hypot(value, self._round), _TINY)
        return 0.5 * (value + root), 0.5 * (1.0 + value / root)

    def _distances(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Gap (n,) [m] over the foam and its slope (n, 3); none where the foam is far."""
        if self._field is None:
            return np.zeros(len(x)), np.zeros_like(x)
        distance, direction = self._field.at(x)
        near = np.isfinite(distance)
        gap = np.where(near, distance - self._below, 0.0)
        return gap, np.where(near[:, None], direction, 0.0)


def objective_of(scene: Scene, assessment: Assessment, goal: Goal) -> Objective:
    """Set up the objective for a result, with the weights of its scene's boxes."""
    classes = {box.name: str(box.visibility) for box in scene.boxes}
    return Objective(
        assessment.solution,
        net=assessment.surface.net,
        c_threshold=assessment.surface.c_threshold,
        weight=weights(assessment.solution.cover, classes),
        goal=goal,
    )


def _sheet_of(cover: Cover) -> ElasticSheet:
    fabrics = [material.fabric for material in cover.materials]
    return ElasticSheet(cover.rest, cover.faces, cover.panel, fabrics, hem=cover.hem)


def _field_of(cover: Cover) -> DistanceField | None:
    return None if cover.foam is None else distance_field(cover.foam.vertices, cover.foam.faces)


def _least(tensor: FloatArray, same: float) -> tuple[FloatArray, FloatArray]:
    """Smaller eigenvalue (m,) of symmetric tensors, rounded where both meet; slope (m, 2, 2)."""
    a, b, c = tensor[:, 0, 0], tensor[:, 1, 1], 0.5 * (tensor[:, 0, 1] + tensor[:, 1, 0])
    half = 0.5 * (a - b)
    radius = np.sqrt(half**2 + c**2 + same**2)
    size = np.maximum(radius, _TINY)
    lean, turn = 0.5 * half / size, 0.5 * c / size
    slope = np.stack([0.5 - lean, -turn, -turn, 0.5 + lean], axis=1).reshape(-1, 2, 2)
    return 0.5 * (a + b) - radius, slope


def weights(cover: Cover, classes: dict[str, str]) -> FloatArray:
    """Weight (m,) of every face: by the class of its box, 0 on the band beside free edges.

    Parameters
    ----------
    classes : zone -> "A", "B" or "C"
    """
    of_zone = np.array(
        [0.0 if n == FREE_EDGE else CLASS_WEIGHTS[classes.get(n, "A")] for n in cover.zone_names]
    )
    return np.asarray(of_zone[cover.zone])
