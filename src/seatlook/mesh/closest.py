"""The place of a triangle mesh that is closest to a point, and on which side the point lies."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.spatial import KDTree

from seatlook.mesh.surface import angles, face_normals

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

_FIRST = 16  # faces tried for each point; more where these do not prove the closest


class Closest(NamedTuple):
    """Closest places of points (k).

    Parameters
    ----------
    face : (k,) int64, -1 where none is within reach
    weights : (k, 3) float64      barycentric, in that face
    offset : (k, 3) float64       from the place to the point, inf where none is within reach
    """

    face: IntArray
    weights: FloatArray
    offset: FloatArray

    @property
    def distance(self) -> FloatArray:
        """Distance (k,), inf where none is within reach."""
        return np.asarray(np.linalg.norm(self.offset, axis=1))


def closest_places(
    points: FloatArray, vertices: FloatArray, faces: IntArray, *, reach: float
) -> Closest:
    """Find the closest place of a mesh to every point, exactly, up to a distance ``reach``.

    Faces are tried in the order of their middles; the closest is proven once the next middle is
    farther away than the best place by the radius of the largest face.

    Parameters
    ----------
    points : (k, 3); vertices : (n, 3); faces : (m, 3), all in one unit
    """
    corner = vertices[faces]
    middle = corner.mean(axis=1)
    radius = float(np.linalg.norm(corner - middle[:, None], axis=2).max())
    tree = KDTree(middle)
    closest = Closest(
        np.full(len(points), -1), np.zeros((len(points), 3)), np.full((len(points), 3), np.inf)
    )
    pending = np.flatnonzero(tree.query(points, distance_upper_bound=reach + radius)[0] < np.inf)
    count = min(_FIRST, len(faces))
    while len(pending):
        query_far, query_faces = tree.query(points[pending], k=np.arange(1, count + 1))
        far, candidates = np.asarray(query_far), np.asarray(query_faces, dtype=np.int64)
        weights = _weights(points[pending][:, None], corner[candidates])
        offset = points[pending][:, None] - np.einsum("kfc,kfcd->kfd", weights, corner[candidates])
        best = np.linalg.norm(offset, axis=2).argmin(axis=1)
        row = np.arange(len(pending))
        closest.face[pending] = candidates[row, best]
        closest.weights[pending], closest.offset[pending] = weights[row, best], offset[row, best]
        certain = closest.distance[pending] <= far[:, -1] - radius
        if count == len(faces):
            break
        pending, count = pending[~certain], min(4 * count, len(faces))
    out = closest.distance > reach
    closest.face[out], closest.weights[out], closest.offset[out] = -1, 0.0, np.inf
    return closest


def pseudonormals(
    vertices: FloatArray, faces: IntArray, closest: Closest
) -> tuple[FloatArray, npt.NDArray[np.bool_]]:
    """Return unit normals (k, 3) that tell the side of every point, and who lies on the rim (k,).

    Of a face its own, of an edge the sum over its faces, of a corner that weighted by the angles:
    the one choice that is right at creases too (Baerentzen and Aanaes 2005).
    """
    own, at = face_normals(vertices, faces), angles(vertices, faces)
    pairs = np.sort(faces[:, [[1, 2], [2, 0], [0, 1]]], axis=2)
    _, number, count = np.unique(
        pairs.reshape(-1, 2), axis=0, return_inverse=True, return_counts=True
    )
    number = number.reshape(-1, 3)
    of_edge = np.stack([np.bincount(number.ravel(), np.repeat(n, 3)) for n in own.T], axis=1)
    of_corner = np.stack(
        [np.bincount(faces.ravel(), (n[:, None] * at).ravel(), len(vertices)) for n in own.T],
        axis=1,
    )
    rim_corner = np.zeros(len(vertices), dtype=np.bool_)
    rim_corner[pairs[count[number] == 1]] = True
    zero = closest.weights <= 1e-9
    kind, face = zero.sum(axis=1), closest.face
    edge = number[face, zero.argmax(axis=1)]
    corner = faces[face, closest.weights.argmax(axis=1)]
    normal = np.where(
        (kind == 0)[:, None],
        own[face],
        np.where((kind == 1)[:, None], of_edge[edge], of_corner[corner]),
    )
    on_rim = np.where(kind == 0, False, np.where(kind == 1, count[edge] == 1, rim_corner[corner]))
    return np.asarray(normal / np.linalg.norm(normal, axis=1, keepdims=True)), on_rim


def distance_to_segments(points: FloatArray, start: FloatArray, end: FloatArray) -> FloatArray:
    """Distance (k,) of points (k, 3) from the nearest of the segments (s, 3) to (s, 3).

    Examples
    --------
    >>> line = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0]])
    >>> distance_to_segments(np.array([[0.5, -0.2, 0], [1.5, 0.3, 0]]), line[:-1], line[1:])
    array([0.2, 0.5])
    """
    way = end - start
    away = points[:, None] - start
    length2 = np.maximum(np.einsum("sd,sd->s", way, way), np.finfo(float).tiny)
    share = np.clip(np.einsum("ksd,sd->ks", away, way) / length2, 0.0, 1.0)
    return np.asarray(np.linalg.norm(away - share[..., None] * way, axis=2).min(axis=1))


def nearest_segments(
    points: FloatArray, a: FloatArray, b: FloatArray
) -> tuple[IntArray, FloatArray, FloatArray]:
    """Nearest of many short segments to each point: (index, parameter in [0, 1], distance).

    Parameters
    ----------
    points : (k, d); a, b : (s, d)    ends of the segments; only the four with the nearest middles
        are tried

    Examples
    --------
    >>> line = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]])
    >>> nearest_segments(np.array([[0.5, -0.2]]), line[:-1], line[1:])
    (array([0]), array([0.5]), array([0.2]))
    """
    count = min(4, len(a))
    _, candidates = KDTree(0.5 * (a + b)).query(points, k=count)
    candidates = np.asarray(candidates).reshape(len(points), count)
    along = b[candidates] - a[candidates]
    to = points[:, None] - a[candidates]
    size = np.maximum((along**2).sum(axis=-1), 1e-30)
    t = np.clip((to * along).sum(axis=-1) / size, 0.0, 1.0)
    distance = np.linalg.norm(to - t[..., None] * along, axis=-1)
    best = distance.argmin(axis=1)
    row = np.arange(len(points))
    return candidates[row, best], t[row, best], distance[row, best]


def border_segments(faces: IntArray, label: IntArray) -> tuple[IntArray, IntArray]:
    """Edges (e, 2) between faces of two labels, and those labels (e, 2), smaller first."""
    pairs = np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    owner = np.repeat(label, 3)
    order = np.lexsort(pairs.T)
    pairs, owner = pairs[order], owner[order]
    index = np.flatnonzero((pairs[1:] == pairs[:-1]).all(axis=1) & (owner[1:] != owner[:-1]))
    return pairs[index], np.sort(np.column_stack([owner[index], owner[index + 1]]), axis=1)


def _weights(p: FloatArray, corner: FloatArray) -> FloatArray:
    """Barycentric weights (k, f, 3) of the places of triangles (k, f, 3, 3) closest to (k, 1, 3).

    After Ericson, Real-Time Collision Detection (2005), section 5.1.5.
    """
    a, b, c = (corner[:, :, i] for i in range(3))
    ab, ac = b - a, c - a
    d1, d2 = _dots(ab, ac, p - a)
    d3, d4 = _dots(ab, ac, p - b)
    d5, d6 = _dots(ab, ac, p - c)
    va, vb, vc = d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2
    zero, one = np.zeros_like(d1), np.ones_like(d1)
    with np.errstate(divide="ignore", invalid="ignore"):
        on_ab, on_ac = d1 / (d1 - d3), d2 / (d2 - d6)
        on_bc = (d4 - d3) / ((d4 - d3) + (d5 - d6))
        v, w = vb / (va + vb + vc), vc / (va + vb + vc)
    where = [
        (d1 <= 0) & (d2 <= 0),
        (d3 >= 0) & (d4 <= d3),
        (d6 >= 0) & (d5 <= d6),
        (vc <= 0) & (d1 >= 0) & (d3 <= 0),
        (vb <= 0) & (d2 >= 0) & (d6 <= 0),
        (va <= 0) & (d4 >= d3) & (d5 >= d6),
    ]
    to_b = np.select(where, [zero, one, zero, on_ab, zero, 1 - on_bc], v)
    to_c = np.select(where, [zero, zero, one, zero, on_ac, on_bc], w)
    return np.stack([1 - to_b - to_c, to_b, to_c], axis=-1)


def _dots(ab: FloatArray, ac: FloatArray, q: FloatArray) -> tuple[FloatArray, FloatArray]:
    return np.einsum("kfd,kfd->kf", ab, q), np.einsum("kfd,kfd->kf", ac, q)
