"""``*INITIAL_STRAIN_SHELL``: strains at integration points, brought to the two surfaces."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from seatlook.errors import InputError
from seatlook.io.lsdyna.deck.cards import LONG_WIDTH, Block
from seatlook.io.lsdyna.deck.placement import shifted
from seatlook.io.lsdyna.deck.shell_sets import of_set
from seatlook.io.lsdyna.deck.transformation import Transformations
from seatlook.model import FloatArray, IntArray
from seatlook.model.shells import StrainAxes

_MOST = 99  # integration points in the plane or over the thickness


@dataclass(frozen=True, slots=True)
class SurfaceStrains:
    """Strains (e, 3, 3) on both surfaces; ``absent`` are without an entry and unstrained."""

    inner: FloatArray
    outer: FloatArray
    axes: StrainAxes
    absent: IntArray


@dataclass(frozen=True, slots=True)
class _Points:
    """Strains at all points of all blocks: element number, level T in [-1, 1], six components."""

    element: IntArray
    level: FloatArray
    six: FloatArray
    local: bool
    first: bool  # of the points of an entry


def surface_strains(
    blocks: Sequence[Block],
    element_ids: IntArray,
    transformations: Transformations,
    sets: Mapping[int, IntArray | Block],
) -> SurfaceStrains | None:
    """Return the strains on the surfaces, None where the deck has none.

    The points of one element are averaged over its plane and a straight line through its levels is
    drawn to T = -1 and +1. A shell without an entry is unstrained, as in the calculation.

    Raises
    ------
    InputError
        Points on one level only, which do not show the bending; local and global axes mixed; a
        shell with two entries; a set that is not there or not read.
    """
    groups = [_placed(p, block, transformations, sets) for block in blocks for p in _groups(block)]
    groups = [points for points in groups if len(points.element)]
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
    _once(blocks[0], np.concatenate([g.element for g in groups if g.first]))
    ends = _to_surfaces(blocks[0], row[inside], level, six, element_ids)
    axes: StrainAxes = "element" if groups[0].local else "global"
    absent = np.setdiff1d(np.arange(len(element_ids)), row[inside])
    return SurfaceStrains(_tensors(ends[0]), _tensors(ends[1]), axes, absent)


def _placed(
    points: _Points,
    block: Block,
    transformations: Transformations,
    sets: Mapping[int, IntArray | Block],
) -> _Points:
    """Give points to the shells of a set, and move them with the file they stand in."""
    element, level, six = points.element, points.level, points.six
    if block.name.endswith("_SET"):
        members = [of_set(block, int(n) + block.place.sets, sets) for n in element]
        each = [len(m) for m in members]
        element = np.concatenate(members)
        level, six = np.repeat(level, each), np.repeat(six, each, axis=0)
    else:
        element = shifted(element, block.place.element)
    if block.place.moves and not points.local:
        six = transformations.frame(block.place).turned(six)
    return _Points(element, level, six, points.local, points.first)


def _once(block: Block, element: IntArray) -> None:
    """Refuse a second entry for a shell: it would be mixed with the first."""
    numbers, count = np.unique(element, return_counts=True)
    if (count > 1).any():
        got = f"shell {numbers[count > 1][0]} more than once"
        raise InputError.single(
            "*INITIAL_STRAIN_SHELL", got=got, expected="one entry for each shell", file=block.file
        )


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
        number, plane, levels, large, local = head.ints(0, 1, 2, 3, 7)[0].tolist()
        if not (number > 0 and 0 <= plane <= _MOST and 0 <= levels <= _MOST and large in (0, 1)):
            raise head.problem(
                0, f"number {number}, NPLANE {plane}, NTHICK {levels}, LARGE {large}",
                f"a number, up to {_MOST} points, LARGE 0 or 1",
            )  # fmt: skip
        blank = levels == 0
        points, lines = max(plane, 1) * (levels or 2), 1 + large
        step = 1 + points * lines
        run = _run(block, at, step)
        if at + run * step > len(block.cards):
            raise head.problem(0, "too few cards", f"{step - 1} cards of strains", "cut short?")
        element = block.table([10], slice(at, at + run * step, step)).ints(0)[:, 0]
        values = [
            _values(block, slice(at + 1 + k * lines, at + run * step, step), large)
            for k in range(points)
        ]
        if blank and points == 2 and not any(v[:, 6].any() for v in values):
            # Without NTHICK and T: the inner surface, then the outer.
            values[0][:, 6], values[1][:, 6] = -1.0, 1.0
        for k, v in enumerate(values):
            groups.append(_Points(element, v[:, 6], v[:, :6], bool(local), k == 0))
        at += run * step
    return groups


def _values(block: Block, rows: slice, large: int) -> FloatArray:
    """Six strains and the level T of one point of every entry."""
    if not large:
        return block.table([10] * 7, rows).floats(*range(7))
    after = slice(rows.start + 1, rows.stop, rows.step)
    # 16 columns a field; some programs write 20, which makes longer cards.
    longest = max(
        len(block.cards[rows.start].rstrip()) - 80, len(block.cards[after.start].rstrip()) - 32
    )
    width = LONG_WIDTH if longest > 0 and b"," not in block.cards[rows.start] else 16
    first = block.table([width] * 5, rows).floats(*range(5))
    second = block.table([width] * 2, after).floats(0, 1)
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
