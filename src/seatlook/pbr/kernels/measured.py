"""Measured maps in pattern coordinates; slopes finer than a sample turn to roughness."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from seatlook.pbr.kernels import leaf
from seatlook.pbr.kernels.brdf import MIN_ALPHA
from seatlook.pbr.kernels.grain import SHARP


class Measured(NamedTuple):
    """All map sets with their mip levels, ``texels`` (q, 8) float32.

    Channels: base colour over its mean (3), alpha squared, metalness, slope along u and v, their
    mean variance. ``levels`` (k, n, 3): where each level of each set begins, its rows and its
    columns, powers of two; ``size`` (k, 2) [m]: width and height of the piece.
    """

    texels: npt.NDArray[np.float32]
    levels: npt.NDArray[np.int64]
    size: npt.NDArray[np.float64]


@leaf()
def _mean(t, p, q, r, s, w, c):
    return w[0] * t[p, c] + w[1] * t[q, c] + w[2] * t[r, c] + w[3] * t[s, c]


@leaf()
def _bilinear(t, level, u, v):
    """Tiled value at (u, v) in tiles, as eight numbers."""
    start, rows, columns = level[0], level[1], level[2]
    x, y = u * columns - 0.5, v * rows - 0.5
    i, j = int(np.floor(x)), int(np.floor(y))
    a, b = x - i, y - j
    top = start + (j & (rows - 1)) * columns
    low = start + ((j + 1) & (rows - 1)) * columns
    left, right = i & (columns - 1), (i + 1) & (columns - 1)
    p, q, r, s = top + left, top + right, low + left, low + right
    w = ((1.0 - a) * (1.0 - b), a * (1.0 - b), (1.0 - a) * b, a * b)
    return (
        _mean(t, p, q, r, s, w, 0),
        _mean(t, p, q, r, s, w, 1),
        _mean(t, p, q, r, s, w, 2),
        _mean(t, p, q, r, s, w, 3),
        _mean(t, p, q, r, s, w, 4),
        _mean(t, p, q, r, s, w, 5),
        _mean(t, p, q, r, s, w, 6),
        _mean(t, p, q, r, s, w, 7),
    )


@leaf()
def measured(maps, material, u, v, width):
    """Colour over its mean, roughness, metalness, slopes of a sample ``width`` [m] wide.

    Olano and Baker 2010 (LEAN mapping): variance of the slopes that a level averages away widens
    the lobe, alpha^2 + 2 variance.
    """
    k = material.maps
    levels = maps.levels[k]
    tile_u, tile_v = maps.size[k, 0], maps.size[k, 1]
    texel = np.sqrt(tile_u / levels[0, 2] * tile_v / levels[0, 1])
    level = max(0.0, np.log2(SHARP * width / texel))
    fine = min(int(level), len(levels) - 1)
    coarse = min(fine + 1, len(levels) - 1)
    mix = min(1.0, level - fine)
    a = _bilinear(maps.texels, levels[fine], u / tile_u, v / tile_v)
    b = _bilinear(maps.texels, levels[coarse], u / tile_u, v / tile_v)
    colour = (a[0] + mix * (b[0] - a[0]), a[1] + mix * (b[1] - a[1]), a[2] + mix * (b[2] - a[2]))
    alpha2 = material.roughness**4 * (a[3] + mix * (b[3] - a[3]))
    alpha2 += 2.0 * (a[7] + mix * (b[7] - a[7]))
    roughness = min(1.0, np.sqrt(max(MIN_ALPHA, np.sqrt(alpha2))))
    metal = material.metalness * (a[4] + mix * (b[4] - a[4]))
    return colour, roughness, metal, a[5] + mix * (b[5] - a[5]), a[6] + mix * (b[6] - a[6])
