"""What both readers of shell results share: part selection, units, checks."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType

import numpy as np
import numpy.typing as npt

from seatlook.errors import InputError, Problem
from seatlook.model import FloatArray, IntArray, Shells

LENGTH_UNITS = {"mm": 1e-3, "cm": 1e-2, "m": 1.0, "inch": 0.0254}
_SMALLEST, _LARGEST = 2e-3, 20.0  # [m] extent of a cover or of the car around it
_THINNEST = 2e-5  # [m]; below lies a car in metres that is taken for a seat in millimetres


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

    def named(self, parts: Iterable[int]) -> str:
        """Return numbers of parts with their titles, the first twenty."""
        titles = self.titles
        numbers = sorted(map(int, parts))
        known = [f"{p} {titles[p]!r}" if titles.get(p) else str(p) for p in numbers[:20]]
        return ", ".join([*known, "..."] if len(numbers) > 20 else known)


@dataclass(frozen=True, slots=True)
class Selection:
    """The shells to evaluate, with their nodes counted anew.

    Parameters
    ----------
    elements : (e,) int64     into the shells of the file
    nodes : (n,) int64        into the nodes of the file
    inside : (shells of the file,) bool     those of the chosen parts, with results or without
    """

    shells: Shells
    elements: IntArray
    nodes: IntArray
    inside: npt.NDArray[np.bool_]


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
    return Selection(shells, elements, nodes, inside)


def _of_parts(table: ElementTable, parts: Sequence[int | str] | None) -> npt.NDArray[np.bool_]:
    if parts is None:
        return np.ones(len(table.part), dtype=bool)
    there = {int(p) for p in np.unique(table.part)}
    by_title: dict[str, list[int]] = {}
    for number in sorted(there & set(table.titles)):
        by_title.setdefault(table.titles[number].casefold(), []).append(number)
    problems: list[Problem] = []
    chosen = set()
    for name in parts:
        wanted = str(name)
        numbers = [int(wanted)] if wanted.isdecimal() else by_title.get(wanted.casefold(), [])
        if len(numbers) == 1 and numbers[0] in there:
            chosen.add(numbers[0])
            continue
        several = len(numbers) > 1
        problems += InputError.single(
            "parts", file=table.file,
            got=f"{name!r}, the title of {len(numbers)} parts" if several else repr(name),
            expected=f"one of their numbers: {', '.join(map(str, numbers))}" if several
            else f"a part with shells: {table.named(there)}",
        ).problems  # fmt: skip
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


def check_thickness_unit(file: Path, thickness: FloatArray) -> None:
    """Refuse thicknesses [m] of a file that only a wrong unit explains."""
    middle = float(np.median(thickness)) if len(thickness) else 0.0
    if 0 < middle < _THINNEST:
        raise InputError.single(
            "thickness", got=f"{middle * 1e3:.3g} mm in the middle", file=file,
            expected=f"{_THINNEST * 1e3:g} mm or more", hint="say the unit of length",
        )  # fmt: skip


def finite(file: Path, key: str, values: FloatArray, numbers: IntArray) -> None:
    """Refuse nan and inf, naming the first rows that hold them."""
    bad = np.flatnonzero(~np.isfinite(values.reshape(len(values), -1)).all(axis=1))
    if len(bad):
        first = ", ".join(map(str, numbers[bad[:5]]))
        raise InputError.single(
            key, got=f"nan or inf in {len(bad)} rows, first {first}", expected="numbers", file=file
        )


def text(raw: bytes) -> str:
    """Read a title: UTF-8 where it is, else Latin-1; what stands behind a zero byte is padding."""
    letters = raw.split(b"\0")[0].strip()
    try:
        return letters.decode()
    except UnicodeDecodeError:
        return letters.decode("latin-1")
