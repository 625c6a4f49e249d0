"""Hessian of chords, summed into blocks of vertices."""

from numba import njit


@njit(cache=True)
def chords(x, ends, length, of_face, material, pull, edge_slot, pair_slot, out):
    """Add the membrane's second derivative (p, 3, 3) by vertices to ``out``.

    ``edge_slot`` (e, 3) are the blocks of an edge's ends and of its pair, ``pair_slot`` (m, 9, 4)
    those of both ends of edge i with both ends of edge j. Of each pair, one block is kept, and what
    belongs to the other, its transpose, is left out by a slot of -1.
    """
    for e in range(len(ends)):
        k = pull[e] / (length[e] * length[e])
        for c in range(3):
            out[edge_slot[e, 0], c, c] += k
            out[edge_slot[e, 1], c, c] += k
            out[edge_slot[e, 2], c, c] -= k
    for t in range(len(of_face)):
        for i in range(3):
            a = of_face[t, i]
            for j in range(3):
                b = of_face[t, j]
                k = material[t, i, j] / (length[a] * length[a] * length[b] * length[b])
                for side in range(4):
                    slot = pair_slot[t, 3 * i + j, side]
                    if slot < 0:
                        continue
                    signed = k if side == 0 or side == 3 else -k
                    for c in range(3):
                        u = signed * (x[ends[a, 1], c] - x[ends[a, 0], c])
                        for d in range(3):
                            out[slot, c, d] += u * (x[ends[b, 1], d] - x[ends[b, 0], d])
