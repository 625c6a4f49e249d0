"""Bending of a flat sheet: Morley curvature from recovered edge slopes, one constant matrix."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csc_array, csr_array, eye_array, kron, vstack

from seatlook.model import FloatArray
from seatlook.solver.edgeslope import Edges, Rows, gradient_matrices
from seatlook.solver.kernels.bending import quadratic

_JUMP = 0.2


def curvature_operator(
    count: int, area: FloatArray, edges: Edges, rows: Rows, stiffness: FloatArray
) -> csr_array:
    """Second derivatives (k11, k22, 2 k12) of a nodal field, three rows for each triangle.

    Green's theorem over the triangle: H = 1/A sum l sym(nu (x) slope). At a free edge nothing
    holds the slope, so it takes the value at which the moment across the edge vanishes.

    Parameters
    ----------
    stiffness : (m, 3, 3) float64 [N m]   bending matrix of each triangle
    """
    m, e = len(area), len(edges.ends)
    warp, weft = gradient_matrices(count, edges, rows)
    scale = edges.sign * edges.length[edges.of_face] / area[:, None]
    across = edges.normal[edges.of_face]
    start, columns = 3 * np.arange(m + 1), edges.of_face.ravel()
    first = csr_array(((scale * across[:, :, 0]).ravel(), columns, start), shape=(m, e))
    second = csr_array(((scale * across[:, :, 1]).ravel(), columns, start), shape=(m, e))
    k11, k22, k12 = first @ warp, second @ weft, first @ weft + second @ warp
    stacked = _interleave(k11, k22, k12)
    return csr_array(_condensation(edges, stiffness) @ stacked)


class Bending:
    """Bending energy ``1/2 sum A k . D k`` [J] of all panels; quadratic in the positions.

    Differences of slopes make a wave of wave number q too soft by (q h)^2 / 6. The jump of the
    curvature between neighbours sees what is missing: it vanishes for quadratics, and a fifth of
    it (``_JUMP``) brings the buckling load of a sheet on a soft bed within 1 % at eight edges per
    wavelength, on regular and irregular meshes alike.

    Parameters
    ----------
    operator : (3m, n) sparse [1/m2]      from ``curvature_operator``
    area : (m,) float64 [m2]
    stiffness : (m, 3, 3) float64 [N m]
    """

    def __init__(
        self, edges: Edges, operator: csr_array, area: FloatArray, stiffness: FloatArray
    ) -> None:
        weight = _blocks(area[:, None, None] * stiffness)
        weight = weight + _jumps(edges, area, stiffness)
        matrix = csr_array(operator.T @ (weight @ operator))
        matrix = csr_array(0.5 * (matrix + matrix.T))
        matrix.sort_indices()
        self._matrix = matrix
        self._start = matrix.indptr.astype(np.int64)
        self._columns = matrix.indices.astype(np.int64)

    def value(self, x: FloatArray, gradient: FloatArray) -> float:
        """Return the energy [J] and add its gradient [N] to ``gradient``."""
        return float(quadratic(self._start, self._columns, self._matrix.data, x, gradient))

    def stiffness(self) -> csc_array:
        """The bending matrix itself, (n, n) [N/m]."""
        return csc_array(self._matrix)

    def hessian(self, x: FloatArray, *, definite: bool = False) -> csc_array:
        """Second derivative (3n, 3n) [N/m]; the same for every ``x`` and never negative."""
        del x, definite
        return csc_array(kron(self._matrix, eye_array(3)))


def _interleave(*rows: csr_array) -> csr_array:
    """Stack three (m, n) matrices so that row 3 t + c is row t of matrix c."""
    m = rows[0].shape[0]
    order = np.arange(3 * m).reshape(3, m).T.ravel()
    return csr_array(csr_array(vstack(rows))[order])


def _blocks(blocks: FloatArray) -> csr_array:
    """Block-diagonal (3m, 3m) matrix of (m, 3, 3) blocks."""
    m = len(blocks)
    columns = np.repeat(np.arange(3 * m).reshape(m, 1, 3), 3, axis=1).ravel()
    return csr_array((blocks.ravel(), columns, 3 * np.arange(3 * m + 1)), shape=(3 * m, 3 * m))


def _jumps(edges: Edges, area: FloatArray, stiffness: FloatArray) -> csr_array:
    """Weight (3m, 3m) of the curvature jump across every inner edge."""
    m = len(area)
    first, second = edges.faces[~edges.free].T
    share = _JUMP * (area[first] + area[second]) / 3.0
    block = share[:, None, None] * 0.5 * (stiffness[first] + stiffness[second])
    rows = (3 * np.stack([first, first, second, second], axis=1))[:, :, None, None]
    columns = (3 * np.stack([first, second, first, second], axis=1))[:, :, None, None]
    values = np.array([1.0, -1.0, -1.0, 1.0])[:, None, None] * block[:, None]
    shape = values.shape
    i = np.broadcast_to(rows + np.arange(3)[:, None], shape).ravel()
    j = np.broadcast_to(columns + np.arange(3), shape).ravel()
    return csr_array((values.ravel(), (i, j)), shape=(3 * m, 3 * m))


def _condensation(edges: Edges, stiffness: FloatArray) -> csr_array:
    """Projection that frees the rotation of each triangle's free edges: I - N (N'DN)^-1 N'D."""
    m = len(edges.of_face)
    project = np.tile(np.eye(3), (m, 1, 1))
    free = edges.free[edges.of_face]
    for t in np.flatnonzero(free.any(axis=1)):
        n0, n1 = edges.normal[edges.of_face[t, free[t]]].T
        N = np.stack([n0 * n0, n1 * n1, 2.0 * n0 * n1])
        D = stiffness[t]
        project[t] -= N @ np.linalg.solve(N.T @ D @ N, N.T @ D)
    return _blocks(project)
