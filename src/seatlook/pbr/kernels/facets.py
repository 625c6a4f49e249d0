"""The facets of a relief that one sample covers, and the mean of the light they reflect.

A grain's slopes reach further than a polished lobe is wide, and are no Gaussian. One lobe at their
mean, widened by their variance (Olano and Baker 2010), has tails that are too bright: those of GGX
grow with its width squared. So the lobes are summed over facets, and only what varies slowly is
read at three cosines for all of them.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from seatlook.pbr.kernels import leaf
from seatlook.pbr.kernels.brdf import (
    COAT_F0,
    GGX,
    D_Charlie,
    V_Neubelt,
    coat_share,
    layers_at,
    lookup_mean,
    sheen_share,
    widened,
)
from seatlook.pbr.kernels.grain import WEAVE, bilinear, nearest_level, stroke
from seatlook.pbr.kernels.light import above_horizon
from seatlook.pbr.kernels.surface import along, dot, minus, row, row_of, unit

# Rows of the room for facets: unit normal, its cosine to the eye, share of the colour.
X, Y, Z, NOV, SHARE = range(5)
ROWS = 5
# Texels are as wide as this share of a facet: what many facets leave out averages away, what a
# wider lobe adds does not.
_SHARP = 0.25


@leaf()
def faceted(material):
    """Whether facets show the relief: a weave would beat with the pixels, or turn its lobes."""
    return 0 <= material.texture < WEAVE and material.anisotropy == 0.0


@leaf()
def _step(place, step, t):
    """Step along warp and weft [m] from one sample to the next, ``step`` apart at distance 1."""
    x = (t * step[0], t * step[1], t * step[2])
    x = along(x, -dot(x, place.n) / max(0.05, dot(place.n, place.v)), place.v)
    return dot(x, place.warp), dot(x, place.weft)


@leaf()
def _bend(mesh, f, n, d):
    """Change of the interpolated normal of face f over a step ``d`` [m] in the pattern."""
    i, j, k = mesh.faces[f, 0], mesh.faces[f, 1], mesh.faces[f, 2]
    u1, v1 = mesh.uv[j, 0] - mesh.uv[i, 0], mesh.uv[j, 1] - mesh.uv[i, 1]
    u2, v2 = mesh.uv[k, 0] - mesh.uv[i, 0], mesh.uv[k, 1] - mesh.uv[i, 1]
    area = u1 * v2 - u2 * v1
    if area == 0.0:
        return (0.0, 0.0, 0.0)
    first = row(mesh.normals, i)
    s = 1.0 / area if dot(first, n) > 0.0 else -1.0 / area
    b1, b2 = s * (d[0] * v2 - d[1] * u2), s * (u1 * d[1] - v1 * d[0])
    x = minus(row(mesh.normals, j), first)
    return along((b1 * x[0], b1 * x[1], b1 * x[2]), b2, minus(row(mesh.normals, k), first))


@leaf()
def spread(mesh, textures, eye, material, f, place, n, at, t, covers, side, facets):
    """Facets of the relief under a sample, or under all that it stands for, into ``facets``.

    ``at`` (u, v) [m]: place of the sample in the pattern; ``t`` [m]: distance from the eye; ``n``:
    normal without the relief; ``covers``: samples along each side that it stands for;
    ``side``: facets along each side of it.
    Returns the mean normal; what the slopes within a facet, and those of all facets, add to the
    squared width of a lobe; and the share of the colour, to which that of each facet is relative.
    """
    across, down = _step(place, row_of(eye.right), t), _step(place, row_of(eye.down), t)
    half = 0.5 * (covers - 1)
    at = (at[0] + half * (across[0] + down[0]), at[1] + half * (across[1] + down[1]))
    across, down = (covers * across[0], covers * across[1]), (covers * down[0], covers * down[1])
    steep = material.texture_depth / material.texture_scale
    texels = textures.texels[material.texture]
    width = np.sqrt(abs(across[0] * down[1] - across[1] * down[0])) / side
    tile = textures.cells * material.texture_scale
    level = nearest_level(textures, tile, _SHARP * width)
    bend, bow = _bend(mesh, f, n, across), _bend(mesh, f, n, down)
    mean, variance, share, weight = (0.0, 0.0, 0.0), 0.0, 0.0, 1.0 / (side * side)
    for q in range(side * side):
        x, y = (q % side + 0.5) / side - 0.5, (q // side + 0.5) / side - 0.5
        u, v = at[0] + x * across[0] + y * down[0], at[1] + x * across[1] + y * down[1]
        su, sv, s2, c = bilinear(texels, textures, level, u / tile, v / tile)
        m = along(along(n, x, bend), y, bow)
        m = unit(along(along(m, -steep * su, place.warp), -steep * sv, place.weft))
        facets[X, q], facets[Y, q], facets[Z, q] = m
        facets[NOV, q], facets[SHARE, q] = max(0.01, dot(m, place.v)), c
        mean = along(mean, weight, m)
        variance += weight * s2
        share += weight * c
    for q in range(side * side):
        facets[SHARE, q] /= share
    within = 2.0 * steep * steep * variance
    beside = within + max(0.0, 1.0 - dot(mean, mean))
    return unit(mean), within, beside, share * stroke(material, at[0], at[1])


class Curves(NamedTuple):
    """Layers over a cosine: ``a + x (b + x c)`` with x = ``scale`` (cosine - ``low``)."""

    low: float
    scale: float
    base: tuple[float, float, float]
    nap: tuple[float, float, float]
    lost: tuple[float, float, float]
    coat: tuple[float, float, float]
    coat_lost: tuple[float, float, float]


@leaf()
def _parabola(first, middle, last):
    """Coefficients of the parabola through values at 0, 1/2 and 1."""
    return first, 4.0 * middle - 3.0 * first - last, 2.0 * (first + last) - 4.0 * middle


@leaf()
def _at(curve, x):
    return curve[0] + x * (curve[1] + x * curve[2])


@leaf()
def _curves(tables, material, view, low, high):
    """Layers between two cosines, each a parabola: a chord would lie below all of them."""
    low = min(max(low, 0.0), 0.99)
    high = min(max(high, low + 1e-3), 1.0)
    a = layers_at(tables, material, view.rows, view.means, low)
    b = layers_at(tables, material, view.rows, view.means, 0.5 * (low + high))
    c = layers_at(tables, material, view.rows, view.means, high)
    return Curves(
        low,
        1.0 / (high - low),
        _parabola(a.base, b.base, c.base),
        _parabola(a.nap, b.nap, c.nap),
        _parabola(1.0 - a.scale - a.bias, 1.0 - b.scale - b.bias, 1.0 - c.scale - c.bias),
        _parabola(a.coat, b.coat, c.coat),
        _parabola(a.coat_lost, b.coat_lost, c.coat_lost),
    )


@leaf()
def curves_to_eye(tables, material, view, facets, count):
    """Layers over the facets' cosines to the eye."""
    if count == 0:
        o = (0.0, 0.0, 0.0)
        return Curves(0.0, 0.0, o, o, o, o, o)
    low, high = 1.0, 0.0
    for q in range(count):
        low, high = min(low, facets[NOV, q]), max(high, facets[NOV, q])
    return _curves(tables, material, view, low, high)


@leaf()
def brdf_facets(tables, material, coupling, view, to_eye, facets, count, part, v, out):
    """Mean over ``count`` facets of BRDF times cosine, into ``out`` (3,).

    ``part``: direction of the light, what it adds to the squared width of the lobes, cosine from
    the surface without its relief, angular radius, and which part of how many it is: each facet
    looks at one of them. The other arguments as for ``brdf``.
    """
    l, wider, smooth, angle, turn, parts = part
    h = unit(along(v, 1.0, l))
    LoH = min(1.0, dot(l, h))
    low, high = 1.0, -1.0
    for q in range(count):
        c = facets[X, q] * l[0] + facets[Y, q] * l[1] + facets[Z, q] * l[2]
        low, high = min(low, c), max(high, c)
    out[0] = out[1] = out[2] = 0.0
    if high <= -angle:
        return
    to_light = _curves(tables, material, view, low, high)
    coat, nap = coat_share(material), sheen_share(material)
    alpha, coat_alpha = widened(view.alpha_x, wider), widened(material.coat_roughness**2, wider)
    diffuse = lobe = again = fibres = coat_lobe = coat_again = 0.0
    fibre_alpha = material.sheen_roughness**2
    for q in range(count):
        if (q + 2 * (q // 4) + q // 8) % parts != turn:
            continue
        m = (facets[X, q], facets[Y, q], facets[Z, q])
        c = above_horizon(dot(m, l), smooth, angle)
        if c <= 1e-5:
            continue
        NoV, NoH = facets[NOV, q], min(1.0, dot(m, h))
        x = (NoV - to_eye.low) * to_eye.scale
        y = min(1.0, max(0.0, (c - to_light.low) * to_light.scale))
        below = c * min(_at(to_eye.nap, x), _at(to_light.nap, y))
        diffuse += c * facets[SHARE, q] * _at(to_eye.base, x) * _at(to_light.base, y)
        again += below * _at(to_eye.lost, x) * _at(to_light.lost, y)
        lobe += below * GGX(alpha, NoV, c, NoH)
        if nap > 0.0:
            under = c * min(_at(to_eye.coat, x), _at(to_light.coat, y))
            fibres += under * D_Charlie(fibre_alpha, NoH) * V_Neubelt(NoV, c)
        if coat > 0.0:
            coat_lobe += c * GGX(coat_alpha, NoV, c, NoH)
            coat_again += c * _at(to_eye.coat_lost, x) * _at(to_light.coat_lost, y)
    weight = parts / count
    diffuse *= weight * (1.0 - material.metalness) / (np.pi * coupling)
    again *= weight / (np.pi * (1.0 - view.means.base))
    fibres *= weight * (1.0 - material.metalness)
    fibres *= lookup_mean(tables.sheen_norm, material.sheen_roughness)
    fresnel = 1.0 - LoH
    fresnel *= fresnel * fresnel * fresnel * fresnel
    top = 0.0
    if coat > 0.0:
        top = (COAT_F0 + (1.0 - COAT_F0) * fresnel) * coat_lobe
        top += view.means.coat_again * coat_again / (np.pi * (1.0 - view.means.coat))
    for k in range(3):
        out[k] = weight * (view.f0[k] + (view.f90[k] - view.f0[k]) * fresnel) * lobe
        out[k] += view.again[k] * again + view.colour[k] * diffuse
        out[k] += fibres * material.sheen[k] + weight * coat * top
