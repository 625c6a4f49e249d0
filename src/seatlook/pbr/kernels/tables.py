"""Directional albedos of the lobes by quadrature, tabulated over roughness and sqrt(mu)."""

from __future__ import annotations

import numpy as np
from numba import njit

from seatlook.pbr.kernels import leaf
from seatlook.pbr.kernels.brdf import alphas, layers_at, means_of, rows_of
from seatlook.pbr.kernels.lobes import D_Charlie, V_Neubelt, V_SmithGGXCorrelated
from seatlook.pbr.kernels.lookup import ROUGHNESS_LOW, lookup, lookup_mean, stretched_at
from seatlook.pbr.kernels.surface import along, cross, dot, unit

# Directions of a quarter turn over which a coupling is averaged where azimuth counts.
_TURNS = 12


@leaf()
def _ggx_albedo(ax, ay, view, n):
    """Scale and bias at one view, by sampling visible normals (Heitz 2018) on an n x n grid.

    ``ax, ay``: widths along and across; ``view``: unit direction.
    """
    v = unit((ax * view[0], ay * view[1], view[2]))
    side = np.sqrt(v[0] * v[0] + v[1] * v[1])
    first = (-v[1] / side, v[0] / side, 0.0) if side > 1e-9 else (0.0, 1.0, 0.0)
    second = cross(v, first)
    scale, bias = 0.0, 0.0
    s = 0.5 * (1.0 + v[2])
    one = np.sqrt((ax * view[0]) ** 2 + (ay * view[1]) ** 2 + view[2] * view[2])
    for i in range(n):
        # Finer towards the rim of the disc, where the normals of the lobe's tail lie.
        q = 1.0 - (i + 0.5) / n
        r, share = np.sqrt(1.0 - q * q), 2.0 * q
        for j in range(n):
            phi = 2.0 * np.pi * (j + 0.5) / n
            t1, t2 = r * np.cos(phi), r * np.sin(phi)
            t2 = (1.0 - s) * np.sqrt(max(0.0, 1.0 - t1 * t1)) + s * t2
            up = np.sqrt(max(0.0, 1.0 - t1 * t1 - t2 * t2))
            h = along(along((t1 * first[0], t1 * first[1], 0.0), t2, second), up, v)
            h = unit((ax * h[0], ay * h[1], max(1e-9, h[2])))
            VoH = dot(view, h)
            l = along((-view[0], -view[1], -view[2]), 2.0 * VoH, h)
            if l[2] <= 0.0 or VoH <= 0.0:
                continue
            both = V_SmithGGXCorrelated(ax, ay, view[0], view[1], view[2], l[0], l[1], l[2])
            # weight = F G2 / G1, with G2 = 4 NoL NoV V and G1 = 2 NoV / (NoV + Lambda term)
            weight = share * both * 4.0 * l[2] * 0.5 * (view[2] + one)
            m = 1.0 - VoH
            fresnel = m * m * m * m * m
            scale += weight * (1.0 - fresnel)
            bias += weight * fresnel
    return scale / (n * n), bias / (n * n)


@leaf()
def _sheen_albedo(alpha, mu, n):
    """Albedo of the sheen at one view, on an even grid over sqrt(NoL) and half a turn."""
    side = np.sqrt(max(0.0, 1.0 - mu * mu))
    total = 0.0
    for i in range(n):
        s = (i + 0.5) / n
        NoL = s * s
        low = np.sqrt(1.0 - NoL * NoL)
        for j in range(n):
            phi = np.pi * (j + 0.5) / n
            x, y, z = side + low * np.cos(phi), low * np.sin(phi), mu + NoL
            NoH = z / np.sqrt(x * x + y * y + z * z)
            total += D_Charlie(alpha, NoH) * V_Neubelt(mu, NoL) * NoL * 2.0 * s
    return total / (n * n) * 2.0 * np.pi


@leaf()
def _mean(table, roughness):
    """Cosine-weighted hemisphere mean of an interpolated table, by the midpoint rule."""
    n, total = 512, 0.0
    for i in range(n):
        s = (i + 0.5) / n
        total += lookup(table, roughness, s * s) * s * s * 2.0 * s
    return 2.0 * total / n


@njit(cache=True)
def integrate(rows, columns, grid):
    """Fields of ``Tables`` on ``rows`` x ``columns`` nodes, each a grid x grid quadrature."""
    scale, bias = np.empty((rows, columns)), np.empty((rows, columns))
    sheen = np.empty((rows, columns))
    scale_mean, bias_mean = np.empty(rows), np.empty(rows)
    for i in range(rows):
        roughness = ROUGHNESS_LOW + (1.0 - ROUGHNESS_LOW) * i / (rows - 1)
        for j in range(columns):
            mu = max(1e-4, (j / (columns - 1)) ** 2)
            alpha, view = roughness**2, (np.sqrt(1.0 - mu * mu), 0.0, mu)
            scale[i, j], bias[i, j] = _ggx_albedo(alpha, alpha, view, grid)
            sheen[i, j] = _sheen_albedo(roughness**2, mu, grid)
    sheen_norm = np.empty(rows)
    for i in range(rows):
        sheen_norm[i] = 1.0 / max(1.0, sheen[i].max())
        sheen[i] *= sheen_norm[i]
    for i in range(rows):
        roughness = ROUGHNESS_LOW + (1.0 - ROUGHNESS_LOW) * i / (rows - 1)
        scale_mean[i] = _mean(scale, roughness)
        bias_mean[i] = _mean(bias, roughness)
    return scale, bias, sheen, scale_mean, bias_mean, sheen_norm


@njit(cache=True)
def integrate_stretched(shape, grid):
    """Fields ``stretched, stretched_mean`` of ``Tables`` on nodes of ``shape`` (4,)."""
    rows, steps, turns, columns = shape
    out, mean = np.empty((rows, steps, turns, columns, 2)), np.empty((rows, steps))
    for i in range(rows):
        roughness = ROUGHNESS_LOW + (1.0 - ROUGHNESS_LOW) * i / (rows - 1)
        for k in range(steps):
            ax, ay = alphas(roughness, k / (steps - 1))
            for t in range(turns):
                x = t / (turns - 1)
                y = np.sqrt(1.0 - x * x)
                for j in range(columns):
                    mu = max(1e-4, (j / (columns - 1)) ** 2)
                    side = np.sqrt(1.0 - mu * mu)
                    view = (side * x, side * y, mu)
                    out[i, k, t, j] = _ggx_albedo(ax, ay, view, grid)
        # Relative to the lobe that is as wide along as across.
        for k in range(steps - 1, -1, -1):
            out[i, k] -= out[i, 0]
    for i in range(rows):
        for k in range(steps):
            mean[i, k] = _mean_stretched(out, i, k)
    return out, mean


@leaf()
def _mean_stretched(table, i, k):
    """Hemisphere mean of what anisotropy changes of the albedo of a lobe with F = 1."""
    n, turns, total = 128, 32, 0.0
    for j in range(n):
        s = (j + 0.5) / n
        for t in range(turns):
            x = np.cos(0.5 * np.pi * (t + 0.5) / turns)
            scale, bias = stretched_at(table, ((i, 0.0), (k, 0.0)), x, s)
            total += (scale + bias) * s * s * 2.0 * s
    return 2.0 * total / (n * turns)


@leaf()
def coupling(tables, materials, out):
    """Mean of what reaches the diffuse base, per material and roughness, into ``out`` (p, k)."""
    n = 256
    for p in range(len(materials)):
        for i in range(out.shape[1]):
            roughness = ROUGHNESS_LOW + (1.0 - ROUGHNESS_LOW) * i / (out.shape[1] - 1)
            means = means_of(tables, materials[p], roughness)
            rows = rows_of(tables, materials[p], roughness)
            total, turns = 0.0, 1 if materials[p].anisotropy == 0.0 else _TURNS
            for j in range(n):
                s = (j + 0.5) / n
                for t in range(turns):
                    x = np.cos(0.5 * np.pi * (t + 0.5) / turns)
                    base = layers_at(tables, materials[p], rows, means, x, s * s).base
                    total += base * s * s * 2.0 * s
            out[p, i] = 2.0 * total / (n * turns)


@leaf()
def layers(tables, materials, out):
    """Layers of each material at its own roughness over sqrt(mu), into ``out`` (p, n, 5).

    Columns: what reaches the diffuse base, what gets below coat and sheen, the share that the
    base's lobe reflects more than once, what gets below the coat, and the share lost by the coat's
    lobe. Only those that are as wide along as across are looked up so.
    """
    n = out.shape[1]
    for p in range(len(materials)):
        roughness = materials[p].roughness
        means = means_of(tables, materials[p], roughness)
        rows = rows_of(tables, materials[p], roughness)
        for j in range(n):
            here = layers_at(tables, materials[p], rows, means, 0.5, (j / (n - 1)) ** 2)
            out[p, j, 0], out[p, j, 1] = here.base, here.sheen
            out[p, j, 2] = 1.0 - here.scale - here.bias
            out[p, j, 3], out[p, j, 4] = here.coat, here.coat_lost


@leaf()
def fibres(tables, materials, out):
    """Distribution of each sheen's fibres over the sine of the half-vector, into ``out`` (p, n)."""
    n = out.shape[1]
    for p in range(len(materials)):
        roughness = materials[p].sheen_roughness
        norm = lookup_mean(tables.sheen_norm, roughness)
        for j in range(n):
            out[p, j] = norm * D_Charlie(roughness * roughness, np.sqrt(1.0 - (j / (n - 1)) ** 2))


@leaf()
def coupling_at(row, roughness):
    """Linear value of one material's row."""
    return lookup_mean(row, roughness)
