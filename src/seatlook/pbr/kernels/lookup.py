"""Tables of directional albedos, and what lies between their nodes."""

from __future__ import annotations

import numpy as np

from seatlook.pbr.kernels import leaf

ROUGHNESS_LOW = 0.08


@leaf()
def cell(value, low, high, n):
    """Index and weight for linear interpolation on ``n`` even nodes."""
    x = (value - low) * ((n - 1.0) * (1.0 / (high - low)))
    x = min(max(x, 0.0), n - 1.0)
    i = min(int(x), n - 2)
    return i, x - i


@leaf()
def bilinear(table, i, a, j, b):
    """Value between four nodes, by the indices and weights of ``cell``."""
    below = table[i, j] + b * (table[i, j + 1] - table[i, j])
    above = table[i + 1, j] + b * (table[i + 1, j + 1] - table[i + 1, j])
    return below + a * (above - below)


@leaf()
def lookup(table, roughness, mu):
    """Bilinear value of a table at roughness and cosine."""
    i, a = cell(roughness, ROUGHNESS_LOW, 1.0, table.shape[0])
    j, b = cell(np.sqrt(mu), 0.0, 1.0, table.shape[1])
    return bilinear(table, i, a, j, b)


@leaf()
def lookup_mean(table, roughness):
    """Linear value of a table over roughness alone."""
    i, a = cell(roughness, ROUGHNESS_LOW, 1.0, table.shape[0])
    return table[i] + a * (table[i + 1] - table[i])


@leaf()
def stretched_at(table, place, x, root):
    """What anisotropy adds to scale and bias, from a table (k, a, t, n, 2).

    ``place``: cells of roughness and anisotropy; ``x``: cosine of the azimuth from the wider
    axis; ``root``: square root of the cosine to the normal.
    """
    (i, a), (k, b) = place
    t, c = cell(x, 0.0, 1.0, table.shape[2])
    j, d = cell(root, 0.0, 1.0, table.shape[3])
    scale, bias = 0.0, 0.0
    for q in range(16):
        w = a if q & 1 else 1.0 - a
        w *= b if q & 2 else 1.0 - b
        w *= c if q & 4 else 1.0 - c
        w *= d if q & 8 else 1.0 - d
        if w > 0.0:
            node = table[i + (q & 1), k + (q >> 1 & 1), t + (q >> 2 & 1), j + (q >> 3)]
            scale += w * node[0]
            bias += w * node[1]
    return scale, bias
