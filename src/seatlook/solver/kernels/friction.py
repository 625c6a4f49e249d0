"""Lagged Coulomb friction between sheet and foam."""

from __future__ import annotations

from numba import njit


@njit(cache=True)
def friction_value(x, anchor, normal, limit, slip, gradient):
    """Energy of the tangential slide u from the anchor; adds its gradient.

    The force rises as limit (2 y - y^2), y = |u| / slip, and stays at ``limit`` beyond.
    """
    energy = 0.0
    for i in range(len(limit)):
        if limit[i] <= 0.0:
            continue
        u0, u1, u2 = x[i, 0] - anchor[i, 0], x[i, 1] - anchor[i, 1], x[i, 2] - anchor[i, 2]
        n0, n1, n2 = normal[i, 0], normal[i, 1], normal[i, 2]
        along = u0 * n0 + u1 * n1 + u2 * n2
        u0, u1, u2 = u0 - along * n0, u1 - along * n1, u2 - along * n2
        size = (u0 * u0 + u1 * u1 + u2 * u2) ** 0.5
        y = size / slip
        if y < 1.0:
            energy += limit[i] * slip * y * y * (1.0 - y / 3.0)
            scale = limit[i] * (2.0 - y) / slip
        else:
            energy += limit[i] * (size - slip / 3.0)
            scale = limit[i] / size
        gradient[i, 0] += scale * u0
        gradient[i, 1] += scale * u1
        gradient[i, 2] += scale * u2
    return energy


@njit(cache=True)
def friction_blocks(x, anchor, normal, limit, slip, blocks):
    """Second derivative (3, 3) per vertex, never indefinite."""
    for i in range(len(limit)):
        blocks[i] = 0.0
        if limit[i] <= 0.0:
            continue
        u0, u1, u2 = x[i, 0] - anchor[i, 0], x[i, 1] - anchor[i, 1], x[i, 2] - anchor[i, 2]
        n = (normal[i, 0], normal[i, 1], normal[i, 2])
        along = u0 * n[0] + u1 * n[1] + u2 * n[2]
        u = (u0 - along * n[0], u1 - along * n[1], u2 - along * n[2])
        size = (u[0] * u[0] + u[1] * u[1] + u[2] * u[2]) ** 0.5
        y = size / slip
        if y < 1.0:
            plane = limit[i] * (2.0 - y) / slip
            # d scale / d size, over size: -limit / slip^2 / size
            radial = -limit[i] / (slip * slip * size) if size > 0.0 else 0.0
        else:
            plane = limit[i] / size
            radial = -limit[i] / (size * size * size)
        for a in range(3):
            for b in range(3):
                blocks[i, a, b] = radial * u[a] * u[b] - plane * n[a] * n[b]
            blocks[i, a, a] += plane


@njit(cache=True)
def drag_anchor(x, anchor, normal, force, slip):
    """Set anchors where contact begins, drop them where it ends, pull them along in sliding."""
    for i in range(len(force)):
        if force[i] <= 0.0:
            anchor[i] = float("nan")
            continue
        if anchor[i, 0] != anchor[i, 0]:
            anchor[i] = x[i]
            continue
        u0, u1, u2 = x[i, 0] - anchor[i, 0], x[i, 1] - anchor[i, 1], x[i, 2] - anchor[i, 2]
        n0, n1, n2 = normal[i, 0], normal[i, 1], normal[i, 2]
        along = u0 * n0 + u1 * n1 + u2 * n2
        u0, u1, u2 = u0 - along * n0, u1 - along * n1, u2 - along * n2
        size = (u0 * u0 + u1 * u1 + u2 * u2) ** 0.5
        keep = min(1.0, slip / size) if size > 0.0 else 1.0
        # The normal part goes: the anchor stays beside the vertex as the foam gives way.
        anchor[i, 0] = x[i, 0] - keep * u0
        anchor[i, 1] = x[i, 1] - keep * u1
        anchor[i, 2] = x[i, 2] - keep * u2
