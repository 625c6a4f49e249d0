"""Edges of a flat mesh and the operators that recover the slope across each of them.

The `edgeslope` element keeps vertices as its only unknowns. A least-squares quadratic around every
edge gives the slope along the edge's conormal. Bending takes its curvature from these slopes
(Morley's element with the edge rotation recovered instead of unknown); the membrane corrects the
length of every edge from its chord to its arc with the same curvature.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array

from seatlook.errors import InputError, InvertedElementError
from seatlook.model import FloatArray, IntArray
from seatlook.solver.kernels import edgeslope as kernels

# A fit whose pivots spread more than this takes the nodes of one more ring.
_WEAK = 0.03


@dataclass(frozen=True, slots=True)
class Edges:
    """Connectivity of a triangle mesh, one row per edge.

    Parameters
    ----------
    ends : (e, 2) int64         in the direction of the first face, which lies on the left
    faces : (e, 2) int64        second column -1 at a free edge
    of_face : (m, 3) int64      edge k runs from corner k to corner k + 1
    sign : (m, 3) float64       +1 where the edge's conormal points out of the face
    length : (e,) float64 [m]
    normal : (e, 2) float64     conormal, out of the first face
    """

    ends: IntArray
    faces: IntArray
    of_face: IntArray
    sign: FloatArray
    length: FloatArray
    normal: FloatArray

    @property
    def free(self) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
        """Edges with one face only, (e,)."""
        return np.asarray(self.faces[:, 1] < 0)


@dataclass(frozen=True, slots=True)
class Rows:
    """Conormal-slope rows, compressed: slope = sum of weights times nodal values."""

    start: IntArray
    nodes: IntArray
    weights: FloatArray


def areas(rest: FloatArray, faces: IntArray) -> FloatArray:
    """Return the rest area (m,) [m2]; raise InvertedElementError for a turned-over triangle."""
    p = rest[faces]
    u, v = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    area = 0.5 * (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
    longest = np.max(np.sum((p - np.roll(p, 1, axis=1)) ** 2, axis=2), axis=1)
    bad = np.flatnonzero(~(area > 1e-6 * longest))
    if len(bad):
        raise InvertedElementError(
            f"{len(bad)} triangles are turned over or have no area at rest, first {bad[0]}"
        )
    return np.asarray(area)


def edges_of(rest: FloatArray, faces: IntArray) -> Edges:
    """Return the edges of a flat, consistently oriented mesh.

    Raises
    ------
    InputError   an edge has three faces, or two that run the same way
    """
    half = np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2)
    key = half.min(axis=1) * len(rest) + half.max(axis=1)
    _, first, inverse, counts = np.unique(
        key, return_index=True, return_inverse=True, return_counts=True
    )
    owner = np.arange(len(half)) // 3
    second = np.flatnonzero(first[inverse] != np.arange(len(half)))
    flipped = half[second, 0] == half[first[inverse[second]], 0]
    if counts.max(initial=0) > 2 or flipped.any():
        raise InputError.single(
            "faces",
            got=f"{int((counts > 2).sum())} edges with over two faces, "
            f"{int(flipped.sum())} with faces that run the same way",
            expected="an oriented sheet",
        )
    ends = half[first]
    beside = np.full((len(first), 2), -1, dtype=np.int64)
    beside[:, 0] = owner[first]
    beside[inverse[second], 1] = owner[second]
    sign = np.where(first[inverse] == np.arange(len(half)), 1.0, -1.0)
    along = rest[ends[:, 1]] - rest[ends[:, 0]]
    length = np.hypot(along[:, 0], along[:, 1])
    return Edges(
        ends=np.ascontiguousarray(ends),
        faces=beside,
        of_face=np.ascontiguousarray(inverse.reshape(-1, 3).astype(np.int64)),
        sign=np.ascontiguousarray(sign.reshape(-1, 3)),
        length=length,
        normal=np.stack([along[:, 1], -along[:, 0]], axis=1) / length[:, None],
    )


def slope_rows(rest: FloatArray, faces: IntArray, edges: Edges) -> Rows:
    """Recover the conormal slope at the middle of every edge.

    The fit uses the eight nodes around the edge's two triangles, near a free edge all neighbours
    of both ends, and one ring more where those do not carry a quadratic.
    """
    ring_start, ring = _rings(len(rest), edges)
    patch = _patches(faces, edges)
    reach = np.where((patch < 0).any(axis=1), kernels.ONE_RING, kernels.PATCH)
    rows, quality = _fit(rest, edges.ends, patch, reach, (ring_start, ring))
    weak = np.flatnonzero(quality < _WEAK)
    if not len(weak):
        return rows
    wide, _ = _fit(
        rest,
        edges.ends[weak],
        patch[weak],
        np.full(len(weak), kernels.TWO_RING),
        (ring_start, ring),
    )
    return _replaced(rows, weak, wide)


def tangent_matrix(count: int, edges: Edges) -> csr_array:
    """Sparse (e, count) operator of the slope along every edge."""
    e = len(edges.ends)
    values = np.stack([-1.0 / edges.length, 1.0 / edges.length], axis=1).ravel()
    return csr_array((values, edges.ends.ravel(), 2 * np.arange(e + 1)), shape=(e, count))


def natural_strains(edges: Edges) -> FloatArray:
    """Matrices (m, 3, 3) from the strains of a triangle's edges to (E11, E22, 2 E12)."""
    t0, t1 = -edges.normal[edges.of_face, 1], edges.normal[edges.of_face, 0]
    # Row k of the inverse pairs the other two directions: a x b over a . (b x c).
    along = np.stack([t0 * t0, t1 * t1, t0 * t1], axis=2)
    out = np.stack([np.cross(along[:, k - 2], along[:, k - 1]) for k in range(3)], axis=2)
    volume = (along[:, 0] * out[:, :, 0]).sum(axis=1)
    return np.ascontiguousarray(out / volume[:, None, None])


def _rings(count: int, edges: Edges) -> tuple[IntArray, IntArray]:
    """Neighbours of every vertex, compressed."""
    both = np.concatenate([edges.ends, edges.ends[:, ::-1]])
    both = both[np.lexsort((both[:, 1], both[:, 0]))]
    start = np.zeros(count + 1, dtype=np.int64)
    np.cumsum(np.bincount(both[:, 0], minlength=count), out=start[1:])
    return start, np.ascontiguousarray(both[:, 1])


def _patches(faces: IntArray, edges: Edges) -> IntArray:
    """The six nodes around each edge besides its ends, -1 where the sheet has ended."""
    other = np.where(
        edges.faces[edges.of_face, 0] == np.arange(len(faces))[:, None],
        edges.faces[edges.of_face, 1],
        edges.faces[edges.of_face, 0],
    )
    far = faces[other].sum(axis=2) - edges.ends[edges.of_face].sum(axis=2)
    far[other < 0] = -1
    patch = np.full((len(edges.ends), 6), -1, dtype=np.int64)
    first = edges.faces[edges.of_face, 0] == np.arange(len(faces))[:, None]
    for k in range(3):
        e = edges.of_face[:, k]
        nodes = np.stack([faces[:, k - 1], far[:, k - 2], far[:, k - 1]], axis=1)
        patch[e[first[:, k]], :3] = nodes[first[:, k]]
        patch[e[~first[:, k]], 3:] = nodes[~first[:, k]]
    return patch


def _fit(
    rest: FloatArray,
    ends: IntArray,
    patch: IntArray,
    reach: IntArray,
    rings: tuple[IntArray, IntArray],
) -> tuple[Rows, FloatArray]:
    start, nodes = kernels.stencils(ends, patch, reach, *rings)
    weights = np.empty(len(nodes))
    quality = kernels.fit(rest, ends, start, nodes, weights)
    return Rows(start, nodes, weights), quality


def _replaced(rows: Rows, which: IntArray, by: Rows) -> Rows:
    """``rows`` with those numbered ``which`` exchanged."""
    sizes = np.diff(rows.start)
    sizes[which] = np.diff(by.start)
    start = np.concatenate([[0], np.cumsum(sizes)])
    new = np.zeros(len(sizes), dtype=bool)
    new[which] = True
    nodes, weights = np.empty(start[-1], dtype=np.int64), np.empty(start[-1])
    target, source = np.repeat(new, sizes), np.repeat(~new, np.diff(rows.start))
    nodes[target], weights[target] = by.nodes, by.weights
    nodes[~target], weights[~target] = rows.nodes[source], rows.weights[source]
    return Rows(start, nodes, weights)
