"""Shadows of rectangles: which of the cells of one each sample sees, by rays, one bit each.

A single share of the whole would dim a highlight in a trench that mirrors the half which is seen.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from numba import njit

from seatlook.pbr.kernels import leaf
from seatlook.pbr.kernels.area import ALL, CELLS, across_at, place_on, rectangle_at
from seatlook.pbr.kernels.bvh import Bvh, new_stack
from seatlook.pbr.kernels.light import Lights
from seatlook.pbr.kernels.noise import even
from seatlook.pbr.kernels.parts import in_parts
from seatlook.pbr.kernels.shadow import count_before, is_within, reaches, start_of
from seatlook.pbr.kernels.surface import Eye, Mesh, dot

_EMPTY, _HIDDEN, _LIT, _SET = 0, 1, 2, 3
# Pixels beside one that must agree: each cell is then asked for six times.
_REACH = 3
# Cells of the pixels in a block of 4 x 2, so that neighbours ask for distant ones.
_ORDER = (0, 5, 2, 7, 4, 1, 6, 3)


@leaf()
def _ask(bvh, lights, k, start, cell, a, b, stack):
    """What a ray to place (a, b), in the unit square, of a cell of light k meets."""
    p, plane, n = start
    rectangle = rectangle_at(lights, k, p)
    if rectangle.ahead <= 0.0:
        return _SET
    column, line = cell // rectangle.rows, cell % rectangle.rows
    x, y = across_at(rectangle, column + a), 2.0 * (line + b) / rectangle.rows - 1.0
    d = place_on(rectangle, x, y)
    far = np.sqrt(dot(d, d))
    d = (d[0] / far, d[1] / far, d[2] / far)
    if dot(n, d) <= 0.0:
        return _SET
    return _LIT if reaches(bvh, p, plane, d, far, stack) else _HIDDEN


@njit(cache=True, nogil=True)
def _first_look(bvh, mesh, eye, ids, lights, k, factor, lines, state):
    """One ray per pixel of some lines, each to another cell than its neighbours'."""
    stack = new_stack()
    for y in range(lines[0], lines[1]):
        for x in range(state.shape[1]):
            for q in range(factor * factor):
                i, j = x * factor + q % factor, y * factor + q // factor
                if ids[j, i] < 0:
                    continue
                start = start_of(mesh, eye, ids[j, i], i, j)
                cell = _ORDER[(x & 3) + 4 * (y & 1)]
                a, b = even(x, y, 2 * k), even(x, y, 2 * k + 1)
                state[y, x] = _ask(bvh, lights, k, start, cell, a, b, stack)
                break


@njit(cache=True, nogil=True)
def _look(bvh, mesh, eye, ids, lights, k, factor, lines, lit, dark, out):
    """Cells that the samples of some lines of pixels see, by what their neighbours met."""
    stack, step = new_stack(), factor * factor
    for y in range(lines[0], lines[1]):
        for x in range(lit.shape[1] - 1):
            some, none = is_within(lit, x, y, _REACH), is_within(dark, x, y, _REACH)
            for q in range(step):
                i, j = x * factor + q % factor, y * factor + q // factor
                if ids[j, i] < 0:
                    continue
                if not (some and none):
                    out[j, i] = 0 if none else ALL
                    continue
                start, seen = start_of(mesh, eye, ids[j, i], i, j), 0
                for cell in range(CELLS):
                    number = 2 * (CELLS * k + cell)
                    a = (q + even(x, y, number)) / step
                    b = (even(x, y, number + 1) + 0.7548776662466927 * q) % 1.0
                    if _ask(bvh, lights, k, start, cell, a, b, stack) != _HIDDEN:
                        seen |= 1 << cell
                out[j, i] = seen


def cells_seen(
    bvh: Bvh,
    mesh: Mesh,
    eye: Eye,
    ids: npt.NDArray[np.int32],
    lights: Lights,
    k: int,
    factor: int,
    out: npt.NDArray[np.uint8],
) -> None:
    """Cells of rectangle k that each sample sees, one bit each, into ``out`` like ``ids``.

    Where the rays of a pixel and its neighbours agree, all or none of them are; elsewhere every
    sample sends one to a place of its own in each cell.
    """
    size = (ids.shape[0] // factor, ids.shape[1] // factor)
    state = np.zeros(size, np.uint8)
    seen = (bvh, mesh, eye, ids, lights, k, factor)
    in_parts(size[0], lambda a, b: _first_look(*seen, (a, b), state), least=16)
    lit, dark = (np.zeros((size[0] + 1, size[1] + 1), np.int32) for _ in range(2))
    count_before(state == _LIT, lit)
    count_before(state == _HIDDEN, dark)
    in_parts(size[0], lambda a, b: _look(*seen, (a, b), lit, dark, out), least=16)
