"""Edges of a flat mesh and the operators that recover the slope across each of them.

The `edgeslope` element keeps vertices as its only unknowns. A least-squares quadratic around every
edge gives the slope along the edge's conormal, so that both triangles beside the edge see one
deformation gradient. Bending takes its curvature from these slopes (Morley's element with the edge
rotation recovered instead of unknown), the membrane its Green strain.
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
# Half the width, in elements, below which the correction of the rows may leave a soft mode.
_NARROW = 3
_SWEEPS, _TOLERANCE = 60, 1e-5


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


Gradients = tuple[csr_array, csr_array]


@dataclass(frozen=True, slots=True)
class Samples:
    """Places where the deformation gradient is taken, three for each triangle.

    An inner edge is one sample of both its triangles. Where an edge is free, or the sheet too
    narrow for recovered slopes, the triangle's own plane gradient stands in.
    """

    ends: IntArray
    length: FloatArray
    normal: FloatArray
    rows: Rows
    of_face: IntArray


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


def slope_rows(rest: FloatArray, faces: IntArray, edges: Edges, *, wide: bool = False) -> Rows:
    """Recover the conormal slope at the middle of every edge.

    Parameters
    ----------
    wide : take all neighbours of both ends instead of the eight nodes around the two triangles;
        more weights than a fit needs, which the patch-test correction uses up
    """
    ring_start, ring = _rings(len(rest), edges)
    patch = _patches(faces, edges)
    reach = np.full(len(edges.ends), kernels.ONE_RING if wide else kernels.PATCH)
    reach[(patch < 0).any(axis=1)] = kernels.ONE_RING
    rows, quality = _fit(rest, edges, patch, reach, (ring_start, ring))
    weak = quality < _WEAK
    if weak.any():
        reach[weak] = kernels.TWO_RING
        rows, _ = _fit(rest, edges, patch, reach, (ring_start, ring))
    return rows


def membrane_samples(rest: FloatArray, faces: IntArray, edges: Edges) -> Samples:
    """Return the samples of the membrane, corrected so that constant stress is in balance."""
    narrow = _narrow(len(rest), faces, edges)
    inner = np.flatnonzero(~edges.free & ~narrow[edges.faces].all(axis=1))
    rank = np.full(len(edges.ends), -1, dtype=np.int64)
    rank[inner] = np.arange(len(inner))
    of_face = np.where(narrow[:, None], -1, rank[edges.of_face])
    own = np.flatnonzero((of_face < 0).any(axis=1))
    of_face = np.where(of_face < 0, 0, of_face)
    planes = plane_samples(rest, faces[own])
    place = np.full(len(faces), -1, dtype=np.int64)
    place[own] = len(inner) + np.arange(len(own))
    keep = (rank[edges.of_face] >= 0) & ~narrow[:, None]
    of_face = np.where(keep, of_face, place[:, None])
    recovered = _select(slope_rows(rest, faces, edges, wide=True), inner)
    rows = Rows(
        start=np.concatenate([recovered.start, recovered.start[-1] + planes.rows.start[1:]]),
        nodes=np.concatenate([recovered.nodes, planes.rows.nodes]),
        weights=np.concatenate([recovered.weights, planes.rows.weights]),
    )
    samples = Samples(
        ends=np.concatenate([edges.ends[inner], planes.ends]),
        length=np.concatenate([edges.length[inner], planes.length]),
        normal=np.concatenate([edges.normal[inner], planes.normal]),
        rows=rows,
        of_face=np.ascontiguousarray(of_face),
    )
    return _balanced(rest, faces, samples, len(inner))


def gradient_matrices(count: int, places: Edges | Samples, rows: Rows) -> Gradients:
    """Sparse (q, count) operators of the derivative along warp and along weft."""
    q = len(places.ends)
    slope = csr_array((rows.weights, rows.nodes, rows.start), shape=(q, count))
    values = np.stack([-1.0 / places.length, 1.0 / places.length], axis=1).ravel()
    along = csr_array((values, places.ends.ravel(), 2 * np.arange(q + 1)), shape=(q, count))
    n0, n1 = places.normal[:, :1], places.normal[:, 1:]
    return (
        csr_array(slope.multiply(n0) - along.multiply(n1)),
        csr_array(slope.multiply(n1) + along.multiply(n0)),
    )


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
    edges: Edges,
    patch: IntArray,
    reach: IntArray,
    rings: tuple[IntArray, IntArray],
) -> tuple[Rows, FloatArray]:
    start, nodes = kernels.stencils(edges.ends, patch, reach, *rings)
    weights = np.empty(len(nodes))
    quality = kernels.fit(rest, edges.ends, start, nodes, weights)
    return Rows(start, nodes, weights), quality


def _narrow(
    count: int, faces: IntArray, edges: Edges
) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """Faces of strips under six elements wide: no vertex nearby is three edges inside."""
    depth = np.full(count, _NARROW, dtype=np.int64)
    depth[edges.ends[edges.free]] = 0
    a, b = edges.ends.T
    for _ in range(_NARROW):
        near = depth.copy()
        np.minimum.at(near, a, depth[b] + 1)
        np.minimum.at(near, b, depth[a] + 1)
        depth = near
    wide = depth >= _NARROW
    for _ in range(2 * _NARROW):
        wider = wide.copy()
        wider[a] |= wide[b]
        wider[b] |= wide[a]
        wide = wider
    return np.asarray(~wide[faces].all(axis=1))


def _select(rows: Rows, chosen: IntArray) -> Rows:
    counts = np.diff(rows.start)[chosen]
    start = np.concatenate([[0], np.cumsum(counts)])
    pick = np.repeat(rows.start[chosen] - start[:-1], counts) + np.arange(start[-1])
    return Rows(start, rows.nodes[pick], rows.weights[pick])


def plane_samples(rest: FloatArray, faces: IntArray) -> Samples:
    """Plane gradient of each triangle, written as an edge: tangent and conormal of edge 0."""
    p = rest[faces]
    along = p[:, 1] - p[:, 0]
    length = np.hypot(along[:, 0], along[:, 1])
    normal = np.stack([along[:, 1], -along[:, 0]], axis=1) / length[:, None]
    opposite = np.roll(p, -2, axis=1) - np.roll(p, -1, axis=1)
    double = along[:, 0] * opposite[:, 0, 1] - along[:, 1] * opposite[:, 0, 0]
    # Gradient of hat k is the opposite edge, turned by +90 degrees, over twice the area.
    hat = np.stack([-opposite[:, :, 1], opposite[:, :, 0]], axis=2) / double[:, None, None]
    weights = np.einsum("tki,ti->tk", hat, normal)
    rows = Rows(3 * np.arange(len(faces) + 1), faces.ravel(), weights.ravel())
    return Samples(
        faces[:, :2], length, normal, rows, np.repeat(np.arange(len(faces))[:, None], 3, 1)
    )


def _balanced(rest: FloatArray, faces: IntArray, samples: Samples, inner: int) -> Samples:
    """Change the rows of the first ``inner`` samples so that constant stress is in balance.

    Recovered slopes are exact for quadratics, yet their transpose does not return the nodal
    forces of a constant stress. The least change that does is found once, on the flat mesh.
    """
    area = areas(rest, faces)
    share = np.bincount(
        samples.of_face.ravel(), np.repeat(area / 3.0, 3), minlength=len(samples.ends)
    )
    n = len(rest)
    got = gradient_matrices(n, samples, samples.rows)
    planes = plane_samples(rest, faces)
    wanted = gradient_matrices(n, planes, planes.rows)
    missing = np.stack([w.T @ area - g.T @ share for g, w in zip(got, wanted, strict=True)], axis=1)
    rows = samples.rows
    start, last = rows.start[: inner + 1], rows.start[inner]
    nodes = rows.nodes[:last]
    basis = np.empty((last, 6))
    ends, length = samples.ends[:inner], samples.length[:inner]
    kernels.quadratics(rest, ends, start, nodes, basis)
    lever = samples.normal[:inner] * (share[:inner] / length)[:, None]
    change = kernels.balance(start, nodes, basis, lever, missing, _SWEEPS, _TOLERANCE)
    weights = rows.weights.copy()
    weights[:last] += change / np.repeat(length, np.diff(start))
    return Samples(
        samples.ends,
        samples.length,
        samples.normal,
        Rows(rows.start, rows.nodes, weights),
        samples.of_face,
    )
