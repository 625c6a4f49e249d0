"""Shadows per sample and the half-space seen from each vertex, by rays."""

from __future__ import annotations

import numpy as np
from numba import njit

from seatlook.pbr.kernels import leaf
from seatlook.pbr.kernels.bvh import nearest, new_stack, occluded
from seatlook.pbr.kernels.noise import even
from seatlook.pbr.kernels.shade import arriving
from seatlook.pbr.kernels.surface import (
    along,
    blend,
    cross,
    dot,
    lift,
    meet,
    minus,
    ray_through,
    row,
    unit,
)

# Rays start this far [m] above the surface: above rounding, below any fold.
_ABOVE = 2e-5
# Beyond this cosine not even the grain turns to the light.
_TURNED = -0.15
_EMPTY, _HIDDEN, _LIT, _AWAY = 0, 1, 2, 3


@leaf()
def _across(l):
    """Two unit vectors across ``l``."""
    a = (1.0, 0.0, 0.0) if abs(l[0]) < 0.6 else (0.0, 1.0, 0.0)
    t = unit(cross(l, a))
    return t, cross(l, t)


@leaf()
def _reaches(bvh, lights, sizes, k, p, n, a, b, stack):
    """Whether point (a, b) of light k's disc, in the unit square, is seen from ``p``."""
    l, _ = arriving(lights, k, p)
    t, s = _across(l)
    r, phi = np.sqrt(a), 2.0 * np.pi * b
    x, y = r * np.cos(phi), r * np.sin(phi)
    if lights.near[k] == 0:
        half = np.tan(0.5 * sizes[k])
        d = unit(along(along(l, half * x, t), half * y, s))
        far = np.inf
    else:
        to = minus(row(lights.vector, k), p)
        d = along(along(to, sizes[k] * x, t), sizes[k] * y, s)
        far = np.sqrt(dot(d, d))
        d = unit(d)
    side = _ABOVE if dot(n, d) > 0.0 else -_ABOVE
    o = along(p, side, n)
    return not occluded(bvh, o[0], o[1], o[2], d[0], d[1], d[2], 0.0, far, stack)


@leaf()
def _start(mesh, eye, f, i, j):
    """Start of a shadow ray for sample (i, j): (point, unit plane normal towards the eye, n)."""
    ray = ray_through(eye, i, j)
    b1, b2, _, plane = meet(mesh, eye, f, ray)
    p = blend(mesh.vertices, mesh.faces, f, b1, b2)
    n = blend(mesh.normals, mesh.faces, f, b1, b2)
    if dot(plane, ray) > 0.0:
        return p, (-plane[0], -plane[1], -plane[2]), (-n[0], -n[1], -n[2])
    return lift(mesh, f, b1, b2, p), plane, n


@njit(cache=True)
def _first_look(bvh, mesh, eye, ids, lights, sizes, k, factor, state):
    """One ray per pixel to the middle of the light."""
    stack = new_stack()
    for y in range(state.shape[0]):
        for x in range(state.shape[1]):
            state[y, x] = _EMPTY
            for q in range(factor * factor):
                i, j = x * factor + q % factor, y * factor + q // factor
                if ids[j, i] < 0:
                    continue
                p, plane, n = _start(mesh, eye, ids[j, i], i, j)
                l, _ = arriving(lights, k, p)
                if dot(n, l) <= _TURNED:
                    state[y, x] = _AWAY
                elif _reaches(bvh, lights, sizes, k, p, plane, 0.0, 0.0, stack):
                    state[y, x] = _LIT
                else:
                    state[y, x] = _HIDDEN
                break


@leaf()
def _mixed(state, x, y, reach):
    """Whether lit and hidden pixels meet within ``reach`` of this one."""
    lit = hidden = False
    for j in range(max(0, y - reach), min(state.shape[0], y + reach + 1)):
        for i in range(max(0, x - reach), min(state.shape[1], x + reach + 1)):
            lit |= state[j, i] == _LIT
            hidden |= state[j, i] == _HIDDEN
    return lit and hidden


@njit(cache=True)
def shadows(bvh, mesh, eye, ids, lights, sizes, k, factor, rays, reach, out):
    """Share of light k that each sample sees, into ``out`` like ``ids``.

    Where a pixel and its neighbours within ``reach`` agree, one ray tells; near a shadow's edge
    every sample sends ``rays`` to its own stratified points of the light's disc.
    """
    height, width = ids.shape[0] // factor, ids.shape[1] // factor
    state = np.zeros((height, width), np.uint8)
    _first_look(bvh, mesh, eye, ids, lights, sizes, k, factor, state)
    stack = new_stack()
    for y in range(height):
        for x in range(width):
            if state[y, x] == _EMPTY:
                continue
            edge = _mixed(state, x, y, reach)
            for q in range(factor * factor):
                i, j = x * factor + q % factor, y * factor + q // factor
                if ids[j, i] < 0:
                    continue
                if not edge and state[y, x] != _AWAY:
                    out[j, i] = 1.0 if state[y, x] == _LIT else 0.0
                    continue
                p, plane, n = _start(mesh, eye, ids[j, i], i, j)
                if dot(n, arriving(lights, k, p)[0]) <= _TURNED:
                    out[j, i] = 0.0
                    continue
                u, v, seen = even(x, y, 2 * k), even(x, y, 2 * k + 1), 0
                total = rays * factor * factor
                for s in range(rays):
                    # Roberts' R2 sequence over all rays of a pixel, shifted per pixel.
                    index = s * factor * factor + q
                    a = (index + u) / total
                    b = (v + 0.7548776662466927 * index) % 1.0
                    seen += _reaches(bvh, lights, sizes, k, p, plane, a, b, stack)
                out[j, i] = seen / rays


@njit(cache=True)
def irradiance(bvh, mesh, lights, sizes, out):
    """Direct irradiance [lux] (n, 3) at every vertex, one ray per light."""
    stack = new_stack()
    for i in range(len(out)):
        out[i] = 0.0
        p, n = row(mesh.vertices, i), row(mesh.normals, i)
        for k in range(len(lights.near)):
            l, e = arriving(lights, k, p)
            c = dot(l, n)
            if c <= 0.0:
                continue
            if _reaches(bvh, lights, sizes, k, along(p, 5 * _ABOVE, n), n, 0.0, 0.0, stack):
                for q in range(3):
                    out[i, q] += c * e[q]


@njit(cache=True)
def gather(bvh, mesh, strata, hits):
    """What each vertex of ``mesh`` sees along strata^2 cosine-weighted directions.

    ``hits`` (n, strata^2) int32: the face met, -1 for open, -2 for the back of a face.
    """
    stack = new_stack()
    for i in range(len(hits)):
        p, n = row(mesh.vertices, i), row(mesh.normals, i)
        t, s = _across(n)
        o = along(p, 10 * _ABOVE, n)
        turn, shift = even(i, 0, 0), even(i, 1, 0)
        for q in range(strata * strata):
            a = (q // strata + shift) / strata
            phi = 2.0 * np.pi * (q % strata + turn) / strata
            r, up = np.sqrt(a), np.sqrt(1.0 - a)
            d = along(
                along((n[0] * up, n[1] * up, n[2] * up), r * np.cos(phi), t), r * np.sin(phi), s
            )
            leaf, _, _, _ = nearest(bvh, o[0], o[1], o[2], d[0], d[1], d[2], 0.0, stack)
            if leaf < 0:
                hits[i, q] = -1
                continue
            out = cross(row(bvh.edge1, leaf), row(bvh.edge2, leaf))
            hits[i, q] = bvh.face[leaf] if dot(out, d) < 0.0 else -2


@leaf()
def bounce(mesh, hits, albedo, irradiances, out):
    """Mean luminance (n, 3) that arrives from the faces met, Lambert with ``albedo`` (p, 3)."""
    for i in range(hits.shape[0]):
        out[i] = 0.0
        for q in range(hits.shape[1]):
            f = hits[i, q]
            if f < 0:
                continue
            a, b, c = mesh.faces[f, 0], mesh.faces[f, 1], mesh.faces[f, 2]
            for k in range(3):
                mean = (irradiances[a, k] + irradiances[b, k] + irradiances[c, k]) / 3.0
                out[i, k] += albedo[mesh.panel[f], k] * mean / (np.pi * hits.shape[1])
