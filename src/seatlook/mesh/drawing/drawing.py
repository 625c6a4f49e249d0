"""A triangle mesh whose faces are replaced by their parts, while lines are drawn into it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from seatlook.errors import InputError
from seatlook.mesh.closest import closest_places
from seatlook.mesh.drawing.shortest import Stop, place_of, shortest_way
from seatlook.mesh.surface import boundary_sides

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]
Edge = tuple[int, int]

SAME = 1e-3  # share of an edge within which a place is the vertex itself
CLEAR = 0.05  # share of an edge within which a free vertex gives way to a line
FLAT = 5e-5  # [m] by which a vertex that gives way may leave the planes of its faces


class Drawing:
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
        self.border = {*faces[side, k].tolist(), *faces[side, (k + 1) % 3].tolist()}
        self.fixed = set(self.border)
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
                    self.edges.setdefault(edge_of(a, b), name)
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
            vertex = self._split(self.between(a, b), (a, b), place)
        else:
            vertex = self._split({face}, (a, b, c), place)
        self.fixed.add(vertex)
        return vertex

    def _path(self, start: int, end: int, key: str) -> list[int]:
        """Return the vertices of a way from one vertex to another, along edges made for it."""
        path, normal = [start], self._normal(start) + self._normal(end)
        while not self.faces_at[path[-1]] & self.faces_at[end]:
            step = self._step(path[-1], end, normal)
            # Beside a crease the next plane may lead back; a way crosses no face twice.
            if step is None or step in path or len(path) > len(self.first_faces):
                # A way that comes to a border leaves the surface; round a hole is not meant.
                leaves = path[-1] in self.border and path[-1] != start
                return self._walked(None if leaves else shortest_way(self, start, end), start, key)
            self.fixed.add(step)
            path.append(step)
        return [*path, end]

    def _walked(self, stops: list[Stop] | None, start: int, key: str) -> list[int]:
        """Return the vertices of a way through these stops."""
        if stops is None:
            x, y, z = 1e3 * self.points[start]
            raise InputError.single(
                key,
                got=f"no way on the surface to the next point from {x:.1f}, {y:.1f}, {z:.1f}",
                expected="a line that stays on the surface",
                hint="where the surface is strongly bent, points closer together help",
            )
        path = []
        for a, b, part in stops:
            place = place_of(self, (a, b, part))
            path.append(a if a == b else self._split(self.between(a, b), (a, b), place))
        return path

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
        return self._split(self.between(b, c), (b, c), place)

    def _split(self, faces: Iterable[int], ends: tuple[int, ...], place: FloatArray) -> int:
        """Put a vertex onto the edge (2 ends) or into the face (3) of these faces."""
        vertex = len(self.points)
        self.points.append(place)
        self.faces_at.append(set())
        if len(ends) == 2 and len(self.between(*ends)) < 2:
            self.border.add(vertex)
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
        name = self.edges.pop(edge_of(*ends), None) if len(ends) == 2 else None
        if name is not None:
            self.edges |= {edge_of(end, vertex): name for end in ends}
        return vertex

    def _gives_way(self, vertex: int, place: FloatArray, off: float) -> bool:
        """Whether a vertex lies at a place, moved there if it may be."""
        if off > CLEAR:
            return False
        if vertex not in self.fixed and self.stays(self.faces_at[vertex], vertex, place):
            self.points[vertex] = place
            return True
        return off <= SAME

    def _edge_gives_way(self, a: int, b: int, place: FloatArray, off: float) -> bool:
        """Whether an edge may run through a place beside it."""
        faces = self.between(a, b)
        free = len(faces) == 2 and edge_of(a, b) not in self.edges
        vectors = [self.vector(f) for f in faces]
        beside = place - self.points[a]
        flat = all(abs(n @ beside) <= FLAT * np.linalg.norm(n) for n in vectors)
        return off <= (CLEAR if free and flat else SAME)

    def merge(self, gone: int, stays: int) -> None:
        """Move a vertex into a neighbour; faces between them vanish, a line goes on."""
        for f in tuple(self.between(gone, stays)):
            self._remove(f)
        faces = tuple(self.faces_at[gone])
        self.replace({f: [stays if v == gone else v for v in self.faces[f]] for f in faces})
        for edge in [edge for edge in self.edges if gone in edge]:
            name = self.edges.pop(edge)
            other = edge[0] if edge[1] == gone else edge[1]
            if other != stays:
                self.edges[edge_of(other, stays)] = name

    def replace(self, faces: Mapping[int, list[int]]) -> None:
        """Give faces other corners."""
        for f, corners in faces.items():
            for a in self.faces[f]:
                self.faces_at[a].discard(f)
            self.faces[f] = corners
        for f, corners in faces.items():
            for a in corners:
                self.faces_at[a].add(f)

    def _remove(self, face: int) -> None:
        for a in self.faces.pop(face):
            self.faces_at[a].discard(face)
        self.parts[self.source.pop(face)].discard(face)

    def stays(
        self, faces: set[int], vertex: int, place: FloatArray, *, smallest: float = 0.5
    ) -> bool:
        """Whether faces keep their planes and a share of their area when a vertex moves."""
        for f in faces:
            k = self.faces[f].index(vertex)
            a, b, c = (self.points[self.faces[f][(k + i) % 3]] for i in range(3))
            before, after = np.cross(b - a, c - a), np.cross(b - place, c - place)
            size = np.linalg.norm(before)
            if abs(before @ (place - a)) > FLAT * size or before @ after < smallest * size**2:
                return False
        return True

    def between(self, a: int, b: int) -> set[int]:
        """Return the faces on both sides of an edge."""
        return self.faces_at[a] & self.faces_at[b]

    def vector(self, face: int) -> FloatArray:
        """Return twice the area times the normal (3,) of a face."""
        a, b, c = (self.points[v] for v in self.faces[face])
        return np.asarray(np.cross(b - a, c - a))

    def _normal(self, vertex: int) -> FloatArray:
        """Return the unit normal at a vertex, faces weighted by their area."""
        normal = np.sum([self.vector(f) for f in self.faces_at[vertex]], axis=0)
        return np.asarray(normal / np.linalg.norm(normal))


def edge_of(a: int, b: int) -> Edge:
    """Return an edge by its smaller vertex first."""
    return (a, b) if a < b else (b, a)
