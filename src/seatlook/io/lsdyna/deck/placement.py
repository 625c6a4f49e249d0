"""Where the shells of an included file go: numbers, lengths and moves of *INCLUDE_TRANSFORM."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from seatlook.model import IntArray


@dataclass(frozen=True, slots=True)
class Move:
    """One *INCLUDE_TRANSFORM: its factor of length (FCTLEN), then its transformation (TRANID).

    Parameters
    ----------
    transformation : number of a *DEFINE_TRANSFORMATION, 0 for none
    file, line : where it stands
    """

    length: float
    transformation: int
    file: Path
    line: int


@dataclass(frozen=True, slots=True)
class Placement:
    """What all *INCLUDE_TRANSFORM around a file do to it.

    Parameters
    ----------
    node, element, part, sets, define, other : what is added to such numbers
    moves : from the file outward
    """

    node: int = 0
    element: int = 0
    part: int = 0
    sets: int = 0
    define: int = 0
    other: int = 0
    moves: tuple[Move, ...] = ()

    @property
    def length(self) -> float:
        """Factor of all lengths that are no places, such as thickness."""
        return float(np.prod([move.length for move in self.moves]))


DECK = Placement()


def shifted(numbers: IntArray, by: int) -> IntArray:
    """Add an offset to numbers; 0 stands for none and stays."""
    return np.where(numbers > 0, numbers + by, numbers)
