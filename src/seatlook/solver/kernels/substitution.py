"""Forward and backward substitution with the fronts of a Cholesky factor; layout as in ``fronts``.

Single right-hand sides take four rows of the factor at a time, triples two: what is loaded, of the
factor or of the solution, serves several products.
"""

from numba import njit


@njit(cache=True)
def forward(storage, at, starts, rim_at, rims, size, x, work):
    """Solve U^T x = x for one right-hand side in the order of elimination."""
    for f in range(len(starts) - 1):
        first = size * starts[f]
        wide, deep = size * starts[f + 1] - first, size * (rim_at[f + 1] - rim_at[f])
        y, side, begin = x[first : first + wide], work[:deep], at[f]
        for j in range(wide):
            row, rest = storage[begin + j : begin + wide], y[j:]
            v = rest[0] / row[0]
            rest[0] = v
            for i in range(1, len(row)):
                rest[i] -= v * row[i]
            begin += wide
        side[:] = 0.0
        for j in range(0, wide - 3, 4):
            a, b = storage[begin : begin + deep], storage[begin + deep : begin + 2 * deep]
            begin += 2 * deep
            c, d = storage[begin : begin + deep], storage[begin + deep : begin + 2 * deep]
            begin += 2 * deep
            s, t, u, v = y[j], y[j + 1], y[j + 2], y[j + 3]
            for i in range(deep):
                side[i] += (s * a[i] + t * b[i]) + (u * c[i] + v * d[i])
        for j in range(wide - wide % 4, wide):
            a, s = storage[begin : begin + deep], y[j]
            begin += deep
            for i in range(deep):
                side[i] += s * a[i]
        rim = rims[rim_at[f] : rim_at[f + 1]]
        for i in range(len(rim)):
            for k in range(size):
                x[size * rim[i] + k] -= side[size * i + k]


@njit(cache=True)
def backward(storage, at, starts, rim_at, rims, size, x, work):
    """Solve U x = x for one right-hand side in the order of elimination."""
    for f in range(len(starts) - 2, -1, -1):
        first = size * starts[f]
        wide, deep = size * starts[f + 1] - first, size * (rim_at[f + 1] - rim_at[f])
        y, side = x[first : first + wide], work[:deep]
        rim = rims[rim_at[f] : rim_at[f + 1]]
        for i in range(len(rim)):
            for k in range(size):
                side[size * i + k] = x[size * rim[i] + k]
        begin = at[f] + wide * wide
        for j in range(0, wide - 3, 4):
            a, b = storage[begin : begin + deep], storage[begin + deep : begin + 2 * deep]
            begin += 2 * deep
            c, d = storage[begin : begin + deep], storage[begin + deep : begin + 2 * deep]
            begin += 2 * deep
            s, t, u, v = 0.0, 0.0, 0.0, 0.0
            for i in range(deep):
                value = side[i]
                s += value * a[i]
                t += value * b[i]
                u += value * c[i]
                v += value * d[i]
            y[j] -= s
            y[j + 1] -= t
            y[j + 2] -= u
            y[j + 3] -= v
        for j in range(wide - wide % 4, wide):
            a, s = storage[begin : begin + deep], 0.0
            begin += deep
            for i in range(deep):
                s += side[i] * a[i]
            y[j] -= s
        begin = at[f] + wide * wide
        for j in range(wide - 1, -1, -1):
            begin -= wide
            row, rest, s, t = storage[begin + j : begin + wide], y[j:], 0.0, 0.0
            for i in range(1, len(row) - 1, 2):
                s += row[i] * rest[i]
                t += row[i + 1] * rest[i + 1]
            if len(row) % 2 == 0:
                s += row[-1] * rest[-1]
            rest[0] = (rest[0] - (s + t)) / row[0]


@njit(cache=True)
def forward_triple(storage, at, starts, rim_at, rims, x, work):
    """Solve U^T x = x for (n, 3) right-hand sides in the order of elimination."""
    for f in range(len(starts) - 1):
        first = starts[f]
        wide, deep = starts[f + 1] - first, rim_at[f + 1] - rim_at[f]
        y, side, begin = x[first : first + wide], work[:deep], at[f]
        for j in range(wide):
            row, rest = storage[begin + j : begin + wide], y[j:]
            p, q, r = rest[0, 0] / row[0], rest[0, 1] / row[0], rest[0, 2] / row[0]
            rest[0, 0], rest[0, 1], rest[0, 2] = p, q, r
            for i in range(1, len(row)):
                a = row[i]
                rest[i, 0] -= p * a
                rest[i, 1] -= q * a
                rest[i, 2] -= r * a
            begin += wide
        side[:] = 0.0
        for j in range(0, wide - 1, 2):
            one, two = storage[begin : begin + deep], storage[begin + deep : begin + 2 * deep]
            begin += 2 * deep
            p, q, r = y[j, 0], y[j, 1], y[j, 2]
            s, t, u = y[j + 1, 0], y[j + 1, 1], y[j + 1, 2]
            for i in range(deep):
                a, b = one[i], two[i]
                side[i, 0] += p * a + s * b
                side[i, 1] += q * a + t * b
                side[i, 2] += r * a + u * b
        if wide % 2:
            one = storage[begin : begin + deep]
            p, q, r = y[wide - 1, 0], y[wide - 1, 1], y[wide - 1, 2]
            for i in range(deep):
                a = one[i]
                side[i, 0] += p * a
                side[i, 1] += q * a
                side[i, 2] += r * a
        rim = rims[rim_at[f] : rim_at[f + 1]]
        for i in range(len(rim)):
            for k in range(3):
                x[rim[i], k] -= side[i, k]


@njit(cache=True)
def backward_triple(storage, at, starts, rim_at, rims, x, work):
    """Solve U x = x for (n, 3) right-hand sides in the order of elimination."""
    for f in range(len(starts) - 2, -1, -1):
        first = starts[f]
        wide, deep = starts[f + 1] - first, rim_at[f + 1] - rim_at[f]
        y, side = x[first : first + wide], work[:deep]
        rim = rims[rim_at[f] : rim_at[f + 1]]
        for i in range(len(rim)):
            for k in range(3):
                side[i, k] = x[rim[i], k]
        begin = at[f] + wide * wide
        for j in range(0, wide - 1, 2):
            one, two = storage[begin : begin + deep], storage[begin + deep : begin + 2 * deep]
            begin += 2 * deep
            p, q, r, s, t, u = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
            for i in range(deep):
                a, b, v, w, z = one[i], two[i], side[i, 0], side[i, 1], side[i, 2]
                p += a * v
                q += a * w
                r += a * z
                s += b * v
                t += b * w
                u += b * z
            y[j, 0] -= p
            y[j, 1] -= q
            y[j, 2] -= r
            y[j + 1, 0] -= s
            y[j + 1, 1] -= t
            y[j + 1, 2] -= u
        # Every row's own part; an odd last row still lacks its rim's.
        odd = wide - 1 if wide % 2 else -1
        begin = at[f] + wide * wide
        for j in range(wide - 1, -1, -1):
            p, q, r = y[j, 0], y[j, 1], y[j, 2]
            if j == odd:
                one = storage[begin + j * deep : begin + wide * deep]
                for i in range(deep):
                    a = one[i]
                    p -= a * side[i, 0]
                    q -= a * side[i, 1]
                    r -= a * side[i, 2]
            row, rest = storage[at[f] + j * wide + j : at[f] + (j + 1) * wide], y[j:]
            for i in range(1, len(row)):
                a = row[i]
                p -= a * rest[i, 0]
                q -= a * rest[i, 1]
                r -= a * rest[i, 2]
            y[j, 0], y[j, 1], y[j, 2] = p / row[0], q / row[0], r / row[0]
