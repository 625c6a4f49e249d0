"""Green strain of a triangle from the arc lengths of its edges, and its stress."""

import numpy as np
from numba import njit

BLEND = 2e-3


@njit(cache=True)
def curve(tables, counts, f, axis, e):
    """Energy, stress and stiffness of a curve whose stiffness is piecewise linear in strain."""
    i = counts[f, axis] - 1
    while i > 0 and e < tables[f, axis, i, 0]:
        i -= 1
    d = e - tables[f, axis, i, 0]
    rise = tables[f, axis, i, 4] if d > 0.0 else 0.0
    k, s, psi = tables[f, axis, i, 1], tables[f, axis, i, 2], tables[f, axis, i, 3]
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
def constitutive(tables, counts, constants, f, e11, e22, e12):
    """Energy density [J/m2], stress (S11, S22, S12) [N/m] at Green strain (E11, E22, 2 E12)."""
    w1, s1, _ = curve(tables, counts, f, 0, e11)
    w2, s2, _ = curve(tables, counts, f, 1, e22)
    w3, s3, _ = curve(tables, counts, f, 2, abs(e12))
    p1, dp1, _ = ramp(e11)
    p2, dp2, _ = ramp(e22)
    b = constants[f, 0] * constants[f, 1]
    a = constants[f, 0] - b
    return (
        w1 + w2 + w3 + a * p1 * p2 + b * e11 * e22,
        s1 + a * dp1 * p2 + b * e22,
        s2 + a * p1 * dp2 + b * e11,
        s3 if e12 >= 0.0 else -s3,
    )


@njit(cache=True)
def tangent(tables, counts, constants, f, e11, e22, e12):
    """Material stiffness (D11, D22, D12, D33) [N/m]; the rest is zero."""
    k1 = curve(tables, counts, f, 0, e11)[2]
    k2 = curve(tables, counts, f, 1, e22)[2]
    k3 = curve(tables, counts, f, 2, abs(e12))[2]
    p1, dp1, ddp1 = ramp(e11)
    p2, dp2, ddp2 = ramp(e22)
    b = constants[f, 0] * constants[f, 1]
    a = constants[f, 0] - b
    return k1 + a * ddp1 * p2, k2 + a * p1 * ddp2, a * dp1 * dp2 + b, k3


@njit(cache=True)
def edge_strains(x, ends, length, start, nodes, weights, offset, bow, strain):
    """Green strain of every edge, its chord lengthened to the arc that its curvature makes.

    ``bow`` (e, 3) [1/m] is the second derivative along the edge, a quadratic's mean square slope
    being the square of the chord's plus a twelfth of (length times bow) squared.
    """
    for e in range(len(ends)):
        b0, b1, b2 = offset[e, 0], offset[e, 1], offset[e, 2]
        for i in range(start[e], start[e + 1]):
            v, w = nodes[i], weights[i]
            b0 += w * x[v, 0]
            b1 += w * x[v, 1]
            b2 += w * x[v, 2]
        bow[e, 0], bow[e, 1], bow[e, 2] = b0, b1, b2
        p, q = ends[e, 0], ends[e, 1]
        d0, d1, d2 = x[q, 0] - x[p, 0], x[q, 1] - x[p, 1], x[q, 2] - x[p, 2]
        square = length[e] * length[e]
        strain[e] = 0.5 * (
            (d0 * d0 + d1 * d1 + d2 * d2) / square
            + (b0 * b0 + b1 * b1 + b2 * b2) * square / 12.0
            - 1.0
        )


@njit(cache=True)
def strains(edge_strain, of_face, natural, E):
    """Green strain (E11, E22, 2 E12) of every triangle from those of its three edges."""
    for t in range(len(of_face)):
        for c in range(3):
            total = 0.0
            for k in range(3):
                total += natural[t, c, k] * edge_strain[of_face[t, k]]
            E[t, c] = total


@njit(cache=True)
def exchange(values, pairs, share, move):
    """Let the triangles ``pairs`` (p, 2) exchange a ``share`` (p, 2) of what they differ by.

    Shares are inverse to the areas of the two. ``move`` (p, 3) is room for the differences.
    """
    for i in range(len(pairs)):
        for c in range(3):
            move[i, c] = values[pairs[i, 1], c] - values[pairs[i, 0], c]
    for i in range(len(pairs)):
        for c in range(3):
            values[pairs[i, 0], c] += share[i, 0] * move[i, c]
            values[pairs[i, 1], c] -= share[i, 1] * move[i, c]


@njit(cache=True)
def exchange_back(values, pairs, share, move):
    """Transpose of ``exchange``."""
    for i in range(len(pairs)):
        for c in range(3):
            move[i, c] = share[i, 1] * values[pairs[i, 1], c] - share[i, 0] * values[pairs[i, 0], c]
    for i in range(len(pairs)):
        for c in range(3):
            values[pairs[i, 0], c] += move[i, c]
            values[pairs[i, 1], c] -= move[i, c]


@njit(cache=True)
def tensions(E, area, fabric, tables, counts, constants, S):
    """Total energy; fills S (m, 3) [J], its derivative by the strains of every triangle."""
    total = 0.0
    for t in range(len(E)):
        f, a = fabric[t], area[t]
        psi, s11, s22, s12 = constitutive(tables, counts, constants, f, E[t, 0], E[t, 1], E[t, 2])
        total += a * psi
        S[t, 0], S[t, 1], S[t, 2] = a * s11, a * s22, a * s12
    return total


@njit(cache=True)
def pulls(S, of_face, natural, pull):
    """Fill ``pull`` (e,) [J], the energy's derivative by the strain of every edge."""
    pull[:] = 0.0
    for t in range(len(of_face)):
        for k in range(3):
            pull[of_face[t, k]] += (
                natural[t, 0, k] * S[t, 0] + natural[t, 1, k] * S[t, 1] + natural[t, 2, k] * S[t, 2]
            )


@njit(cache=True)
def stresses(E, fabric, tables, counts, constants):
    """Stress (S11, S22, S12) [N/m] of every triangle."""
    S = np.empty_like(E)
    for t in range(len(E)):
        f = fabric[t]
        _, S[t, 0], S[t, 1], S[t, 2] = constitutive(
            tables, counts, constants, f, E[t, 0], E[t, 1], E[t, 2]
        )
    return S


@njit(cache=True)
def forces(x, pull, ends, length, start, nodes, weights, bow, gradient):
    """Add the nodal forces of the edges' pulls to ``gradient``."""
    for e in range(len(ends)):
        p, q = ends[e, 0], ends[e, 1]
        square = length[e] * length[e]
        chord = pull[e] / square
        for c in range(3):
            f = chord * (x[q, c] - x[p, c])
            gradient[p, c] -= f
            gradient[q, c] += f
        arc = pull[e] * square / 12.0
        b0, b1, b2 = arc * bow[e, 0], arc * bow[e, 1], arc * bow[e, 2]
        for i in range(start[e], start[e + 1]):
            v, w = nodes[i], weights[i]
            gradient[v, 0] += w * b0
            gradient[v, 1] += w * b1
            gradient[v, 2] += w * b2


@njit(cache=True)
def edge_stiffness(E, natural, area, fabric, tables, counts, constants, out):
    """Second derivative (m, 3, 3) [J] of every triangle's energy by its three edge strains."""
    for t in range(len(E)):
        f = fabric[t]
        d1, d2, d12, d3 = tangent(tables, counts, constants, f, E[t, 0], E[t, 1], E[t, 2])
        for i in range(3):
            a = area[t] * (d1 * natural[t, 0, i] + d12 * natural[t, 1, i])
            b = area[t] * (d12 * natural[t, 0, i] + d2 * natural[t, 1, i])
            c = area[t] * d3 * natural[t, 2, i]
            for j in range(3):
                out[t, i, j] = a * natural[t, 0, j] + b * natural[t, 1, j] + c * natural[t, 2, j]


@njit(cache=True)
def clamp(S):
    """Keep the tensile part of every stress."""
    for t in range(len(S)):
        S[t, 0], S[t, 1], S[t, 2] = tensile(S[t, 0], S[t, 1], S[t, 2])


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
