"""The facets of a relief that one sample covers: where they look, and what they mirror.

A grain's slopes reach further than a polished lobe is wide, and are no Gaussian. One lobe at their
mean, widened by their variance (Olano and Baker 2010), has tails that are too bright: those of GGX
grow with its width squared. So the lobes are summed over facets.
"""

from __future__ import annotations

import numpy as np

from seatlook.pbr.kernels import leaf
from seatlook.pbr.kernels.grain import (
    WEAVE,
    bilinear,
    fetch_bilinear,
    nearest_level,
    stroke,
)
from seatlook.pbr.kernels.surface import along, dot, minus, row, row_of, unit

# Facets of one sample along each side at most.
MOST = 8
# Where the rows of the room for facets begin, each with as many facets as there may be, and a few
# more, or all would want the same lines of the cache. Loops along them hold no branch, no sum and
# no look-up, so that the compiler takes four facets at a time.
_PITCH = MOST * MOST + 4
# Place under the sample, slopes, unit normal, its cosine to the eye, share of the colour; layers
# at that cosine; what of base and coat goes up; point of a light's disc at which a facet looks.
PLACE_X, PLACE_Y, SLOPE_U, SLOPE_V, X, Y, Z, NOV, SHARE = range(0, 9 * _PITCH, _PITCH)
BASE, NAP, LOST, COAT, COAT_LOST = range(9 * _PITCH, 14 * _PITCH, _PITCH)
UP_BASE, UP_COAT, DISC_X, DISC_Y = range(14 * _PITCH, 18 * _PITCH, _PITCH)
# Under one light: share of its part, cosines to it and of the half-vector, Fresnel's power, layers
# there, the nap's fibres.
PART, NOL, NOH, GRAZING, BASE_L, NAP_L, LOST_L, COAT_L, COAT_LOST_L, FIBRES = range(
    18 * _PITCH, 28 * _PITCH, _PITCH
)
# Reflected by the diffuse base, its lobe, the same times Fresnel's power, bounces in it, nap, coat,
# bounces in that.
DIFFUSE, LOBE, LOBE_GRAZING, AGAIN, NAP_LOBE, COAT_LOBE, COAT_AGAIN = range(
    28 * _PITCH, 35 * _PITCH, _PITCH
)
ROOM = 35 * _PITCH
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
def mean_of(facets, start, count):
    """Mean of a row."""
    total = 0.0
    for q in range(count):
        total += facets[start + q]
    return total / count


@leaf()
def spread(mesh, textures, eye, material, f, place, n, at, t, covers, side, facets):
    """Facets of the relief under a sample, or under all that it stands for, into ``facets``.

    ``at`` (u, v) [m]: place of the sample in the pattern; ``t`` [m]: distance from the eye; ``n``:
    normal without the relief; ``covers``: samples along each side that it stands for;
    ``side``: facets along each side of it.
    Returns the mean normal; what the slopes within a facet, and those of all facets, add to the
    squared width of a lobe; and the share of the colour, to which that of each facet is relative.
    """
    count = side * side
    across, down = _step(place, row_of(eye.right), t), _step(place, row_of(eye.down), t)
    across, down = (covers * across[0], covers * across[1]), (covers * down[0], covers * down[1])
    steep = material.texture_depth / material.texture_scale
    variance, share = _slopes(textures, material, at, across, down, side, facets)
    _normals(facets, count, n, _bend(mesh, f, n, across), _bend(mesh, f, n, down), steep, place)
    mean = (mean_of(facets, X, count), mean_of(facets, Y, count), mean_of(facets, Z, count))
    within = 2.0 * steep * steep * variance
    beside = within + max(0.0, 1.0 - dot(mean, mean))
    return unit(mean), within, beside, share * stroke(material, at[0], at[1])


@leaf()
def _slopes(textures, material, at, across, down, side, facets):
    """Slopes and colours of the facets; returns the means of variance within them, and colour."""
    texels = textures.texels[material.texture]
    width = np.sqrt(abs(across[0] * down[1] - across[1] * down[0])) / side
    tile = textures.cells * material.texture_scale
    level = nearest_level(textures, tile, _SHARP * width)
    variance, share, weight, scale = 0.0, 0.0, 1.0 / (side * side), 1.0 / tile
    line, column = 0, 0
    for q in range(side * side):
        x, y = (column + 0.5) / side - 0.5, (line + 0.5) / side - 0.5
        column += 1
        if column == side:
            line, column = line + 1, 0
        u, v = at[0] + x * across[0] + y * down[0], at[1] + x * across[1] + y * down[1]
        su, sv, s2, colour = bilinear(texels, textures, level, u * scale, v * scale)
        # The next sample is most often the one beside.
        u, v = u + across[0], v + across[1]
        fetch_bilinear(texels, textures, level, u * scale, v * scale)
        facets[PLACE_X + q], facets[PLACE_Y + q] = x, y
        facets[SLOPE_U + q], facets[SLOPE_V + q], facets[SHARE + q] = su, sv, colour
        variance += weight * s2
        share += weight * colour
    for q in range(side * side):
        facets[SHARE + q] /= share
    return variance, share


@leaf()
def _normals(facets, count, n, bend, bow, steep, place):
    """Normals of the facets on a surface that bends across and down the sample."""
    for q in range(count):
        x, y = facets[PLACE_X + q], facets[PLACE_Y + q]
        u, v = -steep * facets[SLOPE_U + q], -steep * facets[SLOPE_V + q]
        m = along(along(along(along(n, x, bend), y, bow), u, place.warp), v, place.weft)
        m = unit(m)
        facets[X + q], facets[Y + q], facets[Z + q] = m
        facets[NOV + q] = max(0.01, dot(m, place.v))


@leaf()
def layers_of(layers, mu):
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
def layers_to_eye(layers, facets, count):
    """Layers at the facets' cosines to the eye, into ``facets``."""
    for q in range(count):
        here = layers_of(layers, facets[NOV + q])
        facets[BASE + q], facets[NAP + q], facets[LOST + q] = here[0], here[1], here[2]
        facets[COAT + q], facets[COAT_LOST + q] = here[3], here[4]


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
    base_width, coat_width = view.alpha_x**2 + within, material.coat_roughness**4 + within
    NoV = dot(n, v)
    for q in range(count):
        MoV = facets[NOV + q]
        MoN = facets[X + q] * n[0] + facets[Y + q] * n[1] + facets[Z + q] * n[2]
        up, own = _half(min(1.0, max(-1.0, 2.0 * MoV * MoN - NoV))), _half(MoV)
        facets[UP_BASE + q] = _upwards(up, own, base_width) * (facets[NAP + q] - facets[BASE + q])
        facets[UP_COAT + q] = _upwards(up, own, coat_width) * (1.0 - facets[COAT + q])
    base, coat = view.layers.nap - view.layers.base, 1.0 - view.layers.coat
    return (
        mean_of(facets, UP_BASE, count) / base if base > 1e-6 else 1.0,
        mean_of(facets, UP_COAT, count) / coat if coat > 1e-6 else 1.0,
    )
