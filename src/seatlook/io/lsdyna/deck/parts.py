"""``*PART`` and ``*SECTION_SHELL``: titles, sections and thickness of parts."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from seatlook.io.lsdyna.deck.cards import Block, refuse
from seatlook.io.lsdyna.deck.composite import ply_thickness
from seatlook.io.lsdyna.element_tables import text

# Options of *PART, and the cards that they add behind the first of a part.
_CARDS = {"INERTIA": 3, "REPOSITION": 1, "CONTACT": 1, "PRINT": 1, "ATTACHMENT": 1, "NODES": 0}


@dataclass(frozen=True, slots=True)
class Part:
    """A part; section 0 for none, thickness 0 where the section holds it."""

    number: int
    title: str
    section: int
    thickness: float = 0.0


def read_parts(block: Block) -> Iterator[Part]:
    """Return all parts of one keyword; nothing for one that defines no part of shells."""
    options = set(block.name.split("_")[1:])
    if options <= set(_CARDS):
        yield from _plain(block, options)
    elif "COMPOSITE" in options and options <= {"COMPOSITE", "LONG", "CONTACT"}:
        yield _composite(block, options)


def _plain(block: Block, options: set[str]) -> Iterator[Part]:
    """Read titles, first cards and the cards that options add."""
    more = sum(_CARDS[name] for name in options)
    at = 0
    while at + 1 < len(block.cards):
        number, section = block.table([10, 10], slice(at + 1, at + 2)).ints(0, 1)[0].tolist()
        if number < 1:
            raise refuse(block, f"part {number}", "a title, then a part's number", at + 1)
        yield Part(number, text(block.cards[at]), section)
        axes = 0
        if "INERTIA" in options and at + 2 < len(block.cards):
            # IRCS: a card of axes follows.
            axes = int(block.table([10] * 5, slice(at + 2, at + 3)).ints(4)[0, 0] == 1)
        at += 2 + more + axes
        while at < len(block.cards) and not any(card.strip() for card in block.cards[at : at + 2]):
            at += 1


def _composite(block: Block, options: set[str]) -> Part:
    """Read the one part of *PART_COMPOSITE, as thick as its plies together."""
    plies = 2 + ("CONTACT" in options)
    if len(block.cards) <= plies:
        raise refuse(block, "no plies", "a title, a part and its plies")
    number = int(block.table([10], slice(1, 2)).ints(0)[0, 0])
    columns = (1,) if "LONG" in options else (1, 5)
    total = sum(ply_thickness(block, card, columns) for card in range(plies, len(block.cards)))
    return Part(number, text(block.cards[0]), 0, total)


def read_sections(block: Block) -> Iterator[tuple[int, float]]:
    """Return number and thickness of every section, a mean over its corners."""
    titled = int(block.name.endswith("_TITLE"))
    at = 0
    while at + titled + 1 < len(block.cards):
        head = block.table([10] * 8, slice(at + titled, at + titled + 1))
        section, form, points, plies = head.ints(0, 1, 3, 6)[0].tolist()
        values = block.table([10] * 4, slice(at + titled + 1, at + titled + 2)).floats(0, 1, 2, 3)
        corner = values[0][values[0] > 0]
        if len(corner):
            yield section + block.place.other, float(corner.mean())
        # A user's element adds cards of its own; what follows is not read.
        if form > 100:
            return
        at += titled + 2 + (-(-max(points, 0) // 8) if plies == 1 else 0)
