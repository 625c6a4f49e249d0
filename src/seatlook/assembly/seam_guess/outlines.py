"""Panels as the guess sees them: atoms between stops, their angles, notches and bends.

An *atom* is the stretch of an outline from one stop to the next; atom and stop share their number,
so atom ``k`` starts at stop ``k`` and ends at ``ahead[k]``. A *side* is one or several atoms of a
panel in a row: what is sewn.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from seatlook.mesh import arc_length, nearest_place
from seatlook.model import FloatArray, IntArray, Panel

SHORTEST = 0.015  # m; corners nearer than that to each other are one corner, cut or rounded off
LONGEST_SIDE = 4  # atoms in a row
BEND_SAMPLES = 16
WEAK = np.radians(50.0)  # turn of a corner that may lie inside a sewn edge
_ARM = 0.012  # m on both sides of a corner over which its angle is measured
_SHORT_ARM = 0.004  # m, and that of a corner among others
_STANDS_OUT = np.radians(15.0)  # by which it turns more than those
_LONG_ARM = 0.05  # m, over which a step in the outline is none
_SHARP, _STRAIGHT = np.radians(30.0), np.radians(22.0)
_AT_END = 0.002  # m; a notch that near an end of an edge marks the end
_WIDEST_ALLOWANCE = 0.025  # m; notches are drawn on the cut line as often as on the sew line


@dataclass(frozen=True, slots=True)
class Side:
    """Atoms of one panel in a row.

    Parameters
    ----------
    first, atoms : stop where it starts, and all its atoms in order
    end : stop where it ends
    length : float [m]
    notches : (k,) arc lengths [m], without those at its ends
    bend : (BEND_SAMPLES,) [rad]   turn of the tangent from the start, counter-clockwise
    chord : angle [rad] of the line from start to end
    turns : (len(atoms) - 1,) [rad]  turn of the outline at the stops inside
    """

    first: int
    atoms: tuple[int, ...]
    end: int
    panel: int
    length: float
    notches: FloatArray
    bend: FloatArray
    chord: float
    turns: FloatArray


class Outlines:
    """All panels of a pattern, cut at their stops.

    Attributes
    ----------
    stops : per panel, indices into its outline
    base : per panel, the number of its first stop
    panel_of, ahead : per stop, its panel and the next stop
    angle : (n,) [rad]   inside angle of the panel at each stop
    lengths : (n,) [m]   of the atoms
    """

    def __init__(self, panels: Sequence[Panel]) -> None:
        self.panels = tuple(panels)
        self.stops = [find_stops(panel) for panel in panels]
        counts = [len(s) for s in self.stops]
        self.base = [0, *itertools.accumulate(counts)][:-1]
        self.panel_of = [p for p, n in enumerate(counts) for _ in range(n)]
        self.ahead = [
            b + (k + 1) % n for b, n in zip(self.base, counts, strict=True) for k in range(n)
        ]
        self._arcs = [arc_length(np.vstack([p.outline, p.outline[:1]])) for p in panels]
        self._notches = [_notch_places(p) for p in panels]
        self.sides = [side for p in range(len(panels)) for side in self._sides(p)]
        atoms = [s for s in self.sides if len(s.atoms) == 1]
        self.atoms = sorted(atoms, key=lambda s: s.first)
        self.lengths = np.array([s.length for s in self.atoms])

    def __len__(self) -> int:
        return len(self.panel_of)

    @cached_property
    def angle(self) -> FloatArray:
        """Inside angle [rad] at each stop."""
        turns = [self._turn(p, k) for p, s in enumerate(self.stops) for k in range(len(s))]
        return np.pi - np.array(turns)

    def name(self, stop: int) -> str:
        """Name of the panel of a stop."""
        return self.panels[self.panel_of[stop]].name

    def whole(self, panel: int) -> tuple[int, ...]:
        """Return the stops of a panel in order."""
        first = self.base[panel]
        return tuple(range(first, first + len(self.stops[panel])))

    def place(self, stop: int) -> int:
        """Index of a stop in its panel's outline."""
        panel = self.panel_of[stop]
        return int(self.stops[panel][stop - self.base[panel]])

    def side(self, atoms: tuple[int, ...]) -> Side:
        """Return the side made of atoms of one panel in a row."""
        panel = self.panel_of[atoms[0]]
        return self._side(panel, atoms[0] - self.base[panel], atoms)

    def _sides(self, panel: int) -> list[Side]:
        """Every atom, and every row of atoms that only weak corners part."""
        stops, base = self.stops[panel], self.base[panel]
        n = len(stops)
        sides = []
        for k in range(n):
            for count in range(1, min(LONGEST_SIDE, max(n - 1, 1)) + 1):
                if count > 1 and abs(self._turn(panel, (k + count - 1) % n)) > WEAK:
                    break
                atoms = tuple(base + (k + i) % n for i in range(count))
                sides.append(self._side(panel, k, atoms))
        return sides

    def _side(self, panel: int, k: int, atoms: tuple[int, ...]) -> Side:
        stops, arc = self.stops[panel], self._arcs[panel]
        n, whole = len(stops), float(arc[-1])
        start, last = arc[stops[k]], arc[stops[(k + len(atoms)) % n]]
        length = float((last - start) % whole) or whole
        at = np.sort((self._notches[panel] - start) % whole)
        inner = at[(at > _AT_END) & (at < length - _AT_END)]
        closed = np.vstack([self.panels[panel].outline, self.panels[panel].outline[:1]])
        line = points_at(closed, arc, start + length * np.linspace(0, 1, BEND_SAMPLES + 1))
        step = np.diff(line, axis=0)
        heading = np.unwrap(np.arctan2(step[:, 1], step[:, 0]))
        chord = line[-1] - line[0]
        return Side(
            first=atoms[0], atoms=atoms, end=self.ahead[atoms[-1]], panel=panel,
            length=length, notches=inner, bend=heading - heading[0],
            chord=float(np.arctan2(chord[1], chord[0])),
            turns=np.array([self._turn(panel, (k + i) % n) for i in range(1, len(atoms))]),
        )  # fmt: skip

    def _turn(self, panel: int, k: int) -> float:
        """Turn [rad] of the outline at a stop, over an arm to both sides, left is positive."""
        stops, arc = self.stops[panel], self._arcs[panel]
        at = float(arc[stops[k]])
        n = len(stops)
        room = min(
            (arc[stops[(k + 1) % n]] - at) % arc[-1] or arc[-1],
            (at - arc[stops[k - 1]]) % arc[-1] or arc[-1],
        )
        arm = min(_ARM, 0.4 * float(room))
        return turn_at(self.panels[panel], arc, at, arm)


def points_at(closed: FloatArray, arc: FloatArray, at: FloatArray) -> FloatArray:
    """Points (k, 2) of a closed outline, its first point repeated, at arc lengths round it."""
    s = np.mod(at, arc[-1])
    return np.column_stack([np.interp(s, arc, column) for column in closed.T])


def find_stops(panel: Panel) -> IntArray:
    """Corners of a panel; those nearer to each other than a cut is wide are one.

    Of a corner that is cut off or rounded in facets the middle of its corners stays, so that the
    edges on both sides share what was cut.
    """
    corners = np.unique(panel.corners)
    if len(corners) < 2:
        return corners if len(corners) else np.zeros(1, dtype=np.int64)
    arc = arc_length(np.vstack([panel.outline, panel.outline[:1]]))
    gaps = np.diff(arc[corners], append=arc[corners[0]] + arc[-1])
    if (gaps < SHORTEST).all():
        return corners[:1]
    # Start behind a long gap, so that no group runs over the outline's first point.
    order = np.roll(np.arange(len(corners)), -(int(np.flatnonzero(gaps >= SHORTEST)[-1]) + 1))
    groups: list[list[int]] = [[]]
    for k in order:
        groups[-1].append(int(corners[k]))
        if gaps[k] >= SHORTEST:
            groups.append([])
    groups = [group for group in groups if group]
    lasting = [group for group in groups if not _is_jog(panel, arc, group)]
    kept = lasting if len(lasting) > 1 else groups
    return np.array(sorted(_middle(panel, arc, group) for group in kept), dtype=np.int64)


def _middle(panel: Panel, arc: FloatArray, group: Sequence[int]) -> int:
    """The corner of a group that stands out, as in a mirrored panel too, or the one amid them."""
    turns = [abs(turn_at(panel, arc, float(arc[corner]), _SHORT_ARM)) for corner in group]
    order = np.argsort(turns)
    alone = len(group) > 1 and turns[order[-1]] - turns[order[-2]] > _STANDS_OUT
    return group[int(order[-1])] if alone else group[len(group) // 2]


def _is_jog(panel: Panel, arc: FloatArray, group: Sequence[int]) -> bool:
    """Whether the outline turns sharply there but runs on as before: a step, not a corner."""
    at = float(arc[group[len(group) // 2]])
    sharp = len(group) > 1 or abs(turn_at(panel, arc, at, _ARM)) > _SHARP
    arm = min(_LONG_ARM, 0.12 * float(arc[-1]))
    return bool(sharp and abs(turn_at(panel, arc, at, arm)) < _STRAIGHT)


def turn_at(panel: Panel, arc: FloatArray, at: float, arm: float) -> float:
    """Turn [rad] of an outline at an arc length, over an arm [m] to both sides, left positive."""
    closed = np.vstack([panel.outline, panel.outline[:1]])
    before, here, after = points_at(closed, arc, np.array([at - arm, at, at + arm]))
    u, v = here - before, after - here
    return float(np.arctan2(u[0] * v[1] - u[1] * v[0], u @ v))


def _notch_places(panel: Panel) -> FloatArray:
    """Arc lengths [m] of a panel's notches along its outline, from its first point."""
    closed = np.vstack([panel.outline, panel.outline[:1]])
    places = [nearest_place(closed, notch.position) for notch in panel.notches]
    return np.array([at for distance, at in places if distance < _WIDEST_ALLOWANCE])
