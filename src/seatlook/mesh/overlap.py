"""Flat outlines in space that lie in one plane and cover each other."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import shapely

from seatlook.mesh.surface import FloatArray

_ONE_PLANE = 0.001  # m, between outlines that lie on each other
_COVERED = 0.01  # share of the smaller outline from which it counts as covered
_STEP = 0.003  # m, between outlines above each other


def shared_area(one: FloatArray, two: FloatArray) -> float:
    """Area [m2] that two flat outlines share in one plane; 0 if they are not in one, or hardly.

    Parameters
    ----------
    one, two : (n, 3), (m, 3) float64 [m]   flat polygons

    Examples
    --------
    >>> square = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    >>> shared_area(square, square + [0.75, 0.0, 0.0])
    0.25
    >>> shared_area(square, square + [0.75, 0.0, 0.1])
    0.0
    """
    origin, axes = _plane(one)
    here, there = (one - origin) @ axes.T, (two - origin) @ axes.T
    if np.abs(there[:, 2]).max() > _ONE_PLANE:
        return 0.0
    a, b = shapely.Polygon(here[:, :2]), shapely.Polygon(there[:, :2])
    shared = float(a.intersection(b).area)
    return shared if shared > _COVERED * min(a.area, b.area) else 0.0


def lifts(outlines: Sequence[FloatArray]) -> FloatArray:
    """Way (k, 3) [m] to move each flat outline along its normal so that none covers another.

    Each takes the lowest level that no earlier one has which covers it; most need not move.

    Examples
    --------
    >>> square = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    >>> lifts([square, square + [0.5, 0.0, 0.0], square + [1.25, 0.0, 0.0]])[:, 2]
    array([0.   , 0.003, 0.   ])
    """
    level = np.zeros(len(outlines))
    for number, outline in enumerate(outlines):
        taken = {level[i] for i in range(number) if shared_area(outlines[i], outline) > 0.0}
        level[number] = next(free for free in range(number + 1) if free not in taken)
    normals = np.array([_plane(outline)[1][2] for outline in outlines]).reshape(-1, 3)
    return np.asarray(_STEP * level[:, None] * normals)


def _plane(outline: FloatArray) -> tuple[FloatArray, FloatArray]:
    """First point and axes (3, 3) of a flat polygon; the last is its normal (Newell)."""
    around = outline - outline[0]
    normal = np.cross(around, np.roll(around, -1, axis=0)).sum(axis=0)
    normal = normal / np.linalg.norm(normal)
    along = around[np.argmax(np.linalg.norm(around, axis=1))]
    along = along / np.linalg.norm(along)
    return outline[0], np.array([along, np.cross(normal, along), normal])
