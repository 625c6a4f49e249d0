"""Second derivatives of a field on every triangle, from the slopes recovered at its edges."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from seatlook.model import FloatArray, IntArray
from seatlook.solver.element.edgeslope import Edges, Rows
from seatlook.solver.kernels import curvature as kernels


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
    """Affine map from positions to (x,11, x,22, 2 x,12) of every triangle.

    Parameters
    ----------
    start : (m + 1,) int64; nodes : (k,) int64; weights : (k, 3) float64 [1/m2]
        rows of triangle t at ``start[t]`` to ``start[t + 1]``, a column for each derivative
    offset : (m, 3, 3) float64 [1/m]    what clamped edges add
    reference : (n, 3) float64 [m]      positions where both nearly cancel
    """

    start: IntArray
    nodes: IntArray
    weights: FloatArray
    offset: FloatArray
    reference: FloatArray

    @property
    def rows(self) -> tuple[IntArray, IntArray, FloatArray]:
        """The compressed rows, as the kernels take them."""
        return self.start, self.nodes, self.weights

    def at(self, x: FloatArray) -> FloatArray:
        """Return (x,11, x,22, 2 x,12) of every triangle, (m, 3, 3) [1/m]."""
        out = self.offset.copy()
        kernels.apply(*self.rows, x, out)
        return out

    def back(self, values: FloatArray) -> FloatArray:
        """Return the transposed map (n, 3) of values (m, 3, 3)."""
        out = np.zeros_like(self.reference)
        kernels.apply_back(*self.rows, values, out)
        return out


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
    start, nodes, weights = kernels.triangles(
        count,
        edges.ends,
        edges.of_face,
        edges.sign,
        edges.length,
        edges.normal,
        area,
        held,
        (rows.start, rows.nodes, rows.weights),
    )
    scale = edges.sign * edges.length[edges.of_face] / area[:, None]
    along = scale[:, None] * np.moveaxis(_squares(edges.normal)[edges.of_face], 2, 1)
    offset = np.asarray(along @ slopes[edges.of_face])
    curvature = Curvature(
        start=start,
        nodes=nodes,
        weights=weights,
        offset=offset,
        reference=np.zeros((count, 3)) if clamps is None else clamps.positions,
    )
    loose = edges.free & ~held
    if sewn is not None:
        loose[sewn] = False
    return released(curvature, edges, stiffness, loose)


def released(
    curvature: Curvature, edges: Edges, stiffness: FloatArray, loose: npt.NDArray[np.bool_]
) -> Curvature:
    """``curvature`` with the rotation of the ``loose`` (e,) edges left to their triangles."""
    start, weights, offset = curvature.start, curvature.weights.copy(), curvature.offset.copy()
    for t in np.flatnonzero(loose[edges.of_face].any(axis=1)):
        normal = edges.normal[edges.of_face[t, loose[edges.of_face[t]]]]
        project = _released(normal, stiffness[t])
        weights[start[t] : start[t + 1]] = weights[start[t] : start[t + 1]] @ project.T
        offset[t] = project @ offset[t]
    return replace(curvature, weights=weights, offset=offset)


def _squares(normal: FloatArray) -> FloatArray:
    """(nu_1^2, nu_2^2, 2 nu_1 nu_2) of conormals (..., 2)."""
    n0, n1 = normal[..., 0], normal[..., 1]
    return np.stack([n0 * n0, n1 * n1, 2.0 * n0 * n1], axis=-1)


def _released(normal: FloatArray, D: FloatArray) -> npt.NDArray[np.float64]:
    """Projection that frees the rotation of a triangle's free edges: I - N (N'DN)^-1 N'D."""
    N = _squares(normal).T
    return np.asarray(np.eye(3) - N @ np.linalg.solve(N.T @ D @ N, N.T @ D))
