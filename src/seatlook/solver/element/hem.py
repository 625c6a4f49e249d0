"""Folds across the seams: springs between the slopes of the two panels they join."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csc_array, csr_array, diags_array, eye_array, kron

from seatlook.errors import InputError
from seatlook.model import FloatArray, Hem, IntArray
from seatlook.solver.element.edgeslope import Edges, Rows


class Folds:
    """Energy ``1/2 sum k l |d_a + d_b|^2`` [J] of the folds, quadratic in the positions.

    ``d_a`` and ``d_b`` are the slopes across the rims of both panels, each outward from its own:
    on a rim edge of the coarser side, and the mean over what is sewn to it of the other. In one
    plane they cancel; at an angle theta they leave 2 sin(theta / 2), a moment of k sin(theta). One
    row for each edge of the coarser side: more would keep the seam from twisting.

    Parameters
    ----------
    hem : Hem; edges, rows : of the flat mesh

    Attributes
    ----------
    edges : (e,) int64   rim edges whose slope carries a moment
    """

    def __init__(self, hem: Hem, edges: Edges, rows: Rows) -> None:
        count = len(hem.lift)
        slope = csr_array((rows.weights, rows.nodes, rows.start), shape=(len(edges.ends), count))
        near, far = rim_edges(edges, hem.near, count), rim_edges(edges, hem.far, count)
        self.edges: IntArray = np.union1d(near, far)
        shape = (len(near), len(far))
        mean = csr_array((hem.weight, (hem.row, np.arange(len(far)))), shape=shape)
        across = slope[near] + mean @ slope[far]
        self._jump = csr_array(across)
        self._back = csr_array(self._jump.T)
        self._stiffness = hem.stiffness
        self._weight = (hem.stiffness * hem.length)[:, None]

    def value(self, x: FloatArray, gradient: FloatArray) -> float:
        """Return the energy [J] and add its gradient [N] to ``gradient``."""
        jump = self._jump @ x
        pull = self._weight * jump
        gradient += self._back @ pull
        return 0.5 * float((pull * jump).sum())

    def moments(self, x: FloatArray) -> FloatArray:
        """Moment per length (k,) [N] that every fold bears, k sin(theta)."""
        half_sine = 0.5 * np.linalg.norm(self._jump @ x, axis=1)
        cosine = np.sqrt(np.maximum(1.0 - half_sine**2, 0.0))
        return np.asarray(2.0 * self._stiffness * half_sine * cosine)

    def matrix(self) -> csc_array:
        """The scalar matrix itself, (n, n) [N/m]."""
        return csc_array(self._back @ (diags_array(self._weight[:, 0]) @ self._jump))

    def stiffness(self) -> csc_array | None:
        """Nothing: like bending, folds only matter across the sheet."""
        return None

    def hessian(self, x: FloatArray, *, definite: bool = False) -> csc_array:
        """Second derivative (3n, 3n) [N/m]; the same for every ``x`` and never negative."""
        del x, definite
        return csc_array(kron(self.matrix(), eye_array(3)))


def rim_edges(edges: Edges, ends: IntArray, count: int) -> IntArray:
    """Number (k,) of the free edge between each pair of vertices (k, 2)."""
    key = edges.ends.min(axis=1) * count + edges.ends.max(axis=1)
    order = np.argsort(key)
    query = ends.min(axis=1) * count + ends.max(axis=1)
    index = order[np.minimum(np.searchsorted(key, query, sorter=order), len(order) - 1)]
    if (key[index] != query).any() or not edges.free[index].all():
        raise InputError.single("hem", got="edges inside a panel", expected="edges of the rim")
    return np.asarray(index)
