"""Colours of values, blended over the samples of each pixel."""

import math

import numpy as np
from numba import njit


@njit(cache=True)
def coloured(value, cosine, seen, low, high, table, bare, paper, factor, out):
    """Mean linear colour of every pixel, (h, w, 3), from ``factor`` x ``factor`` samples.

    Values take the nearest row of ``table`` (k, 3), those outside its ends; nan is ``bare``.
    The surface is darker where it turns away, and ``paper`` where nothing is ``seen``.
    """
    last, share = len(table) - 1, 1.0 / (factor * factor)
    for y in range(out.shape[0]):
        for x in range(out.shape[1]):
            red = green = blue = 0.0
            for j in range(factor * y, factor * (y + 1)):
                for i in range(factor * x, factor * (x + 1)):
                    if seen[j, i] < 0:
                        red += share * paper
                        green += share * paper
                        blue += share * paper
                        continue
                    light = share * (0.62 + 0.38 * cosine[j, i])
                    v = value[j, i]
                    if math.isnan(v):
                        red += light * bare
                        green += light * bare
                        blue += light * bare
                        continue
                    k = int(np.rint(min(max((v - low) / (high - low), 0.0), 1.0) * last))
                    red += light * table[k, 0]
                    green += light * table[k, 1]
                    blue += light * table[k, 2]
            out[y, x, 0], out[y, x, 1], out[y, x, 2] = red, green, blue
