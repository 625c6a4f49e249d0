"""What both readers of shell results share: part selection, units, checks."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType

import numpy as np
import numpy.typing as npt

from seatlook.errors import InputError, Problem
from seatlook.model import FloatArray, IntArray, Shells

LENGTH_UNITS = {"mm": 1e-3, "cm": 1e-2, "m": 1.0, "inch": 0.0254}
_SMALLEST, _LARGEST = 2e-3, 20.0  # [m] extent of a cover or of the car around it


@dataclass(frozen=True, slots=True)
class ElementTable:
    """All shells of a file.

    Parameters
    ----------
    corners : (e, 4) int64             into the nodes of the file
    element_ids, part : (e,) int64     numbers of the user
    titles : part number -> title
    usable : (e,) bool                 shells that have results
    """

    file: Path
    corners: IntArray
    element_ids: IntArray
    part: IntArray
    titles: Mapping[int, str]
    usable: npt.NDArray[np.bool_]


@dataclass(frozen=True, slots=True)
class Selection:
    """The shells to evaluate, with their nodes counted anew.

    Parameters
    ----------
    elements : (e,) int64     into the shells of the file
    nodes : (n,) int64        into the nodes of the file
    dropped : shells of the chosen parts that have no results
    """

    shells: Shells
    elements: IntArray
    nodes: IntArray
    dropped: int


def unit_in_metres(name: str) -> float:
    """Return the length of one unit in metres."""
    if name not in LENGTH_UNITS:
        raise InputError.single(
            "length_unit", got=repr(name), expected=f"one of {', '.join(LENGTH_UNITS)}"
        )
    return LENGTH_UNITS[name]


def select(
    table: ElementTable,
    parts: Sequence[int | str] | None,
    *,
    reference: FloatArray | None,
    positions: FloatArray | None = None,
) -> Selection:
    """Take the shells of some parts, by number or title, and check the extent of their nodes.

    Parameters
    ----------
    parts : None for all
    reference, positions : (nodes of the file, 3) float64 [m]    before and after loading
    """
    inside = _of_parts(table, parts)
    elements = np.flatnonzero(inside & table.usable)
    if not len(elements):
        raise InputError.single(
            "shells", got="none with results", expected="deformable shells", file=table.file
        )
    nodes, corners = np.unique(table.corners[elements], return_inverse=True)
    shape = positions if reference is None else reference
    if shape is not None:
        _check_extent(table.file, shape[nodes])
    shells = Shells(
        corners=corners.reshape(-1, 4),
        element_ids=table.element_ids[elements],
        part=table.part[elements],
        part_names=MappingProxyType(dict(table.titles)),
        node_count=len(nodes),
        reference=None if reference is None else reference[nodes],
    )
    return Selection(shells, elements, nodes, int((inside & ~table.usable).sum()))


def _of_parts(table: ElementTable, parts: Sequence[int | str] | None) -> npt.NDArray[np.bool_]:
    if parts is None:
        return np.ones(len(table.part), dtype=bool)
    titles = table.titles
    numbers = {title.casefold(): number for number, title in titles.items()}
    there = {int(p) for p in np.unique(table.part)}
    known = ", ".join(f"{p} {titles[p]!r}" if titles.get(p) else str(p) for p in sorted(there)[:20])
    problems: list[Problem] = []
    chosen = set()
    for name in parts:
        number = int(name) if str(name).isdecimal() else numbers.get(str(name).casefold())
        if number in there:
            chosen.add(number)
        else:
            problems += InputError.single(
                "parts", got=repr(name), expected=f"a part with shells: {known}", file=table.file
            ).problems
    if problems:
        raise InputError(problems)
    return np.isin(table.part, list(chosen))


def _check_extent(file: Path, points: FloatArray) -> None:
    """Refuse a size that only a wrong unit explains."""
    if not np.isfinite(points).all():
        raise InputError.single("nodes", got="nan or inf", expected="finite positions", file=file)
    extent = float(np.ptp(points, axis=0).max())
    if not _SMALLEST <= extent <= _LARGEST:
        raise InputError.single(
            "nodes", got=f"an extent of {extent:.3g} m", file=file,
            expected=f"{_SMALLEST:g} to {_LARGEST:g} m", hint="say the unit of length",
        )  # fmt: skip


def finite(file: Path, key: str, values: FloatArray, numbers: IntArray) -> None:
    """Refuse nan and inf, naming the first rows that hold them."""
    bad = np.flatnonzero(~np.isfinite(values.reshape(len(values), -1)).all(axis=1))
    if len(bad):
        first = ", ".join(map(str, numbers[bad[:5]]))
        raise InputError.single(
            key, got=f"nan or inf in {len(bad)} rows, first {first}", expected="numbers", file=file
        )
