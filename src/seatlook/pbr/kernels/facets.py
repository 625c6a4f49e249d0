"""The facets of a relief that one sample covers, and the mean of the light they reflect.

A grain's slopes reach further than a polished lobe is wide, and are no Gaussian. One lobe at their
mean, widened by their variance (Olano and Baker 2010), has tails that are too bright: those of GGX
grow with its width squared. So the lobes are summed over facets.
"""

from __future__ import annotations

import numpy as np

from seatlook.pbr.kernels import leaf
from seatlook.pbr.kernels.brdf import (
    COAT_F0,
    GGX,
    V_Neubelt,
    coat_share,
    lobe_of,
    sheen_share,
)
from seatlook.pbr.kernels.grain import WEAVE, bilinear, nearest_level, stroke
from seatlook.pbr.kernels.light import above_horizon
from seatlook.pbr.kernels.surface import along, dot, minus, row, row_of, unit

# Rows of the room for facets: unit normal, its cosine to the eye, share of the colour, and layers
# there.
X, Y, Z, NOV, SHARE, BASE, NAP, LOST, COAT, COAT_LOST = range(10)
ROWS = 10
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
    line, column = 0, 0
    for q in range(side * side):
        x, y = (column + 0.5) / side - 0.5, (line + 0.5) / side - 0.5
        column += 1
        if column == side:
            line, column = line + 1, 0
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


@leaf()
def _layers(layers, mu):
    """Layers of a material at one cosine, see ``tables.layers``."""
    x = np.sqrt(mu) * (len(layers) - 1)
    j = min(int(x), len(layers) - 2)
    b = x - j
    low, high = layers[j], layers[j + 1]
    return (
        low[0] + b * (high[0] - low[0]),
        low[1] + b * (high[1] - low[1]),
        low[2] + b * (high[2] - low[2]),
        low[3] + b * (high[3] - low[3]),
        low[4] + b * (high[4] - low[4]),
    )


@leaf()
def _fibres(fibres, sine2):
    """Distribution of the nap at one squared sine, see ``tables.fibres``."""
    x = sine2 * (len(fibres) - 1)
    j = min(int(x), len(fibres) - 2)
    return fibres[j] + (x - j) * (fibres[j + 1] - fibres[j])


@leaf()
def layers_to_eye(layers, facets, count):
    """Layers at the facets' cosines to the eye, into ``facets``."""
    for q in range(count):
        here = _layers(layers, facets[NOV, q])
        facets[BASE, q], facets[NAP, q], facets[LOST, q] = here[0], here[1], here[2]
        facets[COAT, q], facets[COAT_LOST, q] = here[3], here[4]


@leaf()
def _half(cosine):
    """Tangent of half the elevation at whose sine it is."""
    return cosine / (1.0 + np.sqrt(max(0.0, 1.0 - cosine * cosine)))


@leaf()
def _upwards(up, own, squared):
    """Share of a lobe that goes up, of what goes up from its own surface.

    ``up, own``: tangents of half the elevations of the direction mirrored at its middle, above
    either surface. Half-vectors with the slopes of GGX tilt back by less in these shares.
    """
    here = 1.0 + up / np.sqrt(up * up + squared)
    return min(1.0, here / (1.0 + own / np.sqrt(own * own + squared)))


@leaf()
def mirrored_facets(material, view, facets, count, n, within, v):
    """Shares of base and coat that facets mirror, relative to one lobe at their mean normal.

    ``n``: normal without the relief, below which what they mirror is lost; ``within``: as
    ``spread`` returns it.
    """
    base = coat = 0.0
    base_width, coat_width = view.alpha_x**2 + within, material.coat_roughness**4 + within
    whole, top = view.layers.nap - view.layers.base, 1.0 - view.layers.coat
    NoV = dot(n, v)
    for q in range(count):
        MoV = facets[NOV, q]
        MoN = facets[X, q] * n[0] + facets[Y, q] * n[1] + facets[Z, q] * n[2]
        up, own = _half(min(1.0, max(-1.0, 2.0 * MoV * MoN - NoV))), _half(MoV)
        base += _upwards(up, own, base_width) * (facets[NAP, q] - facets[BASE, q])
        if top > 0.0:
            coat += _upwards(up, own, coat_width) * (1.0 - facets[COAT, q])
    return (
        base / (count * whole) if whole > 1e-6 else 1.0,
        coat / (count * top) if top > 1e-6 else 1.0,
    )


@leaf()
def brdf_facets(material, layers, fibres, coupling, view, facets, count, part, v, out):
    """Mean over ``count`` facets of BRDF times cosine, into ``out`` (3,).

    ``layers, fibres``: the material's, see ``tables``; ``part``: direction of the light, what it
    adds to the squared width of the lobes, cosine from the surface without its relief,
    angular radius, and which part of 1, 2 or 4 it is: each facet looks at one of them. The other
    arguments as for ``brdf``.
    """
    l, wider, smooth, angle, turn, parts = part
    h = unit(along(v, 1.0, l))
    LoH = min(1.0, dot(l, h))
    coat, nap = coat_share(material), sheen_share(material)
    base_lobe, top_lobe = lobe_of(view.alpha_x, wider), lobe_of(material.coat_roughness**2, wider)
    diffuse = lobe = again = nap_lobe = coat_lobe = coat_again = 0.0
    for q in range(count):
        if (q + 2 * (q >> 2) + (q >> 3)) & (parts - 1) != turn:
            continue
        m = (facets[X, q], facets[Y, q], facets[Z, q])
        c = above_horizon(dot(m, l), smooth, angle)
        if c <= 1e-5:
            continue
        NoV, NoH = facets[NOV, q], min(1.0, dot(m, h))
        base, below, lost, under, coat_lost = _layers(layers, min(1.0, c))
        below = c * min(facets[NAP, q], below)
        diffuse += c * facets[SHARE, q] * facets[BASE, q] * base
        again += below * facets[LOST, q] * lost
        lobe += below * GGX(base_lobe, NoV, c, NoH)
        if nap > 0.0:
            under = c * min(facets[COAT, q], under)
            nap_lobe += under * _fibres(fibres, 1.0 - NoH * NoH) * V_Neubelt(NoV, c)
        if coat > 0.0:
            coat_lobe += c * GGX(top_lobe, NoV, c, NoH)
            coat_again += c * facets[COAT_LOST, q] * coat_lost
    weight = parts / count
    diffuse *= weight * (1.0 - material.metalness) / (np.pi * coupling)
    again *= weight / (np.pi * (1.0 - view.means.base))
    nap_lobe *= weight * (1.0 - material.metalness)
    fresnel = 1.0 - LoH
    fresnel *= fresnel * fresnel * fresnel * fresnel
    top = 0.0
    if coat > 0.0:
        top = (COAT_F0 + (1.0 - COAT_F0) * fresnel) * coat_lobe
        top += view.means.coat_again * coat_again / (np.pi * (1.0 - view.means.coat))
    for k in range(3):
        out[k] = weight * (view.f0[k] + (view.f90[k] - view.f0[k]) * fresnel) * lobe
        out[k] += view.again[k] * again + view.colour[k] * diffuse
        out[k] += nap_lobe * material.sheen[k] + weight * coat * top
