"""What was read of a pattern file, and what was not."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field

from seatlook.io.pattern.drawing.entities import Left
from seatlook.io.pattern.drawing.layers import UNREAD


@dataclass(frozen=True, slots=True, kw_only=True)
class PieceReport:
    """One piece.

    Parameters
    ----------
    name : of the panel
    block : name of its block in the file, empty in a file without blocks
    quantity : its text, as ``1,1``: as drawn, mirrored
    layers : layer -> number of lines, points and texts on it
    """

    name: str
    block: str
    quantity: str
    layers: Mapping[str, int]


@dataclass(slots=True)
class PatternReport:
    """What was read of a file.

    Parameters
    ----------
    mm_per_unit : float
    pieces : those read, in the order of the file
    left : how many entities of the pieces were not read, by kind, layer and reason
    notes : what was unusual, mended or guessed
    """

    mm_per_unit: float = 1.0
    pieces: list[PieceReport] = field(default_factory=list)
    left: Counter[Left] = field(default_factory=Counter)
    notes: list[str] = field(default_factory=list)

    def warnings(self) -> list[str]:
        """Return the notes, and what was left out though it may matter."""
        expected = set(UNREAD.values())
        return [
            *dict.fromkeys(self.notes),
            *(
                f"not read: {count} {left.kind} on layer {left.layer} ({left.reason})"
                for left, count in self.left.items()
                if left.reason not in expected
            ),
        ]

    def lines(self) -> list[str]:
        """Say what was read, piece by piece, and all that was not read, with the reason."""
        pieces = [f"{len(self.pieces)} pieces, a unit is {self.mm_per_unit:g} mm"]
        for piece in self.pieces:
            layers = ", ".join(f"{layer} ({count})" for layer, count in piece.layers.items())
            quantity = f", quantity {piece.quantity}" if piece.quantity else ""
            pieces.append(f"{piece.name}: layers with lines, points or texts {layers}{quantity}")
        return pieces + [
            f"not read: {count} {left.kind} on layer {left.layer} ({left.reason})"
            for left, count in sorted(self.left.items(), key=lambda item: str(item[0]))
        ]
