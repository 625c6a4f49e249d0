"""Second derivatives of a field on every triangle, from the slopes recovered at its edges."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array, vstack

from seatlook.model import FloatArray, IntArray
from seatlook.solver.edgeslope import Edges, Rows, gradient_matrices


@dataclass(frozen=True, slots=True)
class Clamps:
    """Free edges whose conormal slope is held.

    Parameters
    ----------
    edges : (k,) int64              index of each clamped edge
    slopes : (k, 3) float64 [1]     derivative of the positions along its conormal
    positions : (n, 3) float64 [m]  a state in which the slopes hold
    """

    edges: IntArray
    slopes: FloatArray
    positions: FloatArray


@dataclass(frozen=True, slots=True)
class Curvature:
    """Affine map from positions to (x,11, x,22, 2 x,12), three rows for each triangle.

    Parameters
    ----------
    operator : (3m, n) sparse [1/m2]
    offset : (3m, 3) float64 [1/m]      what clamped edges add
    reference : (n, 3) float64 [m]      positions where both nearly cancel
    """

    operator: csr_array
    offset: FloatArray
    reference: FloatArray

    def at(self, x: FloatArray) -> FloatArray:
        """Return (x,11, x,22, 2 x,12) of every triangle, (m, 3, 3) [1/m]."""
        return np.asarray((self.operator @ x + self.offset).reshape(-1, 3, 3))


def recover_curvature(
    count: int,
    edges: Edges,
    rows: Rows,
    area: FloatArray,
    stiffness: FloatArray,
    clamps: Clamps | None = None,
    sewn: IntArray | None = None,
) -> Curvature:
    """Curvature by Green's theorem over each triangle: H = 1/A sum l sym(nu (x) slope).

    At a free edge nothing holds the slope, so it takes the value at which the moment across the
    edge vanishes; at a clamped one it is given.

    Parameters
    ----------
    stiffness : (m, 3, 3) float64 [N m]   bending matrix of each triangle
    sewn : (k,) int64, optional           free edges that pass on a moment: slope as recovered
    """
    held = np.zeros(len(edges.ends), dtype=bool)
    slopes = np.zeros((len(edges.ends), 3))
    if clamps is not None:
        held[clamps.edges] = True
        slopes[clamps.edges] = clamps.slopes
        weights = np.where(np.repeat(held, np.diff(rows.start)), 0.0, rows.weights)
        rows = Rows(rows.start, rows.nodes, weights)
    warp, weft = gradient_matrices(count, edges, rows)
    by_warp, by_weft = _green(edges, area)
    given_warp, given_weft = edges.normal[:, :1] * slopes, edges.normal[:, 1:] * slopes
    operator = _interleave(by_warp @ warp, by_weft @ weft, by_warp @ weft + by_weft @ warp)
    offset = np.stack(
        [by_warp @ given_warp, by_weft @ given_weft, by_warp @ given_weft + by_weft @ given_warp],
        axis=1,
    )
    loose = edges.free & ~held
    if sewn is not None:
        loose[sewn] = False
    release = _release(edges, stiffness, loose)
    return Curvature(
        operator=csr_array(release @ operator),
        offset=release @ offset.reshape(-1, 3),
        reference=np.zeros((count, 3)) if clamps is None else clamps.positions,
    )


def blocks(values: FloatArray) -> csr_array:
    """Block-diagonal (3m, 3m) matrix of (m, 3, 3) blocks."""
    m = len(values)
    columns = np.repeat(np.arange(3 * m).reshape(m, 1, 3), 3, axis=1).ravel()
    return csr_array((values.ravel(), columns, 3 * np.arange(3 * m + 1)), shape=(3 * m, 3 * m))


def _green(edges: Edges, area: FloatArray) -> tuple[csr_array, csr_array]:
    """Sums (m, e) of edge values times the outward conormal, over the triangle's area."""
    m, e = len(area), len(edges.ends)
    scale = edges.sign * edges.length[edges.of_face] / area[:, None]
    across = edges.normal[edges.of_face]
    start, columns = 3 * np.arange(m + 1), edges.of_face.ravel()
    return (
        csr_array(((scale * across[:, :, 0]).ravel(), columns, start), shape=(m, e)),
        csr_array(((scale * across[:, :, 1]).ravel(), columns, start), shape=(m, e)),
    )


def _interleave(*rows: csr_array) -> csr_array:
    """Stack three (m, n) matrices so that row 3 t + c is row t of matrix c."""
    m = rows[0].shape[0]
    order = np.arange(3 * m).reshape(3, m).T.ravel()
    return csr_array(csr_array(vstack(rows))[order])


def _release(
    edges: Edges, stiffness: FloatArray, free: np.ndarray[tuple[int], np.dtype[np.bool_]]
) -> csr_array:
    """Projection that frees the rotation of each triangle's free edges: I - N (N'DN)^-1 N'D."""
    project = np.tile(np.eye(3), (len(edges.of_face), 1, 1))
    at = free[edges.of_face]
    for t in np.flatnonzero(at.any(axis=1)):
        n0, n1 = edges.normal[edges.of_face[t, at[t]]].T
        N = np.stack([n0 * n0, n1 * n1, 2.0 * n0 * n1])
        D = stiffness[t]
        project[t] -= N @ np.linalg.solve(N.T @ D @ N, N.T @ D)
    return blocks(project)
