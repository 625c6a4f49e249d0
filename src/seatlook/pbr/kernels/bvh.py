"""Bounding volume hierarchy over triangles: binned surface-area build, two ray queries."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from numba import njit

from seatlook.pbr.kernels import leaf

_BINS = 16
_LEAF = 4
_DEPTH = 90


class Bvh(NamedTuple):
    """Nodes in pairs of siblings, and triangles in leaf order.

    ``low, high`` (k, 3); ``first, size`` (k,): ``size`` is 0 for an inner node, whose children
    are ``first`` and ``first + 1``; ``corner, edge1, edge2`` (m, 3); ``face`` (m,).
    """

    low: npt.NDArray[np.float64]
    high: npt.NDArray[np.float64]
    first: npt.NDArray[np.int64]
    size: npt.NDArray[np.int64]
    corner: npt.NDArray[np.float64]
    edge1: npt.NDArray[np.float64]
    edge2: npt.NDArray[np.float64]
    face: npt.NDArray[np.int64]


def build(vertices: npt.NDArray[np.float64], faces: npt.NDArray[np.int64]) -> Bvh:
    """Build the hierarchy of ``vertices`` (n, 3) and ``faces`` (m, 3), m >= 1."""
    corners = vertices[faces]
    low, high, first, count, order = _build(corners.min(axis=1), corners.max(axis=1))
    return Bvh(low, high, first, count, *_edges(corners[order]), order)


def moved(tree: Bvh, vertices: npt.NDArray[np.float64], faces: npt.NDArray[np.int64]) -> Bvh:
    """The same hierarchy round the same triangles in places a little off: only boxes are new."""
    a = vertices[faces[tree.face]]
    low, high = np.empty_like(tree.low), np.empty_like(tree.high)
    _fit(tree.first, tree.size, a.min(axis=1), a.max(axis=1), low, high)
    return Bvh(low, high, tree.first, tree.size, *_edges(a), tree.face)


def _edges(
    a: npt.NDArray[np.float64],
) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    """First corner and two edges of triangles (m, 3, 3), each (m, 3)."""
    corner = np.ascontiguousarray(a[:, 0])
    return corner, a[:, 1] - corner, a[:, 2] - corner


@leaf()
def _grow(low, high, box_low, box_high):
    for k in range(3):
        low[k] = min(low[k], box_low[k])
        high[k] = max(high[k], box_high[k])


@leaf()
def _half_area(low, high):
    x, y, z = high[0] - low[0], high[1] - low[1], high[2] - low[2]
    return x * y + y * z + z * x


@njit(cache=True)
def _best_split(order, start, stop, centre, low, high, axis, c0, scale):
    """Cheapest plane among the bins of one axis: (cost, bin); Wald 2007."""
    n = np.zeros(_BINS, np.int64)
    bl = np.full((_BINS, 3), np.inf)
    bh = np.full((_BINS, 3), -np.inf)
    for i in range(start, stop):
        f = order[i]
        b = min(_BINS - 1, int((centre[f, axis] - c0) * scale))
        n[b] += 1
        _grow(bl[b], bh[b], low[f], high[f])
    right = np.zeros(_BINS)
    rl, rh, count = np.full(3, np.inf), np.full(3, -np.inf), 0
    for b in range(_BINS - 1, 0, -1):
        count += n[b]
        _grow(rl, rh, bl[b], bh[b])
        right[b] = count * _half_area(rl, rh) if count else np.inf
    ll, lh, count = np.full(3, np.inf), np.full(3, -np.inf), 0
    best, where = np.inf, -1
    for b in range(_BINS - 1):
        count += n[b]
        _grow(ll, lh, bl[b], bh[b])
        if count:
            cost = count * _half_area(ll, lh) + right[b + 1]
            if cost < best:
                best, where = cost, b
    return best, where


@leaf()
def _partition(order, start, stop, centre, axis, c0, scale, where):
    i, j = start, stop
    while i < j:
        if min(_BINS - 1, int((centre[order[i], axis] - c0) * scale)) <= where:
            i += 1
        else:
            j -= 1
            order[i], order[j] = order[j], order[i]
    return i


@njit(cache=True)
def _build(low, high):
    m = len(low)
    centre = 0.5 * (low + high)
    order = np.arange(m)
    node_low = np.empty((2 * m, 3))
    node_high = np.empty((2 * m, 3))
    first = np.zeros(2 * m, np.int64)
    count = np.zeros(2 * m, np.int64)
    todo = [(0, 0, m, 0)]
    used = 2  # slot 1 stays empty so that siblings share a cache line
    node_low[1], node_high[1] = np.inf, -np.inf
    while len(todo):
        node, start, stop, depth = todo.pop()
        cl, ch = np.full(3, np.inf), np.full(3, -np.inf)
        node_low[node], node_high[node] = np.inf, -np.inf
        for i in range(start, stop):
            f = order[i]
            _grow(node_low[node], node_high[node], low[f], high[f])
            _grow(cl, ch, centre[f], centre[f])
        first[node], count[node] = start, stop - start
        axis = np.argmax(ch - cl)
        if stop - start <= _LEAF or ch[axis] <= cl[axis] or depth == _DEPTH:
            continue
        scale = _BINS / (ch[axis] - cl[axis])
        _, where = _best_split(order, start, stop, centre, low, high, axis, cl[axis], scale)
        middle = _partition(order, start, stop, centre, axis, cl[axis], scale, where)
        if middle in (start, stop):
            continue
        first[node], count[node] = used, 0
        todo.append((used, start, middle, depth + 1))
        todo.append((used + 1, middle, stop, depth + 1))
        used += 2
    # Copies: there are far fewer nodes than the room that was taken for them.
    nodes = node_low[:used].copy(), node_high[:used].copy()
    return (*nodes, first[:used].copy(), count[:used].copy(), order)


@njit(cache=True)
def _fit(first, size, tri_low, tri_high, low, high):
    """Boxes of all nodes from those of the triangles in leaf order; children come after parents."""
    low[:], high[:] = np.inf, -np.inf
    for node in range(len(first) - 1, -1, -1):
        if size[node]:
            for i in range(first[node], first[node] + size[node]):
                _grow(low[node], high[node], tri_low[i], tri_high[i])
        elif first[node]:  # slot 1 is empty
            for child in (first[node], first[node] + 1):
                _grow(low[node], high[node], low[child], high[child])


@leaf()
def _enter(bvh, node, ox, oy, oz, ix, iy, iz, far):
    """Distance at which the ray enters the node's box, or infinity."""
    t1, t2 = (bvh.low[node, 0] - ox) * ix, (bvh.high[node, 0] - ox) * ix
    near, end = min(t1, t2), max(t1, t2)
    t1, t2 = (bvh.low[node, 1] - oy) * iy, (bvh.high[node, 1] - oy) * iy
    near, end = max(near, min(t1, t2)), min(end, max(t1, t2))
    t1, t2 = (bvh.low[node, 2] - oz) * iz, (bvh.high[node, 2] - oz) * iz
    near, end = max(near, min(t1, t2)), min(end, max(t1, t2))
    return near if end >= max(near, 0.0) and near < far else np.inf


@leaf()
def _triangle(bvh, i, ox, oy, oz, dx, dy, dz):
    """Distance, and weights of the second and third corner; Moeller and Trumbore 1997."""
    ax, ay, az = bvh.edge1[i, 0], bvh.edge1[i, 1], bvh.edge1[i, 2]
    bx, by, bz = bvh.edge2[i, 0], bvh.edge2[i, 1], bvh.edge2[i, 2]
    px, py, pz = dy * bz - dz * by, dz * bx - dx * bz, dx * by - dy * bx
    det = ax * px + ay * py + az * pz
    if det == 0.0:
        return np.inf, 0.0, 0.0
    inv = 1.0 / det
    sx, sy, sz = ox - bvh.corner[i, 0], oy - bvh.corner[i, 1], oz - bvh.corner[i, 2]
    u = (sx * px + sy * py + sz * pz) * inv
    if u < 0.0 or u > 1.0:
        return np.inf, 0.0, 0.0
    qx, qy, qz = sy * az - sz * ay, sz * ax - sx * az, sx * ay - sy * ax
    v = (dx * qx + dy * qy + dz * qz) * inv
    if v < 0.0 or u + v > 1.0:
        return np.inf, 0.0, 0.0
    return (bx * qx + by * qy + bz * qz) * inv, u, v


@leaf()
def _inverse(d):
    """Reciprocal that keeps slab products free of 0 times infinity."""
    return 1.0 / d if abs(d) > 1e-12 else np.copysign(1e12, d)


@leaf()
def occluded(bvh, ox, oy, oz, dx, dy, dz, near, far, stack):
    """Whether anything lies on the ray between ``near`` and ``far``.

    Neighbours hide behind the same triangle: the one that hid the last ray is tried first.
    """
    if stack[-1] >= 0:
        t, _, _ = _triangle(bvh, stack[-1], ox, oy, oz, dx, dy, dz)
        if near < t < far:
            return True
    ix, iy, iz = _inverse(dx), _inverse(dy), _inverse(dz)
    top = 1
    stack[0] = 0
    while top:
        top -= 1
        node = stack[top]
        n = bvh.size[node]
        if n == 0:
            left = bvh.first[node]
            a = _enter(bvh, left, ox, oy, oz, ix, iy, iz, far)
            b = _enter(bvh, left + 1, ox, oy, oz, ix, iy, iz, far)
            if a < np.inf:
                stack[top] = left
                top += 1
            if b < np.inf:
                stack[top] = left + 1
                top += 1
            continue
        for i in range(bvh.first[node], bvh.first[node] + n):
            t, _, _ = _triangle(bvh, i, ox, oy, oz, dx, dy, dz)
            if near < t < far:
                stack[-1] = i
                return True
    return False


@leaf()
def hidden_at(bvh, ox, oy, oz, dx, dy, dz, stack):
    """Distance at which the triangle that :func:`occluded` found last crosses the same ray."""
    t, _, _ = _triangle(bvh, stack[-1], ox, oy, oz, dx, dy, dz)
    return t


@leaf()
def nearest(bvh, ox, oy, oz, dx, dy, dz, near, stack):
    """First triangle on the ray: (index in leaf order or -1, distance, weight, weight)."""
    ix, iy, iz = _inverse(dx), _inverse(dy), _inverse(dz)
    best, far, bu, bv = -1, np.inf, 0.0, 0.0
    top = 1
    stack[0] = 0
    while top:
        top -= 1
        node = stack[top]
        n = bvh.size[node]
        if n == 0:
            left = bvh.first[node]
            a = _enter(bvh, left, ox, oy, oz, ix, iy, iz, far)
            b = _enter(bvh, left + 1, ox, oy, oz, ix, iy, iz, far)
            far_first = a < b
            if far_first and b < np.inf:
                stack[top] = left + 1
                top += 1
            if a < np.inf:
                stack[top] = left
                top += 1
            if not far_first and b < np.inf:
                stack[top] = left + 1
                top += 1
            continue
        for i in range(bvh.first[node], bvh.first[node] + n):
            t, u, v = _triangle(bvh, i, ox, oy, oz, dx, dy, dz)
            if near < t < far:
                best, far, bu, bv = i, t, u, v
    return best, far, bu, bv


@njit(cache=True)
def new_stack():
    """Scratch for the rays of one tree: an entry waits on each level, and one is in hand.

    The last one is the triangle that hid a ray, -1 before any has.
    """
    return np.full(_DEPTH + 3, -1)
