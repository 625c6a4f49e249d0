"""Morley's plate element as the reference: vertices, and the slope across every edge, unknown.

No part of the product, where slopes are recovered from the vertices instead. The state holds a row
for every edge after those of the vertices: the derivative of the positions along its conormal.
"""

import numpy as np
from scipy.sparse import csc_array, csr_array, diags_array, kron

from seatlook.solver.element.curvature import recover_curvature
from seatlook.solver.element.edgeslope import Rows, areas, edges_of, tangent_matrix
from support.reference.counter_examples import LinearMembrane, MatrixBending


class MorleySheet:
    """Morley bending, linear triangles in the plane; offers what an ElasticSheet does to Newton."""

    def __init__(self, X, T, fabric):
        self.faces, self.edges, self.area = T, edges_of(X, T), areas(X, T)
        n, e = len(X), len(self.edges.ends)
        self.count = n
        own = Rows(np.arange(e + 1), n + np.arange(e), np.ones(e))
        D = np.tile(fabric.bending_matrix, (len(T), 1, 1))
        # Every slope is an unknown, so that at a rim the moment vanishes by itself.
        curvature = recover_curvature(
            n + e, self.edges, own, self.area, D, sewn=np.flatnonzero(self.edges.free)
        )
        H = self._rows(curvature)
        self.bending = MatrixBending(H.T @ kron(diags_array(self.area), csr_array(D[0])) @ H)
        self.membrane = LinearMembrane(X, T, fabric)
        self.membrane._count = n + e
        self.thickness = np.full(len(T), fabric.thickness)
        share = np.repeat(fabric.density * self.area / 3.0, 3)
        self.mass = np.bincount(T.ravel(), share, minlength=n + e)

    @property
    def energies(self):
        return (self.membrane, self.bending)

    def flat(self, x):
        """State of positions (n, 3) that are an affine image of the flat sheet."""
        along = tangent_matrix(self.count, self.edges)
        tau = np.stack([-self.edges.normal[:, 1], self.edges.normal[:, 0]], axis=1)
        F = np.linalg.lstsq(tau, along @ x, rcond=None)[0]
        return np.concatenate([x, self.edges.normal @ F])

    def stress_stiffness(self, stress):
        """Stiffness (n + e, n + e) of a uniform stress (2, 2), by slopes at the mid-edges.

        They are single-valued and integrate the square of a quadratic's slope exactly.
        """
        edges, n = self.edges, self.count
        e = len(edges.ends)
        weight = np.bincount(edges.of_face.ravel(), np.repeat(self.area / 3.0, 3), minlength=e)
        tau = np.stack([-edges.normal[:, 1], edges.normal[:, 0]], axis=1)
        along = tangent_matrix(n + e, edges)
        across = csr_array((np.ones(e), (np.arange(e), n + np.arange(e))), shape=(e, n + e))
        total = csc_array((n + e, n + e))
        for left, a in ((along, tau), (across, edges.normal)):
            for right, b in ((along, tau), (across, edges.normal)):
                scale = weight * np.einsum("ei,ij,ej->e", a, stress, b)
                total = total + left.T @ diags_array(scale) @ right
        return csc_array(total)

    def _rows(self, curvature):
        """Curvature as a (3 m, n + e) matrix, three rows for each triangle."""
        start, nodes, weights = curvature.rows
        triangle = np.repeat(np.arange(len(start) - 1), np.diff(start))
        rows = (3 * triangle[:, None] + np.arange(3)).ravel()
        columns = np.repeat(nodes, 3)
        shape = (3 * (len(start) - 1), len(curvature.reference))
        return csr_array((weights.ravel(), (rows, columns)), shape=shape)
