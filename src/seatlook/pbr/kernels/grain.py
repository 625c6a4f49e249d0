"""Relief maps in pattern coordinates, filtered so that detail below a sample turns to roughness."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from seatlook.pbr.kernels import leaf
from seatlook.pbr.kernels.noise import smooth
from seatlook.pbr.kernels.prefetch import prefetch_row


class Textures(NamedTuple):
    """All relief maps with their mip levels, ``texels`` (k, q, 4) float32.

    Channels: slope along u and v and their mean variance, for a depth of one cell; then the share
    of the base colour that the hollows leave. ``start`` (levels,): where each level begins;
    ``size``: texels across level 0; ``cells``: cells of the grain across a tile.
    """

    texels: npt.NDArray[np.float32]
    start: npt.NDArray[np.int64]
    size: int
    cells: float


# Order of the maps, and share of the colour by which a stroke of the hand changes suede.
LEATHER, SUEDE, WEAVE = 0, 1, 2
STROKE = 0.035
# Texels are as wide as this share of a sample: the levels' own filter is wider than a box, and the
# steep narrow folds of a grain are no Gaussian that roughness could stand for.
SHARP = 0.5
# Samples per cell of a weave below which its texels are wider: it is regular and would beat with
# the pixels.
_WEAVE = 4.0


@leaf()
def bilinear(t, textures, level, u, v):
    """Tiled value of one map ``t`` at (u, v) in tiles, as four numbers."""
    n = textures.size >> level
    x, y = u * n - 0.5, v * n - 0.5
    i, j = int(np.floor(x)), int(np.floor(y))
    a, b = x - i, y - j
    base = textures.start[level]
    top, low = base + (j & (n - 1)) * n, base + ((j + 1) & (n - 1)) * n
    left, right = i & (n - 1), (i + 1) & (n - 1)
    # As narrow as the texels, or each of them would be widened.
    w0, w1 = np.float32((1.0 - a) * (1.0 - b)), np.float32(a * (1.0 - b))
    w2, w3 = np.float32((1.0 - a) * b), np.float32(a * b)
    p, q, r, s = top + left, top + right, low + left, low + right
    return (
        w0 * t[p, 0] + w1 * t[q, 0] + w2 * t[r, 0] + w3 * t[s, 0],
        w0 * t[p, 1] + w1 * t[q, 1] + w2 * t[r, 1] + w3 * t[s, 1],
        w0 * t[p, 2] + w1 * t[q, 2] + w2 * t[r, 2] + w3 * t[s, 2],
        w0 * t[p, 3] + w1 * t[q, 3] + w2 * t[r, 3] + w3 * t[s, 3],
    )


@leaf()
def prefetch_bilinear(t, textures, level, u, v):
    """Begin to read what ``bilinear`` will."""
    n = textures.size >> level
    i, j = int(np.floor(u * n - 0.5)), int(np.floor(v * n - 0.5))
    base, column, right = textures.start[level], i & (n - 1), (i + 1) & (n - 1)
    top, low = base + (j & (n - 1)) * n, base + ((j + 1) & (n - 1)) * n
    prefetch_row(t, top + column)  # type: ignore[call-arg]
    prefetch_row(t, low + column)
    prefetch_row(t, top + right)
    prefetch_row(t, low + right)


@leaf()
def nearest_level(textures, tile, width):
    """Level whose texels are nearest to ``width`` [m]."""
    level = int(max(0.0, np.log2(width * textures.size / tile)) + 0.5)
    return min(level, len(textures.start) - 1)


@leaf()
def filtered(t, textures, material, u, v, width):
    """Value of one map by texels ``width`` [m] wide, or the finest."""
    tile = textures.cells * material.texture_scale
    texel = tile / textures.size
    level = max(0.0, np.log2(width / texel))
    last = len(textures.start) - 1
    fine = min(int(level), last)
    coarse = min(fine + 1, last)
    mix = min(1.0, level - fine)
    low = bilinear(t, textures, fine, u / tile, v / tile)
    if mix == 0.0:
        return low
    high = bilinear(t, textures, coarse, u / tile, v / tile)
    return (
        low[0] + mix * (high[0] - low[0]),
        low[1] + mix * (high[1] - low[1]),
        low[2] + mix * (high[2] - low[2]),
        low[3] + mix * (high[3] - low[3]),
    )


@leaf()
def stroke(material, u, v):
    """Share of the colour left by marks of the hand: suede's fibres lie this way or that.

    They change the tone and not the normal: a slope over a few centimetres would be taken for a
    wrinkle.
    """
    if material.texture != SUEDE:
        return 1.0
    bend = 0.4 * smooth(u / 0.06, v / 0.06, 3)
    mark = 4.0 * smooth(u / 0.05 + bend, v / 0.03 + bend, 1)
    return 1.0 + STROKE * (mark / np.sqrt(1.0 + mark * mark) - 1.0)


@leaf()
def grain(textures, material, roughness, u, v, width):
    """Slopes, roughness and colour share of a material's relief for a sample ``width`` [m] wide.

    Olano and Baker 2010 (LEAN mapping): the variance of the slopes that a level averages away
    widens the lobe, alpha^2 + 2 variance, so a minified grain neither sparkles nor turns smooth.
    """
    texels = textures.texels[material.texture]
    if material.texture == WEAVE:
        width *= max(1.0, _WEAVE * width / material.texture_scale)
    su, sv, variance, share = filtered(texels, textures, material, u, v, SHARP * width)
    steep = material.texture_depth / material.texture_scale
    alpha = roughness**2
    alpha = np.sqrt(alpha * alpha + 2.0 * steep * steep * variance)
    share *= stroke(material, u, v)
    return steep * su, steep * sv, min(1.0, np.sqrt(alpha)), share


@leaf()
def holes(pitch, diameter, u, v, width):
    """Share of a sample ``width`` [m] wide that falls into punched holes in staggered rows."""
    height = pitch * np.sqrt(0.75)
    mean = 0.25 * np.pi * diameter * diameter / (pitch * height)
    # Holes closer than a sample show as their mean.
    blur = min(1.0, max(0.0, width / pitch - 0.5))
    if blur == 1.0:
        return mean
    line, nearest = np.floor(v / height), np.inf
    for j in range(2):
        y = v - (line + j) * height
        x = u / pitch - 0.5 * ((line + j) % 2.0)
        x = (x - np.floor(x + 0.5)) * pitch
        nearest = min(nearest, x * x + y * y)
    inside = (0.5 * diameter - np.sqrt(nearest)) / max(width, 1e-9) + 0.5
    return (1.0 - blur) * min(1.0, max(0.0, inside)) + blur * mean
