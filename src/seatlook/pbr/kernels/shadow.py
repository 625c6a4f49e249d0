"""Shadows: the share of each light that each sample sees, by rays to its disc."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from numba import njit

from seatlook.pbr.kernels import leaf
from seatlook.pbr.kernels.bvh import Bvh, hidden_at, new_stack, occluded
from seatlook.pbr.kernels.light import SMALL, Lights, across, angle_of, arriving
from seatlook.pbr.kernels.noise import even
from seatlook.pbr.kernels.parts import in_parts
from seatlook.pbr.kernels.surface import (
    Eye,
    Mesh,
    along,
    blend,
    dot,
    lift,
    meet,
    minus,
    ray_through,
    row,
    row_of,
    unit,
)

# Rays start this far [m] above the surface: above rounding, below any fold.
ABOVE = 2e-5
# Points on a rim.
_RIM = 6
# Least cosine to the light by which an edge is drawn out.
_STEEPEST = 0.1
_EMPTY, _HIDDEN, _AWAY, _LIT, _GRAZING = 0, 1, 2, 3, 4


@leaf()
def disc_at(lights, k, p):
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
def to_middle(disc):
    """Unit direction to the middle of a disc; its distance."""
    l, to, _, _, far = disc
    return l, np.inf if far else np.sqrt(dot(to, to))


@leaf()
def reaches(bvh, p, n, d, far, stack):
    """Whether a ray from ``p`` along ``d`` comes ``far``; ``n``: normal of the plane it leaves.

    It starts above the plane even where it goes below: the curved surface is still lit there.
    """
    o = along(p, ABOVE, n)
    return not occluded(bvh, o[0], o[1], o[2], d[0], d[1], d[2], 0.0, far, stack)


@leaf()
def start_of(mesh, eye, f, i, j):
    """Start of a shadow ray for sample (i, j): (point, unit plane normal towards the eye, n)."""
    ray = ray_through(eye, i, j)
    b1, b2, _, plane = meet(mesh, eye, f, ray)
    p = blend(mesh.vertices, mesh.faces, f, b1, b2)
    n = blend(mesh.normals, mesh.faces, f, b1, b2)
    if dot(plane, ray) > 0.0:
        return p, (-plane[0], -plane[1], -plane[2]), (-n[0], -n[1], -n[2])
    return lift(mesh, f, b1, b2, p), plane, n


@leaf()
def _penumbra(lights, k, far, angle, t):
    """Half the width [m], across the light, of the shadow's edge of what lies ``t`` before it."""
    if far == np.inf:
        return t * np.tan(min(angle, 1.5))
    return lights.size[k] * t / max(far - t, lights.size[k])


@leaf()
def _first_ray(bvh, mesh, eye, f, i, j, lights, k, stack):
    """What one ray from sample (i, j) to the middle of light k meets.

    Returns a state, and how wide [rad], as the eye sees it, the edge of this shadow may be.
    """
    p, plane, n = start_of(mesh, eye, f, i, j)
    l, far = to_middle(disc_at(lights, k, p))
    angle, c = angle_of(lights, k, p), dot(n, l)
    if c <= -angle:
        return _AWAY, 0.0
    if c < angle and angle >= SMALL:
        return _GRAZING, 0.0
    if reaches(bvh, p, plane, l, far, stack):
        return _LIT, 0.0
    o, to = along(p, ABOVE, plane), minus(p, row_of(eye.origin))
    t = hidden_at(bvh, o[0], o[1], o[2], l[0], l[1], l[2], stack)
    half = _penumbra(lights, k, far, angle, t)
    return _HIDDEN, half / (max(c, _STEEPEST) * np.sqrt(dot(to, to)))


@leaf()
def _rim_agrees(bvh, lights, k, start, shift, is_lit, stack):
    """Whether points on the rim of light k are all seen, or all hidden, as its middle is.

    An edge between two of them hides, or shows, 3 % of the disc at most.
    """
    p, plane, n = start
    disc = disc_at(lights, k, p)
    for turn in range(_RIM):
        d, far = _to_disc(disc, 1.0, (turn + shift) / _RIM)
        if dot(n, d) <= 0.0 or reaches(bvh, p, plane, d, far, stack) != is_lit:
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


@njit(cache=True, nogil=True)
def _first_look(bvh, mesh, eye, ids, lights, k, factor, between, lines, state, octave):
    """One ray per pixel of some lines to the middle of the light, on a chequerboard.

    The pixels ``between`` look afterwards, where their neighbours do not agree. ``octave`` (h, w)
    of a hidden pixel: its shadow's edge is less than 2^octave pixels wide.
    """
    stack = new_stack()
    pixel = factor * np.sqrt(dot(row_of(eye.right), row_of(eye.right)))
    pixel /= np.sqrt(dot(row_of(eye.first), row_of(eye.first)))
    for y in range(lines[0], lines[1]):
        for x in range((y + between) % 2, state.shape[1], 2):
            for q in range(factor * factor):
                i, j = x * factor + q % factor, y * factor + q // factor
                f = ids[j, i]
                if f < 0:
                    continue
                if between:
                    state[y, x] = _of_neighbours(state, x, y)
                if state[y, x] == _EMPTY:
                    met, wide = _first_ray(bvh, mesh, eye, f, i, j, lights, k, stack)
                    state[y, x] = met
                    octave[y, x] = _octave(wide / pixel + 0.5)
                elif state[y, x] == _HIDDEN:
                    octave[y, x] = max(octave[y, x - 1], octave[y, x + 1])
                break


@leaf()
def _octave(pixels):
    """Least k for which 2^k is at least so many pixels; no picture is wider than 2^15."""
    k = 0
    while k < 15 and 2.0**k < pixels:
        k += 1
    return k


@njit(cache=True)
def count_before(wanted, total):
    """Number of pixels wanted above and to the left of each corner, into ``total``."""
    for y in range(wanted.shape[0]):
        line = 0
        for x in range(wanted.shape[1]):
            line += wanted[y, x]
            total[y + 1, x + 1] = total[y, x + 1] + line


@leaf()
def is_within(total, x, y, reach):
    """Whether a counted pixel lies within ``reach`` of this one."""
    y0, y1 = max(0, y - reach), min(total.shape[0] - 1, y + reach + 1)
    x0, x1 = max(0, x - reach), min(total.shape[1] - 1, x + reach + 1)
    return total[y1, x1] - total[y0, x1] - total[y1, x0] + total[y0, x0] > 0


@njit(cache=True)
def _edges(state, octave, near):
    """Pixels at the edge of a shadow, ``near`` (h, w): 2 where lit and dark ones touch, 1 beside.

    How far beside is known of every hidden pixel: shadows that begin equally far from what throws
    them are looked at together.
    """
    shape = (state.shape[0] + 1, state.shape[1] + 1)
    lit, dark = np.zeros(shape, np.int32), np.zeros(shape, np.int32)
    count_before(state == _LIT, lit)
    hidden = state == _HIDDEN
    near[:] = 0
    for k in range(16):
        here = hidden & (octave == k)
        if k == 0:
            here |= state == _AWAY
        if not here.any():
            continue
        count_before(here, dark)
        reach = 1 << k
        for y in range(near.shape[0]):
            for x in range(near.shape[1]):
                if is_within(lit, x, y, reach) and is_within(dark, x, y, reach):
                    touch = k == 0 or (is_within(lit, x, y, 1) and is_within(dark, x, y, 1))
                    near[y, x] = max(near[y, x], 2 if touch else 1)


@leaf()
def _share_seen(bvh, lights, k, start, shift, first, step, total, stack):
    """Share of the points of light k above the horizon that a sample sees.

    Points ``first, first + step, ...`` of ``total`` of Roberts' R2 sequence, shifted. The part
    below the horizon is the shading's to leave out.
    """
    p, plane, n = start
    seen = count = 0
    disc = disc_at(lights, k, p)
    l, far = to_middle(disc)
    c, angle = dot(n, l), angle_of(lights, k, p)
    if c <= -angle:
        return 0.0
    for index in range(first, total, step):
        a = (index + shift[0]) / total
        b = (shift[1] + 0.7548776662466927 * index) % 1.0
        d, far = _to_disc(disc, a, b)
        if dot(n, d) > 0.0:
            count += 1
            seen += reaches(bvh, p, plane, d, far, stack)
    if count:
        return seen / count
    # Little of the light has not set: its upper rim stands for it.
    up = unit(along(n, -c, l))
    rim = unit(along(l, 0.9 * angle, up))
    return 1.0 if reaches(bvh, p, plane, rim, far, stack) else 0.0


def shadows(
    bvh: Bvh,
    mesh: Mesh,
    eye: Eye,
    ids: npt.NDArray[np.int32],
    lights: Lights,
    k: int,
    factor: int,
    rays: int,
    out: npt.NDArray[np.uint8],
) -> None:
    """Share of light k [1/255] that each sample sees, into ``out`` like ``ids``.

    Where a pixel and its neighbours agree, as far as the edge of a shadow may spread, one ray is
    enough, and where the rim of the light agrees with its middle, those to it; in a penumbra every
    sample sends ``rays`` to its own stratified points of the light's disc.
    """
    size = (ids.shape[0] // factor, ids.shape[1] // factor)
    state, near, octave = (np.zeros(size, np.uint8) for _ in range(3))
    seen = (bvh, mesh, eye, ids, lights, k, factor)
    for between in (False, True):

        def look(first: int, last: int, between: bool = between) -> None:
            _first_look(*seen, between, (first, last), state, octave)

        in_parts(size[0], look, least=16)
    _edges(state, octave, near)
    in_parts(size[0], lambda a, b: _shares(*seen, rays, (a, b), state, near, out), least=16)


@njit(cache=True, nogil=True)
def _shares(bvh, mesh, eye, ids, lights, k, factor, rays, lines, state, near, out):
    """What the samples of some lines of pixels see, by their states."""
    stack, step = new_stack(), factor * factor
    for y in range(lines[0], lines[1]):
        for x in range(state.shape[1]):
            here = state[y, x]
            if here == _EMPTY:
                continue
            edge = here in (_GRAZING, _AWAY) or near[y, x] > 0
            shift = (even(x, y, 2 * k), even(x, y, 2 * k + 1))
            # Once per pixel, and not where that takes more rays than it saves; nor where an edge
            # may run between the samples, as that of a sun does.
            known = rays * step <= _RIM or near[y, x] == 2 or here in (_GRAZING, _AWAY)
            for q in range(step):
                i, j = x * factor + q % factor, y * factor + q // factor
                if ids[j, i] < 0:
                    continue
                if edge and not known:
                    start = start_of(mesh, eye, ids[j, i], i, j)
                    edge = not _rim_agrees(bvh, lights, k, start, shift[0], here == _LIT, stack)
                known = True
                if not edge:
                    out[j, i] = 255 if here == _LIT else 0
                    continue
                start = start_of(mesh, eye, ids[j, i], i, j)
                share = _share_seen(bvh, lights, k, start, shift, q, step, rays * step, stack)
                out[j, i] = np.rint(255.0 * share)
