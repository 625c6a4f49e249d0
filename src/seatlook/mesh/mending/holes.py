"""Holes of a surface filled: flat across wide openings, smoothly where a scan lacks a patch."""

from __future__ import annotations

import heapq
from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.linalg import spsolve

from seatlook.errors import InputError
from seatlook.mesh.mending.skin import SLIVER_M, Skin
from seatlook.mesh.polyline import length
from seatlook.mesh.surface import FloatArray, IntArray, boundary_loops, edges

_LARGEST_LOOP = 250  # corners triangulated as a whole; of longer ones, ears are cut first
_SMOOTH = 0.25  # of the largest extent; less wide holes go on smoothly, wider are closed flat
_FLAT = 1e3  # m2, cost of a triangle that is a line; more than any opening has
_FINE = 1.5  # largest side of a new face over the mean side of its hole's rim


class Hole(NamedTuple):
    """An open border.

    Parameters
    ----------
    loop : (k,) int64   its vertices, in order
    length : [m]        all round
    """

    loop: IntArray
    length: float


def find_holes(vertices: FloatArray, faces: IntArray) -> list[Hole]:
    """Return the open borders, the longest first."""
    try:
        loops = boundary_loops(faces)
    except KeyError as error:  # a border that comes to a vertex and does not leave it
        raise InputError.single(
            "surface",
            got="borders that are no closed lines",
            expected="a surface that can be mended",
        ) from error
    holes = [Hole(loop, length(vertices[np.append(loop, loop[0])])) for loop in loops]
    return sorted(holes, key=lambda hole: -hole.length)


def fill(skin: Skin, holes: list[Hole]) -> None:
    """Fill holes: small ones go on as the surface around them, wide ones are closed flat."""
    extent = float(np.ptp(skin.vertices, axis=0).max())
    width = [float(np.ptp(skin.vertices[hole.loop], axis=0).max()) for hole in holes]
    small = [hole for hole, w in zip(holes, width, strict=True) if w < _SMOOTH * extent]
    wide = [hole for hole, w in zip(holes, width, strict=True) if w >= _SMOOTH * extent]
    for hole in wide:
        skin.add(np.zeros((0, 3)), _patch(skin.vertices, hole.loop))
    for hole in small:
        _fill_smoothly(skin, hole)
    for some, how in ((small, "holes filled smoothly"), (wide, "openings closed flat")):
        if some:
            longest = max(hole.length for hole in some)
            place = skin.vertices[some[0].loop].mean(axis=0)
            what = f"{how}, the largest {1e3 * longest:.0f} mm round"
            skin.note(what, len(some), place, asked=True)


def _patch(vertices: FloatArray, loop: IntArray) -> IntArray:
    """Triangles (k - 2, 3) over a loop whose surface lies on its left."""
    # A border has its surface on the left: the patch runs the other way round.
    around = loop[::-1]
    ears, rest = _cut_ears(vertices[around])
    return np.asarray(around[np.concatenate([ears, rest[_least_area(vertices[around[rest]])]])])


def _cut_ears(points: FloatArray) -> tuple[IntArray, IntArray]:
    """Cut the shortest ears of a long loop; return them and the corners that are left."""
    n = len(points)
    before, after = [n - 1, *range(n - 1)], [*range(1, n), 0]
    normal = np.cross(points, np.roll(points, -1, axis=0)).sum(axis=0)
    queue = [(_ear(points, before[i], i, after[i], normal), i) for i in range(n)]
    heapq.heapify(queue)
    ears: list[tuple[int, int, int]] = []
    gone = np.zeros(n, dtype=bool)
    while n - len(ears) > _LARGEST_LOOP:
        cost, i = heapq.heappop(queue)
        a, c = before[i], after[i]
        if gone[i] or cost != _ear(points, a, i, c, normal):
            continue  # of before a neighbour went
        ears.append((a, i, c))
        gone[i] = True
        after[a], before[c] = c, a
        for j in (a, c):
            heapq.heappush(queue, (_ear(points, before[j], j, after[j], normal), j))
    return np.array(ears, dtype=np.int64).reshape(-1, 3), np.flatnonzero(~gone)


def _ear(points: FloatArray, a: int, b: int, c: int, normal: FloatArray) -> float:
    """Length of the cut; corners that point into the opening come last."""
    cut = float(np.linalg.norm(points[c] - points[a]))
    convex = np.cross(points[b] - points[a], points[c] - points[b]) @ normal > 0
    return cut if convex else 1e3 + cut


def _least_area(points: FloatArray) -> IntArray:
    """Triangles (k - 2, 3) of least area over a closed loop (Barequet and Sharir 1995)."""
    k = len(points)
    area, best = np.zeros((k, k)), np.zeros((k, k), dtype=np.int64)
    for gap in range(2, k):
        rows = np.arange(k - gap)
        first, last = rows[:, None], rows[:, None] + gap
        middle = first + np.arange(1, gap)
        p = points[first]
        size = np.linalg.norm(np.cross(points[middle] - p, points[last] - p), axis=2)
        total = area[first, middle] + area[middle, last] + size
        total[size <= SLIVER_M * np.linalg.norm(points[last] - p, axis=2)] += _FLAT
        least = total.argmin(axis=1)
        area[rows, rows + gap], best[rows, rows + gap] = total[rows, least], rows + 1 + least
    faces, spans = [], [(0, k - 1)]
    while spans:
        i, j = spans.pop()
        if j - i > 1:
            m = int(best[i, j])
            faces.append((i, m, j))
            spans += [(i, m), (m, j)]
    return np.array(faces, dtype=np.int64).reshape(-1, 3)


def _fill_smoothly(skin: Skin, hole: Hole) -> None:
    """Fill a hole with faces as large as those around it, bent as the surface around it."""
    first = len(skin.vertices)
    size = _FINE * hole.length / len(hole.loop)
    points, patch = _refined(skin.vertices, _patch(skin.vertices, hole.loop), size)
    skin.add(points[first:], patch)
    if len(points) > first:
        _fair(skin, np.arange(first, len(points)))


def _refined(vertices: FloatArray, faces: IntArray, size: float) -> tuple[FloatArray, IntArray]:
    """Halve inner sides longer than ``size``, then flip sides, until there are none."""
    rows = faces.tolist()
    points = list(vertices)
    for _ in range(40):
        added = _halve(points, rows, size)
        _flip_towards_delaunay(points, rows)
        if not added:
            break
    return np.array(points), np.array(rows, dtype=np.int64)


def _owners(rows: list[list[int]]) -> dict[tuple[int, int], int]:
    """Directed side -> its face."""
    return {(r[k], r[(k + 1) % 3]): f for f, r in enumerate(rows) for k in range(3)}


def _halve(points: list[FloatArray], rows: list[list[int]], size: float) -> int:
    owners, added = _owners(rows), 0
    inner = [(a, b) for a, b in owners if a < b and (b, a) in owners]
    spans = {side: float(np.linalg.norm(points[side[0]] - points[side[1]])) for side in inner}
    touched: set[int] = set()
    for (a, b), span in sorted(spans.items(), key=lambda item: -item[1]):
        f, g = owners[a, b], owners[b, a]
        if span <= size or f in touched or g in touched:
            continue
        c, d = (next(v for v in rows[h] if v not in (a, b)) for h in (f, g))
        middle = len(points)
        points.append((points[a] + points[b]) / 2)
        rows[f], rows[g] = [a, middle, c], [b, middle, d]
        rows += [[middle, b, c], [middle, a, d]]
        touched |= {f, g}
        added += 1
    return added


def _flip_towards_delaunay(points: list[FloatArray], rows: list[list[int]]) -> None:
    """Flip inner sides whose two opposite angles are more than 180 degrees together."""
    for _ in range(10):
        owners, flipped = _owners(rows), 0
        touched: set[int] = set()
        for (a, b), f in owners.items():
            g = owners.get((b, a))
            if g is None or a > b or f in touched or g in touched:
                continue
            c, d = (next(v for v in rows[h] if v not in (a, b)) for h in (f, g))
            if (c, d) in owners or (d, c) in owners:
                continue
            if _angle(points, a, c, b) + _angle(points, a, d, b) > np.pi + 1e-6:
                rows[f], rows[g] = [a, d, c], [d, b, c]
                touched |= {f, g}
                flipped += 1
        if not flipped:
            return


def _angle(points: list[FloatArray], a: int, tip: int, b: int) -> float:
    u, v = points[a] - points[tip], points[b] - points[tip]
    return float(np.arctan2(np.linalg.norm(np.cross(u, v)), u @ v))


def _fair(skin: Skin, free: IntArray) -> None:
    """Move vertices so that the Laplacian's Laplacian vanishes there: slopes go on at the rim."""
    n = len(skin.vertices)
    near = np.zeros(n, dtype=bool)
    near[free] = True
    for _ in range(2):
        near[skin.faces[near[skin.faces].any(axis=1)]] = True
    used = np.flatnonzero(near)
    local = np.full(n, -1)
    local[used] = np.arange(len(used))
    pairs = local[edges(skin.faces[near[skin.faces].all(axis=1)])]
    one, two = np.concatenate([pairs, pairs[:, ::-1]]).T
    degree = np.bincount(one, minlength=len(used)).astype(float)
    size = (len(used), len(used))
    links = coo_array((1.0 / degree[one], (one, two)), shape=size).tocsr()
    spread = coo_array((np.ones(len(used)), (np.arange(len(used)),) * 2), shape=size).tocsr()
    bending = ((spread - links) @ (spread - links))[local[free]].tocsc()
    fixed = np.setdiff1d(np.arange(len(used)), local[free])
    known = bending[:, fixed] @ skin.vertices[used[fixed]]
    moved = spsolve(bending[:, local[free]], -known)
    skin.vertices[free] = np.reshape(moved, (len(free), 3))
