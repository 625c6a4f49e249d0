"""Repeatable random numbers from integers, and smooth noise made of them."""

from __future__ import annotations

import numpy as np

from seatlook.pbr.kernels import leaf

_LOW = np.uint64(0xFFFFFFFF)
_PRIMES = (np.uint64(73856093), np.uint64(19349663), np.uint64(83492791))
_MIX = (np.uint64(0x7FEB352D), np.uint64(0x846CA68B))


@leaf()
def even(i, j, k):
    """Number in [0, 1), the same for the same three integers; Wellons' lowbias32.

    Numba widens 32-bit products, so each one is cut back by hand.
    """
    h = (np.uint64(i) * _PRIMES[0]) ^ (np.uint64(j) * _PRIMES[1]) ^ (np.uint64(k) * _PRIMES[2])
    h &= _LOW
    h = ((h ^ (h >> np.uint64(16))) * _MIX[0]) & _LOW
    h = ((h ^ (h >> np.uint64(15))) * _MIX[1]) & _LOW
    return np.float64(h ^ (h >> np.uint64(16))) / 4294967296.0


@leaf()
def smooth(x, y, k):
    """Value noise in [-1, 1] with features of size 1, twice differentiable; Perlin 2002 fade."""
    i, j = int(np.floor(x)), int(np.floor(y))
    a, b = x - i, y - j
    a = a * a * a * (a * (6.0 * a - 15.0) + 10.0)
    b = b * b * b * (b * (6.0 * b - 15.0) + 10.0)
    # The plane is shifted so that all lattice numbers are positive.
    i, j = i + 1048576, j + 1048576
    low = (1.0 - a) * even(i, j, k) + a * even(i + 1, j, k)
    high = (1.0 - a) * even(i, j + 1, k) + a * even(i + 1, j + 1, k)
    return 2.0 * ((1.0 - b) * low + b * high) - 1.0
