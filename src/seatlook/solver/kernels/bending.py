"""Quadratic form of one symmetric scalar matrix in the three columns of the positions."""

from numba import njit


@njit(cache=True)
def quadratic(start, columns, values, x, gradient):
    """Half of x . K x summed over the three axes; adds K x to ``gradient``.

    Rows of K sum to zero, so its upper triangle says all: every pair of vertices pulls on both
    alike. Differences also spare the rounding in which a small energy would drown.
    """
    total = 0.0
    for i in range(len(start) - 1):
        x0, x1, x2 = x[i, 0], x[i, 1], x[i, 2]
        a = b = c = 0.0
        for j in range(start[i], start[i + 1]):
            v, k = columns[j], values[j]
            d0, d1, d2 = x[v, 0] - x0, x[v, 1] - x1, x[v, 2] - x2
            total -= k * (d0 * d0 + d1 * d1 + d2 * d2)
            d0, d1, d2 = k * d0, k * d1, k * d2
            a += d0
            b += d1
            c += d2
            gradient[v, 0] -= d0
            gradient[v, 1] -= d1
            gradient[v, 2] -= d2
        gradient[i, 0] += a
        gradient[i, 1] += b
        gradient[i, 2] += c
    return 0.5 * total
