"""Sparse Cholesky factors by dense fronts, for matrices whose unknowns lie somewhere in space.

Nested dissection: a plane through the middle cuts the vertices in two; those beside the cut come
last, and each half is cut again. Every set of vertices that is eliminated together is a dense
front, left to LAPACK (Duff and Reid 1983, ACM Trans. Math. Softw. 9, 302; George 1973, SIAM J.
on Numerical Analysis 10, 345). What depends on the pattern alone is done once for many factors.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import blas, lapack
from scipy.sparse import csr_array

from seatlook.model import FloatArray, IntArray
from seatlook.solver.kernels import fronts as kernel

_LEAF = 24  # vertices that are not cut any further


@dataclass(slots=True)
class _Front:
    """Vertices eliminated together, and those of later fronts that they touch, in their order."""

    own: IntArray
    children: list[int]
    rim: IntArray
    into: list[IntArray]  # unknowns of each child's rim in this front


class Cholesky:
    """Factor of symmetric positive definite matrices of one pattern.

    Parameters
    ----------
    rows, columns : (p,) int64    vertices of the blocks that are given, each pair once, either way
        round; the diagonal is among them
    points : (n, d) float64 [m]   where the vertices lie; neighbours should be near
    size : int                    unknowns of a vertex, blocks are (size, size)
    """

    def __init__(
        self, rows: IntArray, columns: IntArray, points: FloatArray, *, size: int = 1
    ) -> None:
        self._count, self._size = len(points), size
        self._points = points
        ends = np.concatenate([rows, columns]), np.concatenate([columns, rows])
        graph = csr_array((np.ones(2 * len(rows), np.int8), ends), shape=2 * (len(points),))
        self._begin, self._next = graph.indptr.astype(np.int64), graph.indices.astype(np.int64)
        self._side = np.zeros(len(points), dtype=np.int8)
        self._fronts: list[_Front] = []
        self._cut(np.arange(len(points)))
        self._rank = np.empty(len(points), dtype=np.int64)
        self._rank[np.concatenate([f.own for f in self._fronts])] = np.arange(len(points))
        self._connect()
        self._lay_out(rows, columns)

    def factor(self, blocks: FloatArray) -> bool:
        """Factor the matrix of (p, size, size) blocks; False if it is not positive definite."""
        self._storage.fill(0.0)
        kernel.scatter(blocks, *self._places, self._storage)
        updates: list[FloatArray] = []
        for front, (own, below) in zip(self._fronts, self._parts, strict=True):
            rest = np.zeros((below.shape[1], below.shape[1]))
            first = len(updates) - len(front.into)
            for update, into in zip(updates[first:], front.into, strict=True):
                kernel.extend(update, into, own, below, rest)
            del updates[first:]
            if lapack.dpotrf(own.T, lower=1, clean=0, overwrite_a=1)[1]:
                return False
            if len(rest):
                blas.dtrsm(1.0, own.T, below.T, side=1, lower=1, trans_a=1, overwrite_b=1)
                blas.dsyrk(-1.0, below.T, beta=1.0, c=rest.T, lower=1, overwrite_c=1)
            updates.append(rest)
        return True

    def solve(self, right: FloatArray) -> FloatArray:
        """Solve for (n, size) right-hand sides; of matrices with size 1, for (n, k) of them."""
        x = np.array(right)
        if self._size > 1:
            x = x.reshape(-1, 1)
        for (own, below), (mine, others) in zip(self._parts, self._unknowns, strict=True):
            part = blas.dtrsm(1.0, own.T, x[mine], lower=1)
            x[mine] = part
            x[others] -= below.T @ part
        for (own, below), (mine, others) in zip(
            reversed(self._parts), reversed(self._unknowns), strict=True
        ):
            part = x[mine] - below @ x[others]
            x[mine] = blas.dtrsm(1.0, own.T, part, lower=1, trans_a=1)
        return x.reshape(right.shape)

    def _cut(self, vertices: IntArray) -> int:
        """Cut a set of vertices in two along the plane with fewest beside it; return its front."""
        children = []
        if len(vertices) > _LEAF:
            first, second, vertices = min(self._cuts(vertices), key=lambda cut: len(cut[2]))
            children = [self._cut(part) for part in (first, second) if len(part)]
        empty = np.zeros(0, dtype=np.int64)
        self._fronts.append(_Front(vertices, children, empty, []))
        return len(self._fronts) - 1

    def _cuts(self, vertices: IntArray) -> list[tuple[IntArray, IntArray, IntArray]]:
        """Halves and separators across the two longest axes; the separator is of either half."""
        points = self._points[vertices] - self._points[vertices].mean(axis=0)
        axes = np.linalg.eigh(points.T @ points)[1]
        found = []
        for axis in axes.T[:-3:-1]:
            order = vertices[np.argsort(points @ axis, kind="stable")]
            halves = order[: len(order) // 2], order[len(order) // 2 :]
            for one, other in (halves, halves[::-1]):
                self._side[one] = 1
                near, count = self._neighbours(other)
                start = np.concatenate([[0], np.cumsum(count)[:-1]])
                beside = np.maximum.reduceat(self._side[near], start) > 0
                self._side[one] = 0
                found.append((one, other[~beside], other[beside]))
        return found

    def _neighbours(self, vertices: IntArray) -> tuple[IntArray, IntArray]:
        """Neighbours of all vertices, themselves included, and how many each has."""
        begin = self._begin[vertices]
        count = self._begin[vertices + 1] - begin
        start = np.cumsum(count) - count
        at = np.repeat(begin - start, count) + np.arange(count.sum())
        return self._next[at], count

    def _connect(self) -> None:
        """Find the rim of every front and where its children's rims lie in it."""
        local = np.zeros(self._count, dtype=np.int64)
        last = -1
        for front in self._fronts:
            last += len(front.own)
            rims = [self._fronts[child].rim for child in front.children]
            around = np.unique(np.concatenate([self._neighbours(front.own)[0], *rims]))
            around = around[self._rank[around] > last]
            front.rim = around[np.argsort(self._rank[around])]
            all_of = np.concatenate([front.own, front.rim])
            local[all_of] = np.arange(len(all_of))
            front.into = [self._unknown(local[rim]) for rim in rims]

    def _lay_out(self, rows: IntArray, columns: IntArray) -> None:
        """Give every front its part of the storage, every block its place there."""
        size = self._size
        wide = np.array([len(f.own) for f in self._fronts]) * size
        deep = np.array([len(f.rim) for f in self._fronts]) * size
        end = np.cumsum(wide * (wide + deep))
        self._storage = np.empty(end[-1])
        self._parts, self._unknowns = [], []
        for front, k, r, stop in zip(self._fronts, wide, deep, end, strict=True):
            middle = stop - k * r
            own = self._storage[middle - k * k : middle].reshape(k, k)
            self._parts.append((own, self._storage[middle:stop].reshape(k, r)))
            self._unknowns.append((self._unknown(front.own), self._unknown(front.rim)))
        turned = self._rank[rows] < self._rank[columns]
        low, high = np.where(turned, columns, rows), np.where(turned, rows, columns)
        where, pitch = np.empty(len(rows), dtype=np.int64), np.empty(len(rows), dtype=np.int64)
        front_of = np.empty(self._count, dtype=np.int64)
        front_of[np.concatenate([f.own for f in self._fronts])] = np.repeat(
            np.arange(len(wide)), wide // size
        )
        local = np.zeros(self._count, dtype=np.int64)
        order = np.argsort(front_of[high], kind="stable")
        cuts = np.searchsorted(front_of[high][order], np.arange(len(wide) + 1))
        for f, front in enumerate(self._fronts):
            local[front.own] = size * np.arange(len(front.own))
            local[front.rim] = size * np.arange(len(front.rim))
            mine = order[cuts[f] : cuts[f + 1]]
            inner = front_of[low[mine]] == f
            pitch[mine] = np.where(inner, wide[f], deep[f])
            start = end[f] - wide[f] * deep[f] - np.where(inner, wide[f] ** 2, 0)
            where[mine] = start + local[low[mine]] + local[high[mine]] * pitch[mine]
        self._places = (where, turned, pitch)

    def _unknown(self, vertices: IntArray) -> IntArray:
        """Unknowns of vertices."""
        return np.asarray((vertices[:, None] * self._size + np.arange(self._size)).ravel())
