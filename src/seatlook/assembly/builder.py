"""Meshes of all panels, and the lines of mesh vertices that are sewn, hooked and framed."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np
import shapely

from seatlook import mesh
from seatlook.assembly.ease import seam_ease
from seatlook.assembly.lines import (
    Line,
    anchor_on,
    crossings,
    join,
    line_through,
    rings_on,
    stitches,
)
from seatlook.errors import InputError
from seatlook.mesh.polyline import Sizes, sizes_at
from seatlook.model import (
    Anchor,
    FloatArray,
    Frame,
    Hook,
    IntArray,
    Panel,
    Pattern,
    Scene,
    Seam,
    Stage,
    Stitching,
)

CORNER = np.radians(25.0)  # an outline that turns more than this keeps its vertex
_NARROWEST_HOLE = 1.0  # elements
_FEWEST_ROUND_A_HOLE = 6


@dataclass(frozen=True, slots=True)
class _Rim:
    """The boundary of one panel's mesh."""

    vertices: IntArray  # in outline order
    arc: FloatArray  # arc length of the drawn outline at each of them [m], one more at the end
    place: dict[int, int]  # outline vertex -> place in ``vertices``


@contextmanager
def _panel_named(name: str) -> Iterator[None]:
    """Name the panel in what keeps it from being meshed; places are those of the pattern."""
    try:
        yield
    except InputError as error:
        raise InputError(
            replace(problem, key=f"panel.{name}, {problem.key}") for problem in error.problems
        ) from None


class Builder:
    """Collects the panels' meshes and finds vertex lines in them."""

    def __init__(
        self,
        pattern: Pattern,
        element_size: float,
        own: Mapping[str, float | Sizes] = MappingProxyType({}),
    ) -> None:
        self.pattern = pattern
        self.size = {p.name: own.get(p.name, element_size) for p in pattern.panels}
        self._points: list[FloatArray] = []
        self._faces: list[IntArray] = []
        self._rims: dict[str, _Rim] = {}
        self._lines: dict[str, Line] = {}

    def add(self, panel: Panel, lines: dict[str, FloatArray], *, seed: int) -> None:
        """Mesh one panel; boundary vertices lie at equal arc lengths between kept corners."""
        stops, h = self._stops(panel), self.size[panel.name]
        n = len(panel.outline)
        sampled: list[FloatArray] = []
        steps: list[float] = []
        place: dict[int, int] = {}
        for start, end in zip(stops, [*stops[1:], stops[0] + n], strict=True):
            span = panel.outline[np.arange(start, end + 1) % n]
            place[start] = len(steps)
            sampled.append(mesh.resample(span, h)[:-1])
            # Of the drawn span, not of the chords: both sides of a seam keep their scale.
            steps += mesh.resampled_steps(span, h).tolist()
        inner = [mesh.resample(line, h) for line in lines.values()]
        holes = [
            _sampled_hole(hole, float(sizes_at(h, hole).min()), panel.name) for hole in panel.holes
        ]
        with _panel_named(panel.name):
            points, faces = mesh.triangulate(
                np.concatenate(sampled), h, lines=inner, holes=holes, seed=seed
            )
        offset = sum(map(len, self._points))
        self._points.append(points)
        self._faces.append(faces + offset)
        arc = np.concatenate([[0.0], np.cumsum(steps)])
        self._rims[panel.name] = _Rim(offset + np.arange(len(steps)), arc, place)
        for name, line in zip(lines, inner, strict=True):
            nearest = np.linalg.norm(points[:, None] - line, axis=2).argmin(axis=0)
            self._lines[name] = line_through(points, nearest, offset)

    def _stops(self, panel: Panel) -> list[int]:
        """Outline vertices that stay mesh vertices: ends of named edges and sharp corners."""
        edges = [e for e in self.pattern.edges.values() if e.panel == panel.name]
        ends = sorted({k for e in edges for k in (e.start, e.end)})
        outline = panel.outline
        ahead = np.roll(outline, -1, axis=0) - outline
        behind = outline - np.roll(outline, 1, axis=0)
        cross = behind[:, 0] * ahead[:, 1] - behind[:, 1] * ahead[:, 0]
        turn = np.abs(np.arctan2(cross, (behind * ahead).sum(axis=1)))
        stops, closest = list(ends), sizes_at(self.size[panel.name], outline) / 2
        for k in panel.corners:
            near = stops and np.linalg.norm(outline[stops] - outline[k], axis=1).min() < closest[k]
            if turn[k] > CORNER and not near:
                stops.append(int(k))
        return sorted(stops) or [int(np.argmax(turn))]

    def arrays(self) -> tuple[FloatArray, IntArray, IntArray]:
        """Return uv (n, 2), faces (m, 3) and the panel of each vertex (n,)."""
        owner = np.repeat(np.arange(len(self._points)), [len(p) for p in self._points])
        return np.concatenate(self._points), np.concatenate(self._faces), owner

    def edge(self, name: str) -> Line:
        """Vertices along a named edge, in outline order."""
        edge = self.pattern.edges[name]
        rim = self._rims[edge.panel]
        n, first = len(rim.vertices), rim.place[edge.start]
        at = first + np.arange(((rim.place[edge.end] - first) % n or n) + 1)
        arc = rim.arc[at % n] + np.where(at < n, 0.0, rim.arc[-1])
        return Line(rim.vertices[at % n], arc - arc[0])

    def chain(self, names: Sequence[str], *, reverse: bool = False) -> list[Line]:
        """Edges one after the other, each turned round if ``reverse``."""
        lines = [self.edge(name) for name in names]
        if not reverse:
            return lines
        return [line.turned() for line in lines]

    def stitching(self, seam: Seam, stage: Stage) -> Stitching:
        """Pair points of both sides at equal shares of the length between matching notches.

        There is at most one pair per segment of the coarser side: more would make the finer
        side follow its chords and lock the seam against bending.
        """
        near, far = self.chain([seam.a]), self.chain(seam.b, reverse=seam.reverse)
        knots_a, knots_b = seam_ease(self.pattern, seam).knots
        varies = any(not isinstance(size, float | int) for size in self.size.values())
        a, b = [], []
        weight, places = [], []
        total_a, total_b = near[0].length, sum(ln.length for ln in far)
        start = 0.0
        for side in far:
            share = side.length / total_b
            pitch: float | FloatArray = max(seam.pitch, side.spacing, near[0].spacing)
            if varies:
                part = np.linspace(0.0, 1.0, 4 * max(len(side.arc), len(near[0].arc)))
                beside = total_a * np.interp(start + share * part, knots_b, knots_a)
                steps = side.steps_at(part * side.length), near[0].steps_at(beside)
                pitch = np.maximum(seam.pitch, np.maximum(*steps))
            at, length = stitches(share, total_a, pitch)
            share_a = np.interp(start + at, knots_b, knots_a)
            a.append(near[0].points(total_a * share_a))
            b.append(side.points(at / share * side.length))
            weight.append(length)
            places.append(start + at)
            start += share
        at = np.concatenate(places)
        return Stitching(
            name=seam.name,
            a=join(a),
            b=join(b),
            length=np.concatenate(weight),
            stage=stage.name,
            notches=np.interp(knots_b[1:-1], at, np.arange(len(at), dtype=float)),
        )

    def hook(self, hook: Hook, scene: Scene, x: FloatArray) -> Anchor:
        """Pull the near sides of seams, or internal lines, to their wire."""
        near = {seam.name: seam.a for seam in self.pattern.seams}
        lines = [
            self.edge(near[name]) if name in near else self._lines[name] for name in hook.lines
        ]
        curve = scene.foam.curves[hook.wire]
        others = {other.wire for other in scene.hooks} - {hook.wire}
        crossed = crossings(curve, [scene.foam.curves[name] for name in others])
        return rings_on(lines, hook, curve, crossed, x)

    def frame(self, frame: Frame, scene: Scene, x: FloatArray) -> Anchor:
        """Pull free edges to a curve below the foam."""
        return anchor_on(self.chain(frame.edges), frame, scene.foam.curves[frame.curve], x)


def _sampled_hole(hole: FloatArray, size: float, panel: str) -> FloatArray:
    """Sample a cut-out at about the element size; its sharp corners stay.

    Raises
    ------
    InputError
        A cut-out so narrow that elements of this size cannot go round it.
    """
    wide = 2.0 * shapely.maximum_inscribed_circle(shapely.Polygon(hole)).length
    if wide < _NARROWEST_HOLE * size:
        x, y = 1e3 * hole.mean(axis=0)
        raise InputError.single(
            f"panel.{panel}",
            got=f"a cut-out {1e3 * wide:.3g} mm wide near ({x:.0f}, {y:.0f}) mm",
            expected=f"{1e3 * _NARROWEST_HOLE * size:.3g} mm or more, the size of an element",
            hint="element_size_mm of the panel, or smallest_notch_mm: narrower ones are closed",
        )
    ahead, behind = np.roll(hole, -1, axis=0) - hole, hole - np.roll(hole, 1, axis=0)
    cross = behind[:, 0] * ahead[:, 1] - behind[:, 1] * ahead[:, 0]
    stops = np.flatnonzero(np.abs(np.arctan2(cross, (behind * ahead).sum(axis=1))) > CORNER)
    stops = stops if len(stops) else np.zeros(1, dtype=np.int64)
    ring = np.roll(hole, -stops[0], axis=0)
    ends = np.append(stops - stops[0], len(ring))
    ring = np.vstack([ring, ring[:1]])
    sides = [ring[a : b + 1] for a, b in itertools.pairwise(ends)]
    step = min(size, sum(mesh.length(side) for side in sides) / _FEWEST_ROUND_A_HOLE)
    return np.concatenate([mesh.resample(side, step)[:-1] for side in sides])
