"""Zero-length springs between points of the sheet, or from them to fixed targets."""

from __future__ import annotations

from numba import njit


@njit(cache=True)
def tie_gap(x, vertices, weights, target, gap):
    """Fill ``gap`` (s, 3) = weighted vertices - target."""
    for s in range(len(vertices)):
        for d in range(3):
            total = -target[s, d]
            for k in range(4):
                total += weights[s, k] * x[vertices[s, k], d]
            gap[s, d] = total


@njit(cache=True)
def tie_value(x, vertices, weights, target, stiffness, multiplier, gradient):
    """Energy multiplier . gap + k/2 gap^2; adds its gradient."""
    energy = 0.0
    for s in range(len(vertices)):
        k = stiffness[s]
        if k == 0.0:
            continue
        for d in range(3):
            gap = -target[s, d]
            for j in range(4):
                gap += weights[s, j] * x[vertices[s, j], d]
            force = multiplier[s, d] + k * gap
            energy += 0.5 * (force + multiplier[s, d]) * gap
            for j in range(4):
                gradient[vertices[s, j], d] += weights[s, j] * force
    return energy
