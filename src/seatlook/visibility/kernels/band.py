"""What one band of the pyramid adds to the visibility map."""

import math

from numba import njit


@njit(cache=True)
def contrasts(test, reference, test_ground, reference_ground, darkest, change, shared):
    """Fill ``change = |C_T - C_R|`` and ``shared = min(|C_T|, |C_R|)``, each (h, w).

    C is the band over its background; the backgrounds are replaced by the adaptation luminance.
    """
    h, w = test.shape
    for i in range(h):
        for j in range(w):
            a, b = test_ground[i, j], reference_ground[i, j]
            c_test = (test[i, j] - a) / max(a, darkest)
            c_reference = (reference[i, j] - b) / max(b, darkest)
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
def weigh(change, mask, adaptation, table, lowest, per_octave):
    """Multiply ``change`` and ``mask`` (h, w) by S at the adaptation luminance, in place."""
    h, w = change.shape
    for i in range(h):
        for j in range(w):
            s = sensitivity(adaptation[i, j], table, lowest, per_octave)
            change[i, j] *= s
            mask[i, j] *= s
