"""Reflected share of a surface in a white furnace, by quadrature that resolves every lobe."""

from __future__ import annotations

import numpy as np
from numba import njit

from seatlook.pbr.kernels.brdf import Reflector, brdf, view_of
from seatlook.pbr.kernels.lobes import D_GGX
from seatlook.pbr.kernels.tables import coupling_at
from seatlook.pbr.reflectance.tables import load_tables
from seatlook.pbr.shading.look import pack_materials, tabulated


def reflector_of(appearance, v):
    """Return a plain surface as the kernels take it, seen along ``v`` (3,) in its own frame."""
    materials = pack_materials([appearance])
    couplings, layers, fibres = tabulated(materials)
    colour = tuple(appearance.albedo)
    view = view_of(load_tables(), materials[0], appearance.roughness, colour, *v)
    mean = coupling_at(couplings[0], view.roughness)
    return Reflector(materials[0], layers[0], fibres[0], mean, view)


def reflected(appearance, v, n=256):
    """Reflected share (3,) towards ``v`` (3,) of a light equal from everywhere.

    Half of the nodes are spread evenly over the light's hemisphere, half over the half-vector's
    narrowest GGX lobe; the balance heuristic weighs them (Veach 1995).
    """
    reflector = reflector_of(appearance, v)
    alpha = (reflector.sight.alpha_x, reflector.sight.alpha_y)
    if appearance.coat > 0 and appearance.coat_roughness < appearance.roughness:
        alpha = (appearance.coat_roughness**2,) * 2
    total = np.zeros(3)
    _quadrature(load_tables(), reflector, alpha, n, total)
    return total


@njit(cache=True)
def _quadrature(tables, reflector, alpha, n, total):
    f, seen = np.zeros(3), reflector.sight
    vx, vy, vz = seen.ToV, seen.BoV, seen.NoV
    for i in range(n):
        a = (i + 0.5) / n
        slope = np.sqrt(a / (1 - a))
        for j in range(n):
            phi = 2 * np.pi * (j + 0.5) / n
            for kind in range(2):
                if kind == 0:
                    x, y, z = np.sqrt(a) * np.cos(phi), np.sqrt(a) * np.sin(phi), np.sqrt(1 - a)
                else:
                    x, y = alpha[0] * slope * np.cos(phi), alpha[1] * slope * np.sin(phi)
                    z = 1 / np.sqrt(1 + x * x + y * y)
                    x, y = x * z, y * z
                    c = 2 * (x * vx + y * vy + z * vz)
                    x, y, z = c * x - vx, c * y - vy, c * z - vz
                if z <= 1e-9:
                    continue
                hx, hy, hz = x + vx, y + vy, z + vz
                s = 1 / np.sqrt(hx * hx + hy * hy + hz * hz)
                hx, hy, hz = hx * s, hy * s, hz * s
                VoH = max(hx * vx + hy * vy + hz * vz, 1e-12)
                density = z / np.pi + D_GGX(alpha[0], alpha[1], hx, hy, hz) * hz / (4 * VoH)
                brdf(tables, reflector, 0.0, x, y, z, f)
                for k in range(3):
                    total[k] += f[k] * z / density / (n * n)
