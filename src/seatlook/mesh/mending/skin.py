"""A surface while it is mended, and the report of what was done to it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from seatlook.mesh.surface import FloatArray, IntArray

SLIVER_M = 1e-5  # height of a triangle that is none

BoolArray = npt.NDArray[np.bool_]


class Mend(NamedTuple):
    """One thing that was mended.

    Parameters
    ----------
    what : was done, in words
    number : of faces, edges, holes or bodies, as ``what`` says
    place : (3,) [m] of the first of them
    asked : whether a choice asked for it
    """

    what: str
    number: int
    place: FloatArray
    asked: bool = False


@dataclass(slots=True)
class Skin:
    """A surface while it is mended.

    Parameters
    ----------
    vertices : (n, 3) [m]; faces : (m, 3) int64
    source : (m,) int64   face of the file that each comes from, -1 for a new one
    report : what was done so far
    """

    vertices: FloatArray
    faces: IntArray
    source: IntArray
    report: list[Mend] = field(default_factory=list)

    def note(self, what: str, count: int, place: FloatArray, *, asked: bool = False) -> None:
        """Add a line to the report, if there is anything to say."""
        if count:
            self.report.append(Mend(what, int(count), np.array(place, dtype=float), asked))

    def middle(self, face: int) -> FloatArray:
        """Return the middle (3,) of a face."""
        return np.asarray(self.vertices[self.faces[face]].mean(axis=0))

    def side_lengths(self) -> FloatArray:
        """Return the length (m, 3) [m] of each side, the first from corner 0 to corner 1."""
        corners = self.vertices[self.faces]
        return np.asarray(np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2))

    def keep(self, faces: BoolArray) -> None:
        """Drop all other faces."""
        self.faces, self.source = self.faces[faces], self.source[faces]

    def merge(self, vertex: IntArray) -> None:
        """Let vertex i be vertex ``vertex[i]``, and drop faces that lose a corner by that."""
        self.faces = vertex[self.faces]
        a, b, c = self.faces.T
        self.keep((a != b) & (b != c) & (c != a))

    def add(self, vertices: FloatArray, faces: IntArray) -> None:
        """Add new vertices (k, 3), numbered on from those there are, and faces (j, 3)."""
        self.vertices = np.concatenate([self.vertices, vertices])
        self.faces = np.concatenate([self.faces, faces])
        self.source = np.concatenate([self.source, np.full(len(faces), -1)])

    def compact(self) -> None:
        """Drop vertices without a face."""
        used, index = np.unique(self.faces, return_inverse=True)
        self.vertices, self.faces = self.vertices[used], index.reshape(-1, 3)


class Sides(NamedTuple):
    """The sides of faces, side k of face f being 3 f + k, and the edges that they lie on.

    Parameters
    ----------
    edge : (3 m,) number of the edge; members : (e,) how many sides lie on it
    forward : (3 m,) bool   runs from the smaller vertex to the larger
    """

    edge: IntArray
    members: IntArray
    forward: BoolArray

    def crowd(self) -> IntArray:
        """Return how many sides lie on the edge of each side (3 m,)."""
        return np.asarray(self.members[self.edge])


def sides(faces: IntArray) -> Sides:
    """Find the edges of faces (m, 3)."""
    start, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    key = np.minimum(start, end) * (int(faces.max(initial=-1)) + 1) + np.maximum(start, end)
    _, edge, count = np.unique(key, return_inverse=True, return_counts=True)
    return Sides(edge.reshape(-1).astype(np.int64), count, start < end)
