"""A sew line that is on no layer of its own: it runs parallel inside the outline; millimetres."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import shapely

from seatlook.io.pattern.pieces.join import Chain, without_repeats
from seatlook.model import FloatArray

_WIDEST_MM = 35.0  # allowance
_NARROWEST_MM = 1.0
_ALONG = np.sin(np.radians(8.0))
_SAMPLES = 400
_MOST = 0.9  # of its length is parallel; the rest goes round corners and notches


def parallel_inside(outline: FloatArray, chains: Sequence[Chain]) -> Chain | None:
    """Return the closed line that runs parallel inside an outline; of several the outermost.

    The allowance may differ from edge to edge.
    """
    ring = shapely.LinearRing(outline)
    area = shapely.Polygon(outline)
    inside = [
        chain
        for chain in chains
        if chain.closed and len(chain.points) > 2 and _is_parallel(area, ring, chain.points)
    ]
    return max(inside, key=lambda chain: abs(chain.area)) if inside else None


def outer_ring(chains: Sequence[Chain]) -> Chain | None:
    """Return the line round all that lines enclose together; other lines may end on it."""
    lines = [shapely.LineString(chain.points) for chain in chains if len(chain.points) > 1]
    faces = shapely.get_parts(shapely.polygonize([shapely.union_all(lines)]))
    if not len(faces):
        return None
    whole = max(shapely.get_parts(shapely.union_all(faces)), key=shapely.area)
    ring = without_repeats(shapely.get_coordinates(whole.exterior)[:-1], closed=True)
    return Chain(ring, closed=True, joints=np.zeros((0, 2)))


def _is_parallel(area: shapely.Polygon, ring: shapely.LinearRing, points: FloatArray) -> bool:
    inner = shapely.Polygon(points)
    if not (area.is_valid and inner.is_valid and area.contains(inner)):
        return False
    middle, along = _sampled(inner.exterior)
    places = shapely.points(middle)
    nearest = shapely.line_interpolate_point(ring, shapely.line_locate_point(ring, places))
    across = middle - shapely.get_coordinates(nearest)
    width = np.hypot(*across.T)
    widest = float(np.quantile(width, 0.98))
    if float(np.quantile(width, 0.02)) < _NARROWEST_MM or widest > _WIDEST_MM:
        return False
    parallel = np.abs((across * along).sum(axis=1)) < _ALONG * width
    # All the way round: a square near a corner is parallel to two edges, but far from the others.
    around, _ = _sampled(ring)
    far = shapely.distance(inner.exterior, shapely.points(around))
    return bool(parallel.mean() > _MOST and np.quantile(far, 0.98) < 2.0 * widest)


def _sampled(ring: shapely.LinearRing) -> tuple[FloatArray, FloatArray]:
    """Return points at equal distances and the unit directions there, (n, 2) each."""
    at = (np.arange(_SAMPLES) + 0.5) * ring.length / _SAMPLES
    step = 1e-3 * ring.length / _SAMPLES
    before, after = (
        shapely.get_coordinates(shapely.line_interpolate_point(ring, at + sign * step))
        for sign in (-1, 1)
    )
    along = after - before
    return (before + after) / 2, along / np.maximum(np.hypot(*along.T), 1e-12)[:, None]
