"""Which zone of the pattern a face lies in; one answer for solver, maps and score."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from seatlook.model import FloatArray, IntArray, Pattern, ZoneBox

FREE_EDGE = "free edge"
BAND = 0.015  # [m] width of a seam band on each side, and of the free-edge band


def zones(
    centroids: FloatArray, panel: IntArray, pattern: Pattern, *, boxes: Sequence[ZoneBox] = ()
) -> tuple[IntArray, tuple[str, ...]]:
    """Assign each face to one zone.

    A user's box comes first, then the band along free edges (which is left out of every
    statement: the edge is clamped or trimmed), then the band of the nearest seam, then the
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
    sewn = {edge: seam.name for seam in pattern.seams for edge in (seam.a, *seam.b)}
    zone = np.zeros(len(centroids), dtype=np.int64)
    for i, p in enumerate(pattern.panels):
        mine = np.flatnonzero(panel == i)
        points = centroids[mine]
        chosen = np.full(len(mine), index[f"{p.name} interior"])
        nearest = np.full(len(mine), BAND)
        for edge in (e for e in pattern.edges.values() if e.panel == p.name and e.name in sewn):
            distance = distance_to_polyline(points, pattern.edge_points(edge.name))
            closer = distance < nearest
            chosen[closer] = index[f"seam {sewn[edge.name]}"]
            nearest[closer] = distance[closer]
        for line in _free_polylines(pattern, p.name, sewn):
            chosen[distance_to_polyline(points, line) < BAND] = index[FREE_EDGE]
        for box in (b for b in boxes if b.panel == p.name):
            inside = ((points >= box.low) & (points <= box.high)).all(axis=1)
            chosen[inside] = index[box.name]
        zone[mine] = chosen
    return zone, tuple(names)


def _free_polylines(pattern: Pattern, panel: str, sewn: dict[str, str]) -> list[FloatArray]:
    """Stretches of the outline that no seam covers."""
    outline = pattern.panel(panel).outline
    n = len(outline)
    covered = np.zeros(n, dtype=bool)  # segment k runs from vertex k to k + 1
    for edge in pattern.edges.values():
        if edge.panel == panel and edge.name in sewn:
            count = (edge.end - edge.start) % n or n
            covered[(edge.start + np.arange(count)) % n] = True
    return [outline[[k, (k + 1) % n]] for k in np.flatnonzero(~covered)]


def distance_to_polyline(points: FloatArray, line: FloatArray) -> FloatArray:
    """Distance (m,) of points (m, 2) to an open polyline (k, 2), in its unit.

    Examples
    --------
    >>> distance_to_polyline(np.array([[0.5, 1.0], [2.0, 0.0]]), np.array([[0.0, 0], [1, 0]]))
    array([1., 1.])
    """
    start, step = line[:-1], np.diff(line, axis=0)
    offset = points[:, None] - start
    length2 = np.maximum((step**2).sum(axis=1), 1e-300)
    along = np.clip((offset * step).sum(axis=2) / length2, 0.0, 1.0)
    gap = offset - along[..., None] * step
    return np.asarray(np.sqrt((gap**2).sum(axis=2)).min(axis=1))


def quantile(values: FloatArray, weight: FloatArray, share: float) -> float:
    """Return the smallest value with at least ``share`` of the weight at or below it.

    Examples
    --------
    >>> quantile(np.array([5.0, 0.0, 1.0]), np.array([0.02, 0.9, 0.08]), 0.95)
    1.0
    """
    order = np.argsort(values, kind="stable")
    reached = np.cumsum(weight[order]) / weight.sum()
    return float(values[order][min(int(np.searchsorted(reached, share)), len(values) - 1)])
