"""Which vertices of a drawn surface look around: evenly spread ones, and more where it changes."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from seatlook.mesh import edges
from seatlook.model import FloatArray, IntArray
from seatlook.pbr.kernels.specular_bounce import Vertices
from seatlook.pbr.shading.coarsening import Between, Coarse, coarsened
from seatlook.pbr.shading.subdivision import boundary_edges
from seatlook.pbr.shading.surface import Surface

# Vertices that look lie at most so far apart [m], whatever the solver's mesh.
_APART = 0.0085
# Of a mesh that is finer, about so many look first: as far apart as its area allows.
_FIRST = 12_000
# Between neighbours that see shares further apart, the vertex between them looks itself.
_CONTRAST = 0.2

Hits = npt.NDArray[np.int32]
Look = Callable[[IntArray], Hits]


class Memory:
    """What vertices have seen: each looks once. It knows nothing of who asks, as its cache."""

    def __init__(self, vertices: int) -> None:
        self._row = np.full(vertices, -1)
        self._hits: Hits | None = None

    def __call__(self, look: Look, which: IntArray) -> Hits:
        """Hits (m, rays) of the vertices ``which`` (m,); those that have none yet ``look``."""
        new = which[self._row[which] < 0]
        if len(new) or self._hits is None:
            hits = look(new)
            first = 0 if self._hits is None else len(self._hits)
            self._row[new] = first + np.arange(len(new))
            self._hits = hits if self._hits is None else np.concatenate([self._hits, hits])
        return np.asarray(self._hits[self._row[which]])


class Lookout:
    """Vertices of a surface that may look: evenly spread ones first, then those between them."""

    def __init__(self, surface: Surface) -> None:
        self.surface = surface
        parents, solved = surface.refined.parents, surface.solved
        self._between: list[Between] = []
        level, size, width = 0, surface.element_size, _width(surface)
        if size <= 0.5 * width:
            self.first, self._pairs, self._between = _of_fine_mesh(surface, width)
        else:
            while level < len(parents) and size / 2**level > _APART:
                solved += len(parents[level])
                level += 1
            self.first = np.arange(solved)
            self._pairs = edges(surface.faces_of_level(level))
        if surface.ground is not None:
            around = np.arange(surface.vertices, surface.gathering)
            self.first = np.concatenate([self.first, around])
            beside = surface.vertices + edges(surface.ground.faces)
            self._pairs = np.concatenate([self._pairs, beside])
        for ends in parents[level:]:
            middle = solved + np.arange(len(ends))
            self._between.append(Between(middle, ends, np.full(ends.shape, 0.5)))
            solved += len(ends)

    def where_it_changes(
        self, look: Look, shares: Callable[[Hits], FloatArray], wanted: npt.NDArray[np.bool_]
    ) -> Vertices:
        """Look from evenly spread vertices, then from those between some that see other shares.

        Parameters
        ----------
        shares : of hits (m, rays), the (m, d) shares of them that are compared
        wanted : (n,) whether a vertex is of use
        """
        which = [self.first[wanted[self.first]]]
        hits = [look(which[0])]
        first = shares(hits[0])
        seen = np.ones((self.surface.gathering, first.shape[1]))
        seen[which[0]] = first
        for level in self._between:
            seen[level.vertices] = level.mean(seen)
            differ = (level.apart(seen) > _CONTRAST).any(axis=1) & wanted[level.vertices]
            which.append(level.vertices[differ])
            hits.append(look(which[-1]))
            seen[which[-1]] = shares(hits[-1])
        return Vertices(np.concatenate(which), np.concatenate(hits))

    def spread(self, which: IntArray, values: FloatArray) -> FloatArray:
        """Values (m, d) of the vertices ``which`` carried to all refined ones."""
        out = np.zeros((self.surface.gathering, values.shape[1]))
        looked = np.zeros(len(out), dtype=bool)
        looked[which], out[which] = True, values
        for level in self._between:
            here = ~looked[level.vertices]
            out[level.vertices[here]] = level.mean(out)[here]
        return out

    def pairs(self, which: IntArray) -> IntArray:
        """Rows (e, 2) of ``which`` that lie side by side, or one between the other and others."""
        row = np.full(self.surface.gathering, -1)
        row[which] = np.arange(len(which))
        pairs = [self._pairs]
        for level in self._between:
            looked = row[level.vertices] >= 0
            middle = level.vertices[looked]
            pairs += [np.column_stack([middle, end]) for end in level.ends[looked].T]
        rows = row[np.concatenate(pairs)]
        return np.asarray(rows[(rows >= 0).all(axis=1) & (rows[:, 0] != rows[:, 1])])


def _width(surface: Surface) -> float:
    """How far apart [m] vertices need to look."""
    corners = surface.mesh.vertices[surface.coarse_faces]
    area = 0.5 * np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    total = float(np.linalg.norm(area, axis=1).sum())
    return min(_APART, float(np.sqrt(total / _FIRST)))


def _of_fine_mesh(surface: Surface, width: float) -> Coarse:
    """Spread vertices of a solver's mesh that is finer than light needs to be gathered."""
    faces = surface.coarse_faces
    panel, on_edge = np.full(surface.solved, -1), np.zeros(surface.solved, dtype=bool)
    panel[faces] = surface.mesh.panel[: surface.faces : surface.faces // len(faces), None]
    on_edge[boundary_edges(faces)] = True
    widths = [width]
    while widths[-1] >= 4 * surface.element_size:
        widths.append(0.5 * widths[-1])
    return coarsened(surface.mesh.uv[: surface.solved], panel, on_edge, widths)
