"""Sums of dense blocks in the multifrontal factor."""

from numba import njit


@njit(cache=True)
def scatter(blocks, where, turned, pitch, storage):
    """Put (b, b) blocks where they begin in column-major storage, some of them transposed."""
    size = blocks.shape[1]
    for p in range(len(blocks)):
        at, step = where[p], pitch[p]
        for i in range(size):
            for j in range(size):
                value = blocks[p, j, i] if turned[p] else blocks[p, i, j]
                storage[at + i + j * step] = value


@njit(cache=True)
def extend(update, into, own, below, rest):
    """Add the lower triangle of a child's update to its parent's parts, which are transposed."""
    k = len(own)
    for j in range(len(into)):
        q = into[j]
        if q < k:
            for i in range(j, len(into)):
                p = into[i]
                if p < k:
                    own[q, p] += update[j, i]
                else:
                    below[q, p - k] += update[j, i]
        else:
            for i in range(j, len(into)):
                rest[q - k, into[i] - k] += update[j, i]
