"""Binomial pyramid: (1 4 6 4 1)/16, down by two and up again."""

import numpy as np
from numba import njit

RIM = 2


@njit(cache=True)
def beyond(edge, inner):
    """Sample outside the picture: the slope goes on, so that even shading stays without contrast.

    Kept within a factor two of the edge, since luminance must not turn negative.
    """
    return min(max(2.0 * edge - inner, 0.5 * edge), 2.0 * edge)


@njit(cache=True)
def extend(image):
    """Picture (h, w) with a rim of two pixels, (h + 4, w + 4)."""
    h, w = image.shape
    out = np.empty((h + 2 * RIM, w + 2 * RIM))
    out[RIM:-RIM, RIM:-RIM] = image
    for k in range(1, RIM + 1):
        for j in range(w):
            out[RIM - k, RIM + j] = beyond(image[0, j], image[min(k, h - 1), j])
            out[RIM + h - 1 + k, RIM + j] = beyond(image[h - 1, j], image[max(h - 1 - k, 0), j])
    first, last = RIM, RIM + w - 1
    for i in range(h + 2 * RIM):
        for k in range(1, RIM + 1):
            out[i, first - k] = beyond(out[i, first], out[i, min(first + k, last)])
            out[i, last + k] = beyond(out[i, last], out[i, max(last - k, first)])
    return out


@njit(cache=True)
def reduce(image):
    """Smooth and keep every second pixel, (h, w) -> (ceil(h/2), ceil(w/2))."""
    h, w = image.shape
    rim = extend(image)
    out = np.empty(((h + 1) // 2, (w + 1) // 2))
    row = np.empty(w + 2 * RIM)
    for i in range(out.shape[0]):
        down(rim, 2 * i, row)
        for j in range(out.shape[1]):
            k = 2 * j
            outer, inner = row[k] + row[k + 4], row[k + 1] + row[k + 3]
            out[i, j] = (outer + 4.0 * inner + 6.0 * row[k + 2]) / 256.0
    return out


@njit(cache=True)
def blur(image):
    """Smooth with the same weights, size kept."""
    h, w = image.shape
    rim = extend(image)
    out = np.empty((h, w))
    row = np.empty(w + 2 * RIM)
    for i in range(h):
        down(rim, i, row)
        for j in range(w):
            outer, inner = row[j] + row[j + 4], row[j + 1] + row[j + 3]
            out[i, j] = (outer + 4.0 * inner + 6.0 * row[j + 2]) / 256.0
    return out


@njit(cache=True)
def down(rim, first, row):
    """Weigh five rows of the extended picture from ``first`` on, times 16."""
    a, b, c = rim[first], rim[first + 1], rim[first + 2]
    d, e = rim[first + 3], rim[first + 4]
    for j in range(row.size):
        row[j] = (a[j] + e[j]) + 4.0 * (b[j] + d[j]) + 6.0 * c[j]


@njit(cache=True)
def expand(image, out):
    """Fill ``out`` (h, w) with ``image`` (ceil(h/2), ceil(w/2)) brought back to its size."""
    h, w = out.shape
    rim = extend(image)
    row = np.empty(rim.shape[1])
    for i in range(h):
        above, middle, below = rim[i // 2 + 1], rim[i // 2 + 2], rim[i // 2 + 3]
        if i % 2 == 0:
            for j in range(row.size):
                row[j] = (above[j] + below[j] + 6.0 * middle[j]) / 8.0
        else:
            for j in range(row.size):
                row[j] = (middle[j] + below[j]) / 2.0
        for j in range(0, w, 2):
            k = j // 2 + RIM
            out[i, j] = (row[k - 1] + row[k + 1] + 6.0 * row[k]) / 8.0
        for j in range(1, w, 2):
            k = j // 2 + RIM
            out[i, j] = (row[k] + row[k + 1]) / 2.0
