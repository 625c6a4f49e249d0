"""Names of panels, seams, zones, looks and lights as a reader says them, the name itself beside."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping

import numpy as np

from seatlook.model import Solution
from seatlook.wrinkle import Wrinkle

_NEAR = 0.08  # [m] from a seam up to which a wrinkle is beside it
_SIDE = re.compile(r"[_ -](LH|RH|L|R)$")
_ASIDE = 0.02  # [m] from the middle of the seat, beyond which a panel is to one side
_COUNTS = ("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine")


def panel_words(solution: Solution) -> dict[str, str]:
    """Panel -> how it is said; "left" and "right" only where name and place agree.

    +x is the occupant's left.
    """
    cover = solution.cover
    middle = solution.positions[cover.faces].mean(axis=1)
    result = {}
    for number, name in enumerate(cover.panel_names):
        x = float(np.mean(middle[cover.panel == number, 0])) if (cover.panel == number).any() else 0
        found = _SIDE.search(name)
        left = bool(found) and found[1][0] == "L" if found else False
        agrees = found and abs(x) > _ASIDE and (x > 0) == left
        plain = name[: found.start()] if found and agrees else name
        said = plain.lower().replace("_", " ") if plain.isupper() else plain
        result[name] = f"{'left' if left else 'right'} {said}" if agrees else said
    return result


def zone_words(zone: str, panels: Mapping[str, str]) -> str:
    """Where a zone is, such as "along the seam of insert and left bolster (INSERT-BOLSTER_L)"."""
    kind, _, name = zone.partition(" ")
    if kind == "seam":
        return f"along {seam_words(name, panels)}"
    panel = zone.removesuffix(" interior")
    return f"inside {_beside(panels[panel], panel)}" if panel in panels else f"in {zone}"


def seam_words(seam: str, panels: Mapping[str, str]) -> str:
    """A seam by the panels in its name, the name behind."""
    for name, said in panels.items():
        other = seam.removeprefix(f"{name}-")
        if other != seam and other in panels:
            return f"the seam of {said} and {panels[other]} ({seam})"
    return f"seam {seam}"


def wrinkle_words(wrinkle: Wrinkle, panels: Mapping[str, str]) -> str:
    """Where a wrinkle is: beside a seam, a hook or a frame if one is near, else in its panel."""
    if wrinkle.near_kind == "seam" and wrinkle.distance <= _NEAR:
        return f"beside {seam_words(wrinkle.near, panels)}"
    inside = _beside(panels[wrinkle.panel], wrinkle.panel)
    if wrinkle.near_kind and wrinkle.distance <= _NEAR:
        return f"in {inside}, beside {wrinkle.near_kind} {wrinkle.near}"
    return f"in {inside}"


def look_words(texture: str) -> str:
    """A look without the hyphens of its file."""
    return texture.replace("-", " ")


def light_words(rig: str) -> str:
    """A light of one word with its article."""
    return f"the {rig}" if rig.isalpha() else rig


def listed(words: Iterable[str]) -> str:
    """Words in a row, "and" before the last.

    Examples
    --------
    >>> listed(["a"]), listed(["a", "b", "c"])
    ('a', 'a, b and c')
    """
    *first, last = words
    return f"{', '.join(first)} and {last}" if first else last


def counted(count: int, noun: str) -> str:
    """A small count in words.

    Examples
    --------
    >>> counted(1, "wrinkle"), counted(3, "wrinkle"), counted(12, "wrinkle")
    ('one wrinkle', 'three wrinkles', '12 wrinkles')
    """
    word = _COUNTS[count] if count < len(_COUNTS) else str(count)
    return f"{word} {noun}{'' if count == 1 else 's'}"


def _beside(said: str, name: str) -> str:
    return said if said == name else f"{said} ({name})" if said != name.lower() else said
