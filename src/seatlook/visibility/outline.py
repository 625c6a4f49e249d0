"""How far every place of a cover is from the outlines of its panel: seams, hems, cut-outs."""

from __future__ import annotations

import numpy as np

from seatlook.mesh import boundary_sides
from seatlook.mesh.closest import nearest_segments
from seatlook.mesh.kinematics import deformation_gradient
from seatlook.model import Cover, FloatArray, IntArray

_FLAT = 1e-9  # slope of the distance below which it has no direction
# An outline lies in a direction where it is off by no more than this share of the way, 10 degrees:
# the straight one beside a place 20 mm from it does not count within 100 mm.
_CONE = 0.18
_CHUNK = 2000  # places looked at together, which bounds the memory


def outline_distance(cover: Cover) -> FloatArray:
    """Distance (n,) [m] of every vertex from the nearest outline of its own panel, cut flat."""
    sides = _outlines(cover)
    # Panels may lie over each other in the flat: each gets a storey of its own.
    storey = np.zeros(len(cover.rest))
    storey[cover.faces] = cover.panel[:, None]
    flat = np.column_stack([cover.rest, 1e3 * storey])
    return nearest_segments(flat, flat[sides[:, 0]], flat[sides[:, 1]])[2]


def cutoffs(cover: Cover, cutoff: float) -> FloatArray:
    """Lengths (m, 2, 2) [m], in rest axes, up to which waves are wrinkles, by place and direction.

    Towards the nearest outline, and square to that, it is the way to the outline there, and no more
    than ``cutoff``. So a bend that follows a seam, and with it the profile of a short panel or a
    bolster and the round of its end, is part of the shape; a wave that runs along the seam, as
    surplus length makes it, is not.
    """
    away = outline_distance(cover)
    there = np.column_stack([away, np.zeros((len(away), 2))])
    slope = deformation_gradient(cover.rest, there, cover.faces)[:, 0]
    size = np.linalg.norm(slope, axis=1, keepdims=True)
    across = np.where(size > _FLAT, slope / np.maximum(size, _FLAT), (1.0, 0.0))
    along = np.column_stack([-across[:, 1], across[:, 0]])
    out = np.zeros((len(cover.faces), 2, 2))
    for axis, way in ((across, away[cover.faces].mean(axis=1)), (along, _ways(cover, along))):
        length = np.minimum(np.maximum(way, cover.element_size), cutoff)
        out += length[:, None, None] * axis[:, :, None] * axis[:, None]
    return out


def _outlines(cover: Cover) -> IntArray:
    """Ends (b, 2) of the edges of all outlines."""
    sides = cover.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    return np.asarray(sides[boundary_sides(cover.faces)])


def _ways(cover: Cover, direction: FloatArray) -> FloatArray:
    """Way (m,) [m] from the middle of every face to an outline of its panel, forth or back."""
    centre, side = cover.rest[cover.faces].mean(axis=1), boundary_sides(cover.faces)
    rim, owner = cover.rest[_outlines(cover)].mean(axis=1), cover.panel[side // 3]
    way = np.full(len(centre), np.inf)
    for panel in np.unique(cover.panel):
        rows, points = np.flatnonzero(cover.panel == panel), rim[owner == panel]
        for part in np.array_split(rows, -(-len(rows) // _CHUNK)):
            to = points - centre[part, None]
            d = direction[part, None]
            ahead = np.abs((to * d).sum(axis=2))
            beside = np.abs(to[..., 0] * d[..., 1] - to[..., 1] * d[..., 0])
            way[part] = np.where(beside <= _CONE * ahead, ahead, np.inf).min(axis=1)
    return way
