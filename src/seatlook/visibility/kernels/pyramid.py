"""Binomial pyramid: (1 4 6 4 1)/16, down by two and up again."""

import numpy as np
from numba import njit

RIM = 2


@njit(cache=True)
def beyond(edge, mirrored, step, rise):
    """Sample ``step`` pixels outside the picture, so that even shading stays without contrast.

    What lies as far inside is mirrored, the slope goes on. Kept within a factor two of the edge,
    since luminance must not turn negative.
    """
    return min(max(mirrored - 2.0 * step * rise, 0.5 * edge), 2.0 * edge)


@njit(cache=True)
def rise_of(line):
    """Slope per pixel at the first end of a line, over eight pixels: a texture is no slope."""
    n = min(4, line.size // 2)
    if n == 0:
        return 0.0
    return (line[n : 2 * n].mean() - line[:n].mean()) / n


@njit(cache=True)
def extend(image):
    """Picture (h, w) with a rim of two pixels, (h + 4, w + 4)."""
    h, w = image.shape
    out = np.empty((h + 2 * RIM, w + 2 * RIM))
    out[RIM:-RIM, RIM:-RIM] = image
    for j in range(w):
        lengthen(out[:, RIM + j])
    for i in range(h + 2 * RIM):
        lengthen(out[i])
    return out


@njit(cache=True)
def lengthen(line):
    """Fill the two samples at either end of a line from those between."""
    inner = line[RIM:-RIM]
    last = inner.size - 1
    first_rise, last_rise = rise_of(inner), rise_of(inner[::-1])
    for k in range(1, RIM + 1):
        m = min(k, last)
        line[RIM - k] = beyond(inner[0], inner[m], m, first_rise) if m else inner[0]
        line[RIM + last + k] = (
            beyond(inner[last], inner[last - m], m, last_rise) if m else inner[last]
        )


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
def soften(image):
    """Smooth by (1 6 1)/8, size kept.

    Without it the finest band, which has no finer one above it, would pass 1.6 times what the
    others do; with it all pass the same within 2 dB, up to 0.4 cycles per pixel.
    """
    h, w = image.shape
    rim = extend(image)
    out = np.empty((h, w))
    row = np.empty(w + 2 * RIM)
    for i in range(h):
        above, middle, below = rim[i + 1], rim[i + 2], rim[i + 3]
        for j in range(row.size):
            row[j] = above[j] + below[j] + 6.0 * middle[j]
        for j in range(w):
            out[i, j] = (row[j + 1] + row[j + 3] + 6.0 * row[j + 2]) / 64.0
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
