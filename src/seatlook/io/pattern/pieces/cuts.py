"""Notches cut into an outline: recognised by their shape and, if small, closed; millimetres."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from seatlook.mesh import arc_length
from seatlook.model import FloatArray, Notch
from seatlook.model.pattern import NotchKind

BoolArray = np.ndarray[tuple[int, ...], np.dtype[np.bool_]]

_TURN_DEG = 20.0  # at the mouth; the outline must go on behind it within the same angle
_ON_LINE_MM = 0.01  # off the line between its neighbours, where a mouth is no vertex of its own
_LONGEST = 8.0  # way round a cut over its size
_ONE_NOTCH_MM = 2.0  # a cut and a point that are closer are one notch
_SAME_MM = 0.2  # by which shapes inside a cut differ
SLIT_MM = 0.5  # a cut that is no wider is a slit
DEEPEST_SLIT = 3.0  # over the size below which other cuts are closed


class Cut(NamedTuple):
    """One cut: its mouth's vertices, the run of vertices from one to the other, its notch."""

    first: int
    last: int
    notch: Notch


def close_cuts(points: FloatArray, below: float) -> tuple[FloatArray, tuple[Notch, ...]]:
    """Close the cuts that are less deep and less wide than ``below``, and slits 3 times as deep.

    A cut leaves the outline at a turn, stays inside, and comes back to where the outline goes on
    in the same direction; so neither a chamfer nor a corner nor a curve is one.

    Parameters
    ----------
    points : (n, 2) [mm]     closed, counter-clockwise, the first vertex not repeated
    below : [mm]

    Returns
    -------
    points : (k, 2) [mm]
        Without the cuts; a mouth on a straight stretch leaves no vertex, so that the outline is
        the one that was never cut. Vertices of a curve inside a mouth are lost.
    notches : one for every closed cut

    Examples
    --------
    >>> cut = [[0, 0], [48.5, 0], [50, 3], [51.5, 0], [100, 0], [100, 50], [0, 50]]
    >>> outline, (notch,) = close_cuts(np.array(cut, float), 5.0)
    >>> outline.tolist(), notch.kind, notch.depth
    ([[0.0, 0.0], [100.0, 0.0], [100.0, 50.0], [0.0, 50.0]], 'v', 0.003)
    """
    cuts = _find(points, below)
    n = len(points)
    keep, mouth = np.ones(n, dtype=bool), np.zeros(n, dtype=bool)
    for cut in cuts:
        keep[np.arange(cut.first + 1, cut.last) % n] = False
        mouth[[cut.first % n, cut.last % n]] = True
    index = np.flatnonzero(keep)
    flat = _straight(points[index], mouth[index])
    return points[index[~flat]], tuple(cut.notch for cut in cuts)


def with_cuts(drawn: Sequence[Notch], cuts: Sequence[Notch]) -> tuple[Notch, ...]:
    """Add to the notches of the notch layers the cuts that none of them stands for."""
    notches = list(drawn)
    for cut in cuts:
        if all(np.hypot(*(cut.position - n.position)) > 1e-3 * _ONE_NOTCH_MM for n in notches):
            notches.append(cut)
    return tuple(notches)


def _find(points: FloatArray, below: float) -> list[Cut]:
    """Return the cuts in the order of the outline; of several from one mouth the longest."""
    n = len(points)
    ahead = np.roll(points, -1, axis=0) - points
    behind = np.roll(ahead, 1, axis=0)
    cross = behind[:, 0] * ahead[:, 1] - behind[:, 1] * ahead[:, 0]
    left = np.degrees(np.arctan2(cross, (behind * ahead).sum(axis=1)))
    # A mouth turns inward, which is left: first into the cut, then out of it along the outline.
    turns = np.flatnonzero(left > 0.5 * _TURN_DEG)
    turns = np.concatenate([turns, turns + n])
    way = arc_length(np.concatenate([points, points, points[:1]]))
    cuts: list[Cut] = []
    done = 0
    for first in turns[turns < n]:
        near = (turns > first + 1) & (way[turns] - way[first] < _LONGEST * below)
        longer = [c for k in turns[near] if (c := _cut(points, int(first), int(k), below))]
        if longer and first >= done:
            cuts.append(longer[-1])
            done = longer[-1].last
    return cuts


def _cut(points: FloatArray, first: int, last: int, below: float) -> Cut | None:
    """Return the cut between two vertices if there is one."""
    n = len(points)
    run = points[np.arange(first - 1, last + 2) % n]
    before, after = (_unit(run[1] - run[0]), _unit(run[-1] - run[-2]))
    limit = np.radians(_TURN_DEG)
    if before @ after < np.cos(limit):
        return None
    along = _unit(before + after)
    inward = np.array([-along[1], along[0]])
    inner = run[1:-1] - run[1]
    s, depth = inner @ along, inner @ inward
    away = (_unit(inner[1] - inner[0]), _unit(inner[-1] - inner[-2]))
    turned = away[0] @ inward > np.sin(limit) and away[1] @ inward < -np.sin(limit)
    goes_on = abs(depth[-1]) <= max(np.tan(limit) * s[-1], _SAME_MM) and s[-1] > -_SAME_MM
    deepest = DEEPEST_SLIT * below if np.ptp(s) < SLIT_MM else below
    small = np.ptp(s) < below and depth.max() < deepest
    if not (turned and goes_on and small and depth[1:-1].min() > 0.0):
        return None
    notch = Notch(
        position=5e-4 * (run[1] + run[-2]),
        kind=_kind(s, depth),
        depth=1e-3 * float(depth.max() - 0.5 * depth[-1]),
    )
    return Cut(first, last, notch)


def _kind(s: FloatArray, depth: FloatArray) -> NotchKind:
    """Name the shape of a cut of which ``s`` runs along the outline and ``depth`` into it."""
    low, high = sorted((s[0], s[-1]))
    if len(s) == 3:
        upright = min(abs(s[1] - low), abs(s[1] - high)) < _SAME_MM < high - low
        return "check" if upright else "v"
    if s.min() < low - _SAME_MM or s.max() > high + _SAME_MM:
        return "t"
    flat = len(s) == 4 and abs(depth[1] - depth[2]) < _SAME_MM
    return "castle" if flat else "u"


def _straight(points: FloatArray, mouth: BoolArray) -> BoolArray:
    """Return which mouths (n,) lie on the line between the vertices around them."""
    flat = np.zeros(len(points), dtype=bool)
    fixed = np.flatnonzero(~mouth)
    if len(fixed) < 2:
        return flat
    for k in np.flatnonzero(mouth):
        at = np.searchsorted(fixed, k)
        a, b = points[fixed[at - 1]], points[fixed[at % len(fixed)]]
        across = np.array([a[1] - b[1], b[0] - a[0]]) / np.hypot(*(b - a))
        flat[k] = abs((points[k] - a) @ across) < _ON_LINE_MM
    return flat


def _unit(vector: FloatArray) -> FloatArray:
    return np.asarray(vector / max(float(np.hypot(*vector)), 1e-12))
