"""The sew line of a panel of which only the cut outline is drawn, by the width of its allowance."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import shapely

from seatlook.errors import InputError
from seatlook.model import Edge, FloatArray, IntArray, Panel

_STRAIGHT = 0.02  # sine of the turn at a vertex below which its two sides are one line


def only_cut(panel: Panel) -> bool:
    """Whether no sew line is drawn."""
    return np.array_equal(panel.outline, panel.cut_outline)


def with_allowance(panel: Panel, width: float) -> Panel:
    """Move the sew line inward from the cut outline by ``width`` [m]; corners go with it.

    Raises
    ------
    InputError
        The panel is narrower than two allowances.
    """
    n = len(panel.cut_outline)
    sewn = _mitred(panel.cut_outline, np.full(n, width))
    if _kept(panel.cut_outline, sewn):
        return _sewn(panel, sewn)
    outline = _shrunk(panel, width)
    return replace(panel, outline=outline, corners=_nearest(outline, sewn[panel.corners]))


def with_edge_allowances(
    panel: Panel, edges: Mapping[str, Edge], widths: Mapping[str, float], otherwise: float
) -> Panel:
    """Move the sew line inward by an own width [m] along some edges.

    Vertices keep their numbers, so that edges stay what they are. Where an edge ends without a
    corner, the width changes over within one side of the outline.

    Parameters
    ----------
    edges : of this panel; widths : name of an edge -> width [m]
    otherwise : width along all other edges

    Raises
    ------
    InputError
        The outline has rounder or narrower places than the allowances, or has lost its vertices to
        the allowance of the whole pattern.
    """
    n = len(panel.cut_outline)
    side = np.full(n, otherwise)
    for name, width in widths.items():
        edge = edges[name]
        count = (edge.end - edge.start) % n or n
        side[(edge.start + np.arange(count)) % n] = width
    sewn = _mitred(panel.cut_outline, side)
    if len(panel.outline) != n or not _kept(panel.cut_outline, sewn):
        raise InputError.single(
            "allowance_mm",
            got=f"{1e3 * max(side):g} mm on {panel.name}, which bends more tightly than that",
            expected="a smaller allowance, or a sew line in the file (layer 14)",
        )
    return _sewn(panel, sewn)


def _sewn(panel: Panel, sewn: FloatArray) -> Panel:
    """Give a panel a sew line whose sides are those of its cut line, and take its notches there."""
    ring = np.append(np.arange(len(sewn)), 0)
    sides = shapely.linestrings(panel.cut_outline[np.column_stack([ring[:-1], ring[1:]])])
    notches = []
    for notch in panel.notches:
        side = int(shapely.distance(sides, shapely.Point(notch.position)).argmin())
        start, end = sewn[side], sewn[ring[side + 1]]
        along = (notch.position - start) @ (end - start) / ((end - start) ** 2).sum()
        position = start + np.clip(along, 0.0, 1.0) * (end - start)
        notches.append(replace(notch, position=position))
    return replace(panel, outline=sewn, notches=tuple(notches))


def _mitred(points: FloatArray, side: FloatArray) -> FloatArray:
    """Move each side i, from vertex i to the next, inward by ``side[i]``; (n, 2) their corners."""
    along = np.roll(points, -1, axis=0) - points
    along /= np.maximum(np.hypot(*along.T), 1e-12)[:, None]
    inward = np.column_stack([-along[:, 1], along[:, 0]])
    before, width = np.roll(inward, 1, axis=0), np.roll(side, 1)
    cross = before[:, 0] * inward[:, 1] - before[:, 1] * inward[:, 0]
    straight = np.abs(cross) < _STRAIGHT
    cross = np.where(straight, 1.0, cross)
    # The step to a corner has the length of each width across the side that it belongs to.
    corner = np.column_stack(
        [
            (width * inward[:, 1] - side * before[:, 1]) / cross,
            (side * before[:, 0] - width * inward[:, 0]) / cross,
        ]
    )
    mean = before + inward
    mean /= np.maximum(np.hypot(*mean.T), 1e-12)[:, None]
    flat = 0.5 * (width + side)[:, None] * mean
    return np.asarray(points + np.where(straight[:, None], flat, corner))


def _kept(cut: FloatArray, sewn: FloatArray) -> bool:
    """Whether all sides still run their way, and the line does not cross itself."""
    before, after = (np.roll(p, -1, axis=0) - p for p in (cut, sewn))
    return bool(((before * after).sum(axis=1) > 0).all()) and shapely.Polygon(sewn).is_valid


def _shrunk(panel: Panel, width: float) -> FloatArray:
    """Return the line inside an outline that bends more tightly than the width somewhere."""
    inside = shapely.Polygon(panel.cut_outline).buffer(-width, join_style="mitre")
    if inside.is_empty or inside.geom_type != "Polygon":
        raise InputError.single(
            "allowance_mm",
            got=f"{1e3 * width:g} mm on {panel.name}, which is narrower than two of them",
            expected="a smaller allowance",
        )
    ring = shapely.get_coordinates(inside.exterior)[:-1]
    return np.asarray(ring if shapely.is_ccw(inside.exterior) else ring[::-1])


def _nearest(outline: FloatArray, places: FloatArray) -> IntArray:
    """Return the vertices of an outline nearest to places, each once."""
    away = np.linalg.norm(outline[None] - places[:, None], axis=2)
    return np.unique(away.argmin(axis=1))
