"""From the loose polylines of a pattern file to closed outlines; millimetres throughout."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import shapely
import shapely.ops

from seatlook.errors import InputError
from seatlook.io.pattern.pieces.cuts import close_cuts
from seatlook.io.pattern.pieces.join import MEETING_MM, Chain, without_repeats
from seatlook.model import FloatArray, IntArray

CORNER_DEG = 30.0


def unfold(lines: Sequence[FloatArray], axis: FloatArray) -> list[FloatArray]:
    """Add to the lines of a half piece their mirror images; drop what lies on the axis.

    Parameters
    ----------
    axis : (2, 2), two points of the fold line
    """
    unfolded = []
    for line in lines:
        for part in _off_axis(line, axis):
            unfolded += [part, reflect(part, axis)]
    return unfolded


def reflect(points: FloatArray, axis: FloatArray) -> FloatArray:
    """Mirror points (k, 2) at the line through ``axis`` (2, 2).

    Examples
    --------
    >>> reflect(np.array([[3.0, 1.0]]), np.array([[0.0, 0.0], [0.0, 5.0]])).tolist()
    [[-3.0, 1.0]]
    """
    along = (axis[1] - axis[0]) / np.hypot(*(axis[1] - axis[0]))
    offset = points - axis[0]
    return np.asarray(axis[0] + 2 * np.outer(offset @ along, along) - offset)


def distance_to(points: FloatArray, axis: FloatArray) -> FloatArray:
    """Signed distance (k,) of points to the line through ``axis``, positive on its left."""
    along = (axis[1] - axis[0]) / np.hypot(*(axis[1] - axis[0]))
    offset = points - axis[0]
    return np.asarray(along[0] * offset[:, 1] - along[1] * offset[:, 0])


def _off_axis(line: FloatArray, axis: FloatArray) -> list[FloatArray]:
    """Cut the segments out that lie on the axis and pull the ends exactly onto it."""
    away = distance_to(line, axis)
    on = np.abs(away) < MEETING_MM
    line = np.where(on[:, None], (line + reflect(line, axis)) / 2, line)
    cuts = np.flatnonzero(on[:-1] & on[1:])
    parts = np.split(line, cuts + 1)
    return [p for p in parts if len(p) > 1]


def closed_outline(chains: Sequence[Chain], *, key: str, smallest_notch: float = 0.0) -> Chain:
    """Return the one closed chain, counter-clockwise, without the cuts below a size [mm].

    Raises
    ------
    InputError
        When the outline is missing, open, doubled or crosses itself.
    """
    for chain in chains:
        if not chain.closed:
            first, last = chain.points[[0, -1]].round(2).tolist()
            gap = np.hypot(*(chain.points[0] - chain.points[-1]))
            raise InputError.single(
                key,
                got=f"an open outline, from {first} to {last} mm ({gap:.2f} mm apart)",
                expected="a closed outline",
            )
    if len(chains) != 1:
        raise InputError.single(key, got=f"{len(chains)} closed outlines", expected="one")
    chain = chains[0]
    if chain.area < 0:
        chain = replace(chain, points=_reversed(chain.points))
    points, notches = close_cuts(chain.points, smallest_notch)
    # A slit without width is drawn there and back, so it must be gone before this.
    check_simple(points, key=key)
    return replace(chain, points=points, notches=notches)


def check_simple(points: FloatArray, *, key: str) -> None:
    """Refuse an outline that crosses or touches itself."""
    polygon = shapely.Polygon(points) if len(points) > 2 else shapely.Polygon()
    if not polygon.is_valid or polygon.area == 0:
        reason = shapely.is_valid_reason(polygon) if len(points) > 2 else "fewer than 3 points"
        where = reason.partition("[")[2].rstrip("]")
        got = f"an outline that crosses itself at ({where}) mm" if where else "no area"
        raise InputError.single(key, got=got, expected="a simple outline")


def trimmed(cut: Chain, seams: Sequence[Chain], *, key: str) -> Chain:
    """Return the outline that open sew lines leave of the cut outline.

    Where only some edges carry an allowance, the sew lines end on the cut line, which is itself
    the edge elsewhere.
    """
    polygon = shapely.Polygon(cut.points)
    for seam in seams:
        parts = shapely.ops.split(polygon, shapely.LineString(_lengthened(seam.points))).geoms
        if len(parts) < 2:
            first, last = seam.points[[0, -1]].round(2).tolist()
            raise InputError.single(
                key,
                got=f"an open sew line, from {first} to {last} mm",
                expected="a closed one, or both ends on the cut line",
            )
        polygon = max(parts, key=lambda p: p.area)
    points = without_repeats(np.array(polygon.exterior.coords)[:-1], closed=True)
    ends = np.vstack([s.points[[0, -1]] for s in seams] + [s.joints for s in seams] + [cut.joints])
    chain = Chain(points, True, ends)
    return chain if chain.area > 0 else Chain(_reversed(points), True, ends)


def _lengthened(points: FloatArray) -> FloatArray:
    """Lengthen both ends a little, so that a line ending at the boundary crosses it."""
    ends = []
    for end, inner in ((points[0], points[1]), (points[-1], points[-2])):
        ends.append(end + MEETING_MM * (end - inner) / np.hypot(*(end - inner)))
    return np.vstack([ends[0], points[1:-1], ends[1]])


def _reversed(points: FloatArray) -> FloatArray:
    """Run the other way round from the same first point."""
    return np.roll(points[::-1], 1, axis=0)


def corners(points: FloatArray, marks: FloatArray, *, within: float = 0.5) -> IntArray:
    """Return the vertices of a closed outline at which it turns sharply or which are marked.

    Parameters
    ----------
    points : (n, 2) [mm]
    marks : (k, 2) [mm]    turn points and joints; one farther than ``within`` counts nothing

    Examples
    --------
    >>> square = np.array([[0.0, 0], [5, 0], [10, 0], [10, 10], [0, 10]])
    >>> corners(square, np.array([[5.0, 0.2]])).tolist()
    [0, 1, 2, 3, 4]
    """
    before, after = points - np.roll(points, 1, axis=0), np.roll(points, -1, axis=0) - points
    cross = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    turn = np.degrees(np.abs(np.arctan2(cross, (before * after).sum(axis=1))))
    vertices = set(np.flatnonzero(turn > CORNER_DEG).tolist())
    for mark in marks:
        distance = np.hypot(*(points - mark).T)
        if distance.min() < within:
            vertices.add(int(distance.argmin()))
    return np.array(sorted(vertices), dtype=np.int64)
