"""Averaged Green strain of a triangle from the gradients at its edges, and its law."""

import numpy as np
from numba import njit

BLEND = 2e-3


@njit(cache=True)
def curve(table, count, e):
    """Energy, stress and stiffness of a curve whose stiffness is piecewise linear in strain."""
    i = count - 1
    while i > 0 and e < table[i, 0]:
        i -= 1
    d = e - table[i, 0]
    rise = table[i, 4] if d > 0.0 else 0.0
    k, s, psi = table[i, 1], table[i, 2], table[i, 3]
    return (
        psi + d * (s + d * (0.5 * k + d * rise / 6.0)),
        s + d * (k + 0.5 * d * rise),
        k + d * rise,
    )


@njit(cache=True)
def ramp(e):
    """Share of the coupling that tension switches on, with two derivatives."""
    if e <= 0.0:
        return 0.0, 0.0, 0.0
    d = e + BLEND
    return e * e / d, 1.0 - (BLEND / d) ** 2, 2.0 * BLEND * BLEND / (d * d * d)


@njit(cache=True)
def law(tables, counts, coupling, ratio, e11, e22, e12):
    """Energy density [J/m2], stress (S11, S22, S12) [N/m] at Green strain (E11, E22, 2 E12)."""
    w1, s1, _ = curve(tables[0], counts[0], e11)
    w2, s2, _ = curve(tables[1], counts[1], e22)
    w3, s3, _ = curve(tables[2], counts[2], abs(e12))
    p1, dp1, _ = ramp(e11)
    p2, dp2, _ = ramp(e22)
    a, b = coupling * (1.0 - ratio), coupling * ratio
    return (
        w1 + w2 + w3 + a * p1 * p2 + b * e11 * e22,
        s1 + a * dp1 * p2 + b * e22,
        s2 + a * p1 * dp2 + b * e11,
        s3 if e12 >= 0.0 else -s3,
    )


@njit(cache=True)
def tangent(tables, counts, coupling, ratio, e11, e22, e12):
    """Material stiffness (D11, D22, D12, D33) [N/m]; the rest is zero."""
    k1 = curve(tables[0], counts[0], e11)[2]
    k2 = curve(tables[1], counts[1], e22)[2]
    k3 = curve(tables[2], counts[2], abs(e12))[2]
    p1, dp1, ddp1 = ramp(e11)
    p2, dp2, ddp2 = ramp(e22)
    a, b = coupling * (1.0 - ratio), coupling * ratio
    return k1 + a * ddp1 * p2, k2 + a * p1 * ddp2, a * dp1 * dp2 + b, k3


@njit(cache=True)
def gradients(x, ends, length, normal, start, nodes, weights, F):
    """Deformation gradient at every sample: F (q, 6), warp column first."""
    for q in range(len(ends)):
        a, b = ends[q, 0], ends[q, 1]
        inv = 1.0 / length[q]
        n0, n1 = normal[q, 0], normal[q, 1]
        s0 = s1 = s2 = 0.0
        for i in range(start[q], start[q + 1]):
            v, w = nodes[i], weights[i]
            s0 += w * x[v, 0]
            s1 += w * x[v, 1]
            s2 += w * x[v, 2]
        t0 = (x[b, 0] - x[a, 0]) * inv
        t1 = (x[b, 1] - x[a, 1]) * inv
        t2 = (x[b, 2] - x[a, 2]) * inv
        F[q, 0], F[q, 3] = s0 * n0 - t0 * n1, s0 * n1 + t0 * n0
        F[q, 1], F[q, 4] = s1 * n0 - t1 * n1, s1 * n1 + t1 * n0
        F[q, 2], F[q, 5] = s2 * n0 - t2 * n1, s2 * n1 + t2 * n0


@njit(cache=True)
def strains(F, samples, E):
    """Mean Green strain (E11, E22, 2 E12) of every triangle over its three samples."""
    for t in range(len(samples)):
        a = b = c = 0.0
        for k in range(3):
            f = F[samples[t, k]]
            a += f[0] * f[0] + f[1] * f[1] + f[2] * f[2]
            b += f[3] * f[3] + f[4] * f[4] + f[5] * f[5]
            c += f[0] * f[3] + f[1] * f[4] + f[2] * f[5]
        E[t, 0], E[t, 1], E[t, 2] = 0.5 * (a / 3.0 - 1.0), 0.5 * (b / 3.0 - 1.0), c / 3.0


@njit(cache=True)
def stresses(E, samples, area, fabric, tables, counts, constants, load):
    """Total energy; fills ``load`` (q, 3) with the stress [N m] that every sample carries."""
    total = 0.0
    load[:] = 0.0
    for t in range(len(samples)):
        f = fabric[t]
        psi, s11, s22, s12 = law(
            tables[f], counts[f], constants[f, 0], constants[f, 1], E[t, 0], E[t, 1], E[t, 2]
        )
        total += area[t] * psi
        share = area[t] / 3.0
        for k in range(3):
            q = samples[t, k]
            load[q, 0] += share * s11
            load[q, 1] += share * s22
            load[q, 2] += share * s12
    return total


@njit(cache=True)
def laws(E, fabric, tables, counts, constants):
    """Stress (S11, S22, S12) [N/m] of every triangle."""
    S = np.empty_like(E)
    for t in range(len(E)):
        f = fabric[t]
        _, S[t, 0], S[t, 1], S[t, 2] = law(
            tables[f], counts[f], constants[f, 0], constants[f, 1], E[t, 0], E[t, 1], E[t, 2]
        )
    return S


@njit(cache=True)
def forces(F, load, ends, length, normal, start, nodes, weights, gradient):
    """Add the nodal forces of the samples' stresses to ``gradient``."""
    for q in range(len(ends)):
        s11, s22, s12 = load[q, 0], load[q, 1], load[q, 2]
        n0, n1 = normal[q, 0], normal[q, 1]
        a, b = ends[q, 0], ends[q, 1]
        inv = 1.0 / length[q]
        u, w = s11 * n0 + s12 * n1, s12 * n0 + s22 * n1
        p0 = F[q, 0] * u + F[q, 3] * w
        p1 = F[q, 1] * u + F[q, 4] * w
        p2 = F[q, 2] * u + F[q, 5] * w
        u, w = (s12 * n0 - s11 * n1) * inv, (s22 * n0 - s12 * n1) * inv
        for c in range(3):
            t = F[q, c] * u + F[q, 3 + c] * w
            gradient[a, c] -= t
            gradient[b, c] += t
        for i in range(start[q], start[q + 1]):
            v, r = nodes[i], weights[i]
            gradient[v, 0] += r * p0
            gradient[v, 1] += r * p1
            gradient[v, 2] += r * p2


@njit(cache=True)
def tensile(s11, s22, s12):
    """Tensile part of a symmetric 2x2 stress."""
    mean, half = 0.5 * (s11 + s22), 0.5 * (s11 - s22)
    radius = np.sqrt(half * half + s12 * s12)
    high, low = mean + radius, mean - radius
    if low >= 0.0:
        return s11, s22, s12
    if high <= 0.0:
        return 0.0, 0.0, 0.0
    scale = high / (2.0 * radius)
    return scale * (radius + half), scale * (radius - half), scale * s12
