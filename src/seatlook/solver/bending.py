"""Bending of a flat sheet: Morley curvature from recovered edge slopes, one constant matrix."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csc_array, csr_array, eye_array, kron, triu

from seatlook.model import FloatArray
from seatlook.solver.curvature import Curvature, blocks
from seatlook.solver.edgeslope import Edges
from seatlook.solver.kernels.bending import quadratic

_JUMP = 0.4


class Bending:
    """Bending energy ``1/2 sum A k . D k`` [J] of all panels; quadratic in the positions.

    A mean curvature has less energy than the curvature itself, and recovered slopes are a little
    flat: without more a wave of wave number q would be too soft by (q h)^2 / 5. The jump of the
    curvature between neighbours sees what is missing, since it vanishes for quadratics. Exact
    means on equilateral triangles would call for a quarter of it; ``_JUMP`` brings the buckling
    load of a sheet on a soft bed within 1 % at eight edges per wavelength on regular and
    irregular meshes alike.

    Parameters
    ----------
    edges : of the flat mesh
    curvature : from ``recover_curvature``
    area : (m,) float64 [m2]
    stiffness : (m, 3, 3) float64 [N m]
    """

    def __init__(
        self, edges: Edges, curvature: Curvature, area: FloatArray, stiffness: FloatArray
    ) -> None:
        weight = blocks(area[:, None, None] * stiffness) + _jumps(edges, area, stiffness)
        weighted = csr_array(weight @ curvature.operator)
        matrix = csr_array(curvature.operator.T @ weighted)
        matrix = csr_array(0.5 * (matrix + matrix.T))
        self._matrix = matrix
        pairs = csr_array(triu(matrix, k=1, format="csr"))
        self._pairs = (pairs.indptr.astype(np.int32), pairs.indices.astype(np.int32), pairs.data)
        # Clamped slopes make large terms that cancel; around ``reference`` they are small.
        self._reference = curvature.reference
        at_reference = curvature.at(curvature.reference).reshape(-1, 3)
        self._force = np.asarray(weighted.T @ at_reference)
        self._constant = 0.5 * float((at_reference * (weight @ at_reference)).sum())

    def value(self, x: FloatArray, gradient: FloatArray) -> float:
        """Return the energy [J] and add its gradient [N] to ``gradient``."""
        moved = x - self._reference
        energy = quadratic(*self._pairs, moved, gradient)
        gradient += self._force
        return float(energy + (self._force * moved).sum() + self._constant)

    def stiffness(self) -> csc_array:
        """The bending matrix itself, (n, n) [N/m]."""
        return csc_array(self._matrix)

    def hessian(self, x: FloatArray, *, definite: bool = False) -> csc_array:
        """Second derivative (3n, 3n) [N/m]; the same for every ``x`` and never negative."""
        del x, definite
        return csc_array(kron(self._matrix, eye_array(3)))


def _jumps(edges: Edges, area: FloatArray, stiffness: FloatArray) -> csr_array:
    """Weight (3m, 3m) of the curvature jump across every inner edge."""
    m = len(area)
    first, second = edges.faces[~edges.free].T
    # Near the rim two edges, or one, see all that the triangle misses.
    seen = area / np.maximum((~edges.free)[edges.of_face].sum(axis=1), 1)
    share = _JUMP * (seen[first] + seen[second])
    block = share[:, None, None] * 0.5 * (stiffness[first] + stiffness[second])
    rows = (3 * np.stack([first, first, second, second], axis=1))[:, :, None, None]
    columns = (3 * np.stack([first, second, first, second], axis=1))[:, :, None, None]
    values = np.array([1.0, -1.0, -1.0, 1.0])[:, None, None] * block[:, None]
    i = np.broadcast_to(rows + np.arange(3)[:, None], values.shape).ravel()
    j = np.broadcast_to(columns + np.arange(3), values.shape).ravel()
    return csr_array((values.ravel(), (i, j)), shape=(3 * m, 3 * m))
