"""Contact of the sheet's lower face with the foam."""

from __future__ import annotations

import numpy as np
from numba import njit

from seatlook.solver.kernels.distance import distance, distance_hessian, near


@njit(cache=True)
def measure(x, coefficients, grid, half, settlement, places, distances):
    """Distance and its gradient below every vertex, computed only where one has moved.

    ``distances`` (n, 5) holds them and the offset up to which a distance of infinity means too far.
    """
    for i in range(len(half)):
        offset = half[i] - settlement[i]
        same = x[i, 0] == places[i, 0] and x[i, 1] == places[i, 1] and x[i, 2] == places[i, 2]
        if same and (distances[i, 0] != np.inf or offset <= distances[i, 4]):
            continue
        px, py, pz = x[i, 0], x[i, 1], x[i, 2]
        places[i, 0], places[i, 1], places[i, 2] = px, py, pz
        distances[i, 0], distances[i, 4] = np.inf, offset
        if near(coefficients, grid, px, py, pz, offset):
            distances[i, 0], distances[i, 1], distances[i, 2], distances[i, 3] = distance(
                coefficients, grid, px, py, pz
            )


@njit(cache=True)
def contact_value(distances, half, settlement, stiffness, gradient, settlement_gradient):
    """Energy k/2 <half - settlement - phi>^2 summed over vertices; adds both its gradients."""
    energy = 0.0
    for i in range(len(stiffness)):
        depth = half[i] - settlement[i] - distances[i, 0]
        if depth > 0.0:
            force = stiffness[i] * depth
            energy += 0.5 * force * depth
            settlement_gradient[i] -= force
            gradient[i, 0] -= force * distances[i, 1]
            gradient[i, 1] -= force * distances[i, 2]
            gradient[i, 2] -= force * distances[i, 3]
    return energy


@njit(cache=True)
def contact_state(distances, half, settlement, stiffness, force, normal, depth):
    """Normal force, unit normal and depth in the springs of every vertex; 0 when free."""
    for i in range(len(stiffness)):
        force[i], depth[i] = 0.0, 0.0
        normal[i] = 0.0
        phi, gx, gy, gz = distances[i, 0], distances[i, 1], distances[i, 2], distances[i, 3]
        offset = half[i] - settlement[i]
        if phi < offset:
            norm = (gx * gx + gy * gy + gz * gz) ** 0.5
            depth[i] = offset - phi
            force[i] = stiffness[i] * depth[i] * norm
            normal[i, 0], normal[i, 1], normal[i, 2] = gx / norm, gy / norm, gz / norm


@njit(cache=True)
def contact_blocks(x, coefficients, grid, distances, half, settlement, stiffness, definite, blocks):
    """Second derivative (3, 3) per vertex; ``definite`` leaves the curvature of phi out."""
    for i in range(len(stiffness)):
        blocks[i] = 0.0
        depth = half[i] - settlement[i] - distances[i, 0]
        if depth <= 0.0:
            continue
        g = (distances[i, 1], distances[i, 2], distances[i, 3])
        k = stiffness[i]
        for a in range(3):
            for b in range(3):
                blocks[i, a, b] = k * g[a] * g[b]
        if not definite:
            xx, yy, zz, xy, xz, yz = distance_hessian(coefficients, grid, x[i, 0], x[i, 1], x[i, 2])
            h = ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz))
            for a in range(3):
                for b in range(3):
                    blocks[i, a, b] -= k * depth * h[a][b]


@njit(cache=True)
def thickness(coefficients, grid, x, normal, out):
    """Way through the foam from ``x`` against ``normal``, by steps of the distance."""
    for i in range(len(x)):
        way = grid[3]
        for _ in range(200):
            px = x[i, 0] - way * normal[i, 0]
            py = x[i, 1] - way * normal[i, 1]
            pz = x[i, 2] - way * normal[i, 2]
            if not near(coefficients, grid, px, py, pz, 0.0):
                break
            phi = distance(coefficients, grid, px, py, pz)[0]
            if phi > -0.01 * grid[3]:
                break
            way -= phi
        out[i] = way
