"""Topology, normals, angles and lengths of triangle meshes."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from seatlook.errors import InputError

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]


def edges(faces: IntArray) -> IntArray:
    """Return the undirected edges (e, 2) of ``faces`` (m, 3), each once, smaller index first."""
    half = np.sort(_half_edges(faces), axis=1)
    n = int(faces.max(initial=-1)) + 1
    return np.column_stack(np.divmod(np.unique(half @ [n, 1]), max(n, 1)))


def boundary_sides(faces: IntArray) -> IntArray:
    """Return which sides (b,) belong to one face only; side k of face f has number 3 f + k.

    Side k runs from corner k to the next.

    Examples
    --------
    >>> boundary_sides(np.array([[0, 1, 2], [0, 2, 3]])).tolist()
    [0, 1, 4, 5]
    """
    half = _half_edges(faces)
    key = half.min(axis=1) * (int(faces.max(initial=-1)) + 1) + half.max(axis=1)
    values, count = np.unique(key, return_counts=True)
    single = values[count == 1]
    # Searching among the few takes a third of the time of an inverse of all.
    place = np.minimum(np.searchsorted(single, key), max(len(single) - 1, 0))
    return np.flatnonzero(single[place] == key) if len(single) else np.zeros(0, dtype=np.int64)


def inner_sides(faces: IntArray) -> IntArray:
    """Return pairs (k, 2) of sides along one edge, numbered as in ``boundary_sides``.

    Examples
    --------
    >>> inner_sides(np.array([[0, 1, 2], [0, 2, 3]])).tolist()
    [[2, 3]]
    """
    half = np.sort(_half_edges(faces), axis=1)
    key = half @ [int(faces.max(initial=-1)) + 1, 1]
    order = np.argsort(key, kind="stable")
    at = np.flatnonzero(key[order[1:]] == key[order[:-1]])
    return np.column_stack([order[at], order[at + 1]])


def boundary_loops(faces: IntArray) -> list[IntArray]:
    """Return the closed boundary curves as vertex indices, each with the surface on its left.

    Examples
    --------
    >>> [loop.tolist() for loop in boundary_loops(np.array([[0, 1, 2], [0, 2, 3]]))]
    [[0, 1, 2, 3]]
    """
    half = _half_edges(faces)
    n = int(faces.max(initial=-1)) + 1
    single = half[~np.isin(half @ [n, 1], half @ [1, n])]
    touching = len(np.unique(single[:, 0])) != len(single)
    if touching or len(np.setxor1d(single[:, 0], single[:, 1])):
        got = "boundary curves that touch in a vertex" if touching else "an edge of three faces"
        raise InputError.single(
            "faces", got=got, expected="a manifold surface",
            hint="seatlook mend SURFACE --sheet takes out what is on it twice or hangs on it",
        )  # fmt: skip
    following = dict(single.tolist())
    loops = []
    while following:
        start, vertex = following.popitem()
        loop = [start]
        while vertex != start:
            loop.append(vertex)
            vertex = following.pop(vertex)
        first = loop.index(min(loop))
        loops.append(np.array(loop[first:] + loop[:first], dtype=np.int64))
    return sorted(loops, key=lambda loop: int(loop[0]))


def _half_edges(faces: IntArray) -> IntArray:
    """Return the directed edges (3m, 2), in the order of the faces."""
    return np.asarray(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2))


def edge_lengths(points: FloatArray, faces: IntArray) -> FloatArray:
    """Return the length (e,) [m] of each edge, in the order of ``edges(faces)``."""
    ends = points[edges(faces)]
    return np.asarray(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1))


def face_vectors(points: FloatArray, faces: IntArray) -> FloatArray:
    """Return the area vectors (m, 3) [m2]: normal times area, flat meshes along +z.

    Examples
    --------
    >>> face_vectors(np.array([[0.0, 0.0], [2.0, 0.0], [0.0, 1.0]]), np.array([[0, 1, 2]]))
    array([[0., 0., 1.]])
    """
    if points.shape[1] == 2:
        points = np.column_stack([points, np.zeros(len(points))])
    # Corner by corner takes half the time of gathering (m, 3, 3).
    a, b, c = (points.take(corner, axis=0) for corner in faces.T)
    return np.asarray(0.5 * np.cross(b - a, c - a))


def face_areas(points: FloatArray, faces: IntArray) -> FloatArray:
    """Return the area (m,) [m2] of each face, never negative."""
    return np.asarray(np.linalg.norm(face_vectors(points, faces), axis=1))


def face_normals(points: FloatArray, faces: IntArray) -> FloatArray:
    """Return the unit normal (m, 3) of each face; faces without area give nan."""
    vectors = face_vectors(points, faces)
    return np.asarray(vectors / np.linalg.norm(vectors, axis=1, keepdims=True))


def vertex_normals(points: FloatArray, faces: IntArray) -> FloatArray:
    """Return unit normals (n, 3), weighted by the angle of each face (Thürmer, Wüthrich 1998).

    The angle weights make the result independent of how a smooth surface is triangulated. A vertex
    without a face has zeros.
    """
    weighted = face_normals(points, faces)[:, None] * angles(points, faces)[:, :, None]
    normals = np.zeros((len(points), 3))
    np.add.at(normals, faces, weighted)
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    return np.asarray(np.divide(normals, length, out=normals, where=length > 0))


def angles(points: FloatArray, faces: IntArray) -> FloatArray:
    """Return the inner angles (m, 3) [rad] at the three corners of each face, in 2-D or 3-D."""
    p = points[faces]
    ahead = np.roll(p, -1, axis=1) - p
    back = np.roll(p, 1, axis=1) - p
    cosine = np.einsum("mkd,mkd->mk", ahead, back)
    sine = np.sqrt(
        np.maximum(
            np.einsum("mkd,mkd->mk", ahead, ahead) * np.einsum("mkd,mkd->mk", back, back)
            - cosine**2,
            0.0,
        )
    )
    return np.asarray(np.arctan2(sine, cosine))


def hexagonal_bias(points: FloatArray, pairs: IntArray) -> float:
    """Return ``|mean exp(6 i theta)|`` over the edge directions of a flat mesh, 0 to 1.

    1 is a perfect lattice of equilateral triangles, which steers buckles; 0 has no preference.
    """
    along = points[pairs[:, 1]] - points[pairs[:, 0]]
    theta = np.arctan2(along[:, 1], along[:, 0])
    return float(np.abs(np.exp(6j * theta).mean()))


def winding(point: FloatArray, triangles: FloatArray) -> float:
    """Times triangles (m, 3, 3) wind around a point: solid angles (Van Oosterom, Strackee 1983)."""
    a, b, c = (triangles - point).transpose(1, 0, 2)
    la, lb, lc = (np.linalg.norm(side, axis=1) for side in (a, b, c))
    dot = np.einsum
    top = dot("ij,ij->i", a, np.cross(b, c))
    bottom = (
        la * lb * lc
        + dot("ij,ij->i", a, b) * lc
        + dot("ij,ij->i", b, c) * la
        + dot("ij,ij->i", c, a) * lb
    )
    return float(np.arctan2(top, bottom).sum() / (2 * np.pi))


def spread(points: FloatArray, faces: IntArray, spacing: float) -> tuple[FloatArray, IntArray]:
    """Return places (k, 3) all over a surface, about ``spacing`` apart, and the face (k,) of each.

    Each face has the middles of equal parts of itself: one, four, nine, ...

    Examples
    --------
    >>> corners = np.array([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]])
    >>> places, face = spread(corners, np.array([[0, 1, 2]]), 1.5)
    >>> len(places), places.mean(axis=0).round(3).tolist()
    (4, [0.667, 0.667, 0.0])
    """
    corner = points[faces]
    longest = np.linalg.norm(corner - np.roll(corner, 1, axis=1), axis=2).max(axis=1)
    parts = np.ceil(longest / spacing).astype(np.int64)
    places, owner = [], []
    for count in np.unique(parts):
        weights, own = _middles(int(count)), np.flatnonzero(parts == count)
        places.append(np.einsum("kc,fcd->fkd", weights, corner[own]).reshape(-1, 3))
        owner.append(np.repeat(own, len(weights)))
    return np.concatenate(places), np.concatenate(owner)


def _middles(count: int) -> FloatArray:
    """Barycentric middles (count^2, 3) of the equal parts of a triangle cut ``count`` times."""
    i, j = np.divmod(np.arange(count * count), count)
    upright = i + j < count
    # Turned parts fill the other half of the square that the upright ones are counted in.
    u = np.where(upright, i + 1 / 3, count - i - 1 / 3)
    v = np.where(upright, j + 1 / 3, count - j - 1 / 3)
    return np.column_stack([u, v, count - u - v]) / count
