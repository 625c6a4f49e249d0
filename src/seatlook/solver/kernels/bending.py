"""One symmetric scalar matrix: its assembly, and its quadratic form in the positions."""

import numpy as np
from numba import njit

from seatlook.solver.kernels.curvature import add_row, grown


@njit(cache=True)
def quadratic(start, columns, values, x, gradient):
    """Half of x . K x summed over the three axes; adds K x to ``gradient``.

    Rows of K sum to zero, so its upper triangle says all: every pair of vertices pulls on both
    alike. Differences also spare the rounding in which a small energy would drown, and the sum
    carries what it loses (Kahan 1965): rows of a triangle do not cancel, so it wanders far from
    where it ends.
    """
    total = carry = 0.0
    for i in range(len(start) - 1):
        x0, x1, x2 = x[i, 0], x[i, 1], x[i, 2]
        a = b = c = 0.0
        row = -carry
        for j in range(start[i], start[i + 1]):
            v, k = columns[j], values[j]
            d0, d1, d2 = x[v, 0] - x0, x[v, 1] - x1, x[v, 2] - x2
            row -= k * (d0 * d0 + d1 * d1 + d2 * d2)
            d0, d1, d2 = k * d0, k * d1, k * d2
            a += d0
            b += d1
            c += d2
            gradient[v, 0] -= d0
            gradient[v, 1] -= d1
            gradient[v, 2] -= d2
        gradient[i, 0] += a
        gradient[i, 1] += b
        gradient[i, 2] += c
        added = total + row
        carry = (added - total) - row
        total = added
    return 0.5 * total


@njit(cache=True)
def moments(count, of_face, faces, area, stiffness, jump, start, nodes, weights):
    """Rows of A D k of every triangle plus ``jump`` D times its jumps towards its neighbours."""
    room = 20 * len(of_face)
    begin = np.zeros(len(of_face) + 1, dtype=np.int64)
    columns, values = np.empty(room, dtype=np.int64), np.empty((room, 3))
    mark = np.full(count, -1, dtype=np.int64)
    D, own = np.empty((3, 3)), np.empty((3, 3))
    last = 0
    for t in range(len(of_face)):
        first, most = last, last + start[t + 1] - start[t]
        for k in range(3):
            s = faces[of_face[t, k], 0] + faces[of_face[t, k], 1] - t
            if s >= 0:
                most += start[s + 1] - start[s]
        while most > len(columns):
            columns, values = grown(columns), grown(values)
        for i in range(3):
            for j in range(3):
                own[i, j] = area[t] * stiffness[t, i, j]
        for k in range(3):
            e = of_face[t, k]
            if faces[e, 1] < 0:
                continue
            s = faces[e, 0] + faces[e, 1] - t
            for i in range(3):
                for j in range(3):
                    D[i, j] = 0.5 * jump[e] * (stiffness[t, i, j] + stiffness[s, i, j])
                    own[i, j] += D[i, j]
            last = _add_rows(
                D, -1.0, start[s], start[s + 1], nodes, weights, columns, values, first, last, mark
            )
        last = _add_rows(
            own, 1.0, start[t], start[t + 1], nodes, weights, columns, values, first, last, mark
        )
        begin[t + 1] = last
    return begin, columns[:last], values[:last]


@njit(cache=True, inline="always")
def _add_rows(D, sign, one, end, nodes, weights, columns, values, first, last, mark):
    for i in range(one, end):
        a, b, c = sign * weights[i, 0], sign * weights[i, 1], sign * weights[i, 2]
        last = add_row(
            columns,
            values,
            first,
            last,
            mark,
            nodes[i],
            D[0, 0] * a + D[0, 1] * b + D[0, 2] * c,
            D[1, 0] * a + D[1, 1] * b + D[1, 2] * c,
            D[2, 0] * a + D[2, 1] * b + D[2, 2] * c,
        )
    return last


@njit(cache=True)
def upper(count, start, nodes, weights, begin, columns, values):
    """Strictly upper triangle, compressed, of the sum over triangles of rows' times rows."""
    first = np.zeros(count + 1, dtype=np.int64)
    for i in range(len(nodes)):
        first[nodes[i] + 1] += 1
    for v in range(count):
        first[v + 1] += first[v]
    where, of = np.empty(len(nodes), dtype=np.int64), np.empty(len(nodes), dtype=np.int64)
    fill = first[:-1].copy()
    for t in range(len(start) - 1):
        for i in range(start[t], start[t + 1]):
            where[fill[nodes[i]]], of[fill[nodes[i]]] = i, t
            fill[nodes[i]] += 1
    out = np.zeros(count + 1, dtype=np.int32)
    room = 32 * count + 256
    to, entries = np.empty(room, dtype=np.int32), np.empty(room)
    total, mark = np.zeros(count), np.full(count, -1, dtype=np.int64)
    last = 0
    for v in range(count):
        while last + count > len(to):
            to, entries = grown(to), grown(entries)
        head = last
        for p in range(first[v], first[v + 1]):
            i, t = where[p], of[p]
            a, b, c = weights[i, 0], weights[i, 1], weights[i, 2]
            for j in range(begin[t], begin[t + 1]):
                u = columns[j]
                if u <= v:
                    continue
                if mark[u] != v:
                    mark[u] = v
                    total[u] = 0.0
                    to[last] = u
                    last += 1
                total[u] += a * values[j, 0] + b * values[j, 1] + c * values[j, 2]
        to[head:last].sort()
        for j in range(head, last):
            entries[j] = total[to[j]]
        out[v + 1] = last
    return out, to[:last], entries[:last]
