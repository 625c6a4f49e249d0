"""Lines of mesh vertices, the points stitched on them, and the curves they are pulled to."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from seatlook import mesh
from seatlook.model import Anchor, FloatArray, Hook, IntArray, Points

_ON_LINE = 1e-6  # m; a vertex that near an end of the hooked part belongs to it


@dataclass(frozen=True, slots=True)
class Line:
    """A polyline of mesh vertices, in the order in which it is run through."""

    vertices: IntArray
    arc: FloatArray  # arc length at each vertex [m]

    def points(self, at: FloatArray) -> Points:
        """Points at arc lengths ``at`` (s,)."""
        k = np.clip(np.searchsorted(self.arc, at, side="right") - 1, 0, len(self.arc) - 2)
        w = np.clip((at - self.arc[k]) / (self.arc[k + 1] - self.arc[k]), 0.0, 1.0)
        return Points(
            vertices=np.column_stack([self.vertices[k], self.vertices[k + 1]]),
            weights=np.column_stack([1.0 - w, w]),
        )

    @property
    def length(self) -> float:
        """Length of the line [m]."""
        return float(self.arc[-1])

    @property
    def spacing(self) -> float:
        """Mean distance of its vertices [m]."""
        return self.length / (len(self.vertices) - 1)


def line_through(points: FloatArray, vertices: IntArray, offset: int) -> Line:
    """Return the line through mesh vertices, whose numbers start at ``offset``."""
    return Line(vertices + offset, mesh.arc_length(points[vertices]))


def stitches(share: float, total: float, pitch: float) -> tuple[FloatArray, FloatArray]:
    """Stitch places in [0, share] (both ends and the middles between) and their lengths [m]."""
    count = max(1, round(share * total / pitch))
    middle = (np.arange(count) + 0.5) / count
    at = share * np.concatenate([[0.0], middle, [1.0]])
    length = share * total / count * np.concatenate([[0.5], np.ones(count), [0.5]])
    return at, length * count / (count + 1)


def join(parts: Sequence[Points]) -> Points:
    """Put points one after the other."""
    return Points(
        vertices=np.concatenate([p.vertices for p in parts]),
        weights=np.concatenate([p.weights for p in parts]),
    )


def curve_of(points: FloatArray) -> Callable[[FloatArray], FloatArray]:
    """Return the curve as a function of the share of its length in [0, 1]."""
    arc = mesh.arc_length(points) / mesh.segment_lengths(points).sum()
    return lambda s: np.column_stack([np.interp(s, arc, points[:, k]) for k in range(3)])


def anchor_on(
    lines: Sequence[Line],
    curve: Callable[[FloatArray], FloatArray],
    x: FloatArray,
    *,
    name: str,
    kind: Literal["hook", "frame"],
    stage: str,
) -> Anchor:
    """Send every vertex of the lines to its share of the curve, the shorter way round.

    One point per vertex: more could not all reach their targets.
    """
    before = np.cumsum([0.0, *(ln.length for ln in lines)])
    points = join([ln.points(ln.arc) for ln in lines])
    at = np.concatenate([b + ln.arc for b, ln in zip(before, lines, strict=False)])
    steps = [np.concatenate([[0.0], np.diff(ln.arc), [0.0]]) / 2 for ln in lines]
    return Anchor(
        name=name,
        kind=kind,
        points=points,
        target=_shorter_way(curve, at / before[-1], points.at(x)),
        length=np.concatenate([step[:-1] + step[1:] for step in steps]),
        stage=stage,
        at=at,
    )


def rings_on(
    line: Line, hook: Hook, curve: Callable[[FloatArray], FloatArray], x: FloatArray
) -> Anchor:
    """Pull a line to its wire: its vertices, or hog rings at the hook's pitch.

    A point at a share of the whole line's length goes to that share of the whole wire, whatever
    part of the line is pulled. Rings stand at both ends of that part and at equal steps between
    them, as near to the pitch as that allows, but not closer than the line's vertices.
    """
    end = line.length if hook.end is None else min(hook.end, line.length)
    if hook.pitch is None:
        at = line.arc[(line.arc >= hook.start - _ON_LINE) & (line.arc <= end + _ON_LINE)]
        if len(at) < 2:
            at = np.array([hook.start, end])
    else:
        pitch = max(hook.pitch, line.spacing)
        at = np.linspace(hook.start, end, max(1, round((end - hook.start) / pitch)) + 1)
    step = np.concatenate([[0.0], np.diff(at), [0.0]]) / 2
    points = line.points(at)
    return Anchor(
        name=hook.name,
        kind="hook",
        points=points,
        target=_shorter_way(curve, at / line.length, points.at(x)),
        length=step[:-1] + step[1:],
        stage=hook.stage,
        at=at,
        limit=hook.limit,
    )


def _shorter_way(
    curve: Callable[[FloatArray], FloatArray], share: FloatArray, start: FloatArray
) -> FloatArray:
    """Points of the curve at shares of its length, from that end which is nearer to ``start``."""
    target, turned = curve(share), curve(1.0 - share)
    if np.linalg.norm(turned - start) < np.linalg.norm(target - start):
        return turned
    return target
