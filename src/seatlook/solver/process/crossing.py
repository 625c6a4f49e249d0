"""Where a cover passes through itself, which nothing keeps it from."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from seatlook.mesh import boundary_loops, intersecting_pairs, vertex_normals
from seatlook.model import Cover, FloatArray, IntArray, Points
from seatlook.model.zones import FREE_EDGE

_VERTEX = 1e-9  # weight of a stitch's other vertex below which the stitch is at a vertex


def crossing_pairs(cover: Cover, positions: FloatArray) -> IntArray:
    """Return the pairs (k, 2) of triangles that pass through each other.

    Sewn edges are one line: of two triangles that meet there only edges away from it count.

    Parameters
    ----------
    positions : (n, 3) float64 [m]
    """
    return intersecting_pairs(positions, cover.faces, sewn_vertices(cover))


def hem_crossings(cover: Cover, positions: FloatArray) -> IntArray:
    """Return the pairs (k, 2) of an allowance's triangle that passes through one of the cover.

    The hem has no mesh of its own: an allowance lies one thickness below its panel, inside the
    cover wherever it passes through no panel. The first of a pair is the triangle it lies below.
    """
    hem, n, m = cover.hem, len(positions), len(cover.faces)
    if hem is None:
        return np.zeros((0, 2), dtype=np.int64)
    thickness = np.zeros(n)
    thickness[cover.faces] = cover.thickness[:, None]
    layer = positions - thickness[:, None] * vertex_normals(positions, cover.faces)
    below = np.flatnonzero(hem.density > 0.0)
    faces = np.concatenate([cover.faces, cover.faces[below] + n])
    pairs = intersecting_pairs(np.concatenate([positions, layer]), faces)
    crossings = pairs[(pairs[:, 0] < m) & (pairs[:, 1] >= m)]
    return np.column_stack([below[crossings[:, 1] - m], crossings[:, 0]])


def zone_crossings(cover: Cover, pairs: IntArray) -> dict[str, int]:
    """Count the pairs (k, 2) of triangles that each zone has a part in; zones without are left out.

    A pair of two zones counts in both.
    """
    zone = cover.zone[pairs]
    counts = [int((zone == i).any(axis=1).sum()) for i in range(len(cover.zone_names))]
    return {name: n for name, n in zip(cover.zone_names, counts, strict=True) if n}


def visible_crossings(cover: Cover, pairs: IntArray) -> int:
    """Count the pairs (k, 2) that show: all but those within the band along the free edges."""
    names = np.array(cover.zone_names)
    return int((names[cover.zone[pairs]] != FREE_EDGE).any(axis=1).sum())


def sewn_vertices(cover: Cover) -> IntArray:
    """Pairs (j, 2) of rim vertices that lie over against each other between the same stitches.

    All that meet in one corner are pairs, whether sewn to each other or to a third.
    """
    rims = _Rims(cover.faces, len(cover.rest))
    pairs, corners = [np.zeros((0, 2), dtype=np.int64)], [np.zeros((0, 2), dtype=np.int64)]
    for seam in cover.stitchings:
        for k, following in pairwise(range(len(seam.length))):
            one, other = rims.between(seam.a, k, following), rims.between(seam.b, k, following)
            pairs.append(np.stack(np.meshgrid(one, other), axis=-1).reshape(-1, 2))
        ends = (seam.a.weights.max(axis=1) > 1 - _VERTEX) & (
            seam.b.weights.max(axis=1) > 1 - _VERTEX
        )
        corners.append(np.column_stack([_heavier(side)[ends] for side in (seam.a, seam.b)]))
    return np.concatenate([*pairs, _all_of_one(np.concatenate(corners), len(cover.rest))])


def _heavier(points: Points) -> IntArray:
    """The nearer vertex (s,) of each point."""
    rows = np.arange(len(points))
    return np.asarray(points.vertices[rows, points.weights.argmax(axis=1)])


def _all_of_one(pairs: IntArray, count: int) -> IntArray:
    """All pairs (k, 2) within the groups that ``pairs`` link."""
    ends = np.unique(pairs)
    links = coo_array((np.ones(len(pairs)), tuple(pairs.T)), shape=(count, count))
    group = connected_components(links, directed=False)[1][ends]
    one, other = np.nonzero(group[:, None] == group)
    return np.asarray(np.column_stack([ends[one], ends[other]])[one != other])


class _Rims:
    """The boundary curves of a mesh, and the place of a point on them."""

    def __init__(self, faces: IntArray, count: int) -> None:
        self._loops = boundary_loops(faces)
        self._loop, self._place = np.full(count, -1), np.zeros(count)
        for i, loop in enumerate(self._loops):
            self._loop[loop], self._place[loop] = i, np.arange(len(loop))

    def between(self, points: Points, first: int, second: int) -> IntArray:
        """Vertices from one point to another of the same curve, the shorter way, none elsewhere."""
        on = self._loop[points.vertices[[first, second], 0]]
        if on[0] != on[1] or on[0] < 0:
            return np.zeros(0, dtype=np.int64)
        loop = self._loops[on[0]]
        n = len(loop)
        start = self._at(points, first, n)
        way = (self._at(points, second, n) - start + n / 2) % n - n / 2
        low, high = sorted((start, start + way))
        around = np.arange(int(np.floor(low + _VERTEX)), int(np.ceil(high - _VERTEX)) + 1)
        return np.asarray(loop[around % n] if way else loop[:0])

    def _at(self, points: Points, k: int, n: int) -> float:
        """Place of a point on its curve of ``n`` vertices, the last of which the first follows."""
        one, other = self._place[points.vertices[k]]
        if abs(one - other) > 1:
            one, other = one + n * (one < other), other + n * (other < one)
        return float(points.weights[k] @ (one, other))
