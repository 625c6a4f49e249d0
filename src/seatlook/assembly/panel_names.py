"""What names of panels tell: the side of the seat, and whether two are variants of one piece."""

from __future__ import annotations

import re
from typing import Literal

_LEFT = {"l", "lh", "left", "links", "li", "gauche"}
_RIGHT = {"r", "rh", "right", "rechts", "re", "droite"}
# Words that tell where a piece goes; pieces told apart by other words are variants.
_PLACES = _LEFT | _RIGHT | {
    "f", "b", "front", "back", "rear", "top", "bottom", "upper", "lower", "up", "down", "inner",
    "outer", "inside", "outside", "side", "center", "centre", "middle", "mid", "head", "seat",
    "under", "over", "vorne", "hinten", "oben", "unten", "mirrored", "skirt", "sleeve", "ftorso",
    "btorso", "torso", "cuff", "hood", "collar", "pant", "wb", "fr", "bk", "ft", "cf", "cb",
}  # fmt: skip
_SPLIT = re.compile(r"[A-Za-z]+|\d+|[^\W\d_]+")
Hand = Literal["left", "right", ""]


def words(name: str) -> list[str]:
    """Words and numbers of a name, in small letters.

    Examples
    --------
    >>> words("BOLSTER_L2 (LH)")
    ['bolster', 'l', '2', 'lh']
    >>> words("Lfront")
    ['l', 'front']
    """
    parts = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", name)
    found: list[str] = []
    for word in (w.lower() for w in _SPLIT.findall(parts)):
        found += [word[0], word[1:]] if word[0] in "lr" and word[1:] in _PLACES else [word]
    return found


def hand(name: str) -> Hand:
    """Side of the seat that a name tells."""
    given = set(words(name))
    left, right = bool(given & _LEFT), bool(given & _RIGHT)
    if left == right:
        return ""
    return "left" if left else "right"


def named_variants(one: str, other: str) -> bool:
    """Whether two names differ only by a mark that tells no place.

    Examples
    --------
    >>> named_variants("INSERT", "INSERT_perforated"), named_variants("SIDE_L", "SIDE_R")
    (True, False)
    """
    a, b = words(one), words(other)
    shared = set(a) & set(b)
    apart = (set(a) | set(b)) - shared
    return bool(shared) and not apart & _PLACES
