"""Dense fronts of a sparse Cholesky factor, A = U^T U; see ``multifrontal``.

Fronts are numbered children first. Front f eliminates the vertices from ``starts[f]`` to
``starts[f + 1]`` of the order and touches the later ones in its rim. In the storage lie its rows of
U, first the (w, w) part in its own unknowns, then the (w, d) part in its rim's.
"""

import numpy as np
from numba import njit

BLOCK = 24  # rows of a front that are eliminated together
STRIP = 192  # rows of an update that are computed together, so that half of it is left out


@njit(cache=True)
def lay_out(starts, rim_at, children, size):
    """Where fronts begin in the storage, where their updates go, and how long both are.

    Updates of even and of odd depth lie on a stack each, so that a parent's never covers those of
    its children.
    """
    count = len(children)
    at, home = np.zeros(count + 1, np.int64), np.zeros(count, np.int64)
    parent, odd = np.full(count, -1), np.zeros(count, np.int64)
    stack, top = np.empty(count + 1, np.int64), 0
    for f in range(count):
        wide, deep = size * (starts[f + 1] - starts[f]), size * (rim_at[f + 1] - rim_at[f])
        at[f + 1] = at[f] + wide * (wide + deep)
        for _ in range(children[f]):
            top -= 1
            parent[stack[top]] = f
        stack[top] = f
        top += 1
    for f in range(count - 1, -1, -1):
        if parent[f] >= 0:
            odd[f] = 1 - odd[parent[f]]
    ends, most = np.zeros(2, np.int64), np.zeros(2, np.int64)
    top = 0
    for f in range(count):
        for _ in range(children[f]):
            top -= 1
            ends[odd[stack[top]]] = home[stack[top]]
        home[f] = ends[odd[f]]
        ends[odd[f]] += (size * (rim_at[f + 1] - rim_at[f])) ** 2
        most[odd[f]] = max(most[odd[f]], ends[odd[f]])
        stack[top] = f
        top += 1
    home += odd * most[0]
    return at, home, most[0] + most[1]


@njit(cache=True)
def places(rows, columns, order, starts, rim_at, rims, at, size):
    """Where (b, b) blocks begin in the storage, whether they are turned, and the pitch there."""
    count = len(rows)
    rank, front = np.empty(len(order), np.int64), np.empty(len(order), np.int64)
    rank[order] = np.arange(len(order))
    for f in range(len(starts) - 1):
        front[starts[f] : starts[f + 1]] = f
    where, pitch = np.empty(count, np.int64), np.empty(count, np.int64)
    turned = np.empty(count, np.bool_)
    for p in range(count):
        i, j = rank[rows[p]], rank[columns[p]]
        turned[p] = i > j
        first, last = min(i, j), max(i, j)
        f = front[first]
        wide, deep = size * (starts[f + 1] - starts[f]), size * (rim_at[f + 1] - rim_at[f])
        row = size * (first - starts[f])
        if last < starts[f + 1]:
            where[p], pitch[p] = at[f] + row * wide + size * (last - starts[f]), wide
        else:
            k = np.searchsorted(rims[rim_at[f] : rim_at[f + 1]], last)
            where[p], pitch[p] = at[f] + wide * wide + row * deep + size * k, deep
    return where, turned, pitch


@njit(cache=True)
def scatter(blocks, where, turned, pitch, storage):
    """Put (b, b) blocks in their places, some of them transposed; the rest is zero."""
    storage[:] = 0.0
    size = blocks.shape[1]
    for p in range(len(blocks)):
        at, step = where[p], pitch[p]
        for i in range(size):
            for j in range(size):
                value = blocks[p, j, i] if turned[p] else blocks[p, i, j]
                storage[at + i * step + j] = value


@njit(cache=True)
def into_parent(rim, start, last, parent_rim, size, into):
    """Fill in where a child's rim is among its parent's unknowns."""
    k = 0
    for i in range(len(rim)):
        if rim[i] < last:
            place = rim[i] - start
        else:
            while parent_rim[k] < rim[i]:
                k += 1
            place = last - start + k
        for c in range(size):
            into[size * i + c] = size * place + c


@njit(cache=True)
def extend_own(update, into, own, below):
    """Add what a child's update, of which the upper half counts, says of its parent's rows."""
    wide = len(own)
    for i in range(len(into)):
        p = into[i]
        if p >= wide:
            break
        for j in range(i, len(into)):
            q = into[j]
            if q < wide:
                own[p, q] += update[i, j]
            else:
                below[p, q - wide] += update[i, j]


@njit(cache=True)
def extend_rest(update, into, wide, rest):
    """Add the other part to its parent's own update."""
    for i in range(len(into)):
        p = into[i] - wide
        if p < 0:
            continue
        for j in range(i, len(into)):
            rest[p, into[j] - wide] += update[i, j]


@njit(cache=True)
def corner(own, low, high, root):
    """Turn a corner of own rows into its U; fill ``root`` with the inverse of U^T."""
    for j in range(low, high):
        row = own[j]
        for k in range(low, j):
            for i in range(j, high):
                row[i] -= own[k, j] * own[k, i]
        if not row[j] > 0.0:
            return False
        scale = 1.0 / np.sqrt(row[j])
        for i in range(j, high):
            row[i] *= scale
    root[:] = 0.0
    for j in range(high - low):
        root[j, j] = 1.0
        line = root[j]
        for k in range(j):
            share, other = own[low + k, low + j], root[k]
            for i in range(k + 1):
                line[i] -= share * other[i]
        for i in range(j + 1):
            line[i] /= own[low + j, low + j]
    return True


@njit(cache=True)
def eliminate(own, below, work):
    """Turn a front's rows into those of U; False if it is not positive definite.

    Block by block: what earlier rows say of these is taken from them, their corner is factored,
    and the inverse of the corner finishes them. All but corners is matrix products.
    """
    wide, deep = below.shape
    for low in range(0, wide, BLOCK):
        high = min(low + BLOCK, wide)
        tall = high - low
        root, room = work[: tall * tall].reshape(tall, tall), work[tall * tall :]
        if low:
            above = room[: low * tall].reshape(low, tall)
            above[:] = own[:low, low:high]
            room = room[low * tall :]
            rest = wide - low
            ahead = room[: low * rest].reshape(low, rest)
            ahead[:] = own[:low, low:]
            part = room[low * rest : low * rest + tall * rest].reshape(tall, rest)
            np.dot(above.T, ahead, part)
            own[low:high, low:] -= part
            part = room[: tall * deep].reshape(tall, deep)
            if deep:
                np.dot(above.T, below[:low], part)
                below[low:high] -= part
        if not corner(own, low, high, root):
            return False
        room, rest = work[tall * tall :], wide - high
        if rest:
            ahead = room[: tall * rest].reshape(tall, rest)
            ahead[:] = own[low:high, high:]
            part = room[tall * rest : 2 * tall * rest].reshape(tall, rest)
            np.dot(root, ahead, part)
            own[low:high, high:] = part
        if deep:
            part = room[: tall * deep].reshape(tall, deep)
            np.dot(root, below[low:high], part)
            below[low:high] = part
    return True


@njit(cache=True)
def update_rim(below, rest, work):
    """Fill in the upper half of what a front leaves to its rim, -below^T below."""
    wide, deep = below.shape
    for low in range(0, deep, STRIP):
        high = min(low + STRIP, deep)
        tall, width = high - low, deep - low
        first, room = work[: wide * tall].reshape(wide, tall), work[wide * tall :]
        for i in range(wide):
            for j in range(tall):
                first[i, j] = -below[i, low + j]
        if tall == deep:
            np.dot(first.T, below, rest)
            return
        second = room[: wide * width].reshape(wide, width)
        second[:] = below[:, low:]
        part = room[wide * width : wide * width + tall * width].reshape(tall, width)
        np.dot(first.T, second, part)
        rest[low:high, low:] = part


@njit(cache=True)
def factor(storage, at, starts, rim_at, rims, children, size, home, updates, work):
    """Factor all fronts in their order; False if the matrix is not positive definite."""
    stack, top = np.empty(len(children) + 1, np.int64), 0
    longest = 0
    for f in range(len(children)):
        longest = max(longest, size * (rim_at[f + 1] - rim_at[f]))
    into = np.empty((2, longest), np.int64)
    for f in range(len(children)):
        wide, deep = size * (starts[f + 1] - starts[f]), size * (rim_at[f + 1] - rim_at[f])
        own = storage[at[f] : at[f] + wide * wide].reshape(wide, wide)
        below = storage[at[f] + wide * wide : at[f + 1]].reshape(wide, deep)
        rim = rims[rim_at[f] : rim_at[f + 1]]
        top -= children[f]
        for c in range(children[f]):
            child = stack[top + c]
            under = rims[rim_at[child] : rim_at[child + 1]]
            n = size * len(under)
            into_parent(under, starts[f], starts[f + 1], rim, size, into[c])
            update = updates[home[child] : home[child] + n * n].reshape(n, n)
            extend_own(update, into[c, :n], own, below)
        if not eliminate(own, below, work):
            return False
        rest = updates[home[f] : home[f] + deep * deep].reshape(deep, deep)
        if wide:
            update_rim(below, rest, work)
        else:
            rest[:] = 0.0
        for c in range(children[f]):
            child = stack[top + c]
            n = size * (rim_at[child + 1] - rim_at[child])
            update = updates[home[child] : home[child] + n * n].reshape(n, n)
            extend_rest(update, into[c, :n], wide, rest)
        stack[top] = f
        top += 1
    return True
