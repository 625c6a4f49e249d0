"""Quadratic form of one scalar matrix in the three columns of the positions."""

from numba import njit


@njit(cache=True)
def quadratic(start, columns, values, x, gradient):
    """Half of x . K x summed over the three axes; adds K x to ``gradient``.

    Rows of K sum to zero, so differences of positions stand for the positions: curvature energy
    is small against K times x squared and would drown in rounding.
    """
    total = 0.0
    for i in range(len(start) - 1):
        a = b = c = 0.0
        for j in range(start[i], start[i + 1]):
            v, k = columns[j], values[j]
            d0, d1, d2 = x[v, 0] - x[i, 0], x[v, 1] - x[i, 1], x[v, 2] - x[i, 2]
            a += k * d0
            b += k * d1
            c += k * d2
            total -= k * (d0 * d0 + d1 * d1 + d2 * d2)
        gradient[i, 0] += a
        gradient[i, 1] += b
        gradient[i, 2] += c
    return 0.25 * total
