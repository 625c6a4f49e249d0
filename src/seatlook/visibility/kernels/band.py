"""Contrast and sensitivity in one band of the pyramid."""

import math

from numba import njit

# What the octaves pass together of the contrast of a grating (Minkowski sum, exponent 3).
PASSED = 0.687


@njit(cache=True)
def contrasts(test, reference, test_ground, reference_ground, darkest, change, shared):
    """Fill ``change = |C_T - C_R|`` and ``shared = min(|C_T|, |C_R|)``, each (h, w).

    C is the band over its background, so scaled that a grating has its own contrast over all;
    the backgrounds are replaced by the adaptation luminance.
    """
    h, w = test.shape
    for i in range(h):
        for j in range(w):
            a, b = test_ground[i, j], reference_ground[i, j]
            c_test = (test[i, j] - a) / (PASSED * max(a, darkest))
            c_reference = (reference[i, j] - b) / (PASSED * max(b, darkest))
            change[i, j] = abs(c_test - c_reference)
            shared[i, j] = min(abs(c_test), abs(c_reference))
            test_ground[i, j] = max(0.5 * (a + b), darkest)


@njit(cache=True)
def sensitivity(luminance, table, lowest, per_octave):
    """S by linear interpolation between nodes at equal steps of luminance in every octave."""
    mantissa, exponent = math.frexp(luminance)
    place = (exponent - 1 - lowest) * per_octave + (2.0 * mantissa - 1.0) * per_octave
    place = min(max(place, 0.0), table.size - 1.000001)
    i = int(place)
    return table[i] + (place - i) * (table[i + 1] - table[i])


@njit(cache=True)
def weigh(change, shared, adaptation, table, lowest, per_octave):
    """Replace luminance by the change in thresholds, a shared contrast by its square in them."""
    h, w = shared.shape
    for i in range(h):
        for j in range(w):
            s = sensitivity(adaptation[i, j], table, lowest, per_octave)
            adaptation[i, j] = change[i, j] * s
            shared[i, j] = (shared[i, j] * s) ** 2
