"""Vector work of L-BFGS: one thread, one order of summation, so that a run repeats to the bit."""

from numba import njit


@njit(cache=True)
def dot(a, b):
    """Inner product of two (n, 3) arrays."""
    total = 0.0
    for i in range(len(a)):
        total += a[i, 0] * b[i, 0] + a[i, 1] * b[i, 1] + a[i, 2] * b[i, 2]
    return total


@njit(cache=True)
def largest_row(a):
    """Largest norm of a row; nan if there is one."""
    most = 0.0
    for i in range(len(a)):
        size = a[i, 0] * a[i, 0] + a[i, 1] * a[i, 1] + a[i, 2] * a[i, 2]
        if not size <= most:
            most = size
            if size != size:
                break
    return most**0.5


@njit(cache=True)
def add_scaled(x, scale, d, out):
    """Set ``out`` to x + scale d."""
    for i in range(len(x)):
        for k in range(3):
            out[i, k] = x[i, k] + scale * d[i, k]


@njit(cache=True)
def first_loop(q, s, y, rho, alpha, count):
    """Walk from the newest pair to the oldest (Nocedal and Wright 2006, algorithm 7.4)."""
    memory = len(rho)
    for j in range(count - 1, max(count - memory, 0) - 1, -1):
        i = j % memory
        alpha[i] = rho[i] * dot(s[i], q)
        add_scaled(q, -alpha[i], y[i], q)


@njit(cache=True)
def second_loop(q, s, y, rho, alpha, count):
    """Walk back from the oldest pair to the newest."""
    memory = len(rho)
    for j in range(max(count - memory, 0), count):
        i = j % memory
        beta = rho[i] * dot(y[i], q)
        add_scaled(q, alpha[i] - beta, s[i], q)
