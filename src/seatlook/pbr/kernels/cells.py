"""Distances to scattered points, from which pebbles are made."""

from __future__ import annotations

import numpy as np

from seatlook.pbr.kernels import leaf


@leaf()
def two_nearest(jitter, x, y, first, second):
    """Distance from (x, y) to the nearest and second nearest point, Worley 1996.

    One point lies in each cell of a tile, at ``jitter`` (n, n, 2) in its cell; ``x, y, first,
    second`` (h, w).
    """
    n = jitter.shape[0]
    for row in range(x.shape[0]):
        for column in range(x.shape[1]):
            u, v = x[row, column], y[row, column]
            i, j = int(np.floor(u)), int(np.floor(v))
            near = far = np.inf
            for dj in range(-2, 3):
                for di in range(-2, 3):
                    a = i + di + jitter[(j + dj) % n, (i + di) % n, 0] - u
                    b = j + dj + jitter[(j + dj) % n, (i + di) % n, 1] - v
                    d = a * a + b * b
                    if d < near:
                        near, far = d, near
                    elif d < far:
                        far = d
            first[row, column], second[row, column] = np.sqrt(near), np.sqrt(far)
