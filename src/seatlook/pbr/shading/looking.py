"""Which vertices of a drawn surface look around: evenly spread ones, and more where it changes."""

from __future__ import annotations

import functools
from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from seatlook.model import FloatArray, IntArray
from seatlook.pbr.kernels.specular_bounce import Vertices
from seatlook.pbr.shading.surface import Surface

# Vertices that look lie at most so far apart [m], whatever the solver's mesh.
_APART = 0.0085
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
    """Vertices of a surface that may look, in the order of its refinements."""

    def __init__(self, surface: Surface) -> None:
        parents = surface.refined.parents
        self.surface, self.few, self._level = surface, surface.solved, 0
        while self._level < len(parents) and surface.element_size / 2**self._level > _APART:
            self.few += len(parents[self._level])
            self._level += 1
        self._finer = parents[self._level :]

    def where_it_changes(
        self, look: Look, shares: Callable[[Hits], FloatArray], wanted: npt.NDArray[np.bool_]
    ) -> Vertices:
        """Look from evenly spread vertices, then from those between two that see other shares.

        Parameters
        ----------
        shares : of hits (m, rays), the (m, d) shares of them that are compared
        wanted : (n,) whether a vertex is of use
        """
        which = [np.flatnonzero(wanted[: self.few])]
        hits = [look(which[0])]
        first = shares(hits[0])
        seen = np.ones((self.few, first.shape[1]))
        seen[which[0]] = first
        for ends in self._finer:
            a, b = seen[ends[:, 0]], seen[ends[:, 1]]
            middle = 0.5 * (a + b)
            here = wanted[len(seen) : len(seen) + len(ends)]
            differ = np.flatnonzero((np.abs(a - b) > _CONTRAST).any(axis=1) & here)
            which.append(len(seen) + differ)
            hits.append(look(which[-1]))
            middle[differ] = shares(hits[-1])
            seen = np.concatenate([seen, middle])
        return Vertices(np.concatenate(which), np.concatenate(hits))

    def spread(self, which: IntArray, values: FloatArray) -> FloatArray:
        """Values (m, d) of the vertices ``which`` carried to all refined ones."""
        out = np.zeros((self.few, values.shape[1]))
        first = int(np.searchsorted(which, self.few))
        out[which[:first]] = values[:first]
        for ends in self._finer:
            middle = 0.5 * (out[ends[:, 0]] + out[ends[:, 1]])
            stop = int(np.searchsorted(which, len(out) + len(ends)))
            middle[which[first:stop] - len(out)] = values[first:stop]
            out, first = np.concatenate([out, middle]), stop
        return out

    def pairs(self, which: IntArray) -> IntArray:
        """Rows (e, 2) of ``which`` that lie side by side, or one between the other and a third."""
        row = np.full(self.surface.vertices, -1)
        row[which] = np.arange(len(which))
        pairs, first = [self._edges], self.few
        for ends in self._finer:
            middle = np.flatnonzero(row[first : first + len(ends)] >= 0)
            pairs += [np.column_stack([first + middle, ends[middle, end]]) for end in (0, 1)]
            first += len(ends)
        rows = row[np.concatenate(pairs)]
        return np.asarray(rows[(rows >= 0).all(axis=1)])

    @functools.cached_property
    def _edges(self) -> IntArray:
        faces, n = self.surface.faces_of_level(self._level), self.few
        sides = np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
        key = np.unique(sides[:, 0] * n + sides[:, 1])
        return np.column_stack([key // n, key % n])
