"""The samples of a relief under one sample of the picture: where they look, what they mirror.

A grain's slopes reach further than a polished lobe is wide, and are no Gaussian. One lobe at their
mean, widened by their variance (Olano and Baker 2010), has tails that are too bright: those of GGX
grow with its width squared. So the lobes are summed over samples of the relief.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from seatlook.pbr.kernels import leaf
from seatlook.pbr.kernels.coherent import WHOLE
from seatlook.pbr.kernels.grain import (
    WEAVE,
    bilinear,
    nearest_level,
    prefetch_bilinear,
    stroke,
)
from seatlook.pbr.kernels.surface import along, dot, minus, row, row_of, unit

# Relief samples of one sample along each side at most.
MOST = 8
# One row: as many samples as there may be, and a few more, or all rows would want the same lines of
# the cache.
_ROW = (np.float64, MOST * MOST + 4)
# Layers of a material at one cosine per sample, see ``tables.layers``.
LAYERS = np.dtype([(name, *_ROW) for name in ("base", "sheen", "lost", "coat", "coat_lost")])
# Rows of a relief. Loops along them hold no branch, no sum and no look-up, so that the compiler
# takes four samples at a time. In arrays of their own it takes eight where the processor can, and
# the four of a usual pixel go one by one: such a picture takes a fifth longer.
RELIEF = np.dtype(
    [
        # Place under the sample, slopes, unit normal, its cosine to the eye, share of the colour;
        # layers at that cosine.
        *((name, *_ROW) for name in ("across", "down", "slope_u", "slope_v", "x", "y", "z")),
        *((name, *_ROW) for name in ("NoV", "share")),
        ("layers", LAYERS),
        # What of base and coat goes up; point of a light's disc at which a sample looks.
        *((name, *_ROW) for name in ("up_base", "up_coat", "disc_x", "disc_y")),
        # Under one light: share of its part, cosines to it and of the half-vector, Fresnel's power;
        # layers there; the sheen's fibres.
        *((name, *_ROW) for name in ("part", "NoL", "NoH", "grazing")),
        ("light", LAYERS),
        ("fibres", *_ROW),
        # Lobes D V of base and coat; weights of a rectangle's cells.
        *((name, *_ROW) for name in ("low", "top", "weight")),
        # Reflected by the diffuse base, its lobe, the same times Fresnel's power, bounces in it,
        # sheen, coat, bounces in that.
        *((name, *_ROW) for name in ("diffuse", "lobe", "lobe_grazing", "again")),
        *((name, *_ROW) for name in ("sheen", "coat", "coat_again")),
    ]
)
# Texels are as wide as this share of a relief sample: what many of them leave out averages away,
# what a wider lobe adds does not.
_SHARP = 0.25


class Relief(NamedTuple):
    """Samples of a relief: ``rows`` is a record of ``RELIEF``, the first ``size`` are in use."""

    rows: np.void
    size: int


@leaf()
def sampled(material):
    """Whether samples show the relief: a weave would beat with the pixels, or turn its lobes."""
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
def mean_of(row, size):
    """Mean of the first ``size`` values of a row."""
    total = 0.0
    for q in range(size):
        total += row[q]
    return total / size


@leaf()
def spread(stage, sample, material, n, at, relief):
    """Relief under a sample, or under all that it stands for, into ``relief``.

    ``at`` (u, v) [m]: place of the sample in the pattern; ``n``: normal without the relief.
    Returns the mean normal; what the slopes within a relief sample, and those of all of them, add
    to the squared width of a lobe; and the share of the colour, to which that of each is relative.
    """
    place, hit, eye = sample.place, sample.hit, stage.eye
    covers = 2 if sample.code == WHOLE else 1  # samples along each side
    across, down = _step(place, row_of(eye.right), hit.t), _step(place, row_of(eye.down), hit.t)
    across, down = (covers * across[0], covers * across[1]), (covers * down[0], covers * down[1])
    steep = material.texture_depth / material.texture_scale
    variance, share = _slopes(stage.look.textures, material, at, across, down, sample.side, relief)
    bend, bow = _bend(stage.mesh, hit.face, n, across), _bend(stage.mesh, hit.face, n, down)
    _normals(relief, n, bend, bow, steep, place)
    rows, size = relief
    mean = (mean_of(rows.x, size), mean_of(rows.y, size), mean_of(rows.z, size))
    within = 2.0 * steep * steep * variance
    beside = within + max(0.0, 1.0 - dot(mean, mean))
    return unit(mean), within, beside, share * stroke(material, at[0], at[1])


@leaf()
def _slopes(textures, material, at, across, down, side, relief):
    """Slopes and colours of the samples; returns the means of variance within them, and colour."""
    texels = textures.texels[material.texture]
    width = np.sqrt(abs(across[0] * down[1] - across[1] * down[0])) / side
    tile = textures.cells * material.texture_scale
    level = nearest_level(textures, tile, _SHARP * width)
    variance, share, weight, scale = 0.0, 0.0, 1.0 / (side * side), 1.0 / tile
    line, column, rows = 0, 0, relief.rows
    for q in range(side * side):
        x, y = (column + 0.5) / side - 0.5, (line + 0.5) / side - 0.5
        column += 1
        if column == side:
            line, column = line + 1, 0
        u, v = at[0] + x * across[0] + y * down[0], at[1] + x * across[1] + y * down[1]
        su, sv, s2, colour = bilinear(texels, textures, level, u * scale, v * scale)
        # The next sample is most often the one beside.
        u, v = u + across[0], v + across[1]
        prefetch_bilinear(texels, textures, level, u * scale, v * scale)
        rows.across[q], rows.down[q] = x, y
        rows.slope_u[q], rows.slope_v[q], rows.share[q] = su, sv, colour
        variance += weight * s2
        share += weight * colour
    for q in range(side * side):
        rows.share[q] /= share
    return variance, share


@leaf()
def _normals(relief, n, bend, bow, steep, place):
    """Normals of the samples on a surface that bends across and down the sample."""
    rows, size = relief
    for q in range(size):
        x, y = rows.across[q], rows.down[q]
        u, v = -steep * rows.slope_u[q], -steep * rows.slope_v[q]
        m = along(along(along(along(n, x, bend), y, bow), u, place.warp), v, place.weft)
        m = unit(m)
        rows.x[q], rows.y[q], rows.z[q] = m
        rows.NoV[q] = max(0.01, dot(m, place.v))


@leaf()
def layers_towards(table, cosines, size, layers):
    """Layers of a material, by its table (n, 5), at the first ``size`` cosines of a row."""
    for q in range(size):
        x = np.sqrt(cosines[q]) * (len(table) - 1)
        j = min(int(x), len(table) - 2)
        b = x - j
        low, high = table[j], table[j + 1]
        layers.base[q] = low[0] + b * (high[0] - low[0])
        layers.sheen[q] = low[1] + b * (high[1] - low[1])
        layers.lost[q] = low[2] + b * (high[2] - low[2])
        layers.coat[q] = low[3] + b * (high[3] - low[3])
        layers.coat_lost[q] = low[4] + b * (high[4] - low[4])


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
def mirrored_by(reflector, relief, within, n, v):
    """Shares of base and coat that a relief mirrors, relative to one lobe at its mean normal.

    ``n``: normal without the relief, below which what its samples mirror is lost; ``within``: as
    ``spread`` returns it.
    """
    view, (rows, size) = reflector.sight, relief
    base_width = view.alpha_x**2 + within
    coat_width = reflector.material.coat_roughness**4 + within
    NoV = dot(n, v)
    for q in range(size):
        MoV = rows.NoV[q]
        MoN = rows.x[q] * n[0] + rows.y[q] * n[1] + rows.z[q] * n[2]
        up, own = _half(min(1.0, max(-1.0, 2.0 * MoV * MoN - NoV))), _half(MoV)
        base = rows.layers.sheen[q] - rows.layers.base[q]
        rows.up_base[q] = _upwards(up, own, base_width) * base
        rows.up_coat[q] = _upwards(up, own, coat_width) * (1.0 - rows.layers.coat[q])
    base, coat = view.layers.sheen - view.layers.base, 1.0 - view.layers.coat
    return (
        mean_of(rows.up_base, size) / base if base > 1e-6 else 1.0,
        mean_of(rows.up_coat, size) / coat if coat > 1e-6 else 1.0,
    )
