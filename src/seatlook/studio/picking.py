"""Sewn by four picks: start and end on one line, start and direction on the other.

The end on the other line is the corner that is as far from its start as the first line is long.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from seatlook.errors import InputError
from seatlook.mesh import arc_length, nearest_place
from seatlook.model import FloatArray, Panel, Pattern
from seatlook.studio.pattern_state import Values, millimetres, steps_of

_ALIKE = 0.03  # share of the length within which corners are told apart by how sharp they are
_RIVAL = 0.10  # beyond this a seams file is refused
_LOUD = 0.03  # ease from which it is worth a word


@dataclass(frozen=True, slots=True)
class Stretch:
    """A part of a panel's outline.

    Parameters
    ----------
    start, end : corners of the outline, as they were picked
    forward : whether it runs as the outline does, counter-clockwise
    """

    panel: Panel
    start: int
    end: int
    forward: bool

    @property
    def along(self) -> tuple[int, int]:
        """Both ends in the order of the outline."""
        return (self.start, self.end) if self.forward else (self.end, self.start)

    @property
    def vertices(self) -> list[int]:
        """Vertices of the outline, from the start to the end."""
        first, last = self.along
        n = len(self.panel.outline)
        run = [(first + k) % n for k in range((last - first) % n + 1 or n + 1)]
        return run if self.forward else run[::-1]

    @property
    def points(self) -> FloatArray:
        """Places (k, 2) [m]."""
        return self.panel.outline[self.vertices]

    @property
    def length(self) -> float:
        """Length [m]."""
        return float(arc_length(self.points)[-1])

    def values(self) -> Values:
        """The side as an edit takes it."""
        places = millimetres(self.points)
        return {
            "panel": self.panel.name,
            "from_mm": places[0],
            "to_mm": places[-1],
            "via_mm": places[len(places) // 2],
            "points_mm": [places],
        }


def partner(pattern: Pattern, first: Mapping[str, Any], second: Mapping[str, Any]) -> Values:
    """Find the partner of a line.

    Parameters
    ----------
    first : panel, ``start`` and ``end`` [mm], each near a corner
    second : panel, ``start`` near a corner, and a place ``toward`` which the line runs

    Raises
    ------
    InputError
        No such panel, or no places.
    """
    near = _between(pattern, first)
    far = _candidates(pattern, second, near.length)
    best = far[0]
    ease = near.length / best.length - 1.0
    reverse = near.forward != best.forward
    return {
        "first": near.values(),
        "second": best.values(),
        "reverse": reverse,
        "lengths_mm": [round(1e3 * one.length, 3) for one in (near, best)],
        "ease_percent": round(100 * ease, 3),
        "rivals": [
            {
                **one.values(),
                "length_mm": round(1e3 * one.length, 3),
                "ease_percent": round(100 * (near.length / one.length - 1.0), 3),
            }
            for one in far[1:4]
        ],
        "warnings": _warnings(pattern, near, best, ease, reverse=reverse),
    }


def stretch_between(panel: Panel, ends: Sequence[int], via: FloatArray | None = None) -> Stretch:
    """The way round a panel between two corners: past a place (2,) [m], else the shorter one."""
    ways = [Stretch(panel, ends[0], ends[1], forward) for forward in (True, False)]
    if via is not None:
        return min(ways, key=lambda way: nearest_place(way.points, via)[0])
    return min(ways, key=lambda way: way.length)


def panel_of(pattern: Pattern, name: object) -> Panel:
    """The panel of this name.

    Raises
    ------
    InputError
        There is none.
    """
    for panel in pattern.panels:
        if panel.name == name:
            return panel
    expected = f"one of {', '.join(panel.name for panel in pattern.panels)}"
    raise InputError.single("panel", got=repr(name), expected=expected)


def place_of(values: Mapping[str, Any], key: str) -> FloatArray:
    """A place (2,) [m] that was given in mm.

    Raises
    ------
    InputError
        It is none.
    """
    try:
        place = np.array(values.get(key), dtype=np.float64).reshape(2) / 1e3
    except (TypeError, ValueError):
        place = np.full(2, np.nan)
    if not np.isfinite(place).all():
        raise InputError.single(key, got=repr(values.get(key)), expected="a place [x, y] in mm")
    return place


def nearest_corner(panel: Panel, place: FloatArray) -> tuple[int, float]:
    """The corner of a panel next to a place (2,) [m], and how far away it is."""
    if not len(panel.corners):
        raise InputError.single("panel", got=f"{panel.name} without corners", expected="corners")
    away = np.hypot(*(panel.outline[panel.corners] - place).T)
    return int(panel.corners[away.argmin()]), float(away.min())


def _between(pattern: Pattern, picks: Mapping[str, Any]) -> Stretch:
    panel = panel_of(pattern, picks.get("panel"))
    ends = [nearest_corner(panel, place_of(picks, key))[0] for key in ("start", "end")]
    if ends[0] == ends[1]:
        raise InputError.single(
            "first.end", got="the corner that it starts at", expected="another corner"
        )
    via = place_of(picks, "via") if "via" in picks else None
    return stretch_between(panel, ends, via)


def _candidates(pattern: Pattern, picks: Mapping[str, Any], length: float) -> list[Stretch]:
    """Ways from a corner in one direction to others, the likeliest first."""
    panel = panel_of(pattern, picks.get("panel"))
    start, _ = nearest_corner(panel, place_of(picks, "start"))
    forward = _heads_forward(panel, start, place_of(picks, "toward"))
    ways = [Stretch(panel, start, int(end), forward) for end in panel.corners if int(end) != start]
    if not ways:
        raise InputError.single("second", got=f"{panel.name} of one corner", expected="two")

    def misfit(way: Stretch) -> float:
        return abs(way.length / length - 1.0)

    ways.sort(key=misfit)
    alike = [way for way in ways if misfit(way) <= _ALIKE]
    alike.sort(key=lambda way: (_sewn(pattern, way), misfit(way) - 0.01 * _turn(way)))
    rest = [way for way in ways if way not in alike]
    return alike + [
        way for k, way in enumerate(rest) if misfit(way) <= _RIVAL or not alike + rest[:k]
    ]


def _heads_forward(panel: Panel, start: int, toward: FloatArray) -> bool:
    """Whether a place lies ahead of a corner, not behind it, by the shorter way round."""
    ring = np.vstack([panel.outline, panel.outline[:1]])
    way = arc_length(ring)
    _, at = nearest_place(ring, toward)
    return bool((at - way[start]) % way[-1] <= 0.5 * way[-1])


def _turn(way: Stretch) -> float:
    """How far [rad] the outline turns at the end of a way."""
    outline, n = way.panel.outline, len(way.panel.outline)
    behind = outline[way.end] - outline[way.end - 1]
    ahead = outline[(way.end + 1) % n] - outline[way.end]
    cross = behind[0] * ahead[1] - behind[1] * ahead[0]
    return float(abs(np.arctan2(cross, behind @ ahead)))


def _sewn(pattern: Pattern, way: Stretch) -> bool:
    return bool(_seams_on(pattern, way))


def _seams_on(pattern: Pattern, way: Stretch) -> list[str]:
    """Seams that hold a part of a stretch already."""
    run = way.vertices if way.forward else way.vertices[::-1]
    steps = {(way.panel.name, k) for k in run[:-1]}
    return [
        seam.name
        for seam in pattern.seams
        if any(steps & {*steps_of(pattern, name)} for name in (seam.a, *seam.b))
    ]


def _warnings(
    pattern: Pattern, near: Stretch, far: Stretch, ease: float, *, reverse: bool
) -> list[str]:
    said = [
        f"{way.panel.name}: a part of this line is sewn in {name!r}"
        for way in (near, far)
        for name in _seams_on(pattern, way)
    ]
    if abs(ease) > _RIVAL:
        said.append(f"the lengths differ by {100 * abs(ease):.0f} %, at most 10 % can be sewn")
    elif abs(ease) > _LOUD:
        said.append(f"the lengths differ by {100 * abs(ease):.1f} %")
    if not reverse:
        said.append("both lines run the same way round, which turns one panel over")
    return said
