"""Stencils, least-squares slope rows and their patch-test correction, one edge at a time."""

import numpy as np
from numba import njit

PATCH, ONE_RING, TWO_RING = 0, 1, 2


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
            done = first
            for _ in range(reach[e]):
                last = count
                for i in range(done, last):
                    for j in range(ring_start[nodes[i]], ring_start[nodes[i] + 1]):
                        v = ring[j]
                        if mark[v] != e:
                            mark[v] = e
                            nodes[count] = v
                            count += 1
                done = last
        start[e + 1] = count
    return start, nodes[:count].copy()


@njit(cache=True)
def fit(X, edges, start, nodes, weights):
    """Fill the conormal-slope rows; return the smallest pivot over the largest of each fit.

    The quadratic passes through both ends; of its four free terms (ss, sn, nn, n) the slope is
    orthogonalised last, so that the row is that column's remainder over its squared norm.
    """
    quality = np.empty(len(edges))
    longest = 0
    for e in range(len(edges)):
        longest = max(longest, start[e + 1] - start[e])
    A = np.empty((4, longest))
    root = np.empty(longest)
    norms = np.empty(4)
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
            w = np.sqrt(1.0 / (r0 * r0 + r1 * r1 + 0.05))
            root[i] = w
            A[0, i], A[1, i] = w * 0.5 * (s * s - 0.25), w * s * n
            A[2, i], A[3, i] = w * 0.5 * n * n, w * n
        quality[e] = _orthogonalise(A, norms, k)
        if norms[3] == 0.0:
            # Too few nodes for a quadratic: a plain average, exact for planes.
            for i in range(k):
                v = nodes[start[e] + 2 + i]
                A[3, i] = root[i] * ((X[v, 0] - m0) * t1 - (X[v, 1] - m1) * t0) / length
                norms[3] += A[3, i] ** 2
            norms[3] = np.sqrt(norms[3])
        row = weights[start[e] : start[e + 1]]
        row[0] = 0.0
        row[1] = 0.0
        scale = 1.0 / (norms[3] * norms[3] * length)
        for i in range(k):
            v = nodes[start[e] + 2 + i]
            s = ((X[v, 0] - m0) * t0 + (X[v, 1] - m1) * t1) / length
            c = root[i] * A[3, i] * scale
            row[2 + i] = c
            row[0] -= c * (0.5 - s)
            row[1] -= c * (0.5 + s)
    return quality


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


@njit(cache=True)
def quadratics(X, edges, start, nodes, basis):
    """Orthonormal basis (nnz, 6) of the quadratic polynomials on every stencil."""
    for e in range(len(edges)):
        p, q = edges[e, 0], edges[e, 1]
        m0, m1 = 0.5 * (X[p, 0] + X[q, 0]), 0.5 * (X[p, 1] + X[q, 1])
        scale = 1.0 / np.sqrt((X[q, 0] - X[p, 0]) ** 2 + (X[q, 1] - X[p, 1]) ** 2)
        B = basis[start[e] : start[e + 1]]
        for i in range(len(B)):
            v = nodes[start[e] + i]
            a, b = (X[v, 0] - m0) * scale, (X[v, 1] - m1) * scale
            B[i, 0], B[i, 1], B[i, 2] = 1.0, a, b
            B[i, 3], B[i, 4], B[i, 5] = a * a, a * b, b * b
        for r in range(6):
            before = 0.0
            for i in range(len(B)):
                before += B[i, r] * B[i, r]
            for _ in range(2):
                for c in range(r):
                    dot = 0.0
                    for i in range(len(B)):
                        dot += B[i, r] * B[i, c]
                    for i in range(len(B)):
                        B[i, r] -= dot * B[i, c]
            after = 0.0
            for i in range(len(B)):
                after += B[i, r] * B[i, r]
            # A stencil of six nodes or fewer spans no more: a dropped column binds nothing.
            factor = 1.0 / np.sqrt(after) if after > 1e-10 * before else 0.0
            for i in range(len(B)):
                B[i, r] *= factor


@njit(cache=True)
def balance(start, nodes, basis, lever, target, sweeps, tolerance):
    """Least-norm change of the rows that closes the nodal forces, by conjugate gradients (CGLS).

    ``lever`` (q, 2) is what a unit weight of a row adds to a node, ``target`` (n, 2) what is
    missing there. Only changes that leave quadratics exact are taken.
    """
    change = np.zeros(len(nodes))
    residual = target.copy()
    normal = np.empty(len(nodes))
    _pull(start, nodes, basis, lever, residual, normal)
    search = normal.copy()
    image = np.empty_like(target)
    size = (normal * normal).sum()
    goal = tolerance * tolerance * (target * target).sum()
    for _ in range(sweeps):
        if (residual * residual).sum() <= goal or size == 0.0:
            break
        image[:] = 0.0
        for e in range(len(start) - 1):
            for i in range(start[e], start[e + 1]):
                image[nodes[i], 0] += lever[e, 0] * search[i]
                image[nodes[i], 1] += lever[e, 1] * search[i]
        step = size / (image * image).sum()
        change += step * search
        residual -= step * image
        _pull(start, nodes, basis, lever, residual, normal)
        fresh = (normal * normal).sum()
        search *= fresh / size
        search += normal
        size = fresh
    return change


@njit(cache=True)
def _pull(start, nodes, basis, lever, residual, out):
    """Transpose of the nodal sum, projected off the quadratics."""
    dots = np.empty(6)
    for e in range(len(start) - 1):
        dots[:] = 0.0
        for i in range(start[e], start[e + 1]):
            v = nodes[i]
            y = lever[e, 0] * residual[v, 0] + lever[e, 1] * residual[v, 1]
            out[i] = y
            for r in range(6):
                dots[r] += y * basis[i, r]
        for i in range(start[e], start[e + 1]):
            for r in range(6):
                out[i] -= dots[r] * basis[i, r]
