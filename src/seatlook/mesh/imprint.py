"""Lines drawn into a triangle mesh, so that edges of it run along them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from seatlook.errors import InputError, Problem
from seatlook.mesh.closest import closest_places
from seatlook.mesh.surface import boundary_sides

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]
Edge = tuple[int, int]

SAME = 1e-3  # share of an edge within which a place is the vertex itself
CLEAR = 0.05  # share of an edge within which a free vertex gives way to a line
FLAT = 5e-5  # [m] by which a vertex that gives way may leave the planes of its faces


class Imprinted(NamedTuple):
    """A mesh with lines in it.

    Parameters
    ----------
    vertices : (n, 3) [m]     those of the mesh given first, in their order
    faces : (m, 3) int64
    source : (m,) int64       the face of the mesh given that each is a part of
    edges : edge, smaller vertex first -> name of the line that it lies on
    """

    vertices: FloatArray
    faces: IntArray
    source: IntArray
    edges: dict[Edge, str]


def imprint(vertices: FloatArray, faces: IntArray, lines: Mapping[str, FloatArray]) -> Imprinted:
    """Split the faces of a mesh where lines run over it.

    Each point of a line becomes a vertex at the closest place; between two points the line is the
    cut of the surface with the plane through both and the mean of their normals. Where the line
    passes a vertex within 5 % of an edge, that vertex moves onto it, if the surface stays within
    0.05 mm and the vertex lies on no border and no other line: splitting there would leave slivers.

    Parameters
    ----------
    vertices : (n, 3) [m]; faces : (m, 3)
    lines : name -> (k, 3) [m]; a closed line repeats its first point

    Raises
    ------
    InputError
        A line leaves the surface between two of its points, or the surface folds back there.
    """
    drawing = _Drawing(vertices, faces)
    problems: list[Problem] = []
    for name, line in lines.items():
        on = closest_places(line, vertices, faces, reach=np.inf)
        try:
            drawing.draw(name, line - on.offset, on.face)
        except InputError as error:
            problems += error.problems
    if problems:
        raise InputError(problems)
    numbers = sorted(drawing.faces)
    return Imprinted(
        vertices=np.array(drawing.points),
        faces=np.array([drawing.faces[f] for f in numbers], dtype=np.int64),
        source=np.array([drawing.source[f] for f in numbers], dtype=np.int64),
        edges=drawing.edges,
    )


class _Drawing:
    """A mesh whose faces are replaced by their parts, one after the other."""

    def __init__(self, vertices: FloatArray, faces: IntArray) -> None:
        self.first_faces = faces.tolist()
        self.points = list(np.array(vertices))
        self.faces: dict[int, list[int]] = dict(enumerate(self.first_faces))
        self.source = {f: f for f in self.faces}
        self.parts = {f: {f} for f in self.faces}
        self.faces_at: list[set[int]] = [set() for _ in self.points]
        for f, corners in self.faces.items():
            for a in corners:
                self.faces_at[a].add(f)
        self.first_faces_at = [tuple(numbers) for numbers in self.faces_at]
        side, k = np.divmod(boundary_sides(faces), 3)
        self.fixed = {*faces[side, k].tolist(), *faces[side, (k + 1) % 3].tolist()}
        self.edges: dict[Edge, str] = {}
        self.count = len(self.faces)

    def draw(self, name: str, line: FloatArray, source: IntArray) -> None:
        """Draw a line through places of given faces."""
        vertex = self._insert(line[0], int(source[0]))
        for i in range(1, len(line)):
            following = self._insert(line[i], int(source[i]))
            if following != vertex:
                path = self._path(vertex, following, f"curve.{name}.points_mm")
                for a, b in pairwise(path):
                    self.edges.setdefault(_edge(a, b), name)
                self.fixed.update(path)
            vertex = following

    def _insert(self, place: FloatArray, source: int) -> int:
        """Return the vertex at a place of a given face, a new one where there is none."""
        near = {g for a in self.first_faces[source] for g in self.first_faces_at[a]}
        faces = sorted(part for g in near for part in self.parts[g])
        corner = np.array([[self.points[a] for a in self.faces[f]] for f in faces]).reshape(-1, 3)
        at = closest_places(
            place[None], corner, np.arange(len(corner)).reshape(-1, 3), reach=np.inf
        )
        face, weights = faces[int(at.face[0])], at.weights[0]
        c, b, a = (self.faces[face][k] for k in np.argsort(weights).tolist())
        low, high = float(weights.min()), float(weights.max())
        if self._gives_way(a, place, 1 - high):
            vertex: int = a
        elif self._edge_gives_way(a, b, place, low):
            vertex = self._split(self._between(a, b), (a, b), place)
        else:
            vertex = self._split({face}, (a, b, c), place)
        self.fixed.add(vertex)
        return vertex

    def _path(self, start: int, end: int, key: str) -> list[int]:
        """Return the vertices of a way from one vertex to another, along edges made for it."""
        path, normal = [start], self._normal(start) + self._normal(end)
        while not self.faces_at[path[-1]] & self.faces_at[end]:
            step = self._step(path[-1], end, normal)
            if step is None:
                x, y, z = 1e3 * self.points[path[-1]]
                raise InputError.single(
                    key,
                    got=f"no way on the surface to the next point from {x:.1f}, {y:.1f}, {z:.1f}",
                    expected="a line that stays on the surface",
                    hint="where the surface is strongly bent, points closer together help",
                )
            self.fixed.add(step)
            path.append(step)
        return [*path, end]

    def _step(self, vertex: int, end: int, normal: FloatArray) -> int | None:
        """Return the next vertex on the way to ``end``, or None where there is no way forward."""
        at = self.points[vertex]
        ahead = self.points[end] - at
        across = np.cross(normal, ahead)
        best, gain = None, 0.0
        for f in self.faces_at[vertex]:
            b, c = (a for a in self.faces[f] if a != vertex)
            height_b, height_c = ((self.points[a] - at) @ across for a in (b, c))
            if height_b == height_c or height_b * height_c > 0:
                continue
            share = float(height_b / (height_b - height_c))
            place = self.points[b] + share * (self.points[c] - self.points[b])
            forward = float((place - at) @ ahead / np.linalg.norm(place - at))
            if forward > gain:
                best, gain = (b, c, share, place), forward
        if best is None or (self.points[end] - best[3]) @ ahead <= 0:
            return None
        b, c, share, place = best
        for a, off in ((b, share), (c, 1 - share)):
            if self._gives_way(a, place, off):
                return a
        return self._split(self._between(b, c), (b, c), place)

    def _split(self, faces: Iterable[int], ends: tuple[int, ...], place: FloatArray) -> int:
        """Put a vertex onto the edge (2 ends) or into the face (3) of these faces."""
        vertex = len(self.points)
        self.points.append(place)
        self.faces_at.append(set())
        for f in tuple(faces):
            corners, source = self.faces.pop(f), self.source.pop(f)
            self.parts[source].discard(f)
            for a in corners:
                self.faces_at[a].discard(f)
            for end in ends:
                part = [vertex if a == end else a for a in corners]
                self.faces[self.count], self.source[self.count] = part, source
                self.parts[source].add(self.count)
                for a in part:
                    self.faces_at[a].add(self.count)
                self.count += 1
        name = self.edges.pop(_edge(*ends), None) if len(ends) == 2 else None
        if name is not None:
            self.edges |= {_edge(end, vertex): name for end in ends}
        return vertex

    def _gives_way(self, vertex: int, place: FloatArray, off: float) -> bool:
        """Whether a vertex lies at a place, moved there if it may be."""
        if off > CLEAR:
            return False
        if vertex not in self.fixed and self._stays(self.faces_at[vertex], vertex, place):
            self.points[vertex] = place
            return True
        return off <= SAME

    def _edge_gives_way(self, a: int, b: int, place: FloatArray, off: float) -> bool:
        """Whether an edge may run through a place beside it."""
        faces = self._between(a, b)
        free = len(faces) == 2 and _edge(a, b) not in self.edges
        vectors = [self._vector(f) for f in faces]
        beside = place - self.points[a]
        flat = all(abs(n @ beside) <= FLAT * np.linalg.norm(n) for n in vectors)
        return off <= (CLEAR if free and flat else SAME)

    def _stays(self, faces: set[int], vertex: int, place: FloatArray) -> bool:
        """Whether faces keep their planes and most of their area when a vertex moves."""
        for f in faces:
            k = self.faces[f].index(vertex)
            a, b, c = (self.points[self.faces[f][(k + i) % 3]] for i in range(3))
            before, after = np.cross(b - a, c - a), np.cross(b - place, c - place)
            size = np.linalg.norm(before)
            if abs(before @ (place - a)) > FLAT * size or before @ after < 0.5 * size**2:
                return False
        return True

    def _between(self, a: int, b: int) -> set[int]:
        return self.faces_at[a] & self.faces_at[b]

    def _vector(self, face: int) -> FloatArray:
        a, b, c = (self.points[v] for v in self.faces[face])
        return np.asarray(np.cross(b - a, c - a))

    def _normal(self, vertex: int) -> FloatArray:
        """Return the unit normal at a vertex, faces weighted by their area."""
        normal = np.sum([self._vector(f) for f in self.faces_at[vertex]], axis=0)
        return np.asarray(normal / np.linalg.norm(normal))


def _edge(a: int, b: int) -> Edge:
    return (a, b) if a < b else (b, a)
