"""Pattern + foam + materials -> Cover: mesh the panels, pose them, say what pulls on what."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from seatlook import mesh
from seatlook.errors import AssemblyError, Problem
from seatlook.model import (
    Anchor,
    Cover,
    FloatArray,
    Frame,
    Hook,
    IntArray,
    Panel,
    Pattern,
    Points,
    Scene,
    Seam,
    Stage,
    Stitching,
)
from seatlook.zones import zones

CORNER = np.radians(25.0)  # an outline that turns more than this keeps its vertex


@dataclass(frozen=True, slots=True)
class _Line:
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
        return float(self.arc[-1])

    @property
    def spacing(self) -> float:
        return self.length / (len(self.vertices) - 1)


def assemble(scene: Scene, *, element_size: float | None = None, seed: int | None = None) -> Cover:
    """Mesh and place all panels of a scene and pair up what is sewn, hooked and framed.

    Parameters
    ----------
    scene : Scene
    element_size : float [m], optional      overrides the scene's
    seed : int, optional                    overrides the scene's; drives mesh and imperfection

    Returns
    -------
    Cover
        Panels in the pattern's order, ready for ``solve``.

    Raises
    ------
    AssemblyError
        A panel without material or pose, or parts that do not fit each other; all of them at once.
    InputError
        A panel that cannot be meshed at this element size.
    """
    h = scene.element_size if element_size is None else element_size
    seed = scene.seed if seed is None else seed
    _check_panels(scene)
    builder = _Builder(scene.pattern, h, scene.smallest_notch)
    for i, panel in enumerate(scene.pattern.panels):
        builder.add(panel, _hooked_lines(scene.hooks, panel), seed=1000 * seed + i)
    uv, faces, owner = builder.arrays()
    panel_of_face = owner[faces[:, 0]]
    flat = np.concatenate(
        [_posed(uv[owner == i], scene, panel.name) for i, panel in enumerate(scene.pattern.panels)]
    )
    rest = np.concatenate(
        [_along_grain(uv[owner == i], panel) for i, panel in enumerate(scene.pattern.panels)]
    )
    materials = tuple(scene.materials[p.name] for p in scene.pattern.panels)
    thickness = np.array([m.fabric.thickness for m in materials])[owner]
    normal = np.stack([scene.placement[p.name].rotation[:, 2] for p in scene.pattern.panels])[owner]
    bump = thickness[:, None] * 0.3 * _noise(uv, 2 * h, seed)[:, None] * normal
    zone, zone_names = zones(
        uv[faces].mean(axis=1), panel_of_face, scene.pattern, boxes=scene.boxes
    )
    return Cover(
        rest=rest,
        uv=uv,
        positions=flat + bump,
        faces=faces,
        panel=panel_of_face,
        panel_names=tuple(p.name for p in scene.pattern.panels),
        materials=materials,
        zone=zone,
        zone_names=zone_names,
        stitchings=tuple(builder.stitching(s, scene.stages[0]) for s in scene.pattern.seams),
        anchors=(
            *(builder.hook(hook, scene, flat) for hook in scene.hooks),
            *(builder.frame(frame, scene, flat) for frame in scene.frames),
        ),
        stages=scene.stages,
        foam=scene.foam,
        element_size=float(mesh.edge_lengths(uv, faces).mean()),
        seed=seed,
        scene_digest=scene.digest,
    )


def _check_panels(scene: Scene) -> None:
    """Refuse panels without material or pose, all named at once."""
    problems = [
        Problem(key=f"{key}.{panel.name}", got="nothing", expected=expected, file=scene.path)
        for panel in scene.pattern.panels
        for key, table, expected in (
            ("panel", scene.materials, "a material"),
            ("placement", scene.placement, "a pose (rotation, translation_mm)"),
        )
        if panel.name not in table
    ]
    if problems:
        raise AssemblyError(problems)


def _posed(uv: FloatArray, scene: Scene, panel: str) -> FloatArray:
    """Positions (n, 3) [m] of a panel's vertices before sewing."""
    pose = scene.placement[panel]
    return np.asarray(uv @ pose.rotation[:, :2].T + pose.translation)


def _along_grain(uv: FloatArray, panel: Panel) -> FloatArray:
    """Turn pattern coordinates so that the first axis runs along the warp."""
    warp = panel.grain / np.hypot(*panel.grain)
    return np.asarray(uv @ np.array([[warp[0], -warp[1]], [warp[1], warp[0]]]))


def _noise(uv: FloatArray, shortest: float, seed: int) -> FloatArray:
    """Random smooth field (n,) of rms 1, wavelengths from ``shortest`` [m] to four times that."""
    rng = np.random.default_rng(seed)
    wavelength = shortest * 4.0 ** rng.random(64)
    angle, phase = 2 * np.pi * rng.random((2, 64))
    k = 2 * np.pi / wavelength * np.stack([np.cos(angle), np.sin(angle)])
    return np.asarray(np.cos(uv @ k + phase).sum(axis=1) / np.sqrt(32.0))


def _hooked_lines(hooks: Sequence[Hook], panel: Panel) -> dict[str, FloatArray]:
    """Internal lines of a panel that a hook pulls on; only these must be mesh edges."""
    names = {f"{panel.name}/{line}": line for line in panel.internal_lines}
    return {h.line: panel.internal_lines[names[h.line]] for h in hooks if h.line in names}


class _Builder:
    """Collects the panels' meshes and finds vertex lines in them."""

    def __init__(self, pattern: Pattern, element_size: float, smallest_notch: float) -> None:
        self.pattern = pattern
        self.h = element_size
        self.smallest_notch = smallest_notch
        self._points: list[FloatArray] = []
        self._faces: list[IntArray] = []
        self._boundary: dict[str, dict[int, int]] = {}  # panel -> outline vertex -> mesh vertex
        self._loop: dict[str, IntArray] = {}
        self._lines: dict[str, _Line] = {}

    def add(self, panel: Panel, lines: dict[str, FloatArray], *, seed: int) -> None:
        """Mesh one panel; boundary vertices lie at equal arc lengths between kept corners."""
        stops = self._stops(panel)
        n = len(panel.outline)
        sampled, kept = [], {}
        count = 0
        for start, end in zip(stops, [*stops[1:], stops[0] + n], strict=True):
            span = panel.outline[np.arange(start, end + 1) % n]
            points = mesh.resample(span, self.h)
            kept[start] = count
            sampled.append(points[:-1])
            count += len(points) - 1
        inner = [mesh.resample(line, self.h) for line in lines.values()]
        points, faces = mesh.triangulate(np.concatenate(sampled), self.h, lines=inner, seed=seed)
        offset = sum(map(len, self._points))
        self._points.append(points)
        self._faces.append(faces + offset)
        self._boundary[panel.name] = {k: v + offset for k, v in kept.items()}
        self._loop[panel.name] = offset + np.arange(count)
        for name, line in zip(lines, inner, strict=True):
            nearest = np.linalg.norm(points[:, None] - line, axis=2).argmin(axis=0)
            self._lines[name] = _line(points, nearest, offset)

    def _stops(self, panel: Panel) -> list[int]:
        """Outline vertices that stay mesh vertices: ends of named edges and sharp corners."""
        mine = [e for e in self.pattern.edges.values() if e.panel == panel.name]
        ends = sorted({k for e in mine for k in (e.start, e.end)})
        outline = panel.outline
        ahead = np.roll(outline, -1, axis=0) - outline
        behind = outline - np.roll(outline, 1, axis=0)
        cross = behind[:, 0] * ahead[:, 1] - behind[:, 1] * ahead[:, 0]
        turn = np.abs(np.arctan2(cross, (behind * ahead).sum(axis=1)))
        stops = list(ends)
        for k in panel.corners:
            near = stops and np.linalg.norm(outline[stops] - outline[k], axis=1).min() < self.h / 2
            if turn[k] > CORNER and not near:
                stops.append(int(k))
        return sorted(stops) or [int(np.argmax(turn))]

    def arrays(self) -> tuple[FloatArray, IntArray, IntArray]:
        """Return uv (n, 2), faces (m, 3) and the panel of each vertex (n,)."""
        owner = np.repeat(np.arange(len(self._points)), [len(p) for p in self._points])
        return np.concatenate(self._points), np.concatenate(self._faces), owner

    def edge(self, name: str) -> _Line:
        """Vertices along a named edge, in outline order."""
        edge = self.pattern.edges[name]
        loop, kept = self._loop[edge.panel], self._boundary[edge.panel]
        first, last = kept[edge.start] - loop[0], kept[edge.end] - loop[0]
        count = (last - first) % len(loop) or len(loop)
        vertices = loop[(first + np.arange(count + 1)) % len(loop)]
        # Arc length of the drawn edge, not of its chords: both sides of a seam keep their scale.
        return _Line(vertices, np.linspace(0.0, self.pattern.edge_length(name), count + 1))

    def chain(self, names: Sequence[str], *, reverse: bool = False) -> list[_Line]:
        """Edges one after the other, each turned round if ``reverse``."""
        lines = [self.edge(name) for name in names]
        if not reverse:
            return lines
        return [_Line(ln.vertices[::-1], ln.length - ln.arc[::-1]) for ln in lines]

    def stitching(self, seam: Seam, stage: Stage) -> Stitching:
        """Pair points of both sides at equal shares of the seam's length.

        There is at most one pair per segment of the coarser side: more would make the finer
        side follow its chords and lock the seam against bending.
        """
        near, far = self.chain([seam.a]), self.chain(seam.b, reverse=seam.reverse)
        a, b = [], []
        weight = []
        total_a, total_b = near[0].length, sum(ln.length for ln in far)
        done = 0.0
        for side in far:
            share = side.length / total_b
            span = share * total_a
            pitch = max(seam.pitch, side.spacing, near[0].spacing * span / max(span, 1e-12))
            at, length = _stitches(share, total_a, pitch)
            a.append(near[0].points(total_a * np.clip(done + at, 0.0, 1.0)))
            b.append(side.points(at / share * side.length))
            weight.append(length)
            done += share
        return Stitching(
            name=seam.name, a=_join(a), b=_join(b), length=np.concatenate(weight), stage=stage.name
        )

    def hook(self, hook: Hook, scene: Scene, x: FloatArray) -> Anchor:
        """Pull the near side of a seam, or an internal line, to its wire."""
        seams = {s.name: s for s in self.pattern.seams}
        line = self.edge(seams[hook.line].a) if hook.line in seams else self._lines[hook.line]
        wire = scene.foam.curves[hook.wire]
        return _anchor(hook.name, "hook", [line], _curve(wire), x, hook.stage, self.h)

    def frame(self, frame: Frame, scene: Scene, x: FloatArray) -> Anchor:
        """Pull free edges to a curve below the foam."""
        curve = _curve(scene.foam.curves[frame.curve])
        return _anchor(frame.name, "frame", self.chain(frame.edges), curve, x, frame.stage, self.h)


def _line(points: FloatArray, vertices: IntArray, offset: int) -> _Line:
    steps = np.linalg.norm(np.diff(points[vertices], axis=0), axis=1)
    return _Line(vertices + offset, np.concatenate([[0.0], np.cumsum(steps)]))


def _stitches(share: float, total: float, pitch: float) -> tuple[FloatArray, FloatArray]:
    """Stitch places in [0, share] (both ends and the middles between) and their lengths [m]."""
    count = max(1, round(share * total / pitch))
    middle = (np.arange(count) + 0.5) / count
    at = share * np.concatenate([[0.0], middle, [1.0]])
    length = share * total / count * np.concatenate([[0.5], np.ones(count), [0.5]])
    return at, length * count / (count + 1)


def _join(parts: Sequence[Points]) -> Points:
    return Points(
        vertices=np.concatenate([p.vertices for p in parts]),
        weights=np.concatenate([p.weights for p in parts]),
    )


def _curve(points: FloatArray) -> Callable[[FloatArray], FloatArray]:
    """Return the curve as a function of the share of its length in [0, 1]."""
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    arc = np.concatenate([[0.0], np.cumsum(steps)]) / steps.sum()
    return lambda s: np.column_stack([np.interp(s, arc, points[:, k]) for k in range(3)])


def _anchor(
    name: str,
    kind: str,
    lines: Sequence[_Line],
    curve: Callable[[FloatArray], FloatArray],
    x: FloatArray,
    stage: str,
    h: float,
) -> Anchor:
    """Spread points over the lines and send each to its share of the curve, shorter way round."""
    total = sum(ln.length for ln in lines)
    parts, shares, lengths = [], [], []
    done = 0.0
    for line in lines:
        at, length = _stitches(line.length / total, total, max(h, line.spacing))
        parts.append(line.points(at * total))
        shares.append(done + at)
        lengths.append(length)
        done += line.length / total
    points, share = _join(parts), np.concatenate(shares)
    start = points.at(x)
    target, turned = curve(share), curve(1.0 - share)
    if np.linalg.norm(turned - start) < np.linalg.norm(target - start):
        target = turned
    return Anchor(
        name=name,
        kind="hook" if kind == "hook" else "frame",
        points=points,
        target=target,
        length=np.concatenate(lengths),
        stage=stage,
    )
