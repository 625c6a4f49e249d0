"""``*SET_SHELL``: which shells a set names."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import numpy as np

from seatlook.io.lsdyna.deck.cards import Block, refuse
from seatlook.model import IntArray

_OPTIONS = {"", "ALL", "ELEM", "DELEM", "PART", "DPART"}
_LISTS = {"", "LIST", "LIST_COLLECT", "COLLECT"}
_RANGES = {"GENERATE", "LIST_GENERATE", "LIST_GENERATE_COLLECT"}


def shell_sets(blocks: Iterable[Block], shells: IntArray) -> dict[int, IntArray | Block]:
    """Return the shells of every set by its number; the block itself where its kind is not read.

    Parameters
    ----------
    shells : (k, 6) int64     number, part and corners of all shells of the deck
    """
    sets: dict[int, IntArray | Block] = {}
    for block in blocks:
        kind = block.name.removeprefix("SET_SHELL").removeprefix("_")
        titled = kind.endswith("TITLE")
        kind = kind.removesuffix("TITLE").removesuffix("_")
        head = block.table([10], slice(int(titled), int(titled) + 1)).ints(0)
        if not len(head):
            continue
        number = int(head[0, 0]) + block.place.sets
        members = _members(block, kind, int(titled) + 1, shells)
        known = sets.get(number)
        if isinstance(known, np.ndarray) and isinstance(members, np.ndarray):
            members = np.union1d(known, members)
        sets[number] = members
    return sets


def _members(block: Block, kind: str, at: int, shells: IntArray) -> IntArray | Block:
    rows = slice(at, None)
    shift = block.place.element
    if kind in _LISTS:
        numbers = block.table([10] * 8, rows).ints(*range(8)).ravel()
        return np.asarray(np.unique(numbers[numbers > 0]) + shift)
    if kind == "COLUMN":
        return np.unique(block.table([10], rows).ints(0)) + shift
    if kind in _RANGES:
        ends = block.table([10] * 8, rows).ints(*range(8)).reshape(-1, 2) + shift
        number = shells[:, 0]
        inside = ((number >= ends[:, :1]) & (number <= ends[:, 1:])).any(axis=0)
        return np.asarray(number[inside])
    if kind == "GENERAL":
        return _general(block, at, shells)
    return block


def _general(block: Block, at: int, shells: IntArray) -> IntArray | Block:
    """Read options row by row: ALL, ELEM, DELEM, PART and DPART; else the set is not read."""
    table = block.table([10] * 8, slice(at, None))
    numbers = table.ints(*range(1, 8)) if set(table.words(0)) <= _OPTIONS else None
    if numbers is None:
        return block
    inside = np.zeros(len(shells), dtype=np.bool_)
    for option, row in zip(table.words(0), numbers, strict=True):
        wanted = row[row > 0]
        if option == "ALL":
            inside[:] = True
        elif option.endswith("ELEM"):
            inside[np.isin(shells[:, 0], wanted + block.place.element)] = option == "ELEM"
        elif option.endswith("PART"):
            inside[np.isin(shells[:, 1], wanted + block.place.part)] = option == "PART"
    return np.asarray(shells[inside, 0])


def of_set(block: Block, number: int, sets: Mapping[int, IntArray | Block]) -> IntArray:
    """Return the shells of a set that ``block`` names.

    Raises
    ------
    InputError
        A set that is not there, or of a kind that is not read.
    """
    members = sets.get(number)
    if members is None:
        raise refuse(block, f"set {number}", "a *SET_SHELL of the deck")
    if isinstance(members, Block):
        raise refuse(members, f"set {number}, of a kind that is not read",
                     "LIST, LIST_GENERATE, COLUMN, or GENERAL with ALL, ELEM or PART")  # fmt: skip
    return members
