"""Curvature of a triangulated surface from its shape alone."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array

from seatlook.mesh import vertex_normals
from seatlook.model import FloatArray, IntArray

_FEW = 6  # neighbours; with fewer a quadratic has no equation to spare
_SINGULAR = 1e-9


def vertex_curvature(points: FloatArray, faces: IntArray) -> FloatArray:
    """Curvature tensor at every vertex, from a quadratic fitted to its neighbours.

    Around each vertex the surface is taken as a height over the tangent plane,
    ``z = g . u + u . H . u / 2``, fitted to the neighbours by least squares; where there are fewer
    than six, near an edge, to their neighbours too. The slope g corrects a normal that is a little
    off (Cazals and Pouget 2005, polynomial fitting of osculating jets).

    Parameters
    ----------
    points : (n, 3) float64 [m]; faces : (m, 3) int64, consistently oriented

    Returns
    -------
    (n, 3, 3) float64 [1/m]
        Symmetric, in the tangent plane; positive where the surface is convex seen from the side
        that the normals point to. A vertex without a face or with too few neighbours has zeros.
    """
    n = len(points)
    normal = vertex_normals(points, faces)
    first, second = _tangents(normal)
    a, b = _pairs(n, faces)
    step = points[b] - points[a]
    u, v, z = (np.einsum("pd,pd->p", step, axis[a]) for axis in (first, second, normal))
    size = np.sqrt(np.bincount(a, u * u + v * v, n) / np.maximum(np.bincount(a, minlength=n), 1))
    size[size == 0] = 1.0
    u, v, z = u / size[a], v / size[a], z / size[a]
    basis = np.stack([0.5 * u * u, u * v, 0.5 * v * v, u, v], axis=1)
    matrix = np.empty((n, 5, 5))
    for i in range(5):
        for j in range(i + 1):
            matrix[:, i, j] = matrix[:, j, i] = np.bincount(a, basis[:, i] * basis[:, j], n)
    right = np.stack([np.bincount(a, column * z, n) for column in basis.T], axis=1).astype(float)
    fit = _solved(matrix, right)
    fit[:, :3] /= size[:, None]
    return _tensor(fit, first, second, normal)


def _tangents(normal: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return two unit vectors that complete each normal; zeros where it is zero."""
    helper = np.eye(3)[np.argmin(np.abs(normal), axis=1)]
    first = np.cross(normal, helper)
    first /= np.maximum(np.linalg.norm(first, axis=1, keepdims=True), 1e-300)
    return first, np.cross(normal, first)


def _pairs(n: int, faces: IntArray) -> tuple[IntArray, IntArray]:
    """Return each vertex beside each neighbour that its fit uses."""
    start, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    half = csr_array((np.ones(len(start), dtype=np.int32), (start, end)), shape=(n, n))
    ring = half + half.T
    many = np.diff(ring.indptr) >= _FEW
    few = np.flatnonzero(~many)
    wider = (ring[few] @ ring + ring[few]).tocoo()
    near = ring.tocoo()
    keep = many[near.row]
    a = np.concatenate([near.row[keep], few[wider.row]]).astype(np.int64)
    b = np.concatenate([near.col[keep], wider.col]).astype(np.int64)
    return a[a != b], b[a != b]


def _solved(matrix: FloatArray, right: FloatArray) -> FloatArray:
    """Solve the normal equations where they have a solution."""
    # Hadamard's ratio: 1 for orthogonal columns, 0 where the neighbours do not fix the quadratic.
    diagonal = np.prod(np.diagonal(matrix, axis1=1, axis2=2), axis=1)
    good = np.linalg.det(matrix) > _SINGULAR * np.maximum(diagonal, 1e-30)
    fit = np.zeros_like(right)
    fit[good] = np.linalg.solve(matrix[good], right[good][:, :, None])[:, :, 0]
    return fit


def _tensor(
    fit: FloatArray, first: FloatArray, second: FloatArray, normal: FloatArray
) -> FloatArray:
    """Turn height, slope and second derivatives into the curvature tensor in space."""
    slope = fit[:, 3:]
    along = np.stack([first, second], axis=2) + normal[:, :, None] * slope[:, None, :]
    squared = 1.0 + (slope**2).sum(axis=1)
    form = fit[:, [[0, 1], [1, 2]]] / np.sqrt(squared)[:, None, None]
    inverse = np.eye(2) - slope[:, :, None] * slope[:, None, :] / squared[:, None, None]
    dual = along @ inverse
    return np.asarray(-dual @ form @ np.swapaxes(dual, 1, 2))
