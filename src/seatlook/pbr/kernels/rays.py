"""Shadows per sample and the half-space seen from each vertex, by rays."""

from __future__ import annotations

import numpy as np
from numba import njit

from seatlook.pbr.kernels import leaf
from seatlook.pbr.kernels.bvh import nearest, new_stack, occluded
from seatlook.pbr.kernels.light import SMALL, across, angle_of, arriving, panorama_towards
from seatlook.pbr.kernels.noise import even
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
ABOVE = 2e-5
# What a ray meets other than the front of a face: the sky, what does not shine; or it is not sent.
OPEN, DARK, UNSENT = -1, -2, -3
# Points on a rim.
_RIM = 6
_EMPTY, _HIDDEN, _AWAY, _LIT, _GRAZING = 0, 1, 2, 3, 4


@leaf()
def _disc(lights, k, p):
    """Light k seen from ``p``: unit direction, vector to its middle, two radii, whether it is far.

    Of a far light only the directions count: its middle is one away.
    """
    l, _ = arriving(lights, k, p)
    t, s = across(l)
    if lights.near[k] == 0:
        half = np.tan(0.5 * lights.size[k])
        return l, l, along((0.0, 0.0, 0.0), half, t), along((0.0, 0.0, 0.0), half, s), True
    to, half = minus(row(lights.vector, k), p), lights.size[k]
    return l, to, along((0.0, 0.0, 0.0), half, t), along((0.0, 0.0, 0.0), half, s), False


@leaf()
def _to_disc(disc, a, b):
    """Unit direction to point (a, b), in the unit square, of a disc; its distance."""
    _, to, t, s, far = disc
    r, phi = np.sqrt(a), 2.0 * np.pi * b
    d = along(along(to, r * np.cos(phi), t), r * np.sin(phi), s)
    length = np.sqrt(dot(d, d))
    scale = 1.0 / length
    return (d[0] * scale, d[1] * scale, d[2] * scale), np.inf if far else length


@leaf()
def _to_middle(disc):
    """Unit direction to the middle of a disc; its distance."""
    l, to, _, _, far = disc
    return l, np.inf if far else np.sqrt(dot(to, to))


@leaf()
def _reaches(bvh, p, n, d, far, stack):
    """Whether a ray from ``p`` along ``d`` comes ``far``; ``n``: normal of the plane it leaves.

    It starts above the plane even where it goes below: the curved surface is still lit there.
    """
    o = along(p, ABOVE, n)
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


@leaf()
def _state(bvh, mesh, eye, f, i, j, lights, k, stack):
    """What one ray from sample (i, j) to the middle of light k meets."""
    p, plane, n = _start(mesh, eye, f, i, j)
    l, far = _to_middle(_disc(lights, k, p))
    angle, c = angle_of(lights, k, p), dot(n, l)
    if c <= -angle:
        return _AWAY
    if c < angle and angle >= SMALL:
        return _GRAZING
    return _LIT if _reaches(bvh, p, plane, l, far, stack) else _HIDDEN


@leaf()
def _rim_agrees(bvh, lights, k, start, shift, is_lit, stack):
    """Whether points on the rim of light k are all seen, or all hidden, as its middle is.

    An edge between two of them hides, or shows, 3 % of the disc at most.
    """
    p, plane, n = start
    disc = _disc(lights, k, p)
    for turn in range(_RIM):
        d, far = _to_disc(disc, 1.0, (turn + shift) / _RIM)
        if dot(n, d) <= 0.0 or _reaches(bvh, p, plane, d, far, stack) != is_lit:
            return False
    return True


@leaf()
def _of_neighbours(state, x, y):
    """State on which the four pixels beside this one agree, ``_EMPTY`` where they do not."""
    if x == 0 or y == 0 or x == state.shape[1] - 1 or y == state.shape[0] - 1:
        return _EMPTY
    here = state[y, x - 1]
    same = here == state[y, x + 1] and here == state[y - 1, x] and here == state[y + 1, x]
    return here if same else _EMPTY


@njit(cache=True)
def _first_look(bvh, mesh, eye, ids, lights, k, factor, state):
    """One ray per pixel to the middle of the light, on a chequerboard.

    The pixels between look where their neighbours do not agree.
    """
    stack = new_stack()
    state[:] = _EMPTY
    for between in range(2):
        for y in range(state.shape[0]):
            for x in range((y + between) % 2, state.shape[1], 2):
                for q in range(factor * factor):
                    i, j = x * factor + q % factor, y * factor + q // factor
                    if ids[j, i] < 0:
                        continue
                    if between:
                        state[y, x] = _of_neighbours(state, x, y)
                    if state[y, x] == _EMPTY:
                        state[y, x] = _state(bvh, mesh, eye, ids[j, i], i, j, lights, k, stack)
                    break


@njit(cache=True)
def _counts(state, first, last):
    """Number of pixels of some kinds above and to the left of each corner, (h + 1, w + 1)."""
    total = np.zeros((state.shape[0] + 1, state.shape[1] + 1), np.int32)
    for y in range(state.shape[0]):
        line = 0
        for x in range(state.shape[1]):
            line += first <= state[y, x] <= last
            total[y + 1, x + 1] = total[y, x + 1] + line
    return total


@leaf()
def _within(total, x, y, reach):
    """Whether a counted pixel lies within ``reach`` of this one."""
    y0, y1 = max(0, y - reach), min(total.shape[0] - 1, y + reach + 1)
    x0, x1 = max(0, x - reach), min(total.shape[1] - 1, x + reach + 1)
    return total[y1, x1] - total[y0, x1] - total[y1, x0] + total[y0, x0] > 0


@leaf()
def _share_seen(bvh, lights, k, start, shift, first, step, total, stack):
    """Share of the points of light k above the horizon that a sample sees.

    Points ``first, first + step, ...`` of ``total`` of Roberts' R2 sequence, shifted. The part
    below the horizon is the shading's to leave out.
    """
    p, plane, n = start
    seen = count = 0
    disc = _disc(lights, k, p)
    l, far = _to_middle(disc)
    c, angle = dot(n, l), angle_of(lights, k, p)
    if c <= -angle:
        return 0.0
    for index in range(first, total, step):
        a = (index + shift[0]) / total
        b = (shift[1] + 0.7548776662466927 * index) % 1.0
        d, far = _to_disc(disc, a, b)
        if dot(n, d) > 0.0:
            count += 1
            seen += _reaches(bvh, p, plane, d, far, stack)
    if count:
        return seen / count
    # Little of the light has not set: its upper rim stands for it.
    up = unit(along(n, -c, l))
    rim = unit(along(l, 0.9 * angle, up))
    return 1.0 if _reaches(bvh, p, plane, rim, far, stack) else 0.0


@njit(cache=True)
def shadows(bvh, mesh, eye, ids, lights, k, factor, rays, reach, out):
    """Share of light k [1/255] that each sample sees, into ``out`` like ``ids``.

    Where a pixel and its neighbours within ``reach`` agree, one ray is enough, and where the rim of
    the light agrees with its middle, those to it; in a penumbra every sample sends ``rays`` to its
    own stratified points of the light's disc.
    """
    height, width = ids.shape[0] // factor, ids.shape[1] // factor
    state = np.zeros((height, width), np.uint8)
    _first_look(bvh, mesh, eye, ids, lights, k, factor, state)
    lit, dark = _counts(state, _LIT, _LIT), _counts(state, _HIDDEN, _AWAY)
    stack, step = new_stack(), factor * factor
    for y in range(height):
        for x in range(width):
            if state[y, x] == _EMPTY:
                continue
            edge = state[y, x] == _GRAZING or state[y, x] == _AWAY
            edge = edge or (_within(lit, x, y, reach) and _within(dark, x, y, reach))
            shift = (even(x, y, 2 * k), even(x, y, 2 * k + 1))
            # Once per pixel, and not where that takes more rays than it saves.
            known = rays * step <= _RIM or not (state[y, x] == _LIT or state[y, x] == _HIDDEN)
            for q in range(step):
                i, j = x * factor + q % factor, y * factor + q // factor
                if ids[j, i] < 0:
                    continue
                if edge and not known:
                    start, is_lit = _start(mesh, eye, ids[j, i], i, j), state[y, x] == _LIT
                    edge = not _rim_agrees(bvh, lights, k, start, shift[0], is_lit, stack)
                known = True
                if not edge:
                    out[j, i] = 255 if state[y, x] == _LIT else 0
                    continue
                start = _start(mesh, eye, ids[j, i], i, j)
                share = _share_seen(bvh, lights, k, start, shift, q, step, rays * step, stack)
                out[j, i] = np.rint(255.0 * share)


@njit(cache=True)
def inset(mesh, face, out):
    """Points (n, 3) at which light is gathered: vertices, and inside ``face`` those on an edge.

    ``face`` (n,): -1 within a panel. On a seam the point of a vertex touches the other panel.
    """
    for i in range(len(out)):
        p, f = row(mesh.vertices, i), face[i]
        if f >= 0:
            b1 = 0.6 if mesh.faces[f, 1] == i else 0.2
            b2 = 0.6 if mesh.faces[f, 2] == i else 0.2
            p = lift(mesh, f, b1, b2, blend(mesh.vertices, mesh.faces, f, b1, b2))
        for k in range(3):
            out[i, k] = p[k]


@njit(cache=True)
def lit(bvh, points, normals, lights, out):
    """Whether the middle of light k reaches point i, into ``out`` (k, n)."""
    stack = new_stack()
    for i in range(out.shape[1]):
        p, n = row(points, i), row(normals, i)
        o = along(p, 5 * ABOVE, n)
        for k in range(len(out)):
            l, far = _to_middle(_disc(lights, k, p))
            out[k, i] = 1.0 if dot(l, n) > 0.0 and _reaches(bvh, o, n, l, far, stack) else 0.0


@leaf()
def direction(n, i, q, strata):
    """Direction q of strata^2 cosine-weighted ones around ``n``, turned per vertex i."""
    t, s = across(n)
    turn, shift = even(i, 0, 0), even(i, 1, 0)
    a = (q // strata + shift) / strata
    phi = 2.0 * np.pi * (q % strata + turn) / strata
    r, up = np.sqrt(a), np.sqrt(1.0 - a)
    return along(along((n[0] * up, n[1] * up, n[2] * up), r * np.cos(phi), t), r * np.sin(phi), s)


@leaf()
def face_met(bvh, o, d, faces, stack):
    """Face in front of which a ray ends; ``OPEN``, or ``DARK`` at the back of a face.

    Faces from ``faces`` on, below a seam, count as backs.
    """
    leaf, _, _, _ = nearest(bvh, o[0], o[1], o[2], d[0], d[1], d[2], 0.0, stack)
    if leaf < 0:
        return OPEN
    f = bvh.face[leaf]
    front = dot(cross(row(bvh.edge1, leaf), row(bvh.edge2, leaf)), d) < 0.0
    return f if front and f < faces else DARK


@njit(cache=True)
def sky_seen(normals, which, hits, strata, panorama, unhidden, out):
    """Mean luminance (m, 3) of a panorama over the open directions.

    What an unhidden plane gets (``unhidden`` (m, 3)) times the share that is open of what all
    directions see, each blurred to what it stands for: a window in a dark room is hit by chance,
    and few rays by themselves would leave patches of light and dark.
    """
    width = np.sqrt(1.0 / strata)
    open_, every = np.empty(3), np.empty(3)
    for r in range(len(hits)):
        n = row(normals, which[r])
        open_[:], every[:] = 0.0, 1e-30
        for q in range(strata * strata):
            seen = panorama_towards(panorama, width, direction(n, which[r], q, strata))
            for k in range(3):
                every[k] += seen[k]
                if hits[r, q] == OPEN:
                    open_[k] += seen[k]
        for k in range(3):
            out[r, k] = unhidden[r, k] * open_[k] / every[k]


@njit(cache=True)
def gather(bvh, faces, points, normals, which, strata, hits):
    """What the vertices ``which`` see along strata^2 cosine-weighted directions, into ``hits``."""
    stack = new_stack()
    for r in range(len(which)):
        i = which[r]
        n = row(normals, i)
        o = along(row(points, i), 10 * ABOVE, n)
        for q in range(strata * strata):
            hits[r, q] = face_met(bvh, o, direction(n, i, q, strata), faces, stack)


@leaf()
def bounce(mesh, hits, albedo, luminances, out):
    """Mean luminance (m, 3) from the faces met, Lambert with ``albedo`` (p, 3).

    ``luminances`` (n, 3): luminance that the vertices get.
    """
    for r in range(hits.shape[0]):
        out[r] = 0.0
        for q in range(hits.shape[1]):
            f = hits[r, q]
            if f < 0:
                continue
            a, b, c = mesh.faces[f, 0], mesh.faces[f, 1], mesh.faces[f, 2]
            for k in range(3):
                mean = (luminances[a, k] + luminances[b, k] + luminances[c, k]) / 3.0
                out[r, k] += albedo[mesh.panel[f], k] * mean / hits.shape[1]
