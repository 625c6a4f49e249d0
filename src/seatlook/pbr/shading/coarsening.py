"""Evenly spread vertices of a fine mesh, level after level, each between three earlier ones."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.spatial import Delaunay, KDTree

from seatlook.mesh import edges
from seatlook.model import FloatArray, IntArray


class Between(NamedTuple):
    """Vertices that lie between others.

    ``vertices`` (k,); ``ends`` (k, p): between which; ``share`` (k, p): how much of each, sum 1.
    """

    vertices: IntArray
    ends: IntArray
    share: FloatArray

    def mean(self, values: FloatArray) -> FloatArray:
        """Values (k, d) of these vertices from those (n, d) of all."""
        return np.asarray(
            sum(self.share[:, [j]] * values[self.ends[:, j]] for j in range(self.ends.shape[1]))
        )

    def apart(self, values: FloatArray) -> FloatArray:
        """Greatest difference (k, d) among the values (n, d) of their ends."""
        low = high = values[self.ends[:, 0]]
        for end in self.ends.T[1:]:
            low, high = np.minimum(low, values[end]), np.maximum(high, values[end])
        return np.asarray(high - low)


class Coarse(NamedTuple):
    """Vertices ``first`` (k,), pairs (e, 2) of them side by side, and those ``between``."""

    first: IntArray
    pairs: IntArray
    between: list[Between]


def coarsened(
    flat: FloatArray, panel: IntArray, on_edge: npt.NDArray[np.bool_], widths: list[float]
) -> Coarse:
    """Pick one vertex per square of the flat panels, in ever smaller squares, and then the rest.

    Parameters
    ----------
    flat : (n, 2) [m]     places in the flat panels
    panel : (n,) int64    to which the vertices belong; below 0 for those without a face
    on_edge : (n,)        on the outline of a panel: those have squares of their own, for light
        changes fast across a seam
    widths : of the squares [m], each level finer than the one before
    """
    used = panel >= 0
    chosen = _extremes(flat, panel)
    chosen |= _one_per_square(flat, panel, on_edge, chosen, widths[0])
    first, pairs = np.flatnonzero(chosen), []
    between: list[Between] = []
    for width in [*widths[1:], 0.0]:
        wanted = _one_per_square(flat, panel, on_edge, chosen, width) if width else used
        parts = []
        for name in np.unique(panel[used]):
            own = panel == name
            held, new = np.flatnonzero(own & chosen), np.flatnonzero(own & wanted & ~chosen)
            mesh = Delaunay(flat[held])
            if not between:
                pairs.append(held[edges(mesh.simplices.astype(np.int64))])
            parts.append(_located(mesh, flat, held, new))
        between.append(Between(*map(np.concatenate, zip(*parts, strict=True))))
        chosen = chosen | wanted
    return Coarse(first, np.concatenate(pairs), between)


def _extremes(flat: FloatArray, panel: IntArray) -> npt.NDArray[np.bool_]:
    """Whether a vertex is the outermost of its panel along one of eight directions."""
    out = np.zeros(len(flat), dtype=bool)
    u, v = flat.T
    for along in (u, v, u + v, u - v):
        order = np.lexsort((along, panel))
        ends = np.flatnonzero(np.diff(panel[order], prepend=-2, append=-2))
        out[order[ends[:-1]]] = out[order[ends[1:] - 1]] = True
    return out & (panel >= 0)


def _one_per_square(
    flat: FloatArray,
    panel: IntArray,
    on_edge: npt.NDArray[np.bool_],
    chosen: npt.NDArray[np.bool_],
    width: float,
) -> npt.NDArray[np.bool_]:
    """Whether a vertex is the one nearest to the middle of its square, or ``chosen`` before."""
    place = (flat - flat.min(axis=0)) / width
    square = place.astype(np.int64)
    off = np.where(chosen, -1.0, ((place - square - 0.5) ** 2).sum(axis=1))
    columns, lines = square.max(axis=0) + 1
    key = ((panel * 2 + on_edge) * lines + square[:, 1]) * columns + square[:, 0]
    order = np.lexsort((off, key))
    out = chosen.copy()
    out[order[np.flatnonzero(np.diff(key[order], prepend=-1))]] = True
    return out & (panel >= 0)


def _located(
    mesh: Delaunay, flat: FloatArray, held: IntArray, new: IntArray
) -> tuple[IntArray, IntArray, FloatArray]:
    """Between which of the vertices ``held`` the ``new`` ones lie; the nearest, outside them."""
    inside = mesh.find_simplex(flat[new])
    to_share = mesh.transform[inside]
    share = np.einsum("kij,kj->ki", to_share[:, :2], flat[new] - to_share[:, 2])
    share = np.column_stack([share, 1.0 - share.sum(axis=1)])
    ends = held[mesh.simplices[inside]]
    lost = np.flatnonzero((inside < 0) | ~np.isfinite(share).all(axis=1))
    if len(lost):
        ends[lost] = held[KDTree(flat[held]).query(flat[new[lost]])[1]][:, None]
        share[lost] = (1.0, 0.0, 0.0)
    return new, ends, share
