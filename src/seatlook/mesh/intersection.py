"""Which triangles of a surface pass through each other."""

from __future__ import annotations

from itertools import combinations_with_replacement

import numpy as np
import numpy.typing as npt
from scipy.spatial import cKDTree

from seatlook.mesh.surface import FloatArray, IntArray

BoolArray = npt.NDArray[np.bool_]

_FLAT = 1e-9  # of a triangle's size; nearer to its plane than that is in it
_BLOCK = 32768  # pairs that are looked at together, which bounds the memory
_SIDES = ((0, 1), (1, 2), (2, 0))


def intersecting_pairs(
    points: FloatArray, faces: IntArray, joined: IntArray | None = None
) -> IntArray:
    """Return the pairs (k, 2) of triangles that pass through each other, smaller number first.

    Triangles that touch in a point or an edge do not; those that lie in one plane do if their
    insides overlap. Neighbours cannot but meet in the vertices that they share: of such a pair
    only the edges away from these count.

    Parameters
    ----------
    points : (n, 3) float64 [m]; faces : (m, 3) int64
    joined : (j, 2) int64   vertices that are one place to within a gap, such as sewn ones

    Notes
    -----
    Two triangles intersect if an edge of one crosses the other, or both lie in one plane
    (Möller 1997). Signs are those of float64: exact but where a corner is within about 1e-9 of the
    triangle's size of the other's plane, which counts as touching it.

    Examples
    --------
    >>> floor = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
    >>> points = np.array([*floor, [0.2, 0.2, -1], [0.3, 0.2, 1], [0.2, 0.3, 1]])
    >>> intersecting_pairs(points, np.array([[0, 1, 2], [3, 4, 5]]))
    array([[0, 1]])
    """
    if len(faces) < 2:
        return np.zeros((0, 2), dtype=np.int64)
    pairs, same_place = _near(points[faces]), _Joined(joined, len(points))
    blocks = np.split(pairs, range(_BLOCK, len(pairs), _BLOCK))
    return np.concatenate([_intersecting(points, faces, block, same_place) for block in blocks])


def _intersecting(
    points: FloatArray, faces: IntArray, pairs: IntArray, joined: _Joined
) -> IntArray:
    """Those of the pairs (k, 2) of triangles that pass through each other."""
    first, second = points[faces[pairs[:, 0]]], points[faces[pairs[:, 1]]]
    below, above = _heights(first, second), _heights(second, first)
    flat = (below == 0.0).all(axis=1) & (above == 0.0).all(axis=1)
    chosen = np.flatnonzero(_straddles(below) & _straddles(above) | flat)
    pairs, flat = pairs[chosen], flat[chosen]
    first, second = first[chosen], second[chosen]
    same = joined.corners(faces[pairs[:, 0]], faces[pairs[:, 1]])
    first_shared, second_shared = np.asarray(same.any(axis=2)), np.asarray(same.any(axis=1))
    crossing = _crossed(first, second, above[chosen], first_shared)
    crossing |= _crossed(second, first, below[chosen], second_shared)
    coplanar = np.flatnonzero(flat & ~same.any(axis=(1, 2)))
    crossing[coplanar] = _overlap(first[coplanar], second[coplanar])
    return np.asarray(pairs[crossing])


def _near(corners: FloatArray) -> IntArray:
    """Pairs (k, 2) of triangles (m, 3, 3) whose boxes overlap, in order."""
    centre = corners.mean(axis=1)
    reach = np.linalg.norm(corners - centre[:, None], axis=2).max(axis=1)
    pairs = _within_reach(centre, reach)
    i, j = pairs.T
    pairs = pairs[((centre[i] - centre[j]) ** 2).sum(axis=1) < (reach[i] + reach[j]) ** 2]
    low, high = corners.min(axis=1), corners.max(axis=1)
    i, j = pairs.T
    pairs = pairs[((low[i] <= high[j]) & (low[j] <= high[i])).all(axis=1)]
    return np.asarray(pairs[np.lexsort(pairs.T[::-1])])


def _within_reach(centre: FloatArray, reach: FloatArray) -> IntArray:
    """Pairs (k, 2) of centres (m, 3) at most both their reaches (m,) apart, and some more.

    They are sought among triangles of much the same size: beside one large triangle in a mesh of
    small ones, its reach would make pairs of all of them.
    """
    size = np.floor(np.log2(np.maximum(reach, 1e-9 * reach.max(initial=1.0)))).astype(np.int64)
    groups = [np.flatnonzero(size == each) for each in np.unique(size)]
    trees = [cKDTree(centre[group]) for group in groups]
    found = []
    for a, b in combinations_with_replacement(range(len(groups)), 2):
        radius = reach[groups[a]].max() + reach[groups[b]].max()
        if a == b:
            own = trees[a].query_pairs(radius, output_type="ndarray")
            found.append(groups[a][own])
        else:
            near = trees[a].sparse_distance_matrix(trees[b], radius, output_type="coo_matrix")
            found.append(np.column_stack([groups[a][near.row], groups[b][near.col]]))
    return np.sort(np.concatenate(found).astype(np.int64), axis=1)


def _heights(plane: FloatArray, corners: FloatArray) -> FloatArray:
    """Signed distance (k, 3) of corners from the planes of triangles (k, 3, 3), 0 if in them."""
    normal = np.cross(plane[:, 1] - plane[:, 0], plane[:, 2] - plane[:, 0])
    area = np.linalg.norm(normal, axis=1)
    normal /= np.maximum(area, np.finfo(float).tiny)[:, None]
    height = np.einsum("kcd,kd->kc", corners - plane[:, :1], normal)
    height[np.abs(height) <= _FLAT * np.sqrt(area)[:, None]] = 0.0
    return np.asarray(height)


def _straddles(height: FloatArray) -> BoolArray:
    """Whether corners lie on both sides."""
    return np.asarray((height.min(axis=1) < 0.0) & (height.max(axis=1) > 0.0))


def _crossed(
    triangle: FloatArray, other: FloatArray, height: FloatArray, shared: BoolArray
) -> BoolArray:
    """Whether an edge of ``triangle`` goes through the inside of ``other``, (k,).

    ``height`` (k, 3) of the triangle's corners above the other's plane; ``shared`` (k, 3) for those
    that are corners of both.
    """
    crossing = np.zeros(len(triangle), dtype=bool)
    for i, j in _SIDES:
        k = np.flatnonzero((height[:, i] * height[:, j] < 0.0) & ~shared[:, i] & ~shared[:, j])
        start, end, o = triangle[k, i], triangle[k, j], other[k]
        along, spoke = end - start, o - start[:, None]
        side = np.stack(
            [np.einsum("kd,kd->k", along, np.cross(spoke[:, a], spoke[:, b])) for a, b in _SIDES],
            axis=1,
        )
        crossing[k] |= (side > 0.0).all(axis=1) | (side < 0.0).all(axis=1)
    return crossing


def _overlap(first: FloatArray, second: FloatArray) -> BoolArray:
    """Whether triangles (k, 3, 3) of one plane share more than their rims, by separating axes."""
    normal = np.cross(first[:, 1] - first[:, 0], first[:, 2] - first[:, 0])
    apart = np.zeros(len(first), dtype=bool)
    for triangle in (first, second):
        for i, j in _SIDES:
            axis = np.cross(normal, triangle[:, j] - triangle[:, i])
            a, b = (np.einsum("kcd,kd->kc", t, axis) for t in (first, second))
            shared = np.minimum(a.max(axis=1), b.max(axis=1)) - np.maximum(
                a.min(axis=1), b.min(axis=1)
            )
            apart |= shared <= _FLAT * np.abs(a.max(axis=1) - a.min(axis=1))
    return ~apart


class _Joined:
    """Which vertices are one place."""

    def __init__(self, joined: IntArray | None, count: int) -> None:
        pairs = np.zeros((0, 2), dtype=np.int64) if joined is None else joined
        self._count = count
        self._some = np.zeros(count, dtype=bool)
        self._some[pairs] = True
        self._keys = np.unique(np.concatenate([pairs, pairs[:, ::-1]]) @ [count, 1])

    def corners(self, first: IntArray, second: IntArray) -> BoolArray:
        """Whether corner i of the first (k, 3) is corner j of the second, (k, 3, 3)."""
        a, b = first[:, :, None], second[:, None, :]
        same = a == b
        if len(self._keys):
            key = a * self._count + b
            at = np.minimum(np.searchsorted(self._keys, key), len(self._keys) - 1)
            same |= (self._keys[at] == key) & self._some[a] & self._some[b]
        return np.asarray(same)
