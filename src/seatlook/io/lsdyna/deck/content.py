"""What a keyword deck and its includes hold of shells, keyword by keyword."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from seatlook.errors import InputError
from seatlook.files import read_file
from seatlook.io.lsdyna.deck.cards import Block, refuse
from seatlook.io.lsdyna.deck.composite import composite_shells
from seatlook.io.lsdyna.deck.includes import deck_blocks
from seatlook.io.lsdyna.deck.parameters import parameters
from seatlook.io.lsdyna.deck.parts import read_parts, read_sections
from seatlook.io.lsdyna.deck.placement import shifted
from seatlook.io.lsdyna.deck.transformation import Transformations, read_transformations
from seatlook.model import FloatArray, IntArray

# Keywords that move or add shells, or give them a thickness, in a way that is not followed here.
_REFUSED = {
    "NODE_TRANSFORM": "no nodes that are moved",
    "NODE_THICKNESS": "no thickness at nodes",
    "PART_MOVE": "no parts that are moved",
    "PART_DUPLICATE": "no copies of parts",
    "PART_STACKED_ELEMENTS": "no stacked elements",
    "ELEMENT_GENERATE_SHELL": "shells one by one",
}
_UNITS = {"MM": "mm", "CM": "cm", "M": "m", "IN": "inch"}  # *CONTROL_UNITS -> ours


@dataclass(slots=True)
class Deck:
    """What a deck and its includes hold.

    Parameters
    ----------
    shells : per block (k, 6) int64          number, part, four corners
    shell_thickness : per block (k,)         nan where the section's counts
    sections, part_thickness : number -> thickness
    offsets : beginning of a hint where *INCLUDE_TRANSFORM changes the numbers of parts
    """

    transformations: Transformations
    node_ids: list[IntArray] = field(default_factory=list)
    nodes: list[FloatArray] = field(default_factory=list)
    shells: list[IntArray] = field(default_factory=list)
    shell_thickness: list[FloatArray] = field(default_factory=list)
    sections: dict[int, float] = field(default_factory=dict)
    part_sections: dict[int, int] = field(default_factory=dict)
    part_thickness: dict[int, float] = field(default_factory=dict)
    titles: dict[int, str] = field(default_factory=dict)
    strains: list[Block] = field(default_factory=list)
    sets: list[Block] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    offsets: str = ""

    def thickness_of_part(self, part: int) -> float:
        """Thickness by plies or section, nan without."""
        section = self.sections.get(self.part_sections.get(part, 0), np.nan)
        return self.part_thickness.get(part, section)


def read_deck(file: Path, *, length_unit: str) -> Deck:
    """Read a deck with all its includes.

    Raises
    ------
    InputError
        No deck; a keyword that would change shells and is not followed; a unit of *CONTROL_UNITS
        other than ``length_unit``.
    """
    content = read_file(file)
    first = content.lstrip()[:1]
    if first not in (b"*", b"$"):
        raise InputError.single(
            "file", got="no keyword on the first line", expected="a keyword deck", file=file
        )
    found = list(deck_blocks(file, content))
    named = parameters(found)
    if named:
        found = [replace(block, parameters=named) for block in found]
    deck = Deck(read_transformations(found))
    for block in found:
        if block.name == "CONTROL_UNITS" and not block.place.moves:
            _check_unit(block, length_unit)
        _take(deck, block)
    if any(block.place.part for block in found):
        deck.offsets = "IDPOFF of *INCLUDE_TRANSFORM changes the numbers of parts; "
    deck.notes += deck.transformations.notes({block.place for block in found})
    return deck


def _check_unit(block: Block, length_unit: str) -> None:
    name = next(iter(block.table([10], slice(0, 1)).words(0)), "")
    if name and _UNITS.get(name) != length_unit:
        raise InputError.single(
            "*CONTROL_UNITS", got=f"LENGTH {name}", expected=f"{length_unit}, as it is to be read",
            file=block.file, line=block.line, hint="say the unit of length",
        )  # fmt: skip


def _take(deck: Deck, block: Block) -> None:
    """Keep what one keyword holds."""
    name = block.name
    if name in _REFUSED:
        raise refuse(block, "a keyword that is not followed", _REFUSED[name])
    if name == "NODE":
        _take_nodes(deck, block)
    elif name.startswith("ELEMENT_SHELL"):
        _take_shells(deck, block)
    elif name == "PART" or name.startswith("PART_"):
        _take_parts(deck, block)
    elif name in ("SECTION_SHELL", "SECTION_SHELL_TITLE"):
        for section, thickness in read_sections(block):
            deck.sections[section] = thickness * block.place.length
    elif name in ("INITIAL_STRAIN_SHELL", "INITIAL_STRAIN_SHELL_SET"):
        deck.strains.append(block)
    elif name.startswith("INITIAL_STRAIN_SHELL"):
        raise refuse(block, "a kind of strains that is not read", "*INITIAL_STRAIN_SHELL or _SET")
    elif name.startswith("SET_SHELL"):
        deck.sets.append(block)


def _take_nodes(deck: Deck, block: Block) -> None:
    i = block.width or 8
    table = block.table([i, 16, 16, 16])
    deck.node_ids.append(shifted(table.ints(0)[:, 0], block.place.node))
    points = table.floats(1, 2, 3)
    if block.place.moves:
        points = deck.transformations.frame(block.place).moved(points)
    deck.nodes.append(points)


def _take_parts(deck: Deck, block: Block) -> None:
    place = block.place
    for part in read_parts(block):
        number = part.number + place.part
        deck.titles[number] = part.title
        if part.section:
            deck.part_sections[number] = part.section + place.other
        if part.thickness > 0:
            deck.part_thickness[number] = part.thickness * place.length


def _take_shells(deck: Deck, block: Block) -> None:
    options = set(block.name.split("_")[2:])
    unknown = options - {"THICKNESS", "BETA", "MCID", "OFFSET"}
    if unknown <= {"COMPOSITE", "LONG"} and options == unknown and "COMPOSITE" in options:
        ids, own = composite_shells(block, long="LONG" in options)
    elif unknown:
        raise refuse(
            block, f"option {', '.join(sorted(unknown))}",
            "THICKNESS, BETA, MCID, OFFSET or COMPOSITE",
        )  # fmt: skip
    else:
        ids, own = _plain_shells(block, options)
    place = block.place
    deck.shells.append(
        np.column_stack([
            shifted(ids[:, 0], place.element), shifted(ids[:, 1], place.part),
            shifted(ids[:, 2:6], place.node),
        ])
    )  # fmt: skip
    deck.shell_thickness.append(own * place.length)


def _plain_shells(block: Block, options: set[str]) -> tuple[IntArray, FloatArray]:
    """Return numbers (k, 10) and thickness (k,) of shells with a card, or two or three, each."""
    thick = bool(options & {"THICKNESS", "BETA", "MCID"})
    step = 1 + thick + ("OFFSET" in options)
    i = block.width or 8
    table = block.table([i] * 10, slice(0, None, step))
    ids = table.ints(*range(10))
    far = np.flatnonzero(ids[:, 6:].any(axis=1))
    if len(far) and thick:
        raise table.problem(int(far[0]), "a shell with eight nodes", "three or four nodes")
    own = np.full(len(ids), np.nan)
    if thick:
        corner = block.table([16] * 4, slice(1, None, step)).floats(0, 1, 2, 3)
        triangle = (ids[: len(corner), 5] == 0) | (ids[: len(corner), 5] == ids[: len(corner), 4])
        corner[triangle, 3] = corner[triangle, :3].mean(axis=1)
        own[: len(corner)] = np.where((corner > 0).all(axis=1), corner.mean(axis=1), np.nan)
    return ids, own
