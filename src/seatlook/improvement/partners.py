"""Both sides of a seam move together: what else must change so that sewn lengths still agree."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from seatlook import mesh
from seatlook.improvement.candidate import Candidate, outline_way
from seatlook.improvement.cutting.outline import Outline
from seatlook.model import FloatArray, IntArray, Pattern

# How much rather a partner changes than the panel that is corrected: else it would be undone.
_RATHER = 4.0
_SEWABLE = 1e-3  # of a correction, by which lengths that cannot be kept may miss each other
_ROUNDS, _SLOW = 8, 0.9  # of Newton's method; what a round leaves of a difference, at most
_SINGULAR = 0.01  # of the largest singular value: what hardly changes a length is left alone
_CUT = ("offset", "length")
_Amounts = Mapping[Candidate, float]


@dataclass(frozen=True, slots=True)
class _Line:
    """A sewn edge: where it lies in its panel's outline, and which side of which seam it is."""

    panel: int
    rows: IntArray
    points: FloatArray
    seam: int
    sign: float

    def longer(self, way: FloatArray) -> float:
        """How much longer it gets, to first order, when the outline moves by ``way`` (r, 2)."""
        along = np.diff(self.points, axis=0)
        along /= np.maximum(np.linalg.norm(along, axis=1), 1e-12)[:, None]
        return float((along * np.diff(way[self.rows], axis=0)).sum())


class Partners:
    """Lengths of the two sides of every seam, and how they change with the outlines.

    Parameters
    ----------
    pattern : as it was drawn
    outlines : as they were drawn, one for each panel

    Attributes
    ----------
    drawn : (s,) float64 [m]    near side minus far side of every seam
    """

    def __init__(self, pattern: Pattern, outlines: Sequence[Outline]) -> None:
        self._outlines = outlines
        self._lines = _lines(pattern)
        self._count = len(pattern.seams)
        self.drawn = self._measured({})
        self._lengths = tuple(
            Candidate(kind="length", name=side.edge, panel=outline.panel, side=number)
            for outline in outlines
            for number, side in enumerate(outline.sides)
            if side.edge in self._lines
        )
        self._slopes: dict[Candidate, FloatArray] = {}
        self._ways: dict[Candidate, FloatArray] = {}

    def slope(self, candidate: Candidate) -> FloatArray:
        """By how much the differences (s,) change for an amount of 1 [1]."""
        if candidate not in self._slopes:
            slope, way = np.zeros(self._count), self._way(candidate)
            for line in self._lines.values():
                if line.panel == candidate.panel:
                    slope[line.seam] += line.sign * line.longer(way)
            self._slopes[candidate] = slope
        return self._slopes[candidate]

    def followers(
        self, candidate: Candidate, frozen: frozenset[str] = frozenset()
    ) -> dict[Candidate, float] | None:
        """Lengths that must change with a candidate, for an amount of 1; None if some cannot.

        An offset leaves all differences as they are, a length changes the one of its own seam: that
        is its ease. Partners change rather than the panel that is corrected.

        Parameters
        ----------
        frozen : names of edges that stay
        """
        if candidate.kind not in _CUT:
            return {}
        wrong, ease = -self.slope(candidate), self._lines.get(candidate.name)
        if candidate.kind == "length" and ease is not None:
            wrong[ease.seam] += ease.sign
        if np.abs(wrong).max(initial=0.0) < _SEWABLE:
            return {}
        free = [c for c in self._lengths if not self._touches(c, frozen) and c != candidate]
        matrix = np.stack([self.slope(c) for c in free], axis=1)
        easy = np.array([1.0 if c.panel == candidate.panel else _RATHER for c in free])
        amounts = easy * (np.linalg.pinv(matrix * easy, rcond=_SINGULAR) @ wrong)
        if np.abs(matrix @ amounts - wrong).max() > _SEWABLE:
            return None
        pairs = zip(free, amounts, strict=True)
        return {c: float(v) for c, v in pairs if abs(v) > _SEWABLE}

    def seam_of(self, candidate: Candidate) -> int | None:
        """Number of the seam whose ease a length is; None for all else."""
        line = self._lines.get(candidate.name)
        return line.seam if candidate.kind == "length" and line is not None else None

    def closing(self, candidate: Candidate, made: _Amounts) -> float:
        """Amount [m] of a length that makes both sides of its seam equal; 0 for all else."""
        line = self._lines.get(candidate.name)
        if candidate.kind != "length" or line is None:
            return 0.0
        return float(-line.sign * self.differences(made)[line.seam])

    def exact(self, amounts: _Amounts) -> dict[Candidate, float]:
        """Add what makes differences what amounts mean to first order, where they miss it.

        Only what moves anyway is moved for it.
        """
        cut = {c: v for c, v in amounts.items() if c.kind in _CUT and v != 0.0}
        asked, ways = self.differences(cut), self._moved(cut)
        free = [c for c in self._lengths if c.panel in ways and self._within(c, ways[c.panel])]
        if not free:
            return dict(amounts)
        inverse = np.linalg.pinv(np.stack([self.slope(c) for c in free], axis=1), rcond=_SINGULAR)
        away = asked - self._measured(ways)
        for _ in range(_ROUNDS):
            tried = dict(cut)
            for candidate, amount in zip(free, inverse @ away, strict=True):
                tried[candidate] = tried.get(candidate, 0.0) + float(amount)
            left = asked - self._measured(self._moved(tried))
            if np.abs(left).max() > _SLOW * np.abs(away).max():
                break
            cut, away = tried, left
        return {c: v for c, v in amounts.items() if c.kind not in _CUT} | cut

    def differences(self, amounts: _Amounts) -> FloatArray:
        """Near side minus far side of every seam, (s,) [m], to first order."""
        total = self.drawn.copy()
        for candidate, amount in amounts.items():
            if candidate.kind in _CUT:
                total += amount * self.slope(candidate)
        return total

    def _way(self, candidate: Candidate) -> FloatArray:
        if candidate not in self._ways:
            self._ways[candidate] = outline_way(self._outlines[candidate.panel], candidate)
        return self._ways[candidate]

    def _moved(self, cut: _Amounts) -> dict[int, FloatArray]:
        """How the outline of every panel that changes moves, (r, 2) [m]."""
        ways: dict[int, FloatArray] = {}
        for candidate, amount in cut.items():
            way = amount * self._way(candidate)
            ways[candidate.panel] = ways.get(candidate.panel, 0.0) + way
        return ways

    def _within(self, candidate: Candidate, way: FloatArray) -> bool:
        """Whether a length moves nothing but what moves anyway."""
        return not self._way(candidate)[~way.any(axis=1)].any()

    def _touches(self, candidate: Candidate, frozen: frozenset[str]) -> bool:
        """Whether a length moves an edge that stays, if only its corner."""
        sides = self._outlines[candidate.panel].sides
        stay = [side.at for side in sides if side.edge in frozen]
        return any(self._way(candidate)[at].any() for at in stay)

    def _measured(self, ways: Mapping[int, FloatArray]) -> FloatArray:
        found = np.zeros(self._count)
        for line in self._lines.values():
            points = line.points
            if line.panel in ways:
                points = points + ways[line.panel][line.rows]
            found[line.seam] += line.sign * mesh.length(points)
        return found


def _lines(pattern: Pattern) -> dict[str, _Line]:
    """Every sewn edge by its name."""
    panels = {panel.name: number for number, panel in enumerate(pattern.panels)}
    lines = {}
    for number, seam in enumerate(pattern.seams):
        for name, sign in ((seam.a, 1.0), *((b, -1.0) for b in seam.b)):
            edge = pattern.edges[name]
            index, points = panels[edge.panel], pattern.edge_points(name)
            rows = (edge.start + np.arange(len(points))) % len(pattern.panels[index].outline)
            lines[name] = _Line(index, rows, points, number, sign)
    return lines
