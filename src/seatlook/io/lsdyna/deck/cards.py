"""Cards of a keyword deck: fixed width or free with commas, and LS-DYNA's way to write numbers."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from seatlook.errors import InputError
from seatlook.io.lsdyna.deck.placement import DECK, Placement
from seatlook.model import FloatArray, IntArray

LONG_WIDTH = 20
_PARAMETER = (
    "*PARAMETER does not define it; expressions are not read: "
    "write the number here, or let LS-DYNA write a dynain"
)
_SHORT_EXPONENT = re.compile(rb"(?<=[0-9.])[dD]?(?=[+-]\d+$)")

Bytes = npt.NDArray[np.bytes_]


@dataclass(frozen=True, slots=True)
class Block:
    """One keyword with its data cards.

    Parameters
    ----------
    name : in capitals, without the star
    width : of identity fields when the deck is not in standard format; 0 in standard format
    lines : (k,) int64      line of each card, from 1
    place : how *INCLUDE_TRANSFORM places the file that the block stands in
    parameters : name in capitals -> its value as text, for fields with ``&name``
    """

    file: Path
    name: str
    line: int
    width: int
    cards: list[bytes]
    lines: list[int]
    place: Placement = DECK
    parameters: Mapping[bytes, bytes] = field(default_factory=dict)

    def table(self, widths: Sequence[int], rows: slice = slice(None)) -> Table:
        """Read cards as columns of the given standard widths."""
        if self.width == LONG_WIDTH:
            widths = [LONG_WIDTH] * len(widths)
        cards = self.cards[rows]
        return Table(self, _fields(cards, widths), np.array(self.lines[rows], dtype=np.int64))


@dataclass(frozen=True, slots=True)
class Table:
    """Fields of some cards of one kind, (k, columns) as text."""

    block: Block
    fields: Bytes
    lines: IntArray

    def floats(self, *columns: int) -> FloatArray:
        """Return the columns as numbers (k, c); empty fields are 0."""
        return np.asarray(self._numbers(columns, np.float64))

    def ints(self, *columns: int) -> IntArray:
        """Return the columns as whole numbers (k, c); empty fields are 0."""
        return np.asarray(self._numbers(columns, np.int64))

    def _numbers(self, columns: tuple[int, ...], kind: Any) -> Any:
        text = np.char.strip(self.fields[:, list(columns)])
        text = np.where(text == b"", b"0", text)
        try:
            values = text.astype(kind)
        except (ValueError, OverflowError):
            values = self._one_by_one(text, kind)
        if kind is np.float64 and not np.isfinite(values).all():
            row = int(np.flatnonzero(~np.isfinite(values).all(axis=1))[0])
            raise self.problem(row, "nan or inf", "numbers")
        return values

    def _one_by_one(self, text: Bytes, kind: Any) -> Any:
        """Convert with LS-DYNA's short exponents, and name the line that cannot be converted."""
        values = np.zeros(text.shape, dtype=kind)
        for (row, column), word in np.ndenumerate(text):
            try:
                number = float(_SHORT_EXPONENT.sub(b"e", self._filled(word)))
                values[row, column] = number
            except (ValueError, OverflowError) as error:
                shown = word.decode("latin-1")
                hint = _PARAMETER if "&" in shown else ""
                raise self.problem(row, repr(shown), "a number", hint) from error
            if kind is np.int64 and number != int(number):
                raise self.problem(row, repr(word.decode("latin-1")), "a whole number")
        return values

    def _filled(self, word: bytes) -> bytes:
        """Put the value of a parameter in the place of its name, as in &thick or -&thick."""
        sign, mark, name = word.partition(b"&")
        value = self.block.parameters.get(name.strip().upper())
        if not mark or value is None or sign.strip() not in (b"", b"-"):
            return word
        if sign.strip() and value.startswith(b"-"):
            return value[1:]
        return sign.strip() + value

    def words(self, column: int) -> list[str]:
        """Return a column as text in capitals."""
        return [field.decode("latin-1").strip().upper() for field in self.fields[:, column]]

    def problem(self, row: int, got: str, expected: str, hint: str = "") -> InputError:
        """Make the error of card ``row``."""
        return InputError.single(
            f"*{self.block.name}", got=got, expected=expected, hint=hint,
            file=self.block.file, line=int(self.lines[row]),
        )  # fmt: skip


def refuse(block: Block, got: str, expected: str, card: int | None = None) -> InputError:
    """Make the error of a keyword, or of one of its cards."""
    line = block.line if card is None else block.lines[card]
    return InputError.single(
        f"*{block.name}", got=got, expected=expected, file=block.file, line=line
    )


def _fields(cards: Sequence[bytes], widths: Sequence[int]) -> Bytes:
    """Cut cards into fields; a card with a comma is free format."""
    if not cards:
        return np.zeros((0, len(widths)), dtype="S1")
    if any(b"," in card for card in cards):
        return np.array([_cut(card, widths) for card in cards])
    total = sum(widths)
    flat = np.array([card[:total].ljust(total) for card in cards], dtype=f"S{total}")
    letters = flat.view("S1").reshape(len(cards), total)
    ends = np.cumsum(widths)
    widest = max(widths)
    out = np.zeros((len(cards), len(widths)), dtype=f"S{widest}")
    for k, (end, width) in enumerate(zip(ends, widths, strict=True)):
        out[:, k] = np.ascontiguousarray(letters[:, end - width : end]).view(f"S{width}")[:, 0]
    return out


def _cut(card: bytes, widths: Sequence[int]) -> list[bytes]:
    if b"," in card:
        return [*card.split(b","), *[b""] * len(widths)][: len(widths)]
    ends = np.cumsum(widths)
    return [card[end - width : end] for end, width in zip(ends, widths, strict=True)]


def blocks(file: Path, content: bytes) -> Iterator[Block]:
    """Split a deck at its keywords; comments are dropped, *END stops."""
    if b"\0" in content:
        raise InputError.single(
            "file", got="binary data", expected="a keyword deck in text", file=file
        )
    deck_width = 0
    block: Block | None = None
    for number, raw in enumerate(content.splitlines(), 1):
        if raw.startswith(b"$"):
            continue
        if not raw.startswith(b"*"):
            if block is not None:
                block.cards.append(raw)
                block.lines.append(number)
            continue
        if block is not None:
            yield block
        name, width = _keyword(raw, deck_width)
        if name == "KEYWORD":
            deck_width = width
        if name == "END":
            return
        block = Block(file, name, number, width, [], [])
    if block is not None:
        yield block


def _keyword(raw: bytes, deck_width: int) -> tuple[str, int]:
    """Return the name and the width that its ending (+ long, - standard, % I10) or LONG=Y asks."""
    head, *options = raw[1:].decode("latin-1").upper().split() or [" "]
    switches = {"+": LONG_WIDTH, "-": 0, "%": 10}
    width = deck_width
    if head[-1] in switches:
        head, width = head[:-1], switches[head[-1]]
    for option in options:
        if option in switches:
            width = switches[option]
        if head == "KEYWORD":
            width = {"LONG=Y": LONG_WIDTH, "I10=Y": 10}.get(option, width)
    return head, width
