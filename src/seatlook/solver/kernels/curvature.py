"""Second derivatives of every triangle as rows over vertices, and what is built from them.

Rows are compressed: those of triangle t are ``weights[start[t] : start[t + 1]]``, one column for
each of (x,11  x,22  2 x,12), over ``nodes`` in the same places.
"""

import numpy as np
from numba import njit


@njit(cache=True, inline="always")
def add_row(nodes, weights, first, last, mark, node, a, b, c):
    """Add (a, b, c) at ``node`` to the rows that began at ``first``; return where they end."""
    at = mark[node]
    if at < first:
        at = last
        mark[node] = at
        nodes[at] = node
        weights[at, 0] = weights[at, 1] = weights[at, 2] = 0.0
        last += 1
    weights[at, 0] += a
    weights[at, 1] += b
    weights[at, 2] += c
    return last


@njit(cache=True)
def grown(array):
    """Copy of an array with room for as many rows again."""
    return np.concatenate((array, np.empty_like(array)))


@njit(cache=True)
def triangles(count, ends, of_face, sign, length, normal, area, held, slope):
    """Rows of every triangle by Green's theorem, 1/A sum l sym(nu (x) grad).

    ``slope`` holds start, nodes and weights of the conormal slopes; ``held`` edges leave it out.
    """
    begin, from_nodes, by = slope
    start = np.zeros(len(of_face) + 1, dtype=np.int64)
    room = 13 * len(of_face)
    nodes, weights = np.empty(room, dtype=np.int64), np.empty((room, 3))
    mark = np.full(count, -1, dtype=np.int64)
    last = 0
    for t in range(len(of_face)):
        first, most = last, last + 6
        for k in range(3):
            most += begin[of_face[t, k] + 1] - begin[of_face[t, k]]
        while most > len(nodes):
            nodes, weights = grown(nodes), grown(weights)
        for k in range(3):
            e = of_face[t, k]
            n0, n1 = normal[e, 0], normal[e, 1]
            scale = sign[t, k] * length[e] / area[t]
            a, b, c = scale * n0 * n0, scale * n1 * n1, scale * 2.0 * n0 * n1
            if not held[e]:
                for i in range(begin[e], begin[e + 1]):
                    w, v = by[i], from_nodes[i]
                    last = add_row(nodes, weights, first, last, mark, v, w * a, w * b, w * c)
            # Along the edge, tau = (-nu_2, nu_1).
            a = sign[t, k] / area[t] * n0 * n1
            c = sign[t, k] / area[t] * (n0 * n0 - n1 * n1)
            last = add_row(nodes, weights, first, last, mark, ends[e, 1], -a, a, c)
            last = add_row(nodes, weights, first, last, mark, ends[e, 0], a, -a, -c)
        start[t + 1] = last
    return start, nodes[:last], weights[:last]


@njit(cache=True)
def apply(start, nodes, weights, x, out):
    """Add the derivatives (m, 3, 3) at positions x to ``out``."""
    for t in range(len(start) - 1):
        for i in range(start[t], start[t + 1]):
            for c in range(3):
                for axis in range(3):
                    out[t, c, axis] += weights[i, c] * x[nodes[i], axis]


@njit(cache=True)
def apply_back(start, nodes, weights, values, out):
    """Add the transposed rows times values (m, 3, 3) to ``out`` (n, 3)."""
    for t in range(len(start) - 1):
        for i in range(start[t], start[t + 1]):
            for c in range(3):
                for axis in range(3):
                    out[nodes[i], axis] += weights[i, c] * values[t, c, axis]


@njit(cache=True)
def along_edges(count, faces, normal, start, nodes, weights):
    """Rows of the second derivative along every edge, the mean of that in its triangles."""
    room = 17 * len(faces)
    begin = np.zeros(len(faces) + 1, dtype=np.int32)
    columns, values = np.empty(room, dtype=np.int32), np.empty(room)
    mark = np.full(count, -1, dtype=np.int64)
    last = 0
    for e in range(len(faces)):
        first = last
        most = last + start[faces[e, 0] + 1] - start[faces[e, 0]]
        if faces[e, 1] >= 0:
            most += start[faces[e, 1] + 1] - start[faces[e, 1]]
        while most > len(columns):
            columns, values = grown(columns), grown(values)
        share = 0.5 if faces[e, 1] >= 0 else 1.0
        a, b = share * normal[e, 1] ** 2, share * normal[e, 0] ** 2
        c = -share * normal[e, 0] * normal[e, 1]
        for s in range(2):
            t = faces[e, s]
            if t < 0:
                continue
            for i in range(start[t], start[t + 1]):
                v = nodes[i]
                w = a * weights[i, 0] + b * weights[i, 1] + c * weights[i, 2]
                at = mark[v]
                if at < first:
                    mark[v] = at = last
                    columns[at] = v
                    values[at] = 0.0
                    last += 1
                values[at] += w
        begin[e + 1] = last
    return begin, columns[:last], values[:last]
