"""LS-DYNA keyword decks and dynain files: nodes, shells, thickness and surface strains.

Read are ``*NODE``, ``*ELEMENT_SHELL`` (with ``_THICKNESS``, ``_BETA``, ``_MCID``, ``_OFFSET``,
``_COMPOSITE``), ``*PART``, ``*SECTION_SHELL``, ``*INITIAL_STRAIN_SHELL`` (and ``_SET``),
``*INCLUDE``, ``*INCLUDE_PATH`` and ``*INCLUDE_TRANSFORM``. What would change the shells and is not
followed is refused by name; other keywords are skipped. Standard, LONG=Y, I10=Y and comma formats,
and numbers such as ``1.5-3``.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from seatlook.errors import InputError
from seatlook.files import reader
from seatlook.io.lsdyna.deck.content import Deck, read_deck
from seatlook.io.lsdyna.deck.initial_strain import SurfaceStrains, surface_strains
from seatlook.io.lsdyna.deck.shell_sets import shell_sets
from seatlook.io.lsdyna.element_tables import (
    ElementTable,
    Selection,
    check_thickness_unit,
    select,
    unit_in_metres,
)
from seatlook.model import FloatArray, IntArray, ShellResult, ShellState


@reader("a keyword deck")
def read_keyword(
    path: Path,
    *,
    parts: Sequence[int | str] | None = None,
    thickness: float | None = None,
    length_unit: str = "mm",
    reference: Path | None = None,
) -> ShellResult:
    """Read the shells of a keyword deck as a result of one state.

    Parameters
    ----------
    parts : part numbers or titles; without it all shells
    thickness : float [m]      for decks that do not hold it; overrides the deck's
    length_unit : "mm", "cm", "m" or "inch"
    reference : a deck with the same nodes before any load; needed where there are no strains

    Raises
    ------
    InputError
        Unreadable numbers with their line, nodes or parts that do not exist, no shells, no
        thickness, no strains and no reference.
    """
    file = Path(path)
    scale = unit_in_metres(length_unit)
    deck = read_deck(file, length_unit=length_unit)
    node_ids, positions = _nodes(file, deck, scale)
    table = _table(file, deck, node_ids)
    start = None
    if reference is not None:
        start = _reference(Path(reference), node_ids, length_unit)
    chosen = select(table, parts, reference=start, positions=positions)
    shells = chosen.shells
    strains = surface_strains(
        deck.strains,
        shells.element_ids,
        deck.transformations,
        shell_sets(deck.sets, np.concatenate(deck.shells)),
    )
    if strains is None and shells.reference is None:
        raise InputError.single(
            "*INITIAL_STRAIN_SHELL", got="none for these shells", file=file,
            expected="strains on at least two levels of the thickness, or a reference deck",
        )  # fmt: skip
    t = _thickness(deck, chosen, scale) if thickness is None else np.full(len(shells), thickness)
    _check_thickness(deck, table, chosen, t)
    if thickness is None:
        check_thickness_unit(file, t)
    state = ShellState(
        time=0.0,
        positions=positions[chosen.nodes],
        thickness=t,
        strain_inner=None if strains is None else strains.inner,
        strain_outer=None if strains is None else strains.outer,
        strain_axes="global" if strains is None else strains.axes,
        alive=np.ones(len(shells), dtype=bool),
    )
    return ShellResult(
        shells=shells,
        times=np.zeros(1),
        read=[state].__getitem__,
        notes=(*deck.notes, *_notes(table, shells.part, strains)),
    )


def _table(file: Path, deck: Deck, node_ids: IntArray) -> ElementTable:
    table = _shells(file, deck)
    return ElementTable(
        file=file,
        corners=_indices(file, node_ids, table),
        element_ids=table[:, 0],
        part=table[:, 1],
        titles=deck.titles,
        usable=np.ones(len(table), dtype=bool),
    )


def _notes(table: ElementTable, part: IntArray, strains: SurfaceStrains | None) -> tuple[str, ...]:
    if strains is None:
        return ("the deck has no strains: curvature is taken from the geometry",)
    count = len(strains.absent)
    if not count:
        return ()
    names = table.named(np.unique(part[strains.absent]))
    return (f"{count} shells have no strains in the deck and count as unstrained: part {names}",)


def _shells(file: Path, deck: Deck) -> IntArray:
    if not sum(map(len, deck.shells)):
        raise InputError.single("*ELEMENT_SHELL", got="none", expected="shells", file=file)
    table = np.concatenate(deck.shells)
    triangle = table[:, 5] == 0
    table[triangle, 5] = table[triangle, 4]
    _unique(file, "*ELEMENT_SHELL", table[:, 0])
    return table


def _nodes(file: Path, deck: Deck, scale: float) -> tuple[IntArray, FloatArray]:
    """Return node numbers, sorted, and positions [m]."""
    if not sum(map(len, deck.node_ids)):
        raise InputError.single("*NODE", got="none", expected="nodes", file=file)
    ids = np.concatenate(deck.node_ids)
    _unique(file, "*NODE", ids)
    order = np.argsort(ids)
    return ids[order], np.concatenate(deck.nodes)[order] * scale


def _unique(file: Path, keyword: str, ids: IntArray) -> None:
    numbers, count = np.unique(ids, return_counts=True)
    if (count > 1).any():
        raise InputError.single(
            keyword, got=f"number {numbers[count > 1][0]} more than once", file=file,
            expected="each number once",
        )  # fmt: skip


def _indices(file: Path, node_ids: IntArray, table: IntArray) -> IntArray:
    """Turn node numbers into indices."""
    at = np.minimum(np.searchsorted(node_ids, table[:, 2:]), len(node_ids) - 1)
    absent = (node_ids[at] != table[:, 2:]).any(axis=1)
    if absent.any():
        first = ", ".join(map(str, table[absent, 0][:5]))
        raise InputError.single(
            "*ELEMENT_SHELL", got=f"{int(absent.sum())} shells on unknown nodes, first {first}",
            expected="nodes of *NODE", file=file,
        )  # fmt: skip
    return np.asarray(at, dtype=np.int64)


def _reference(file: Path, node_ids: IntArray, length_unit: str) -> FloatArray:
    """Read the same nodes before loading."""
    deck = read_deck(file, length_unit=length_unit)
    ids, positions = _nodes(file, deck, unit_in_metres(length_unit))
    at = np.minimum(np.searchsorted(ids, node_ids), len(ids) - 1)
    absent = node_ids[ids[at] != node_ids]
    if len(absent):
        raise InputError.single(
            "*NODE", got=f"{len(absent)} nodes missing, first {absent[0]}",
            expected="the nodes of the deformed deck", file=file,
        )  # fmt: skip
    return positions[at]


def _thickness(deck: Deck, chosen: Selection, scale: float) -> FloatArray:
    """Thickness [m] of each shell: its own, else that of its part's section, else nan."""
    own = np.concatenate(deck.shell_thickness)[chosen.elements]
    part = chosen.shells.part
    of_part = {p: deck.thickness_of_part(p) for p in np.unique(part).tolist()}
    section = np.array([of_part[p] for p in part.tolist()])
    return np.where(np.isfinite(own), own, section) * scale


def _check_thickness(
    deck: Deck, table: ElementTable, chosen: Selection, thickness: FloatArray
) -> None:
    shells = chosen.shells
    bad = ~(np.isfinite(thickness) & (thickness > 0))
    if bad.any():
        names = table.named(np.unique(shells.part[bad]))
        raise InputError.single(
            "thickness", file=table.file,
            got=f"none for {int(bad.sum())} shells of part {names}, first "
            f"{shells.element_ids[bad][0]}",
            expected="*SECTION_SHELL, *PART_COMPOSITE or *ELEMENT_SHELL_THICKNESS of this part",
            hint=f"{deck.offsets}or say the thickness",
        )  # fmt: skip
