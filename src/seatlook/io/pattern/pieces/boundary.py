"""What the lines of the boundary layer are: outline, sew line, cut-out, slit; millimetres."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
import shapely

from seatlook.io.pattern.drawing.entities import Left
from seatlook.io.pattern.drawing.layers import BOUNDARY
from seatlook.io.pattern.pieces.join import GAP_MM, MEETING_MM, Chain
from seatlook.io.pattern.pieces.sewline import outer_ring, parallel_inside
from seatlook.model import FloatArray, Notch


@dataclass(slots=True)
class Boundary:
    """The lines of the boundary layer, sorted.

    Parameters
    ----------
    outline : the outline, or all there is where it cannot be told
    inner : closed lines inside it
    slits : open lines from the edge inward
    """

    outline: list[Chain]
    inner: list[Chain] = field(default_factory=list)
    slits: list[Notch] = field(default_factory=list)


def sort_boundary(chains: Sequence[Chain], deepest: float, left: Counter[Left]) -> Boundary:
    """Sort the chains of the boundary layer by what they can be beside the outline.

    Parameters
    ----------
    deepest : longest slit that is a notch [mm]
    """
    closed = [chain for chain in chains if _has_area(chain)]
    if len(chains) < 2 or not closed:
        return Boundary(list(chains))
    outline = max(closed, key=lambda chain: abs(chain.area))
    area = shapely.Polygon(outline.points)
    if not area.is_valid:
        return Boundary(list(chains))
    result = Boundary([outline])
    for chain in chains:
        if chain is outline:
            continue
        line = shapely.LineString(chain.points)
        if not area.buffer(GAP_MM).contains(line):
            result.outline.append(chain)
        elif _has_area(chain):
            if area.exterior.hausdorff_distance(line) < GAP_MM:
                left[Left("outline", BOUNDARY, "drawn twice")] += 1
            else:
                result.inner.append(chain)
        elif (slit := _slit(area.exterior, chain.points, deepest)) is not None:
            result.slits.append(slit)
        else:
            left[Left("line", BOUNDARY, "an open line inside the outline")] += 1
    return result


def take_sew_line(
    outline: FloatArray, candidates: Mapping[str, list[Chain]]
) -> tuple[str, Chain] | None:
    """Take the sew line out of closed lines on other layers, by being parallel to the outline.

    Returns
    -------
    its layer and the line, or None
    """
    found = {layer: parallel_inside(outline, chains) for layer, chains in candidates.items()}
    lines = {layer: chain for layer, chain in found.items() if chain is not None}
    if not lines:
        return _taken_together(outline, candidates)
    layer = max(lines, key=lambda name: abs(lines[name].area))
    # Which line it is, by identity: chains hold arrays and do not compare.
    candidates[layer][:] = [chain for chain in candidates[layer] if chain is not lines[layer]]
    return layer, lines[layer]


def _taken_together(
    outline: FloatArray, candidates: Mapping[str, list[Chain]]
) -> tuple[str, Chain] | None:
    """Take a sew line that is drawn edge by edge, with other lines that end on it."""
    for layer, chains in candidates.items():
        ring = outer_ring([chain for chain in chains if not chain.closed])
        if ring is None or parallel_inside(outline, [ring]) is None:
            continue
        edge = shapely.LinearRing(ring.points).buffer(MEETING_MM)
        on = [edge.contains(shapely.LineString(c.points)) for c in chains]
        ends = [c.points[[0, -1]] for c, is_on in zip(chains, on, strict=True) if is_on]
        chains[:] = [c for c, is_on in zip(chains, on, strict=True) if not is_on]
        return layer, replace(ring, joints=np.concatenate(ends))
    return None


def outermost(chains: Sequence[Chain], layer: str, left: Counter[Left]) -> list[Chain]:
    """Leave out closed lines that lie in another; those of a cut-out, as a rule."""
    closed = [chain for chain in chains if _has_area(chain)]
    if len(closed) < 2 or len(closed) < len(chains):
        return list(chains)
    largest = max(closed, key=lambda chain: abs(chain.area))
    area = shapely.Polygon(largest.points).buffer(GAP_MM)
    outside = [c for c in closed if c is largest or not area.contains(shapely.LineString(c.points))]
    if len(outside) < len(closed):
        left[Left("line", layer, "closed, inside the sew line")] += len(closed) - len(outside)
    return outside


def _has_area(chain: Chain) -> bool:
    if not chain.closed or len(chain.points) < 3:
        return False
    return abs(chain.area) > 1e-3 * float(np.ptp(chain.points, axis=0).max()) ** 2


def _slit(edge: shapely.LinearRing, points: FloatArray, deepest: float) -> Notch | None:
    """Return the notch that a short line from the edge inward is."""
    away = shapely.distance(edge, shapely.points(points))
    depth = float(away.max())
    if away.min() > GAP_MM or depth >= deepest or np.ptp(points, axis=0).max() >= deepest:
        return None
    place = points[int(away.argmin())]
    return Notch(position=1e-3 * place, kind="v", depth=1e-3 * depth)
