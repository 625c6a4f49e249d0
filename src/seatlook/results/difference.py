"""Two covers, one map: where the one wrinkles more than the other."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import KDTree

from seatlook.errors import InputError
from seatlook.model import FloatArray, Solution
from seatlook.wrinkle import recover

_APART = 3.0  # element sizes to the nearest vertex of the other cover, beyond which there is none


@dataclass(frozen=True, slots=True, kw_only=True)
class ZoneDifference:
    """Means of one value in one zone of both covers, weighted by rest area."""

    zone: str
    mean: float
    other: float

    @property
    def difference(self) -> float:
        """How much more the first cover has."""
        return self.mean - self.other


def difference(
    solution: Solution, values: FloatArray, other: Solution, other_values: FloatArray
) -> FloatArray:
    """Subtract a value of another cover, face by face, on the faces of the first.

    On the same mesh it is the plain difference. Else the other's values are carried to its
    vertices and taken, panel by panel, from the nearest point of the pattern, so that variants
    whose panels changed size or mesh can be compared. Both panels are laid corner on corner.

    Parameters
    ----------
    values, other_values : (m,) and (m',) float64

    Returns
    -------
    (m,) float64    nan where the other cover has no such panel, or nothing near

    Raises
    ------
    InputError
        Values that do not belong to their covers.
    """
    for cover, array in ((solution.cover, values), (other.cover, other_values)):
        if array.shape != (len(cover.faces),):
            raise InputError.single(
                "values", got=f"shape {array.shape}", expected=f"({len(cover.faces)},)"
            )
    first, second = solution.cover, other.cover
    if np.array_equal(first.faces, second.faces) and first.panel_names == second.panel_names:
        return values - other_values
    nodal = recover(second.rest, second.faces, other_values)
    smooth = recover(first.rest, first.faces, values)[first.faces].mean(axis=1)
    centre = first.rest[first.faces].mean(axis=1)
    out = np.full(len(values), np.nan)
    for number, name in enumerate(first.panel_names):
        rows = np.flatnonzero(first.panel == number)
        if name not in second.panel_names or not len(rows):
            continue
        used = np.unique(second.faces[second.panel == second.panel_names.index(name)])
        if not len(used):
            continue
        shift = first.rest[first.faces[rows]].min(axis=(0, 1)) - second.rest[used].min(axis=0)
        distance, nearest = KDTree(second.rest[used] + shift).query(centre[rows])
        index = np.asarray(nearest)
        near = distance < _APART * max(first.element_size, second.element_size)
        out[rows[near]] = smooth[rows[near]] - nodal[used[index[near]]]
    return out


def zone_differences(
    solution: Solution, values: FloatArray, other: Solution, other_values: FloatArray
) -> tuple[ZoneDifference, ...]:
    """Compare zones of the same name by their means: buckled patterns are not unique."""
    means, other_means = (
        _zone_means(*pair) for pair in ((solution, values), (other, other_values))
    )
    return tuple(
        ZoneDifference(zone=zone, mean=means[zone], other=other_means[zone])
        for zone in means
        if zone in other_means
    )


def _zone_means(solution: Solution, values: FloatArray) -> dict[str, float]:
    cover, area = solution.cover, solution.cover.rest_area
    count = len(cover.zone_names)
    weight = np.bincount(cover.zone, area, count)
    total = np.bincount(cover.zone, area * values, count)
    return {
        name: float(t / w) for name, t, w in zip(cover.zone_names, total, weight, strict=True) if w
    }
