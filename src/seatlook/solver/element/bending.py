"""Bending of a flat sheet: Morley curvature from recovered edge slopes, one constant matrix."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from scipy.sparse import csc_array, csr_array, diags_array, eye_array, kron

from seatlook.model import FloatArray, IntArray
from seatlook.solver.element.curvature import Curvature
from seatlook.solver.element.edgeslope import Edges
from seatlook.solver.kernels import bending as kernels

JUMP = 0.4


class Bending:
    """Bending energy ``1/2 sum A k . D k`` [J] of all panels; quadratic in the positions.

    A mean curvature has less energy than the curvature itself, and recovered slopes are a little
    flat: without more a wave of wave number q would be too soft by (q h)^2 / 5. The jump of the
    curvature between neighbours sees what is missing, since it vanishes for quadratics. Exact
    means on equilateral triangles would call for a quarter of it; ``JUMP`` brings the buckling
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
        count = len(curvature.reference)
        jump = jump_weights(edges, area)
        moments = kernels.moments(
            count, edges.of_face, edges.faces, area, stiffness, jump, *curvature.rows
        )
        self._pairs: tuple[IntArray, IntArray, FloatArray] = kernels.upper(
            count, *curvature.rows, *moments
        )
        # Clamped slopes make large terms that cancel; around ``reference`` they are small.
        self._reference = curvature.reference
        at_reference = curvature.at(curvature.reference)
        moment = np.zeros_like(at_reference)
        if at_reference.any():
            moment = _moments(edges, area, stiffness, jump, at_reference)
        self._force = curvature.back(moment)
        self._constant = 0.5 * float((at_reference * moment).sum())

    def value(self, x: FloatArray, gradient: FloatArray) -> float:
        """Return the energy [J] and add its gradient [N] to ``gradient``."""
        moved = x - self._reference
        energy = kernels.quadratic(*self._pairs, moved, gradient)
        gradient += self._force
        return float(energy + (self._force * moved).sum() + self._constant)

    def stiffness(self) -> csc_array:
        """The bending matrix itself, (n, n) [N/m]."""
        return self._matrix

    @cached_property
    def _matrix(self) -> csc_array:
        start, columns, values = self._pairs
        n = len(self._reference)
        half = csr_array((values, columns, start), shape=(n, n))
        both = csr_array(half + half.T)
        return csc_array(both - diags_array(both.sum(axis=1)))

    def hessian(self, x: FloatArray, *, definite: bool = False) -> csc_array:
        """Second derivative (3n, 3n) [N/m]; the same for every ``x`` and never negative."""
        del x, definite
        return csc_array(kron(self._matrix, eye_array(3)))


def jump_weights(edges: Edges, area: FloatArray) -> FloatArray:
    """Area (e,) [m2] that the jump of the curvature across every edge stands for, 0 at the rim."""
    # Near the rim two edges, or one, see all that the triangle misses.
    share = area / np.maximum((~edges.free)[edges.of_face].sum(axis=1), 1)
    return np.where(edges.free, 0.0, JUMP * share[edges.faces].sum(axis=1))


def _moments(
    edges: Edges, area: FloatArray, stiffness: FloatArray, jump: FloatArray, k: FloatArray
) -> FloatArray:
    """Derivative (m, 3, 3) [N] of the energy by the curvatures k (m, 3, 3)."""
    moment = area[:, None, None] * (stiffness @ k)
    first, second = edges.faces[~edges.free].T
    between = 0.5 * jump[~edges.free, None, None] * (stiffness[first] + stiffness[second])
    exchange = between @ (k[first] - k[second])
    np.add.at(moment, first, exchange)
    np.subtract.at(moment, second, exchange)
    return np.asarray(moment)
