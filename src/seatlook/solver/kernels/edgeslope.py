"""Stencils and least-squares slope rows, one edge at a time."""

import numpy as np
from numba import njit

PATCH, ONE_RING, TWO_RING = 0, 1, 2

RIDGE = 0.02


@njit(cache=True)
def stencils(edges, patch, reach, ring_start, ring):
    """Nodes of every edge, its ends first: those of ``patch`` or the rings of both ends."""
    n_edges = len(edges)
    mark = np.full(len(ring_start) - 1, -1, dtype=np.int64)
    start = np.zeros(n_edges + 1, dtype=np.int64)
    nodes = np.empty(16 * n_edges + 256, dtype=np.int64)
    count = 0
    for e in range(n_edges):
        first = count
        if count + len(mark) + 8 > len(nodes):
            grown = np.empty(2 * len(nodes) + len(mark), dtype=np.int64)
            grown[:count] = nodes[:count]
            nodes = grown
        for k in range(2):
            nodes[count] = edges[e, k]
            mark[edges[e, k]] = e
            count += 1
        if reach[e] == PATCH:
            for k in range(patch.shape[1]):
                v = patch[e, k]
                if v >= 0 and mark[v] != e:
                    mark[v] = e
                    nodes[count] = v
                    count += 1
        else:
            begin = first
            for _ in range(reach[e]):
                last = count
                for i in range(begin, last):
                    for j in range(ring_start[nodes[i]], ring_start[nodes[i] + 1]):
                        v = ring[j]
                        if mark[v] != e:
                            mark[v] = e
                            nodes[count] = v
                            count += 1
                begin = last
        start[e + 1] = count
    return start, nodes[:count].copy()


@njit(cache=True)
def fit(X, edges, start, nodes, weights):
    """Fill the rows of the mean conormal slope; return how well each fit's quadratic is held.

    The quadratic passes through both ends; of its four free terms (ss, sn, nn, n) the slope is
    orthogonalised last, so that the row is that column's remainder over its squared norm. What
    is returned is the smallest such norm over the largest.
    """
    quality = np.empty(len(edges))
    longest = 0
    for e in range(len(edges)):
        longest = max(longest, start[e + 1] - start[e])
    A, C = np.empty((4, longest)), np.empty((4, longest))
    root, row = np.empty(longest), np.empty(longest)
    along, across = np.empty(longest), np.empty(longest)
    norms, bias, S = np.empty(4), np.empty(4), np.empty((4, 4))
    for e in range(len(edges)):
        p, q = edges[e, 0], edges[e, 1]
        d0, d1 = X[q, 0] - X[p, 0], X[q, 1] - X[p, 1]
        length = np.sqrt(d0 * d0 + d1 * d1)
        t0, t1 = d0 / length, d1 / length
        m0, m1 = 0.5 * (X[p, 0] + X[q, 0]), 0.5 * (X[p, 1] + X[q, 1])
        k = start[e + 1] - start[e] - 2
        for i in range(k):
            v = nodes[start[e] + 2 + i]
            r0, r1 = (X[v, 0] - m0) / length, (X[v, 1] - m1) / length
            s, n = r0 * t0 + r1 * t1, r0 * t1 - r1 * t0
            along[i], across[i] = s, n
            w = np.sqrt(1.0 / (r0 * r0 + r1 * r1 + 0.05))
            root[i] = w
            A[0, i], A[1, i] = w * 0.5 * (s * s - 0.25), w * s * n
            A[2, i], A[3, i] = w * 0.5 * n * n, w * n
            # Cubics without a mean slope across the edge, zero at its ends.
            C[0, i], C[1, i] = w * s * (s * s - 0.25) / 6.0, w * n * (s * s - 1.0 / 12.0) / 2.0
            C[2, i], C[3, i] = w * s * n * n / 2.0, w * n * n * n / 6.0
        quality[e] = _orthogonalise(A, norms, k)
        if norms[3] > 0.0:
            for i in range(k):
                row[i] = A[3, i] / (norms[3] * norms[3])
            _clear_cubics(A, C, norms, k, row, bias, S)
        else:
            # Too few nodes for a quadratic: a plain average, exact for planes.
            total = 0.0
            for i in range(k):
                row[i] = root[i] * across[i]
                total += row[i] * row[i]
            for i in range(k):
                row[i] /= total
        out = weights[start[e] : start[e + 1]]
        out[0] = 0.0
        out[1] = 0.0
        for i in range(k):
            c = root[i] * row[i] / length
            out[2 + i] = c
            out[0] -= c * (0.5 - along[i])
            out[1] -= c * (0.5 + along[i])
    return quality


@njit(cache=True)
def _clear_cubics(A, C, norms, k, row, bias, S):
    """Take out of ``row`` what cubics put into it, as far as the nodes tell cubics from quadratics.

    Least squares in which the four cubic terms, scaled by the edge, are held near zero by
    ``RIDGE``: where the nodes leave one of them open it stays out of the slope.
    """
    for j in range(4):
        bias[j] = 0.0
        for i in range(k):
            bias[j] += row[i] * C[j, i]
        for c in range(4):
            if norms[c] == 0.0:
                continue
            dot = 0.0
            for i in range(k):
                dot += C[j, i] * A[c, i]
            dot /= norms[c] * norms[c]
            for i in range(k):
                C[j, i] -= dot * A[c, i]
    for j in range(4):
        for c in range(j + 1):
            dot = RIDGE if c == j else 0.0
            for i in range(k):
                dot += C[j, i] * C[c, i]
            for b in range(c):
                dot -= S[j, b] * S[c, b]
            S[j, c] = dot / S[c, c] if c < j else np.sqrt(dot)
        for c in range(j):
            bias[j] -= S[j, c] * bias[c]
        bias[j] /= S[j, j]
    for j in range(3, -1, -1):
        for c in range(j + 1, 4):
            bias[j] -= S[c, j] * bias[c]
        bias[j] /= S[j, j]
        for i in range(k):
            row[i] -= bias[j] * C[j, i]


@njit(cache=True)
def _orthogonalise(A, norms, k):
    """Gram-Schmidt, twice, over the rows of A; rows that vanish are dropped."""
    largest = 0.0
    for r in range(4):
        before = 0.0
        for i in range(k):
            before += A[r, i] * A[r, i]
        for _ in range(2):
            for c in range(r):
                if norms[c] == 0.0:
                    continue
                dot = 0.0
                for i in range(k):
                    dot += A[r, i] * A[c, i]
                dot /= norms[c] * norms[c]
                for i in range(k):
                    A[r, i] -= dot * A[c, i]
        after = 0.0
        for i in range(k):
            after += A[r, i] * A[r, i]
        norms[r] = np.sqrt(after) if after > 1e-10 * before else 0.0
        largest = max(largest, norms[r])
    return norms.min() / largest
