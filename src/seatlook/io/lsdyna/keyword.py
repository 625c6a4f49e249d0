"""LS-DYNA keyword decks and dynain files: nodes, shells, thickness and surface strains.

Read are ``*NODE``, ``*ELEMENT_SHELL`` (with ``_THICKNESS``, ``_BETA``, ``_MCID``, ``_OFFSET``),
``*PART``, ``*SECTION_SHELL``, ``*INITIAL_STRAIN_SHELL`` and ``*INCLUDE``; other keywords are
skipped. Standard, LONG=Y, I10=Y and comma formats, and numbers such as ``1.5-3``.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from seatlook.errors import InputError
from seatlook.io.lsdyna.cards import Block, blocks
from seatlook.io.lsdyna.element_tables import (
    ElementTable,
    Selection,
    select,
    unit_in_metres,
)
from seatlook.io.lsdyna.initial_strain import SurfaceStrains, surface_strains
from seatlook.io.toml import read_file
from seatlook.model import FloatArray, IntArray, ShellResult, ShellState

_MAX_INCLUDES = 100


@dataclass(slots=True)
class _Deck:
    """What a deck and its includes hold."""

    node_ids: list[IntArray] = field(default_factory=list)
    nodes: list[FloatArray] = field(default_factory=list)
    shells: list[IntArray] = field(default_factory=list)  # id, part, four corners
    shell_thickness: list[FloatArray] = field(default_factory=list)  # nan: the section's
    sections: dict[int, float] = field(default_factory=dict)
    part_sections: dict[int, int] = field(default_factory=dict)
    titles: dict[int, str] = field(default_factory=dict)
    strains: list[Block] = field(default_factory=list)


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
    deck = _read(file)
    node_ids, positions = _nodes(file, deck, scale)
    table = _table(file, deck, node_ids)
    start = None if reference is None else _reference(Path(reference), node_ids, scale)
    chosen = select(table, parts, reference=start, positions=positions)
    shells = chosen.shells
    strains = surface_strains(deck.strains, shells.element_ids)
    if strains is None and shells.reference is None:
        raise InputError.single(
            "*INITIAL_STRAIN_SHELL", got="none for these shells", file=file,
            expected="strains on at least two levels of the thickness, or a reference deck",
        )  # fmt: skip
    t = _thickness(deck, chosen, scale) if thickness is None else np.full(len(shells), thickness)
    _check_thickness(file, t, shells.element_ids)
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
        shells=shells, times=np.zeros(1), read=[state].__getitem__, notes=_notes(strains)
    )


def _table(file: Path, deck: _Deck, node_ids: IntArray) -> ElementTable:
    table = _shells(file, deck)
    return ElementTable(
        file=file,
        corners=_indices(file, node_ids, table),
        element_ids=table[:, 0],
        part=table[:, 1],
        titles=deck.titles,
        usable=np.ones(len(table), dtype=bool),
    )


def _notes(strains: SurfaceStrains | None) -> tuple[str, ...]:
    if strains is None:
        return ("the deck has no strains: curvature is taken from the geometry",)
    if strains.absent:
        return (f"{strains.absent} shells have no strains in the deck and count as unstrained",)
    return ()


def _read(file: Path) -> _Deck:
    deck = _Deck()
    content = read_file(file)
    first = content.lstrip()[:1]
    if first not in (b"*", b"$"):
        raise InputError.single(
            "file", got="no keyword on the first line", expected="a keyword deck", file=file
        )
    for block in _with_includes(file, content, {file.resolve()}):
        _take(deck, block)
    return deck


def _with_includes(file: Path, content: bytes, opened: set[Path]) -> Iterator[Block]:
    for block in blocks(file, content):
        if block.name != "INCLUDE":
            yield block
            continue
        for card, line in zip(block.cards, block.lines, strict=True):
            name = card.decode("latin-1").strip()
            if not name:
                continue
            target = (file.parent / name).resolve()
            if target in opened or len(opened) > _MAX_INCLUDES:
                raise InputError.single(
                    "*INCLUDE", got=f"{name!r} again", expected="each file once",
                    file=file, line=line,
                )  # fmt: skip
            opened.add(target)
            try:
                inner = read_file(file.parent / name)
            except (InputError, ValueError) as error:
                raise InputError.single(
                    "*INCLUDE", got=repr(name), expected="a readable file", file=file, line=line
                ) from error
            yield from _with_includes(file.parent / name, inner, opened)


def _take(deck: _Deck, block: Block) -> None:
    """Keep what one keyword holds."""
    if block.name == "NODE":
        i = block.width or 8
        table = block.table([i, 16, 16, 16])
        deck.node_ids.append(table.ints(0)[:, 0])
        deck.nodes.append(table.floats(1, 2, 3))
    elif block.name.startswith("ELEMENT_SHELL"):
        _take_shells(deck, block)
    elif block.name == "PART" or block.name.startswith("PART_"):
        _take_parts(deck, block)
    elif block.name in ("SECTION_SHELL", "SECTION_SHELL_TITLE"):
        _take_sections(deck, block)
    elif block.name == "INITIAL_STRAIN_SHELL":
        deck.strains.append(block)


def _take_shells(deck: _Deck, block: Block) -> None:
    options = set(block.name.split("_")[2:])
    unknown = options - {"THICKNESS", "BETA", "MCID", "OFFSET"}
    if unknown:
        raise InputError.single(
            f"*{block.name}", got=f"option {', '.join(sorted(unknown))}", file=block.file,
            line=block.line, expected="THICKNESS, BETA, MCID or OFFSET",
        )  # fmt: skip
    thick = bool(options & {"THICKNESS", "BETA", "MCID"})
    step = 1 + thick + ("OFFSET" in options)
    i = block.width or 8
    table = block.table([i] * 10, slice(0, None, step))
    ids = table.ints(*range(10))
    far = np.flatnonzero(ids[:, 6:].any(axis=1))
    if len(far) and thick:
        raise table.problem(int(far[0]), "a shell with eight nodes", "three or four nodes")
    deck.shells.append(ids[:, :6])
    own = np.full(len(ids), np.nan)
    if thick:
        corner = block.table([16] * 4, slice(1, None, step)).floats(0, 1, 2, 3)
        triangle = (ids[: len(corner), 5] == 0) | (ids[: len(corner), 5] == ids[: len(corner), 4])
        corner[triangle, 3] = corner[triangle, :3].mean(axis=1)
        own[: len(corner)] = np.where((corner > 0).all(axis=1), corner.mean(axis=1), np.nan)
    deck.shell_thickness.append(own)


def _take_parts(deck: _Deck, block: Block) -> None:
    """Read pairs of title and card; options add cards, so of those the first pair only."""
    count = len(block.cards) // 2 if block.name == "PART" else min(1, len(block.cards) // 2)
    numbers = block.table([10, 10], slice(1, 2 * count, 2)).ints(0, 1)
    for (part, section), title in zip(numbers.tolist(), block.cards[0::2], strict=False):
        deck.part_sections[part] = section
        deck.titles[part] = title.decode("latin-1").strip()


def _take_sections(deck: _Deck, block: Block) -> None:
    titled = int(block.name.endswith("_TITLE"))
    at = 0
    while at + titled + 1 < len(block.cards):
        head = block.table([10] * 8, slice(at + titled, at + titled + 1))
        section, form, points, plies = head.ints(0, 1, 3, 6)[0].tolist()
        values = block.table([10] * 4, slice(at + titled + 1, at + titled + 2)).floats(0, 1, 2, 3)
        corner = values[0][values[0] > 0]
        if len(corner):
            deck.sections[section] = float(corner.mean())
        # A user's element adds cards of its own; what follows is not read.
        if form > 100:
            return
        at += titled + 2 + (-(-max(points, 0) // 8) if plies == 1 else 0)


def _shells(file: Path, deck: _Deck) -> IntArray:
    if not sum(map(len, deck.shells)):
        raise InputError.single("*ELEMENT_SHELL", got="none", expected="shells", file=file)
    table = np.concatenate(deck.shells)
    triangle = table[:, 5] == 0
    table[triangle, 5] = table[triangle, 4]
    _unique(file, "*ELEMENT_SHELL", table[:, 0])
    return table


def _nodes(file: Path, deck: _Deck, scale: float) -> tuple[IntArray, FloatArray]:
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


def _reference(file: Path, node_ids: IntArray, scale: float) -> FloatArray:
    """Read the same nodes before loading."""
    ids, positions = _nodes(file, _read(file), scale)
    at = np.minimum(np.searchsorted(ids, node_ids), len(ids) - 1)
    absent = node_ids[ids[at] != node_ids]
    if len(absent):
        raise InputError.single(
            "*NODE", got=f"{len(absent)} nodes missing, first {absent[0]}",
            expected="the nodes of the deformed deck", file=file,
        )  # fmt: skip
    return positions[at]


def _thickness(deck: _Deck, chosen: Selection, scale: float) -> FloatArray:
    """Thickness [m] of each shell: its own, else that of its part's section, else nan."""
    own = np.concatenate(deck.shell_thickness)[chosen.elements]
    of_part = {p: deck.sections.get(s, np.nan) for p, s in deck.part_sections.items()}
    section = np.array([of_part.get(p, np.nan) for p in chosen.shells.part.tolist()])
    return np.where(np.isfinite(own), own, section) * scale


def _check_thickness(file: Path, thickness: FloatArray, ids: Iterable[int]) -> None:
    bad = ~(np.isfinite(thickness) & (thickness > 0))
    if bad.any():
        first = int(np.asarray(ids)[bad][0])
        raise InputError.single(
            "thickness", got=f"none for {int(bad.sum())} shells, first {first}", file=file,
            expected="*SECTION_SHELL or *ELEMENT_SHELL_THICKNESS", hint="or say the thickness",
        )  # fmt: skip
