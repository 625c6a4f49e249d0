"""Narrow faces along the lines of a drawing merged into their neighbours, or their edges turned."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from seatlook.mesh.drawing.drawing import FLAT, Drawing, edge_of

FloatArray = npt.NDArray[np.float64]

NARROW = np.radians(12.0)  # the smallest angle of a face that is left alone
_ROUNDS = 6
_SMALLEST = 0.3  # of the area of a face, that it keeps when a corner of it moves


def tidy(drawing: Drawing, *, border: bool = True) -> None:
    """Merge or turn what drawing lines has left narrow, best where it is worst.

    A vertex may go to a neighbour: a free one to any, one of a line along this line, where the line
    stays within ``FLAT``. Ends, corners and crossings of lines stay. Each change must widen the
    narrowest face that it touches.
    """
    if not drawing.edges:
        return
    for _ in range(_ROUNDS):
        narrow = sorted(
            (angle, f) for f in _changed(drawing) if (angle := _least(drawing, f)) < NARROW
        )
        done = [_merged(drawing, f, border) or _turned(drawing, f) for _, f in narrow]
        if not any(done):
            return


def _changed(drawing: Drawing) -> list[int]:
    """Return the faces that touch a line, or are parts or neighbours of one that was divided."""
    first = len(drawing.first_faces)
    on_line = {v for pair in drawing.edges for v in pair}
    return sorted({f for v in on_line for f in drawing.faces_at[v]} | {
        f for f in drawing.faces if f >= first
    })  # fmt: skip


def _least(drawing: Drawing, face: int) -> float:
    """Return the smallest angle of a face, 0 where it is no more."""
    corners = drawing.faces.get(face)
    return np.inf if corners is None else _smallest(*(drawing.points[v] for v in corners))


def _smallest(a: FloatArray, b: FloatArray, c: FloatArray) -> float:
    u, v, w = b - a, c - b, a - c
    twice = float(np.linalg.norm(np.cross(u, v)))
    sizes = sorted(float(np.linalg.norm(side)) for side in (u, v, w))
    # The smallest angle lies between the two longest sides.
    return float(np.arcsin(min(1.0, twice / max(sizes[1] * sizes[2], 1e-300))))


def _merged(drawing: Drawing, face: int, border: bool) -> bool:
    """Merge an end of the shortest edge of a face into the other."""
    if face not in drawing.faces:
        return False
    corners = drawing.faces[face]
    pairs = [(corners[k], corners[(k + 1) % 3]) for k in range(3)]
    a, b = min(
        pairs, key=lambda p: float(np.linalg.norm(drawing.points[p[0]] - drawing.points[p[1]]))
    )
    return _merge(drawing, a, b, border) or _merge(drawing, b, a, border)


def _merge(drawing: Drawing, gone: int, stays: int, border: bool) -> bool:
    """Move a vertex into a neighbour, where line, surface and angles allow it."""
    bound = _bound(drawing, gone)
    if bound:
        names = {drawing.edges.get(edge_of(gone, v), "") for v in bound}
        is_border = any(len(drawing.between(gone, v)) == 1 for v in bound)
        if len(bound) != 2 or stays not in bound or len(names) > 1 or (is_border and not border):
            return False
        other = bound[0] if bound[1] == stays else bound[1]
        if _off(drawing, gone, stays, other) > FLAT:
            return False
    shared = drawing.between(gone, stays)
    moved = drawing.faces_at[gone] - shared
    if len(_around(drawing, gone) & _around(drawing, stays)) != len(shared):
        return False
    place = drawing.points[stays]
    if not drawing.stays(moved, gone, place, smallest=_SMALLEST):
        return False
    before = min(_least(drawing, f) for f in drawing.faces_at[gone])
    after = min(
        (_smallest(*(place if v == gone else drawing.points[v] for v in drawing.faces[f]))
         for f in moved), default=np.inf,
    )  # fmt: skip
    if after <= before:
        return False
    drawing.merge(gone, stays)
    return True


def _bound(drawing: Drawing, vertex: int) -> list[int]:
    """Return the neighbours that a vertex is joined to by a line or the border."""
    return [
        v
        for v in sorted(_around(drawing, vertex))
        if edge_of(vertex, v) in drawing.edges or len(drawing.between(vertex, v)) == 1
    ]


def _around(drawing: Drawing, vertex: int) -> set[int]:
    return {v for f in drawing.faces_at[vertex] for v in drawing.faces[f]} - {vertex}


def _off(drawing: Drawing, vertex: int, a: int, b: int) -> float:
    """Return how far a vertex is from the straight way between two others [m]."""
    start, way = drawing.points[a], drawing.points[b] - drawing.points[a]
    across = np.cross(way, drawing.points[vertex] - start)
    return float(np.linalg.norm(across) / max(float(np.linalg.norm(way)), 1e-300))


def _quadrangle(drawing: Drawing, face: int) -> tuple[int, int, int, int, int] | None:
    """Return the longest edge of a face, its third corner, that beyond the edge and its face."""
    if face not in drawing.faces:
        return None
    corners = drawing.faces[face]
    ends = [drawing.points[v] for v in corners]
    k = max(range(3), key=lambda i: float(np.linalg.norm(ends[i] - ends[(i + 1) % 3])))
    a, b, c = (corners[(k + i) % 3] for i in range(3))
    others = drawing.between(a, b) - {face}
    if len(others) != 1:
        return None
    (other,) = others
    d = next(v for v in drawing.faces[other] if v not in (a, b))
    return None if drawing.between(c, d) else (a, b, c, d, other)


def _turned(drawing: Drawing, face: int) -> bool:
    """Turn the longest edge of a face in the quadrangle of its two faces."""
    corners = _quadrangle(drawing, face)
    if corners is None or edge_of(*corners[:2]) in drawing.edges:
        return False
    a, b, c, d, other = corners
    A, B, C, D = (drawing.points[v] for v in (a, b, c, d))
    across = np.cross(B - A, D - C)
    size = float(np.linalg.norm(across))
    normal = drawing.vector(face) + drawing.vector(other)
    after = (np.cross(A - C, D - C), np.cross(D - C, B - C))
    if size == 0 or abs((C - A) @ across) > FLAT * size or any(v @ normal <= 0 for v in after):
        return False
    before = min(_least(drawing, face), _least(drawing, other))
    if min(_smallest(C, A, D), _smallest(C, D, B)) <= before:
        return False
    drawing.replace({face: [c, a, d], other: [c, d, b]})
    return True
