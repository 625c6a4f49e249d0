"""Ties that send one point to two places, and hooks far from their wires."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from seatlook.assembly.contradictions.contradiction import (
    Contradiction,
    Lines,
    gap_between,
    place_text,
)
from seatlook.mesh import length
from seatlook.model import Anchor, Cover, FloatArray, Hook, IntArray, Pattern, Points, Scene

FARTHEST_WIRE = 0.100  # m, mean way of a hooked line to its wire
NEAR_WIRE = 0.050  # m; from here on a wire at less than half of the way is the one that was meant;
# ways are 33 to 53 mm on the family, and the nearest place of any wire is within 3 mm of that
TIES_APART = 0.001  # m: ties of one point are then both off by what the verdict refuses
_ON_LINE = 1e-6  # m; a point that near a junction belongs to the line before


def ties_apart(lines: Lines, cover: Cover) -> Iterator[Contradiction]:
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
                f"{two.name!r}, which pulls a point to {place_text(there)} that {one.kind} "
                f"{one.name!r} pulls to {place_text(here)}, {1e3 * apart:.1f} mm away",
                f"one place for a shared point, to {1e3 * TIES_APART:g} mm",
            )


def far_hooks(lines: Lines, scene: Scene, cover: Cover) -> Iterator[Contradiction]:
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
            way = gap_between(start, target)
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
                f"{place_text(start[middle])} goes to {place_text(target[middle])}{hint}",
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


def _way(start: FloatArray, target: FloatArray) -> float:
    """Mean way of points to the nearest of the targets."""
    return float(np.linalg.norm(start[:, None] - target, axis=2).min(axis=1).mean())
