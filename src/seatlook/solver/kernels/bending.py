"""Product of one scalar matrix with the three columns of the positions."""

from numba import njit


@njit(cache=True)
def quadratic(start, columns, values, x, gradient):
    """Half of x . K x summed over the three axes; adds K x to ``gradient``."""
    total = 0.0
    for i in range(len(start) - 1):
        a = b = c = 0.0
        for j in range(start[i], start[i + 1]):
            v, k = columns[j], values[j]
            a += k * x[v, 0]
            b += k * x[v, 1]
            c += k * x[v, 2]
        total += a * x[i, 0] + b * x[i, 1] + c * x[i, 2]
        gradient[i, 0] += a
        gradient[i, 1] += b
        gradient[i, 2] += c
    return 0.5 * total
