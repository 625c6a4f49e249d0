"""Lines of mesh vertices, the points stitched on them, and the curves they are pulled to."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.interpolate import PchipInterpolator

from seatlook import mesh
from seatlook.model import Anchor, FloatArray, Frame, Hook, IntArray, Points, Wire

_ON_LINE = 1e-6  # m; a vertex that near an end of the hooked part belongs to it
_MEETS = 2e-3  # m; wires that come so near to each other meet
_AT_CROSSING = 1e-3  # m to either side of it


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

    def steps_at(self, at: FloatArray) -> FloatArray:
        """Distance (s,) [m] of the two vertices around arc lengths ``at`` (s,)."""
        k = np.searchsorted(self.arc[1:-1], at, side="right")
        return np.asarray(np.diff(self.arc)[k])

    def turned(self) -> Line:
        """The same line, run through from its other end."""
        return Line(self.vertices[::-1], self.length - self.arc[::-1])

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


def stitches(
    share: float, total: float, pitch: float | FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Stitch places in [0, share] (both ends and the middles between) and their lengths [m].

    Parameters
    ----------
    share : of the line's length ``total`` [m]
    pitch : distance of the stitches [m], or (k,) at even steps from 0 to ``share``
    """
    if isinstance(pitch, np.ndarray):
        way = share * total * np.linspace(0.0, 1.0, len(pitch))
        borders = mesh.even_places(way, pitch) / way[-1]
        count, middle = len(borders) - 1, (borders[1:] + borders[:-1]) / 2
        step = count * np.diff(borders)
    else:
        count = max(1, round(share * total / pitch))
        middle, step = (np.arange(count) + 0.5) / count, np.ones(count)
    at = share * np.concatenate([[0.0], middle, [1.0]])
    length = share * total / count * np.concatenate([[0.5 * step[0]], step, [0.5 * step[-1]]])
    return at, length * count / (count + 0.5 * (step[0] + step[-1]))


def join(parts: Sequence[Points]) -> Points:
    """Put points one after the other."""
    return Points(
        vertices=np.concatenate([p.vertices for p in parts]),
        weights=np.concatenate([p.weights for p in parts]),
    )


@dataclass(frozen=True, slots=True)
class Course:
    """The piece of a curve that a chain of lines takes, line by line.

    Parameters
    ----------
    curve : (k, 3) float64 [m]
    before : (n + 1,) float64 [m]   length of the chain where the part of each line begins that is
                                    pulled, and where the last one ends
    stops : (n + 1,) float64 [m]    places along the curve that these points go to; on a closed one
                                    they may go on past its end
    smooth : whether the stretch of the lines changes gradually from one to the next
    """

    curve: FloatArray
    before: FloatArray
    stops: FloatArray
    smooth: bool = False

    def targets(self, at: FloatArray) -> FloatArray:
        """Points (s, 3) [m] of the curve for lengths ``at`` (s,) along the chain."""
        return mesh.points_at(self.curve, self.places(at))

    def places(self, at: FloatArray) -> FloatArray:
        """Places (s,) [m] along the curve of points at lengths ``at`` (s,) along the chain."""
        place = np.interp(at, self.before, self.stops)
        if self.smooth:  # or the rings beside a junction would pull along the wire
            inside = np.clip(at, self.before[0], self.before[-1])
            place = PchipInterpolator(self.before, self.stops)(inside)
        return np.asarray(place)

    def turned(self) -> Course:
        """The same piece of the curve, run through from its other end."""
        return replace(self, stops=self.stops[0] + self.stops[-1] - self.stops)


def course(
    lines: Sequence[Line],
    curve: FloatArray,
    junctions: Sequence[float],
    part: tuple[float, float | None] = (0.0, None),
) -> Course:
    """Lay lines along a curve, at equal shares of the lengths, or from junction to junction.

    The first and the last junction are those of the part of the chain that is pulled.
    """
    before = _begins(lines)
    if junctions:
        start, end = part
        reached = before.copy()
        reached[[0, -1]] = start, before[-1] if end is None else end
        return Course(curve, reached, np.array(junctions))
    return Course(curve, before, before / before[-1] * mesh.arc_length(curve)[-1])


def anchor_on(lines: Sequence[Line], frame: Frame, curve: FloatArray, x: FloatArray) -> Anchor:
    """Send every vertex of the lines to its place on the curve, the shorter way round.

    One point per vertex: more could not all reach their targets.
    """
    way = course(lines, curve, frame.junctions)
    points = join([line.points(line.arc) for line in lines])
    at = np.concatenate([b + ln.arc for b, ln in zip(_begins(lines), lines, strict=False)])
    steps = [np.concatenate([[0.0], np.diff(line.arc), [0.0]]) / 2 for line in lines]
    start, target = points.at(x), way.targets(at)
    if not frame.junctions and _misses(way.turned().targets(at), start) < _misses(target, start):
        target = way.turned().targets(at)
    return Anchor(
        name=frame.name,
        kind="frame",
        points=points,
        target=target,
        length=np.concatenate([step[:-1] + step[1:] for step in steps]),
        stage=frame.stage,
        at=at,
    )


def rings_on(
    lines: Sequence[Line], hook: Hook, wire: FloatArray, crossed: FloatArray, x: FloatArray
) -> Anchor:
    """Pull a chain of lines to its wire: their vertices, or hog rings at the hook's pitch.

    A point at a length along the chain goes to its place on the wire, whatever part of the chain is
    pulled. Rings stand at both ends of that part, at the junctions, and at equal steps between
    them, as near to the pitch as that allows, but not closer than the lines' vertices. Each line
    runs the way in which its places start nearer to the wire, and so does the wire. Where they
    slide along it later, they do not pass places (c,) where it is ``crossed``.
    """
    way = course(lines, wire, hook.junctions, (hook.start, hook.end))
    way = replace(way, smooth=len(lines) > 1)
    ways = (way,) if hook.junctions and len(lines) > 1 else (way, way.turned())
    way, lines = min(
        (_run(lines, w, x) for w in ways), key=lambda run: _start_misses(run[0], run[1], x)
    )
    at, points = [], []
    for line, begin, part in _parts(lines, hook):
        at.append(begin + part)
        points.append(line.points(part))
    along = np.concatenate(at)
    step = np.concatenate([[0.0], np.diff(along), [0.0]]) / 2
    return Anchor(
        name=hook.name,
        kind="hook",
        points=join(points),
        target=way.targets(along),
        length=step[:-1] + step[1:],
        stage=hook.stage,
        at=along,
        limit=hook.limit,
        wire=_on_wire(way, along, crossed) if hook.slides else None,
    )


def crossings(wire: FloatArray, others: Sequence[FloatArray]) -> FloatArray:
    """Places [m] along a wire, rising, where another one meets or crosses it."""
    places = []
    for other in others:
        away, place = mesh.nearest_places(wire, mesh.resample(other, _AT_CROSSING))
        beside = np.concatenate([[np.inf], away, [np.inf]])
        least = (away <= _MEETS) & (away <= beside[:-2]) & (away < beside[2:])
        places += place[least].tolist()
    return np.sort(places)


def _on_wire(way: Course, at: FloatArray, crossed: FloatArray) -> Wire:
    """Where rings at lengths ``at`` are put on a wire, and the stops to either side of them."""
    low, high = (-np.inf, np.inf) if mesh.is_closed(way.curve) else (0.0, mesh.length(way.curve))
    turn = mesh.length(way.curve) if np.isinf(high) else 0.0
    place = np.clip(way.places(at), low, high)
    knots = np.unique([low, *crossed - turn, *crossed, *crossed + turn, high])
    k = np.searchsorted(knots[1:-1], place, side="right")
    stops = np.column_stack([knots[k], knots[k + 1]])
    for crossing in crossed:  # what sits on it belongs to neither side
        stops[np.abs(place - crossing) <= _AT_CROSSING] = np.clip(
            [crossing - _AT_CROSSING, crossing + _AT_CROSSING], low, high
        )
    return Wire(curve=way.curve, place=place, stops=stops)


def _parts(lines: Sequence[Line], hook: Hook) -> Iterator[tuple[Line, float, FloatArray]]:
    """Each line, where it begins, and its rings; the ring at a junction is the line's before."""
    before = _begins(lines)
    last = before[-1] if hook.end is None else min(hook.end, before[-1])
    first = hook.start
    for line, begin in zip(lines, before, strict=False):
        low, high = max(first - begin, 0.0), min(last - begin, line.length)
        if high < low or (begin > first and high <= low + _ON_LINE):
            continue
        if hook.pitch is None:
            at = line.arc[(line.arc >= low - _ON_LINE) & (line.arc <= high + _ON_LINE)]
            at = at if len(at) > 1 else np.array([low, high])
        else:
            pitch = max(hook.pitch, line.spacing)
            at = np.linspace(low, high, max(1, round((high - low) / pitch)) + 1)
        yield line, float(begin), at[1:] if begin > first else at


def _run(lines: Sequence[Line], way: Course, x: FloatArray) -> tuple[Course, list[Line]]:
    """The course, and the lines of a chain each turned to where it starts nearer to it."""
    if len(lines) == 1:  # it keeps its way; the wire is turned
        return way, list(lines)
    return way, [
        min((line, line.turned()), key=lambda one: _line_misses(one, begin, way, x))
        for line, begin in zip(lines, _begins(lines), strict=False)
    ]


def _begins(lines: Sequence[Line]) -> FloatArray:
    """Length of a chain [m] where each line begins, and in all."""
    return np.cumsum([0.0, *(line.length for line in lines)])


def _start_misses(way: Course, lines: Sequence[Line], x: FloatArray) -> float:
    return sum(
        _line_misses(line, begin, way, x)
        for line, begin in zip(lines, _begins(lines), strict=False)
    )


def _line_misses(line: Line, begin: float, way: Course, x: FloatArray) -> float:
    return _misses(way.targets(begin + line.arc), x[line.vertices])


def _misses(target: FloatArray, start: FloatArray) -> float:
    """Sum of the squared ways [m2] from where points start to their targets."""
    return float(((target - start) ** 2).sum())
