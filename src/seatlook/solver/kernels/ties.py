"""Zero-length springs between points of the sheet, or from them to targets and to wires."""

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
def tie_value(
    x, vertices, weights, target, stiffness, multiplier, direction, play, force, gradient
):
    """Energy of all ties; fills ``force`` (s, 3), minus the pull of each, and adds the gradient.

    A tie at its target has energy multiplier . gap + k/2 gap^2. One that may slide has it across
    its direction; along it is free between the two ends of its play, where it meets stops.
    """
    energy = 0.0
    for s in range(len(vertices)):
        k = stiffness[s]
        if k == 0.0:
            for d in range(3):
                force[s, d] = multiplier[s, d]
            continue
        along = 0.0
        for d in range(3):
            gap = -target[s, d]
            for j in range(4):
                gap += weights[s, j] * x[vertices[s, j], d]
            pull = multiplier[s, d] + k * gap
            force[s, d] = pull
            energy += 0.5 * (pull + multiplier[s, d]) * gap
            along += pull * direction[s, d]
        low, high = play[s]
        if low < high:
            pushed = max(along - k * high, 0.0) + min(along - k * low, 0.0)
            energy += 0.5 * (pushed * pushed - along * along) / k
            for d in range(3):
                force[s, d] += (pushed - along) * direction[s, d]
        for d in range(3):
            for j in range(4):
                gradient[vertices[s, j], d] += weights[s, j] * force[s, d]
    return energy
