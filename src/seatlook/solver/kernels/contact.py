"""Contact of the sheet's lower face with the foam."""

from __future__ import annotations

from numba import njit

from seatlook.solver.kernels.distance import distance, distance_hessian, near


@njit(cache=True)
def contact_value(x, coefficients, grid, half, settled, stiffness, gradient, settled_gradient):
    """Energy k/2 <half - settled - phi>^2 summed over vertices; adds both its gradients."""
    energy = 0.0
    for i in range(len(stiffness)):
        offset = half[i] - settled[i]
        if not near(coefficients, grid, x[i, 0], x[i, 1], x[i, 2], offset):
            continue
        phi, gx, gy, gz = distance(coefficients, grid, x[i, 0], x[i, 1], x[i, 2])
        depth = offset - phi
        if depth > 0.0:
            force = stiffness[i] * depth
            energy += 0.5 * force * depth
            settled_gradient[i] -= force
            gradient[i, 0] -= force * gx
            gradient[i, 1] -= force * gy
            gradient[i, 2] -= force * gz
    return energy


@njit(cache=True)
def contact_state(x, coefficients, grid, half, settled, stiffness, force, normal, depth):
    """Normal force, unit normal and depth in the springs of every vertex; 0 when free."""
    for i in range(len(stiffness)):
        force[i], depth[i] = 0.0, 0.0
        normal[i] = 0.0
        offset = half[i] - settled[i]
        if not near(coefficients, grid, x[i, 0], x[i, 1], x[i, 2], offset):
            continue
        phi, gx, gy, gz = distance(coefficients, grid, x[i, 0], x[i, 1], x[i, 2])
        if phi < offset:
            norm = (gx * gx + gy * gy + gz * gz) ** 0.5
            depth[i] = offset - phi
            force[i] = stiffness[i] * depth[i] * norm
            normal[i, 0], normal[i, 1], normal[i, 2] = gx / norm, gy / norm, gz / norm


@njit(cache=True)
def contact_blocks(x, coefficients, grid, half, settled, stiffness, definite, blocks):
    """Second derivative (3, 3) per vertex; ``definite`` leaves the curvature of phi out."""
    for i in range(len(stiffness)):
        blocks[i] = 0.0
        px, py, pz = x[i, 0], x[i, 1], x[i, 2]
        offset = half[i] - settled[i]
        if not near(coefficients, grid, px, py, pz, offset):
            continue
        phi, gx, gy, gz = distance(coefficients, grid, px, py, pz)
        depth = offset - phi
        if depth <= 0.0:
            continue
        g = (gx, gy, gz)
        k = stiffness[i]
        for a in range(3):
            for b in range(3):
                blocks[i, a, b] = k * g[a] * g[b]
        if not definite:
            xx, yy, zz, xy, xz, yz = distance_hessian(coefficients, grid, px, py, pz)
            h = ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz))
            for a in range(3):
                for b in range(3):
                    blocks[i, a, b] -= k * depth * h[a][b]


@njit(cache=True)
def thickness(coefficients, grid, x, normal, through):
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
        through[i] = way
