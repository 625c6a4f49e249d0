"""Sparse Cholesky factors by nested dissection and dense fronts.

A cut through the graph of a matrix leaves two parts that do not touch; those beside the cut come
last, and each part is cut again. Every set of vertices that is eliminated together is a dense front
(George 1973, SIAM J. on Numerical Analysis 10, 345; Duff and Reid 1983, ACM Trans. Math. Softw. 9,
302). Cuts are straight in coordinates that the graph gives itself: distances, in edges, from some
vertices far from each other.
"""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array

from seatlook.model import FloatArray, IntArray
from seatlook.solver.kernels import dissection, fronts, substitution


class Pattern:
    """Order of elimination for all matrices whose entries are in the same places.

    Parameters
    ----------
    rows, columns : (p,) int64    vertices of the blocks that are given, each pair once, either way
        round
    count : int                   vertices
    size : int                    unknowns of a vertex, blocks are (size, size)
    """

    def __init__(self, rows: IntArray, columns: IntArray, count: int, *, size: int = 1) -> None:
        ends = np.concatenate([rows, columns]), np.concatenate([columns, rows])
        graph = csr_array((np.ones(2 * len(rows), np.int8), ends), shape=(count, count))
        begin, near = graph.indptr.astype(np.int64), graph.indices.astype(np.int64)
        self.size = size
        self.order, self.starts, self.children = dissection.dissect(begin, near)
        self.rim_at, self.rims = dissection.rims(
            begin, near, self.order, self.starts, self.children
        )
        self.at, self.home, self.updates = fronts.lay_out(
            self.starts, self.rim_at, self.children, size
        )
        self.where, self.turned, self.pitch = fronts.places(
            rows, columns, self.order, self.starts, self.rim_at, self.rims, self.at, size
        )
        wide, deep = size * np.diff(self.starts), size * np.diff(self.rim_at)
        longer = np.maximum(wide, deep)
        room = (wide + fronts.STRIP + 2 * fronts.BLOCK) * (longer + fronts.STRIP)
        self.room = int(room.max(initial=0))


class Cholesky:
    """Factor of symmetric positive definite matrices of one pattern."""

    def __init__(self, pattern: Pattern) -> None:
        self._pattern = pattern
        self._storage, self._work = np.empty(pattern.at[-1]), np.empty(pattern.room)
        self._triples = np.empty((int(np.diff(pattern.rim_at).max(initial=0)), 3))

    def factor(self, blocks: FloatArray) -> bool:
        """Factor the matrix of (p, size, size) blocks; False if it is not positive definite."""
        p = self._pattern
        fronts.scatter(blocks, p.where, p.turned, p.pitch, self._storage)
        return bool(
            fronts.factor(
                self._storage,
                p.at,
                p.starts,
                p.rim_at,
                p.rims,
                p.children,
                p.size,
                p.home,
                np.empty(p.updates),
                self._work,
            )
        )

    def solve(self, right: FloatArray) -> FloatArray:
        """Solve for (n, size) right-hand sides; of matrices with size 1, for (n, k) of them."""
        p = self._pattern
        out, x = np.empty_like(right), right[p.order]
        if p.size > 1:
            x = self._substituted(x.ravel()).reshape(right.shape)
        elif right.shape[1] == 3:
            layout = self._storage, p.at, p.starts, p.rim_at, p.rims
            substitution.forward_triple(*layout, x, self._triples)
            substitution.backward_triple(*layout, x, self._triples)
        else:
            for k in range(right.shape[1]):
                x[:, k] = self._substituted(x[:, k].copy())
        out[p.order] = x
        return out

    def _substituted(self, x: FloatArray) -> FloatArray:
        """Solve for one right-hand side of all unknowns in the order of elimination, in place."""
        p = self._pattern
        layout = self._storage, p.at, p.starts, p.rim_at, p.rims, p.size
        substitution.forward(*layout, x, self._work)
        substitution.backward(*layout, x, self._work)
        return x
