"""The shortest way between two vertices of a mesh, where no plane leads from one to the other."""

from __future__ import annotations

import heapq
from collections.abc import Iterator
from itertools import pairwise
from typing import Protocol

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
# A place that a way goes through: a vertex (a, a, 0), or one on the edge from a to b > a.
Stop = tuple[int, int, int]


class Net(Protocol):
    """A mesh as lists: places, corners of faces, faces at vertices, vertices of the border."""

    points: list[FloatArray]
    faces: dict[int, list[int]]
    faces_at: list[set[int]]
    border: set[int]


_PARTS = 6  # an edge can be crossed at its sixths
_DETOUR = 2.0  # times the straight distance, the longest way that is still meant


def shortest_way(net: Net, start: int, end: int) -> list[Stop] | None:
    """Find the shortest way over the surface, through vertices and places on edges.

    Beside a sharp edge the planes through two points of a line may lead back; this way does not.
    It does not run along a border, nor round a hole: one that is ``_DETOUR`` times as long as the
    straight distance is none.

    Returns
    -------
    The stops of the way, both ends included; None where there is no such way
    """
    goal = net.points[end]
    longest = _DETOUR * float(np.linalg.norm(goal - net.points[start]))
    first, last = (start, start, 0), (end, end, 0)
    length, before = {first: 0.0}, dict[Stop, Stop]()
    ahead = [(0.0, first)]
    done = set()
    while ahead:
        _, at = heapq.heappop(ahead)
        if at == last:
            return _walked(before, at)
        if at in done:
            continue
        done.add(at)
        here = place_of(net, at)
        for stop in _beside(net, at):
            if stop in done or (stop != last and _on_border(net, stop)):
                continue
            there = place_of(net, stop)
            way = length[at] + float(np.linalg.norm(there - here))
            least = way + float(np.linalg.norm(goal - there))
            if least <= longest and way < length.get(stop, np.inf):
                length[stop], before[stop] = way, at
                heapq.heappush(ahead, (least, stop))
    return None


def _walked(before: dict[Stop, Stop], at: Stop) -> list[Stop]:
    """The stops from the first to this one."""
    way = [at]
    while way[-1] in before:
        way.append(before[way[-1]])
    return way[::-1]


def place_of(net: Net, stop: Stop) -> FloatArray:
    """Place (3,) [m] of a stop."""
    a, b, part = stop
    here, there = net.points[a], net.points[b]
    return np.asarray(here + part / _PARTS * (there - here))


def _on_border(net: Net, stop: Stop) -> bool:
    """Whether a stop lies on a border."""
    a, b, _ = stop
    return a in net.border if a == b else len(net.faces_at[a] & net.faces_at[b]) < 2


def _beside(net: Net, at: Stop) -> Iterator[Stop]:
    """Stops that share a face with this one."""
    a, b, _ = at
    for f in net.faces_at[a] if a == b else (net.faces_at[a] & net.faces_at[b]):
        corners = net.faces[f]
        for c, d in pairwise([*corners, corners[0]]):
            yield (c, c, 0)
            low, high = min(c, d), max(c, d)
            if (low, high) != (a, b):
                yield from ((low, high, part) for part in range(1, _PARTS))
