"""Colours of values, blended over the samples of each pixel."""

import math

from numba import njit


@njit(cache=True)
def coloured(value, cosine, seen, low, high, table, bare, paper, factor, out):
    """Mean linear colour of every pixel, (h, w, 3), from ``factor`` x ``factor`` samples.

    Values take the nearest row of ``table`` (k, 3), those outside its ends; nan is ``bare`` (3,).
    The surface is darker where it turns away, and ``paper`` where nothing is ``seen``.
    """
    last, share = len(table) - 1, 1.0 / (factor * factor)
    out[:] = 0.0
    for j in range(value.shape[0]):
        for i in range(value.shape[1]):
            pixel = out[j // factor, i // factor]
            if seen[j, i] < 0:
                for c in range(3):
                    pixel[c] += share * paper
                continue
            light = share * (0.62 + 0.38 * cosine[j, i])
            v = value[j, i]
            colour = bare
            if not math.isnan(v):
                place = min(max((v - low) / (high - low), 0.0), 1.0) * last
                colour = table[int(round(place))]
            for c in range(3):
                pixel[c] += light * colour[c]
