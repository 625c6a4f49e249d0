"""Contradictions of a scene that show before it is solved: places that cannot be reached together.

Each has a name, by which ``[check] allow`` of the scene lets it pass.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import combinations
from typing import Any

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from seatlook.assembly.sewn_surface import (
    WIDEST_POINT,
    SewnSurface,
    alike,
    exchanged,
    sewn_surface,
)
from seatlook.errors import InputError, Problem
from seatlook.io.toml import Document, Key, read_document, spelled
from seatlook.mesh import face_areas, length
from seatlook.model import (
    Anchor,
    Cover,
    FloatArray,
    Hook,
    IntArray,
    Pattern,
    Points,
    Scene,
    Stitching,
)
from seatlook.solver.foam.distance import DistanceField, distance_field

FARTHEST_WIRE = 0.100  # m, mean way of a hooked line to its wire
NEAR_WIRE = 0.050  # m; from here on a wire at less than half of the way is the one that was meant;
# ways are 33 to 53 mm on the family, and the nearest place of any wire is within 3 mm of that
TIES_APART = 0.001  # m: ties of one point are then both off by what the verdict refuses
DEEPEST_CURVE = 0.010  # m: a cover that is held deeper counts as buried
DEEPEST_START, INSIDE = 0.020, 0.2  # m; share of a panel that may start deeper
LARGEST, SMALLEST = 4.0, 0.01  # area of the panels over that of the foam; .55 on the demo
TWISTED = 0.95  # gap of a seam with one side turned round, over its gap; 1.15 and more on the demo
EXCHANGED = 0.5  # gap of two seams with exchanged partners, over their gap
FALLEN_APART = 0.8  # the same, where the cover is in fewer pieces with exchanged partners
_APART = 0.050  # m, mean gap from which partners can be exchanged
_ON_LINE = 1e-6  # m; a point that near a junction belongs to the line before
_SHARES = np.linspace(0.0, 1.0, 11)  # of a seam's length, where gaps are measured


@dataclass(frozen=True, slots=True, kw_only=True)
class Contradiction:
    """What cannot be: its name out of ``ALLOWED``, what is said of it, and where it is.

    Parameters
    ----------
    places : (k, 3) float64 [m]   on the cover as it starts, the foam or a curve; may be none
    """

    name: str
    problem: Problem
    places: FloatArray


def contradictions(scene: Scene, cover: Cover) -> tuple[Contradiction, ...]:
    """Find what a solve could not mend and the scene does not allow.

    These are ties that send one point to two places, a hook far from its wire, a curve through the
    foam, panels that start inside the foam, seams twisted or exchanged.
    """
    lines = _Lines(scene)
    found = list(_seams(lines, scene, cover))
    found += _shared_points(lines, cover)
    if cover.foam is not None:
        field = distance_field(cover.foam.vertices, cover.foam.faces)
        found += _starts(lines, cover, field)
        found += _curves(lines, scene, cover, field)
        found += _hooks(lines, scene, cover)
    return tuple(one for one in found if one.name not in scene.allowed)


def out_of_scale(scene: Scene) -> tuple[Contradiction, ...]:
    """Find a pattern that is far too large or small for the foam, if the scene does not allow it.

    It is looked at before the cover is meshed, which would take too long.
    """
    lines, foam = _Lines(scene), face_areas(scene.foam.vertices, scene.foam.faces).sum()
    area = sum(panel.area for panel in scene.pattern.panels)
    ratio = float(area / foam)
    if "scale" in scene.allowed or SMALLEST <= ratio <= LARGEST:
        return ()
    return (
        lines.problem(
            "scale",
            ("pattern", "file"),
            [],
            f"panels of {1e4 * area:.4g} cm2, {ratio:.3g} times the foam's area",
            f"{SMALLEST:g} to {LARGEST:g} times: is one of them in another unit?",
        ),
    )


def refuse(found: Iterable[Contradiction]) -> None:
    """Refuse contradictions, all of them at once.

    Raises
    ------
    InputError
        There is one; each with file, line and both places.
    """
    problems = [one.problem for one in found]
    if problems:
        raise InputError(problems)


class _Lines:
    """The lines of the scene's files; a scene that was made in memory has none."""

    def __init__(self, scene: Scene) -> None:
        self._scene = self._seams = None
        if scene.path is not None and scene.path.exists():
            self._scene = read_document(scene.path)
            seams = scene.path.parent / str(self._scene.data["pattern"]["seams"])
            self._seams = read_document(seams) if seams.exists() else None

    def tie(self, anchor: Anchor) -> Key:
        """Key of the hook or frame that an anchor comes from."""
        rows: list[dict[str, Any]] = []
        if self._scene is not None:
            rows = self._scene.data.get(anchor.kind, [])
        names = [row.get("name") for row in rows]
        number: str | int = names.index(anchor.name) if anchor.name in names else anchor.name
        return (anchor.kind, number)

    def problem(
        self, name: str, key: Key, places: list[FloatArray], got: str, expected: str
    ) -> Contradiction:
        """A contradiction in the scene file."""
        return _contradiction(self._scene, name, key, places, got, expected)

    def seam(
        self, name: str, number: int, places: list[FloatArray], got: str, expected: str
    ) -> Contradiction:
        """A contradiction of a seam in the seams file."""
        return _contradiction(self._seams, name, ("seam", number), places, got, expected)


def _contradiction(
    document: Document | None,
    name: str,
    key: Key,
    places: list[FloatArray],
    got: str,
    expected: str,
) -> Contradiction:
    problem = Problem(
        key=spelled(key),
        got=got,
        expected=expected,
        file=None if document is None else document.file,
        line=None if document is None else document.line(key),
        hint=f'if it is meant: [check] allow = ["{name}"] in the scene',
    )
    return Contradiction(
        name=name, problem=problem, places=np.array(places, dtype=np.float64).reshape(-1, 3)
    )


def _seams(lines: _Lines, scene: Scene, cover: Cover) -> Iterator[Contradiction]:
    """Seams that turn a panel inside out or whose ties cross, and pairs that want to change."""
    sides = [(_at_shares(s, s.a, cover), _at_shares(s, s.b, cover)) for s in cover.stitchings]
    gaps = [_gap(a, b) for a, b in sides]
    seams = scene.pattern.seams
    for number, (seam, (a, b), gap) in enumerate(zip(seams, sides, gaps, strict=True)):
        turned = _gap(a, b[::-1])
        crossed = turned < TWISTED * gap
        if crossed or not seam.reverse:
            way = "whose ties cross" if crossed else "which turns a panel inside out"
            yield lines.seam(
                "twisted seam",
                number,
                [a[0], b[0]],
                f"{seam.name!r}, {way}: {1e3 * gap:.0f} mm from side to side, and "
                f"{1e3 * turned:.0f} mm with one side turned round ({_place(a[0])} is sewn to "
                f"{_place(b[0])})",
                "sides that run the same way: exchange from and to, or reverse",
            )
    certain, likely = (
        {(seams.index(one), seams.index(two)) for one, two in pairs}
        for pairs in exchanged(scene.pattern)
    )
    for i, j in combinations(range(len(sides)), 2):
        other = _nearer(sides[i][0], sides[j][1]) + _nearer(sides[j][0], sides[i][1])
        gap = gaps[i] + gaps[j]
        nearer = other < EXCHANGED * gap or ((i, j) in likely and other < FALLEN_APART * gap)
        far = gap > 2 * _APART and nearer and alike(scene.pattern, seams[i], seams[j])
        if far or (i, j) in certain:
            why = "; sewn so, the panels make no cover" if (i, j) in certain else ""
            yield lines.seam(
                "exchanged seams",
                i,
                [sides[i][0][5], sides[j][0][5]],
                f"{seams[i].name!r} and {seams[j].name!r}, {1e3 * gaps[i]:.0f} and "
                f"{1e3 * gaps[j]:.0f} mm from side to side at {_place(sides[i][0][5])} and "
                f"{_place(sides[j][0][5])}; with each other's partners {1e3 * other / 2:.0f} mm"
                f"{why}",
                "each edge sewn to the partner beside it",
            )
    if not certain and not (surface := sewn_surface(scene.pattern, seams)).closed:
        yield _no_cover(lines, surface)


def _no_cover(lines: _Lines, surface: SewnSurface) -> Contradiction:
    """Seams that no exchange of two partners makes a cover of."""
    places, angle = max(surface.points, key=lambda point: point[1])
    what = f"panels that make a surface with {surface.handles} handles"
    if not surface.handles:
        names = ", ".join(sorted({panel for panel, _ in places}))
        what = f"{np.degrees(angle):.0f} degrees at the point where {names} meet"
    return lines.seam(
        "exchanged seams",
        0,
        [],
        what,
        f"none, and at most {np.degrees(WIDEST_POINT):.0f} degrees: each edge sewn to its partner",
    )


def _shared_points(lines: _Lines, cover: Cover) -> Iterator[Contradiction]:
    """Points of the cover, sewn or the same, that two ties send to different places."""
    point = _joined(cover)
    ties: dict[int, list[tuple[Anchor, FloatArray]]] = {}
    for anchor in cover.anchors:
        rows, vertices = _on_vertices(anchor.points)
        for row, vertex in zip(rows, vertices, strict=True):
            ties.setdefault(int(point[vertex]), []).append((anchor, anchor.target[row]))
    seen = set()
    for pulled in ties.values():
        for (one, here), (two, there) in combinations(pulled, 2):
            apart = float(np.linalg.norm(here - there))
            if apart <= TIES_APART or (one.name, two.name) in seen:
                continue
            seen.add((one.name, two.name))
            yield lines.problem(
                "ties apart",
                lines.tie(two),
                [here, there],
                f"{two.name!r}, which pulls a point to {_place(there)} that {one.kind} "
                f"{one.name!r} pulls to {_place(here)}, {1e3 * apart:.1f} mm away",
                f"one place for a shared point, to {1e3 * TIES_APART:g} mm",
            )


def _starts(lines: _Lines, cover: Cover, field: DistanceField) -> Iterator[Contradiction]:
    """Panels that start inside the foam."""
    depth = -field.at(cover.positions)[0][cover.faces].mean(axis=1)
    for number, name in enumerate(cover.panel_names):
        own = cover.panel == number
        area = cover.rest_area[own]
        share = float(area[depth[own] > DEEPEST_START].sum() / area.sum())
        if share > INSIDE:
            place = cover.positions[cover.faces[own][np.argmax(depth[own])]].mean(axis=0)
            yield lines.problem(
                "start inside",
                ("placement", name),
                [place],
                f"{100 * share:.0f} % of the panel more than {1e3 * DEEPEST_START:g} mm inside the "
                f"foam, {1e3 * depth[own].max():.0f} mm at {_place(place)}",
                f"at most {100 * INSIDE:g} %",
            )


def _curves(
    lines: _Lines, scene: Scene, cover: Cover, field: DistanceField
) -> Iterator[Contradiction]:
    """Frame curves that run through the foam; wires are looked at when the scene is read."""
    curve = {frame.name: frame.curve for frame in scene.frames}
    for anchor in cover.anchors:
        depth = -field.at(anchor.target)[0]
        if anchor.kind == "frame" and depth.max() > DEEPEST_CURVE:
            yield lines.problem(
                "curve inside",
                (*lines.tie(anchor), "curve"),
                [anchor.target[np.argmax(depth)]],
                f"{curve[anchor.name]!r}, {1e3 * depth.max():.0f} mm inside the foam at "
                f"{_place(anchor.target[np.argmax(depth)])}",
                f"a curve outside, or at most {1e3 * DEEPEST_CURVE:g} mm inside",
            )


def _hooks(lines: _Lines, scene: Scene, cover: Cover) -> Iterator[Contradiction]:
    """Hooked lines, each of a chain, that start far from their wire or nearer to another place."""
    hooks = {hook.name: hook for hook in scene.hooks}
    anchors = [anchor for anchor in cover.anchors if anchor.kind == "hook"]
    wires: dict[str, list[FloatArray]] = {}
    for anchor in anchors:
        wires.setdefault(hooks[anchor.name].wire, []).append(anchor.target)
    for anchor in anchors:
        hook = hooks[anchor.name]
        for name, rows in _rows_of_lines(hook, anchor, scene.pattern):
            start, target = anchor.points.at(cover.positions)[rows], anchor.target[rows]
            way = _gap(start, target)
            ways = {wire: _way(start, np.concatenate(places)) for wire, places in wires.items()}
            nearest = min(ways, key=lambda wire: ways[wire])
            nearer = way > NEAR_WIRE and ways[nearest] < 0.5 * way
            if not (way > FARTHEST_WIRE or nearer):
                continue
            other = "another place of it" if nearest == hook.wire else repr(nearest)
            hint = f"; {other} is {1e3 * ways[nearest]:.0f} mm away" if nearer else ""
            middle = len(start) // 2
            yield lines.problem(
                "hook far",
                (*lines.tie(anchor), "wire"),
                [start[middle], target[middle]],
                f"{hook.wire!r}, {1e3 * way:.0f} mm from line {name!r}: "
                f"{_place(start[middle])} goes to {_place(target[middle])}{hint}",
                f"a wire at most {1e3 * FARTHEST_WIRE:g} mm away, and none much nearer",
            )


def _rows_of_lines(hook: Hook, anchor: Anchor, pattern: Pattern) -> Iterator[tuple[str, IntArray]]:
    """The points of an anchor that lie on each line of its hook."""
    if len(hook.lines) == 1 or anchor.at is None:
        yield hook.lines[0], np.arange(len(anchor.points))
        return
    line = np.searchsorted(
        np.cumsum([_line_length(name, pattern) for name in hook.lines])[:-1], anchor.at - _ON_LINE
    )
    for number, name in enumerate(hook.lines):
        rows = np.flatnonzero(line == number)
        if len(rows):
            yield name, rows


def _line_length(name: str, pattern: Pattern) -> float:
    """Length [m] of a seam's near side, or of an internal line called PANEL/LINE."""
    near = {seam.name: seam.a for seam in pattern.seams}
    if name in near:
        return pattern.edge_length(near[name])
    panel, _, line = name.partition("/")
    return length(pattern.panel(panel).internal_lines[line])


def _joined(cover: Cover) -> IntArray:
    """Number of the point (n,) that each vertex is one with, by seams that tie vertex to vertex."""
    pairs = [np.zeros((0, 2), dtype=np.int64)]
    for seam in cover.stitchings:
        rows_a, a = _on_vertices(seam.a)
        rows_b, b = _on_vertices(seam.b)
        _, i, j = np.intersect1d(rows_a, rows_b, return_indices=True)
        pairs.append(np.column_stack([a[i], b[j]]))
    first, second = np.concatenate(pairs).T
    n = len(cover.rest)
    graph = coo_array((np.ones(len(first)), (first, second)), shape=(n, n))
    return np.asarray(connected_components(graph, directed=False)[1])


def _on_vertices(points: Points) -> tuple[IntArray, IntArray]:
    """Rows of the points that are vertices, and these vertices."""
    corner = points.weights.argmax(axis=1)
    rows = np.flatnonzero(points.weights.max(axis=1) > 1.0 - 1e-9)
    return rows, points.vertices[rows, corner[rows]]


def _at_shares(seam: Stitching, side: Points, cover: Cover) -> FloatArray:
    """Places (11, 3) at equal shares of a seam's side, as it starts."""
    places = side.at(cover.positions)
    share = np.cumsum(seam.length) - 0.5 * seam.length
    share = (share - share[0]) / (share[-1] - share[0])
    return np.column_stack([np.interp(_SHARES, share, column) for column in places.T])


def _gap(a: FloatArray, b: FloatArray) -> float:
    return float(np.linalg.norm(a - b, axis=1).mean())


def _nearer(a: FloatArray, b: FloatArray) -> float:
    """Gap of two lines, run through the better way round."""
    return min(_gap(a, b), _gap(a, b[::-1]))


def _way(start: FloatArray, target: FloatArray) -> float:
    """Mean way of points to the nearest of the targets."""
    return float(np.linalg.norm(start[:, None] - target, axis=2).min(axis=1).mean())


def _place(point: FloatArray) -> str:
    """A place in the units of the scene file."""
    return f"({', '.join(f'{1e3 * value:.0f}' for value in point)}) mm"
