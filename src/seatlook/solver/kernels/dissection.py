"""Nested dissection of a graph: in which order to eliminate, and what touches what."""

import numpy as np
from numba import njit

COORDINATES = 5  # of a vertex, from as many far ones
SMOOTHED = 2  # times, so that a step of some edges is no step of the coordinates
AXES = 2  # along which cuts are tried
LEAF = 12  # vertices that are not cut any further
SIDE = 0.3  # of the vertices that each side of a cut has at least
TURNS = 30  # of the power method


@njit(cache=True)
def components(begin, near):
    """Vertices in connected groups, each walked breadth first, and where each group begins."""
    n = len(begin) - 1
    order, groups = np.empty(n, np.int64), np.empty(n + 1, np.int64)
    visited = np.zeros(n, np.bool_)
    tail, count = 0, 0
    for first in range(n):
        if visited[first]:
            continue
        groups[count] = head = tail
        count += 1
        visited[first] = True
        order[tail] = first
        tail += 1
        while head < tail:
            v = order[head]
            head += 1
            for e in range(begin[v], begin[v + 1]):
                w = near[e]
                if not visited[w]:
                    visited[w] = True
                    order[tail] = w
                    tail += 1
    groups[count] = n
    return order, groups[: count + 1].copy()


@njit(cache=True)
def coordinates(begin, near, order, groups):
    """Edges (n, k) between every vertex and some of its group that are far from each other."""
    n = len(begin) - 1
    out, mean = np.zeros((n, COORDINATES)), np.empty((n, COORDINATES))
    away, closest = np.empty(n, np.int64), np.full(n, n)
    queue = np.empty(n, np.int64)
    for g in range(len(groups) - 1):
        group = order[groups[g] : groups[g + 1]]
        far = group[-1]
        for k in range(COORDINATES):
            for v in group:
                away[v] = -1
            away[far], queue[0] = 0, far
            head, tail = 0, 1
            while head < tail:
                v = queue[head]
                head += 1
                for e in range(begin[v], begin[v + 1]):
                    w = near[e]
                    if away[w] < 0:
                        away[w] = away[v] + 1
                        queue[tail] = w
                        tail += 1
            for v in group:
                out[v, k] = away[v]
                closest[v] = min(closest[v], away[v])
                if closest[v] > closest[far]:
                    far = v
    for _ in range(SMOOTHED):
        for v in range(n):
            for k in range(COORDINATES):
                total = 0.0
                for e in range(begin[v], begin[v + 1]):
                    total += out[near[e], k]
                mean[v, k] = total / max(begin[v + 1] - begin[v], 1)
        out, mean = mean, out
    return out


@njit(cache=True)
def longest(points, vertices, out):
    """Fill ``out`` (a, k) with the axes along which vertices spread most, by the power method."""
    dim = points.shape[1]
    middle, spread, turned = np.zeros(dim), np.zeros((dim, dim)), np.empty(dim)
    for v in vertices:
        for a in range(dim):
            middle[a] += points[v, a] / len(vertices)
    for v in vertices:
        for a in range(dim):
            for b in range(dim):
                spread[a, b] += (points[v, a] - middle[a]) * (points[v, b] - middle[b])
    for k in range(len(out)):
        axis = out[k]
        axis[:] = spread[np.argmax(np.diag(spread))]
        size = 0.0
        for _ in range(TURNS):
            norm = 0.0
            for a in range(dim):
                norm += axis[a] * axis[a]
            if norm == 0.0:
                break
            size = 0.0
            for a in range(dim):
                turned[a] = 0.0
                for b in range(dim):
                    turned[a] += spread[a, b] * axis[b] / np.sqrt(norm)
                size += turned[a] * axis[a] / np.sqrt(norm)
            axis[:] = turned / max(size, 1e-300)
        for a in range(dim):
            for b in range(dim):
                spread[a, b] -= size * axis[a] * axis[b]


@njit(cache=True)
def count_beside(begin, near, order, place, before, after):
    """For every cut of ``order``, how many have neighbours across it: before it, after it."""
    n = len(order)
    before[: n + 1] = 0
    after[: n + 1] = 0
    for i in range(n):
        v = order[i]
        first, last = i, i
        for e in range(begin[v], begin[v + 1]):
            p = place[near[e]]
            if p >= 0:
                first, last = min(first, p), max(last, p)
        # After cuts from first + 1 to i, before cuts from i + 1 to last.
        after[first + 1] += 1
        after[i + 1] -= 1
        if last > i:
            before[i + 1] += 1
            before[last + 1] -= 1
    for s in range(1, n + 1):
        before[s] += before[s - 1]
        after[s] += after[s - 1]


@njit(cache=True)
def cut(begin, near, points, vertices, place, work):
    """Sort ``vertices`` into two parts and what separates them; return where each begins.

    A cut across the longest axes is taken that separates most by least: few vertices over the
    product of what it leaves on both sides. All vertices beside it on one side are taken out.
    """
    n = len(vertices)
    low, high = max(int(SIDE * n), 1), n - max(int(SIDE * n), 1)
    axes, key = np.empty((AXES, points.shape[1])), np.empty(n)
    longest(points, vertices, axes)
    best, at, is_before = np.inf, n // 2, True
    chosen = vertices.copy()
    for axis in axes:
        for i in range(n):
            key[i] = 0.0
            for a in range(len(axis)):
                key[i] += axis[a] * points[vertices[i], a]
        order = vertices[np.argsort(key, kind="mergesort")]
        for i in range(n):
            place[order[i]] = i
        count_beside(begin, near, order, place, work[0], work[1])
        for s in range(low, high + 1):
            for side in range(2):
                size = work[side, s]
                one, other = s, n - s
                if side == 0:
                    one -= size
                else:
                    other -= size
                score = (size + 0.5) / (one * other + 0.5)
                if score < best:
                    best, at, is_before = score, s, side == 0
                    chosen[:] = order
    for i in range(n):
        place[chosen[i]] = i
    first, second, third = 0, 0, 0
    for i in range(n):
        v, beside = chosen[i], False
        if (i < at) == is_before:
            for e in range(begin[v], begin[v + 1]):
                p = place[near[e]]
                beside |= p >= 0 and (p >= at) == is_before
        if beside:
            work[1, third] = v
            third += 1
        elif i < at:
            vertices[first] = v
            first += 1
        else:
            work[0, second] = v
            second += 1
    vertices[first : first + second] = work[0, :second]
    vertices[first + second :] = work[1, :third]
    place[chosen] = -1
    return first, first + second


@njit(cache=True)
def dissect(begin, near):
    """Order of elimination, where each front's own vertices begin in it, and its children.

    Children come before their parent, the last of them right before it.
    """
    n = len(begin) - 1
    order, groups = components(begin, near)
    points = coordinates(begin, near, order, groups)
    place, work = np.full(n, -1), np.empty((2, n + 2), np.int64)
    starts, children = np.empty(2 * n + 2, np.int64), np.zeros(2 * n + 2, np.int64)
    stack = np.empty((2 * n + 2, 3), np.int64)
    count, top = 0, len(groups) - 1
    for g in range(top):
        stack[g] = np.array([groups[top - 1 - g], groups[top - g], -1])
    while top > 0:
        top -= 1
        low, high, own = stack[top]
        if own >= 0:
            starts[count], children[count] = own, 2
            count += 1
        elif high - low <= LEAF:
            starts[count] = low
            count += 1
        else:
            middle, end = cut(begin, near, points, order[low:high], place, work)
            stack[top] = np.array([low, high, low + end])
            stack[top + 1] = np.array([low + middle, low + end, -1])
            stack[top + 2] = np.array([low, low + middle, -1])
            top += 3
    starts[count] = n
    return order, starts[: count + 1].copy(), children[:count].copy()


@njit(cache=True)
def rims(begin, near, order, starts, children):
    """Places in the order of the later vertices that each front touches, sorted; their begins."""
    n, count = len(order), len(children)
    rank, mark = np.empty(n, np.int64), np.full(n, -1)
    rank[order] = np.arange(n)
    at, stack = np.zeros(count + 1, np.int64), np.empty(count + 1, np.int64)
    rim = np.empty(4 * n + 64, np.int64)
    top = 0
    for f in range(count):
        low = end = at[f]
        last = starts[f + 1]
        if low + n > len(rim):
            longer = np.empty(2 * len(rim) + n, np.int64)
            longer[:low] = rim[:low]
            rim = longer
        for v in order[starts[f] : last]:
            for e in range(begin[v], begin[v + 1]):
                r = rank[near[e]]
                if r >= last and mark[r] != f:
                    mark[r], rim[end] = f, r
                    end += 1
        for _ in range(children[f]):
            top -= 1
            for k in range(at[stack[top]], at[stack[top] + 1]):
                r = rim[k]
                if r >= last and mark[r] != f:
                    mark[r], rim[end] = f, r
                    end += 1
        rim[low:end].sort()
        at[f + 1] = end
        stack[top] = f
        top += 1
    return at, rim[: at[count]].copy()
