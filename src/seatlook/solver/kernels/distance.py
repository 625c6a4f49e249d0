"""Distance from a triangle surface on a grid, and its cubic B-spline."""

from __future__ import annotations

import math

import numpy as np
from numba import njit


@njit(cache=True)
def triangle_distance2(p, a, b, c):
    """Squared distance from point ``p`` to triangle abc (Ericson 2005, section 5.1.5)."""
    ab0, ab1, ab2 = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    ac0, ac1, ac2 = c[0] - a[0], c[1] - a[1], c[2] - a[2]
    ap0, ap1, ap2 = p[0] - a[0], p[1] - a[1], p[2] - a[2]
    d1 = ab0 * ap0 + ab1 * ap1 + ab2 * ap2
    d2 = ac0 * ap0 + ac1 * ap1 + ac2 * ap2
    bb = ab0 * ab0 + ab1 * ab1 + ab2 * ab2
    bc = ab0 * ac0 + ab1 * ac1 + ab2 * ac2
    cc = ac0 * ac0 + ac1 * ac1 + ac2 * ac2
    d3, d4 = d1 - bb, d2 - bc
    d5, d6 = d1 - bc, d2 - cc
    va, vb, vc = d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2
    if d1 <= 0.0 and d2 <= 0.0:
        v, w = 0.0, 0.0
    elif d3 >= 0.0 and d4 <= d3:
        v, w = 1.0, 0.0
    elif d6 >= 0.0 and d5 <= d6:
        v, w = 0.0, 1.0
    elif vc <= 0.0 and d1 >= 0.0 and d3 <= 0.0:
        v, w = d1 / (d1 - d3), 0.0
    elif vb <= 0.0 and d2 >= 0.0 and d6 <= 0.0:
        v, w = 0.0, d2 / (d2 - d6)
    elif va <= 0.0 and d4 - d3 >= 0.0 and d5 - d6 >= 0.0:
        w = (d4 - d3) / ((d4 - d3) + (d5 - d6))
        v = 1.0 - w
    else:
        v, w = vb / (va + vb + vc), vc / (va + vb + vc)
    r0 = ap0 - v * ab0 - w * ac0
    r1 = ap1 - v * ab1 - w * ac1
    r2 = ap2 - v * ab2 - w * ac2
    return r0 * r0 + r1 * r1 + r2 * r2


@njit(cache=True)
def fill_band(vertices, faces, grid, band, distance2, nearest):
    """Exact squared distance and nearest face at nodes up to ``band`` cells from a face."""
    p = np.empty(3)
    low, high = np.empty(3, np.int64), np.empty(3, np.int64)
    for f in range(len(faces)):
        a, b, c = vertices[faces[f, 0]], vertices[faces[f, 1]], vertices[faces[f, 2]]
        for d in range(3):
            least, most = min(a[d], b[d], c[d]), max(a[d], b[d], c[d])
            low[d] = max(int(math.ceil((least - grid[d]) / grid[3] - band)), 0)
            high[d] = min(
                int(math.floor((most - grid[d]) / grid[3] + band)), distance2.shape[d] - 1
            )
        for i in range(low[0], high[0] + 1):
            p[0] = grid[0] + i * grid[3]
            for j in range(low[1], high[1] + 1):
                p[1] = grid[1] + j * grid[3]
                for k in range(low[2], high[2] + 1):
                    p[2] = grid[2] + k * grid[3]
                    d2 = triangle_distance2(p, a, b, c)
                    if d2 < distance2[i, j, k]:
                        distance2[i, j, k] = d2
                        nearest[i, j, k] = f


@njit(cache=True)
def improve(vertices, faces, grid, distance2, nearest, far, before, changed):
    """Let nodes outside the band (``far``) try the nearest faces of their neighbours.

    Only where one of them has changed since, in the pass ``before`` or in this one.
    """
    p = np.empty(3)
    nx, ny, nz = nearest.shape
    for i in range(nx):
        p[0] = grid[0] + i * grid[3]
        for j in range(ny):
            p[1] = grid[1] + j * grid[3]
            for k in range(nz):
                if not far[i, j, k]:
                    continue
                if not (
                    before[i, j, k]
                    or before[max(i - 1, 0), j, k]
                    or before[min(i + 1, nx - 1), j, k]
                    or before[i, max(j - 1, 0), k]
                    or before[i, min(j + 1, ny - 1), k]
                    or before[i, j, max(k - 1, 0)]
                    or before[i, j, min(k + 1, nz - 1)]
                    or changed[max(i - 1, 0), j, k]
                    or changed[i, max(j - 1, 0), k]
                    or changed[i, j, max(k - 1, 0)]
                ):
                    continue
                p[2] = grid[2] + k * grid[3]
                own = -1
                for s in range(-1, 6):
                    i2, j2, k2 = i, j, k
                    if s >= 0:
                        step = 1 - 2 * (s % 2)
                        if s // 2 == 0:
                            i2 = min(max(i + step, 0), nx - 1)
                        elif s // 2 == 1:
                            j2 = min(max(j + step, 0), ny - 1)
                        else:
                            k2 = min(max(k + step, 0), nz - 1)
                    f = nearest[i2, j2, k2]
                    if f == own:
                        continue
                    d2 = triangle_distance2(
                        p, vertices[faces[f, 0]], vertices[faces[f, 1]], vertices[faces[f, 2]]
                    )
                    if d2 < distance2[i, j, k]:
                        distance2[i, j, k] = d2
                        nearest[i, j, k] = f
                        changed[i, j, k] |= s >= 0
                    own = nearest[i, j, k]


@njit(cache=True)
def count_crossings(vertices, faces, grid, winding):
    """Add the signed crossings of the surface with each vertical grid line, node above."""
    nx, ny, nz = winding.shape
    h = grid[3]
    for f in range(len(faces)):
        a, b, c = vertices[faces[f, 0]], vertices[faces[f, 1]], vertices[faces[f, 2]]
        area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        if area == 0.0:
            continue
        i0 = max(int(math.ceil((min(a[0], b[0], c[0]) - grid[0]) / h)), 0)
        i1 = min(int(math.floor((max(a[0], b[0], c[0]) - grid[0]) / h)), nx - 1)
        j0 = max(int(math.ceil((min(a[1], b[1], c[1]) - grid[1]) / h)), 0)
        j1 = min(int(math.floor((max(a[1], b[1], c[1]) - grid[1]) / h)), ny - 1)
        for i in range(i0, i1 + 1):
            x = grid[0] + i * h
            for j in range(j0, j1 + 1):
                y = grid[1] + j * h
                wc = ((b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])) / area
                wa = ((c[0] - b[0]) * (y - b[1]) - (c[1] - b[1]) * (x - b[0])) / area
                wb = 1.0 - wa - wc
                if wa >= 0.0 and wb >= 0.0 and wc >= 0.0:
                    z = wa * a[2] + wb * b[2] + wc * c[2]
                    k = int(math.ceil((z - grid[2]) / h))
                    if 0 <= k < nz:
                        winding[i, j, k] += 1 if area < 0.0 else -1


@njit(cache=True, inline="always")
def _weights(t):
    """Cubic B-spline weights of four nodes at fraction ``t`` of the cell."""
    s = 1.0 - t
    return (
        s * s * s / 6.0,
        (4.0 - 6.0 * t * t + 3.0 * t * t * t) / 6.0,
        (4.0 - 6.0 * s * s + 3.0 * s * s * s) / 6.0,
        t * t * t / 6.0,
    )


@njit(cache=True, inline="always")
def _slopes(t):
    """First derivatives of the weights."""
    s = 1.0 - t
    return (-0.5 * s * s, t * (1.5 * t - 2.0), s * (2.0 - 1.5 * s), 0.5 * t * t)


@njit(cache=True, inline="always")
def _bends(t):
    """Second derivatives of the weights."""
    s = 1.0 - t
    return (s, 1.0 - 3.0 * s, 1.0 - 3.0 * t, t)


@njit(cache=True)
def near(coefficients, grid, px, py, pz, reach):
    """Whether a point is in the grid and may be closer than ``reach`` to the surface."""
    h = grid[3]
    i, j, k = int((px - grid[0]) / h), int((py - grid[1]) / h), int((pz - grid[2]) / h)
    nx, ny, nz = coefficients.shape
    if i < 1 or j < 1 or k < 1 or i > nx - 3 or j > ny - 3 or k > nz - 3:
        return False
    # A distance changes by at most its step; a cell is sqrt(3) h across.
    return coefficients[i, j, k] < reach + 3.0 * h


@njit(cache=True)
def distance(coefficients, grid, px, py, pz):
    """Signed distance and its gradient at a point inside the grid."""
    h = grid[3]
    u, v, w = (px - grid[0]) / h, (py - grid[1]) / h, (pz - grid[2]) / h
    i, j, k = int(u), int(v), int(w)
    wx, wy, wz = _weights(u - i), _weights(v - j), _weights(w - k)
    sx, sy, sz = _slopes(u - i), _slopes(v - j), _slopes(w - k)
    phi, gx, gy, gz = 0.0, 0.0, 0.0, 0.0
    for a in range(4):
        q, qy, qz = 0.0, 0.0, 0.0
        for b in range(4):
            # By single entries: a view of the row would cost more than its products.
            d, e = i + a - 1, j + b - 1
            c0, c1 = coefficients[d, e, k - 1], coefficients[d, e, k]
            c2, c3 = coefficients[d, e, k + 1], coefficients[d, e, k + 2]
            r = wz[0] * c0 + wz[1] * c1 + wz[2] * c2 + wz[3] * c3
            rz = sz[0] * c0 + sz[1] * c1 + sz[2] * c2 + sz[3] * c3
            q += wy[b] * r
            qy += sy[b] * r
            qz += wy[b] * rz
        phi += wx[a] * q
        gx += sx[a] * q
        gy += wx[a] * qy
        gz += wx[a] * qz
    return phi, gx / h, gy / h, gz / h


@njit(cache=True)
def distance_hessian(coefficients, grid, px, py, pz):
    """Second derivatives xx, yy, zz, xy, xz, yz of the signed distance."""
    h = grid[3]
    u, v, w = (px - grid[0]) / h, (py - grid[1]) / h, (pz - grid[2]) / h
    i, j, k = int(u), int(v), int(w)
    wx, wy, wz = _weights(u - i), _weights(v - j), _weights(w - k)
    sx, sy, sz = _slopes(u - i), _slopes(v - j), _slopes(w - k)
    bx, by, bz = _bends(u - i), _bends(v - j), _bends(w - k)
    xx, yy, zz, xy, xz, yz = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for a in range(4):
        for b in range(4):
            for c in range(4):
                q = coefficients[i + a - 1, j + b - 1, k + c - 1]
                xx += bx[a] * wy[b] * wz[c] * q
                yy += wx[a] * by[b] * wz[c] * q
                zz += wx[a] * wy[b] * bz[c] * q
                xy += sx[a] * sy[b] * wz[c] * q
                xz += sx[a] * wy[b] * sz[c] * q
                yz += wx[a] * sy[b] * sz[c] * q
    hh = h * h
    return xx / hh, yy / hh, zz / hh, xy / hh, xz / hh, yz / hh


@njit(cache=True)
def evaluate(coefficients, grid, points, phi, gradient):
    """Signed distance and gradient at many points; inf and 0 outside the grid."""
    for n in range(len(points)):
        x, y, z = points[n, 0], points[n, 1], points[n, 2]
        phi[n] = np.inf
        gradient[n] = 0.0
        if near(coefficients, grid, x, y, z, np.inf):
            phi[n], gradient[n, 0], gradient[n, 1], gradient[n, 2] = distance(
                coefficients, grid, x, y, z
            )
