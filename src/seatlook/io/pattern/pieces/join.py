"""Loose polylines joined end to end; millimetres throughout."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from seatlook.model import FloatArray, Notch

MEETING_MM = 0.1  # exporters write 2 to 4 decimals of a millimetre or an inch
GAP_MM = 0.5  # between ends that were meant to meet
_NEIGHBOURS = 8
_SHORTEST_LOOP = 4.0  # a line that closes itself over the gap it leaves


@dataclass(frozen=True, slots=True)
class Chain:
    """Polylines joined end to end; a closed one does not repeat its first point."""

    points: FloatArray
    closed: bool
    joints: FloatArray
    notches: tuple[Notch, ...] = ()

    @property
    def area(self) -> float:
        """Signed area [mm2], positive when counter-clockwise."""
        x, y = self.points.T
        return float(0.5 * np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))


def join(lines: Sequence[FloatArray]) -> list[Chain]:
    """Join polylines where exactly two ends meet.

    Parameters
    ----------
    lines : (k, 2) each; a closed polyline repeats its first point

    Examples
    --------
    >>> [chain] = join([np.array([[0.0, 0], [1, 0]]), np.array([[2.0, 2], [1, 0]])])
    >>> chain.points.tolist(), chain.closed
    ([[0.0, 0.0], [1.0, 0.0], [2.0, 2.0]], False)
    """
    return _chains(lines, _partners(lines))


def join_outline(lines: Sequence[FloatArray]) -> tuple[list[Chain], list[float]]:
    """Join the polylines of an outline, of which every end is to meet another.

    Where more than two ends meet, as at the mouth of a slit, the nearest belong together, and of
    equally near ones those that follow each other in the file. What is left is joined over gaps up
    to 0.5 mm, in their middle.

    Returns
    -------
    chains
    gaps : widths [mm] of the gaps
    """
    partner = _partners(lines)
    free = [e for e in range(2 * len(lines)) if partner.get(partner.get(e, -1), -1) != e]
    ends = _ends(lines)
    pairs = _nearest(lines, ends, free)
    for _, a, b in pairs:
        partner[a], partner[b] = b, a
    whole = [line.copy() for line in lines]
    # Ends that nearly meet become one: a short step back would cross the outline.
    for a, b in partner.items():
        if partner.get(b) == a and np.hypot(*(ends[a] - ends[b])) > MEETING_MM / 100:
            whole[a // 2][-(a % 2)] = (ends[a] + ends[b]) / 2
    return _chains(whole, partner), [gap for gap, _, _ in pairs if gap > MEETING_MM]


def _nearest(
    lines: Sequence[FloatArray], ends: FloatArray, free: list[int]
) -> list[tuple[float, int, int]]:
    """Pair free ends, the nearest first; each once."""
    if len(free) < 2:
        return []
    count = min(_NEIGHBOURS, len(free))
    distance, other = (
        np.asarray(found)
        for found in cKDTree(ends[free]).query(
            ends[free], k=count, distance_upper_bound=GAP_MM + 1e-9
        )
    )
    pairs = set()
    for i, row in enumerate(other):
        for k, j in enumerate(row):
            if np.isfinite(distance[i, k]) and i != j:
                a, b = sorted((free[i], free[int(j)]))
                if a // 2 != b // 2 or _is_loop(lines[a // 2], float(distance[i, k])):
                    pairs.add((round(float(distance[i, k]), 6), b - a, a, b))
    paired: set[int] = set()
    nearest = []
    for gap, _, a, b in sorted(pairs):
        if a not in paired and b not in paired:
            paired |= {a, b}
            nearest.append((gap, a, b))
    return nearest


def _is_loop(line: FloatArray, gap: float) -> bool:
    """Whether a line whose ends are near each other goes far between them."""
    return float(np.ptp(line, axis=0).max()) > _SHORTEST_LOOP * gap and len(line) > 3


def _chains(lines: Sequence[FloatArray], partner: dict[int, int]) -> list[Chain]:
    ends = range(2 * len(lines))
    done: set[int] = set()
    chains = []
    # Open chains start at a free end; what is left over are loops.
    for start in [*(e for e in ends if e not in partner), *ends]:
        if start // 2 in done:
            continue
        route = [start]
        done.add(start // 2)
        while (following := partner.get(route[-1] ^ 1)) is not None and following // 2 not in done:
            route.append(following)
            done.add(following // 2)
        parts = [lines[e // 2][:: -1 if e % 2 else 1] for e in route]
        closed = partner.get(route[-1] ^ 1) == start
        joints = np.array([p[0] for p in parts[0 if closed and len(parts) > 1 else 1 :]])
        points = without_repeats(np.vstack(parts), closed=closed)
        chains.append(Chain(points, closed, joints.reshape(-1, 2)))
    return chains


def _ends(lines: Sequence[FloatArray]) -> FloatArray:
    return np.array([p for line in lines for p in (line[0], line[-1])]).reshape(-1, 2)


def _partners(lines: Sequence[FloatArray]) -> dict[int, int]:
    """Pair the ends that meet; end 2 i is the start of line i, end 2 i + 1 its last point."""
    if not lines:
        return {}
    ends = _ends(lines)
    # Three are enough to see that an end, which is its own neighbour, has more than one other.
    near = np.asarray(cKDTree(ends).query(ends, k=3, distance_upper_bound=MEETING_MM)[1])
    there = near < len(ends)
    return {
        e: int(next(o for o in near[e] if o != e))
        for e in np.flatnonzero(there.sum(axis=1) == 2).tolist()
    }


def without_repeats(points: FloatArray, *, closed: bool) -> FloatArray:
    """Drop points that repeat the one before."""
    keep = np.r_[True, np.hypot(*np.diff(points, axis=0).T) > MEETING_MM / 100]
    points = points[keep]
    while closed and len(points) > 1 and np.hypot(*(points[-1] - points[0])) < MEETING_MM:
        points = points[:-1]
    return points
