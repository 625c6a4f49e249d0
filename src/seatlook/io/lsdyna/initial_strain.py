"""``*INITIAL_STRAIN_SHELL``: strains at integration points, brought to the two surfaces."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from seatlook.errors import InputError
from seatlook.io.lsdyna.cards import LONG_WIDTH, Block
from seatlook.model import FloatArray, IntArray
from seatlook.model.shells import StrainAxes

_MOST = 99  # integration points in the plane or over the thickness


@dataclass(frozen=True, slots=True)
class SurfaceStrains:
    """Strains (e, 3, 3) on both surfaces; ``absent`` shells have no entry and are unstrained."""

    inner: FloatArray
    outer: FloatArray
    axes: StrainAxes
    absent: int


@dataclass(frozen=True, slots=True)
class _Points:
    """Strains at all points of all blocks: element number, level T in [-1, 1], six components."""

    element: IntArray
    level: FloatArray
    six: FloatArray
    local: bool


def surface_strains(blocks: Sequence[Block], element_ids: IntArray) -> SurfaceStrains | None:
    """Return the strains on the surfaces, None where the deck has none.

    The points of one element are averaged over its plane and a straight line through its levels is
    drawn to T = -1 and +1. A shell without an entry is unstrained, as in the calculation.

    Raises
    ------
    InputError
        Points on one level only, which do not show the bending; local and global axes mixed.
    """
    groups = [points for block in blocks for points in _groups(block)]
    if not groups:
        return None
    if len({g.local for g in groups}) > 1:
        raise InputError.single(
            "*INITIAL_STRAIN_SHELL", got="ILOCAL 0 and 1", expected="one of them",
            file=blocks[0].file,
        )  # fmt: skip
    element = np.concatenate([g.element for g in groups])
    order = np.argsort(element_ids)
    at = np.minimum(np.searchsorted(element_ids[order], element), len(order) - 1)
    row = order[at]
    inside = element_ids[row] == element
    if not inside.any():
        return None
    level, six = (np.concatenate([getattr(g, n) for g in groups])[inside] for n in ("level", "six"))
    ends = _to_surfaces(blocks[0], row[inside], level, six, element_ids)
    axes: StrainAxes = "element" if groups[0].local else "global"
    absent = len(element_ids) - len(np.unique(row[inside]))
    return SurfaceStrains(_tensors(ends[0]), _tensors(ends[1]), axes, absent)


def _to_surfaces(
    block: Block, row: IntArray, level: FloatArray, six: FloatArray, ids: IntArray
) -> tuple[FloatArray, FloatArray]:
    """Least-squares line through the levels of each element, at T = -1 and T = +1."""
    e = len(ids)
    count = np.bincount(row, minlength=e)
    there = count > 0
    n = np.maximum(count, 1)
    mean = np.bincount(row, level, e) / n
    off = level - mean[row]
    spread = np.bincount(row, off**2, e)
    if (there & (spread < 1e-6)).any():
        first = int(ids[there & (spread < 1e-6)][0])
        raise InputError.single(
            "*INITIAL_STRAIN_SHELL", got=f"one level of thickness for shell {first}",
            expected="at least two, which show the bending", file=block.file,
            line=block.line,
        )  # fmt: skip
    middle = np.stack([np.bincount(row, c, e) for c in six.T], axis=1) / n[:, None]
    moment = np.stack([np.bincount(row, c * off, e) for c in six.T], axis=1)
    slope = moment / np.where(there, spread, 1.0)[:, None]
    return middle + slope * (-1.0 - mean)[:, None], middle + slope * (1.0 - mean)[:, None]


def _tensors(six: FloatArray) -> FloatArray:
    """(e, 3, 3) from xx, yy, zz, xy, yz, zx."""
    return six[:, [[0, 3, 5], [3, 1, 4], [5, 4, 2]]]


def _groups(block: Block) -> list[_Points]:
    """Read the entries of a block; those of one shape that follow each other are read at once."""
    groups: list[_Points] = []
    at = 0
    while at < len(block.cards):
        head = block.table([10] * 8, slice(at, at + 1))
        plane, levels, large, local = head.ints(1, 2, 3, 7)[0].tolist()
        if not (1 <= plane <= _MOST and 1 <= levels <= _MOST and large in (0, 1)):
            raise head.problem(
                0, f"NPLANE {plane}, NTHICK {levels}, LARGE {large}",
                f"1 to {_MOST} points, LARGE 0 or 1",
            )  # fmt: skip
        points, lines = plane * levels, 1 + large
        step = 1 + points * lines
        run = _run(block, at, step)
        if at + run * step > len(block.cards):
            raise head.problem(0, "too few cards", f"{step - 1} cards of strains", "cut short?")
        element = block.table([10], slice(at, at + run * step, step)).ints(0)[:, 0]
        for k in range(points):
            values = _values(block, slice(at + 1 + k * lines, at + run * step, step), large)
            groups.append(_Points(element, values[:, 6], values[:, :6], bool(local)))
        at += run * step
    return groups


def _values(block: Block, rows: slice, large: int) -> FloatArray:
    """Six strains and the level T of one point of every entry."""
    if not large:
        return block.table([10] * 7, rows).floats(*range(7))
    first = block.table([16] * 5, rows).floats(*range(5))
    second = block.table([16] * 2, slice(rows.start + 1, rows.stop, rows.step)).floats(0, 1)
    return np.concatenate([first, second], axis=1)


def _run(block: Block, at: int, step: int) -> int:
    """Count the entries from card ``at`` on whose first cards differ in the element only."""
    shape = _behind_the_element(block, at)
    k = at
    while k < len(block.cards) and _behind_the_element(block, k) == shape:
        k += step
    return (k - at) // step


def _behind_the_element(block: Block, k: int) -> bytes:
    card = block.cards[k]
    if b"," in card:
        return card.partition(b",")[2].replace(b" ", b"")
    return card[block.width if block.width == LONG_WIDTH else 10 :].rstrip()
