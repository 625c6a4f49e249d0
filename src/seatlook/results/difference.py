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
    for cover, given in ((solution.cover, values), (other.cover, other_values)):
        if given.shape != (len(cover.faces),):
            raise InputError.single(
                "values", got=f"shape {given.shape}", expected=f"({len(cover.faces)},)"
            )
    mine, theirs = solution.cover, other.cover
    if np.array_equal(mine.faces, theirs.faces) and mine.panel_names == theirs.panel_names:
        return values - other_values
    carried = recover(theirs.rest, theirs.faces, other_values)
    smooth = recover(mine.rest, mine.faces, values)[mine.faces].mean(axis=1)
    centre = mine.rest[mine.faces].mean(axis=1)
    out = np.full(len(values), np.nan)
    for number, name in enumerate(mine.panel_names):
        rows = np.flatnonzero(mine.panel == number)
        if name not in theirs.panel_names or not len(rows):
            continue
        used = np.unique(theirs.faces[theirs.panel == theirs.panel_names.index(name)])
        if not len(used):
            continue
        shift = mine.rest[mine.faces[rows]].min(axis=(0, 1)) - theirs.rest[used].min(axis=0)
        distance, found = KDTree(theirs.rest[used] + shift).query(centre[rows])
        near = np.asarray(found)
        there = distance < _APART * max(mine.element_size, theirs.element_size)
        out[rows[there]] = smooth[rows[there]] - carried[used[near[there]]]
    return out


def zone_differences(
    solution: Solution, values: FloatArray, other: Solution, other_values: FloatArray
) -> tuple[ZoneDifference, ...]:
    """Compare zones of the same name by their means: buckled patterns are not unique."""
    mine, theirs = (_zone_means(*pair) for pair in ((solution, values), (other, other_values)))
    return tuple(
        ZoneDifference(zone=zone, mean=mine[zone], other=theirs[zone])
        for zone in mine
        if zone in theirs
    )


def _zone_means(solution: Solution, values: FloatArray) -> dict[str, float]:
    cover, area = solution.cover, solution.cover.rest_area
    count = len(cover.zone_names)
    weight = np.bincount(cover.zone, area, count)
    total = np.bincount(cover.zone, area * values, count)
    return {
        name: float(t / w) for name, t, w in zip(cover.zone_names, total, weight, strict=True) if w
    }
