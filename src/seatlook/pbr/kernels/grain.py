"""Relief maps in pattern coordinates, filtered so that detail below a sample turns to roughness."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from seatlook.pbr.kernels import leaf
from seatlook.pbr.kernels.noise import smooth


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


# Order of the maps, and share of the colour by which a stroke of the hand changes the nap.
LEATHER, SUEDE, WEAVE = 0, 1, 2
_STROKE = 0.035


@leaf()
def _bilinear(textures, which, level, u, v):
    """Tiled texel value at (u, v) in tiles, as four numbers."""
    n = textures.size >> level
    x, y = u * n - 0.5, v * n - 0.5
    i, j = int(np.floor(x)), int(np.floor(y))
    a, b = x - i, y - j
    base = textures.start[level]
    top, low = base + (j & (n - 1)) * n, base + ((j + 1) & (n - 1)) * n
    left, right = i & (n - 1), (i + 1) & (n - 1)
    t = textures.texels[which]
    w0, w1, w2, w3 = (1.0 - a) * (1.0 - b), a * (1.0 - b), (1.0 - a) * b, a * b
    p, q, r, s = top + left, top + right, low + left, low + right
    return (
        w0 * t[p, 0] + w1 * t[q, 0] + w2 * t[r, 0] + w3 * t[s, 0],
        w0 * t[p, 1] + w1 * t[q, 1] + w2 * t[r, 1] + w3 * t[s, 1],
        w0 * t[p, 2] + w1 * t[q, 2] + w2 * t[r, 2] + w3 * t[s, 2],
        w0 * t[p, 3] + w1 * t[q, 3] + w2 * t[r, 3] + w3 * t[s, 3],
    )


@leaf()
def grain(textures, material, u, v, width):
    """Slopes, roughness and colour share of a material's relief for a sample ``width`` [m] wide.

    Olano and Baker 2010 (LEAN mapping): the variance of the slopes that a level averages away
    widens the lobe, alpha^2 + 2 variance, so a minified grain neither sparkles nor turns smooth.
    """
    tile = textures.cells * material.texture_scale
    texel = tile / textures.size
    level = max(0.0, np.log2(width / texel))
    last = len(textures.start) - 1
    fine = min(int(level), last)
    coarse = min(fine + 1, last)
    mix = min(1.0, level - fine)
    fine_value = _bilinear(textures, material.texture, fine, u / tile, v / tile)
    coarse_value = _bilinear(textures, material.texture, coarse, u / tile, v / tile)
    su, sv, variance, share = (
        fine_value[0] + mix * (coarse_value[0] - fine_value[0]),
        fine_value[1] + mix * (coarse_value[1] - fine_value[1]),
        fine_value[2] + mix * (coarse_value[2] - fine_value[2]),
        fine_value[3] + mix * (coarse_value[3] - fine_value[3]),
    )
    steep = material.texture_depth / material.texture_scale
    alpha = material.roughness**2
    alpha = np.sqrt(alpha * alpha + 2.0 * steep * steep * variance)
    if material.texture == SUEDE:
        # Marks of the hand: the nap lies this way or that over a few centimetres. They change the
        # tone and not the normal: a slope over such a length would be taken for a wrinkle.
        bend = 0.4 * smooth(u / 0.06, v / 0.06, 3)
        mark = 4.0 * smooth(u / 0.05 + bend, v / 0.03 + bend, 1)
        share *= 1.0 + _STROKE * (mark / np.sqrt(1.0 + mark * mark) - 1.0)
    return steep * su, steep * sv, min(1.0, np.sqrt(alpha)), share
