"""Which zone of the pattern a face lies in; one answer for solver, maps and score."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from seatlook.mesh.polyline import distance_to_polyline
from seatlook.model._check import FloatArray, IntArray
from seatlook.model.pattern import Pattern
from seatlook.model.scene import ZoneBox

FREE_EDGE = "free edge"
BAND = 0.015  # [m] width of a seam band on each side, and of the free-edge band


def built_in_zones(pattern: Pattern) -> tuple[str, ...]:
    """Names of the classes of boxes, and of the zones that a pattern has without boxes."""
    none = np.zeros((0, 2)), np.zeros(0, dtype=np.int64)
    return ("A", "B", "C", *zones(*none, pattern)[1])


def zones(
    centroids: FloatArray, panel: IntArray, pattern: Pattern, *, boxes: Sequence[ZoneBox] = ()
) -> tuple[IntArray, tuple[str, ...]]:
    """Assign each face to one zone.

    A user's box comes first, then the band along free edges and cut-outs (which is left out
    of every statement: the edge is clamped or trimmed), then the band of the nearest seam, then the
    panel's interior.

    Parameters
    ----------
    centroids : (m, 2) float64 [m]   face centres in pattern coordinates
    panel : (m,) int64               index into ``pattern.panels``

    Returns
    -------
    zone : (m,) int64
    names : tuple of str
        Box names, ``free edge``, ``seam NAME``, ``PANEL interior``.
    """
    names = [
        *(box.name for box in boxes),
        FREE_EDGE,
        *(f"seam {seam.name}" for seam in pattern.seams),
        *(f"{p.name} interior" for p in pattern.panels),
    ]
    index = {name: i for i, name in enumerate(names)}
    seam_of = {edge: seam.name for seam in pattern.seams for edge in (seam.a, *seam.b)}
    zone = np.zeros(len(centroids), dtype=np.int64)
    for i, p in enumerate(pattern.panels):
        rows = np.flatnonzero(panel == i)
        points = centroids[rows]
        chosen = np.full(len(rows), index[f"{p.name} interior"])
        nearest = np.full(len(rows), BAND)
        for edge in (e for e in pattern.edges.values() if e.panel == p.name and e.name in seam_of):
            distance = distance_to_polyline(points, pattern.edge_points(edge.name))
            closer = distance < nearest
            chosen[closer] = index[f"seam {seam_of[edge.name]}"]
            nearest[closer] = distance[closer]
        holes = [np.vstack([hole, hole[:1]]) for hole in p.holes]
        for line in (*_free_polylines(pattern, p.name, seam_of), *holes):
            chosen[distance_to_polyline(points, line) < BAND] = index[FREE_EDGE]
        for box in (b for b in boxes if b.panel == p.name):
            inside = ((points >= box.low) & (points <= box.high)).all(axis=1)
            chosen[inside] = index[box.name]
        zone[rows] = chosen
    return zone, tuple(names)


def _free_polylines(pattern: Pattern, panel: str, seam_of: dict[str, str]) -> list[FloatArray]:
    """Stretches of the outline that no seam covers."""
    outline = pattern.panel(panel).outline
    n = len(outline)
    covered = np.zeros(n, dtype=bool)  # segment k runs from vertex k to k + 1
    for edge in pattern.edges.values():
        if edge.panel == panel and edge.name in seam_of:
            count = (edge.end - edge.start) % n or n
            covered[(edge.start + np.arange(count)) % n] = True
    return [outline[[k, (k + 1) % n]] for k in np.flatnonzero(~covered)]
