"""A first guess at which edges of a pattern are sewn together, from lengths, notches and corners.

A pattern file says nothing about sewing. Two edges that are sewn have nearly the same length,
their notches meet, and their ends meet the ends of seams already found; where several edges would
do, the one that keeps both grain lines in one direction is taken. Check the guess.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import combinations
from types import MappingProxyType

import numpy as np

from seatlook.assembly.ease import notches_on
from seatlook.mesh import arc_length
from seatlook.model import Edge, FloatArray, Panel, Pattern, Seam

LONGEST_EASE = 0.03  # of one edge on one edge
LONGEST_RUN_EASE = 0.006  # of one edge on several: many sums come near by chance
_RUN = 4  # edges in a row that one edge may be sewn to
_SHORTEST = 0.015  # m; shorter edges are cuts and facets
_AT_END = 0.002  # m; a notch that near an end of an edge marks the end
_TWIN = 0.002  # share of a length by which mirrored edges may differ
_NOTCH_MISFIT = 0.02  # share of the length by which notches that meet may miss


@dataclass(frozen=True, slots=True, kw_only=True)
class Proposal:
    """Named edges, the seams guessed, why, and what else would have done.

    Parameters
    ----------
    pattern : panels with an edge between each two corners, and the seams
    reasons : seam name -> one sentence for the reader
    rivals : seam name -> names of edges that would fit as well
    free : names of edges sewn to nothing
    """

    pattern: Pattern
    reasons: MappingProxyType[str, str]
    rivals: MappingProxyType[str, tuple[str, ...]]
    free: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class _Side:
    """Edges one after the other: length [m], arc lengths of notches and of inner ends [m]."""

    length: float
    notches: FloatArray
    joints: FloatArray


@dataclass(frozen=True, slots=True, kw_only=True)
class _Match:
    """A possible seam with its evidence; ``order`` sorts the best first."""

    a: str
    b: tuple[str, ...]
    near: _Side
    far: _Side
    corners: int
    notched: bool
    turn: float
    twins: bool

    @property
    def ease(self) -> float:
        return self.near.length / self.far.length - 1

    @property
    def evidence(self) -> tuple[bool, float]:
        # Mirrored panels fit each other everywhere and are rarely sewn together: they come last.
        # An end at a seam found before counts less than notches that meet, two count more.
        return (self.twins, -self.corners - (1.5 if self.notched else 0.0))

    @property
    def fit(self) -> tuple[float, ...]:
        return (round(self.turn, 1), round(abs(self.ease), 3), len(self.b))

    @property
    def edges(self) -> frozenset[str]:
        return frozenset((self.a, *self.b))


@dataclass
class _Sewing:
    """Edges with their corners; corners that are sewn together share a class."""

    pattern: Pattern
    any_notch: bool
    twins: frozenset[frozenset[str]]
    sides: dict[str, tuple[float, FloatArray]]
    free: list[str] = field(default_factory=list)
    meets: dict[tuple[str, int], tuple[str, int]] = field(default_factory=dict)
    seams: list[_Match] = field(default_factory=list)

    def corner(self, name: str, *, end: bool) -> tuple[str, int]:
        edge = self.pattern.edges[name]
        at = (edge.panel, edge.end if end else edge.start)
        while self.meets.get(at, at) != at:
            at = self.meets[at]
        return at

    def runs(self) -> Iterator[tuple[str, ...]]:
        """Edges in a row round the border of what is sewn so far."""
        following: dict[tuple[str, int], list[str]] = {}
        for name in self.free:
            following.setdefault(self.corner(name, end=False), []).append(name)
        for name in self.free:
            run: tuple[str, ...] = (name,)
            yield run
            while len(run) < _RUN:
                ahead = following.get(self.corner(run[-1], end=True), [])
                if len(ahead) != 1 or ahead[0] in run:
                    break
                run = (*run, ahead[0])
                yield run

    def match(self, a: str, run: tuple[str, ...]) -> _Match | None:
        """Judge edge ``a`` sewn to a run; None where it cannot be."""
        edges, pattern = self.pattern.edges, self.pattern
        if a in run or any(edges[b].panel == edges[a].panel for b in run):
            return None
        # The far side is run through backwards, so its last edge meets the start of ``a``.
        b = run[::-1]
        near, far = self.side((a,), reverse=False), self.side(b, reverse=True)
        limit = LONGEST_EASE if len(run) == 1 else LONGEST_RUN_EASE
        corners = int(self.corner(a, end=False) == self.corner(b[0], end=True))
        corners += int(self.corner(a, end=True) == self.corner(b[-1], end=False))
        notched = _notches_meet(near, far)
        twins = any(frozenset((edges[a].panel, edges[x].panel)) in self.twins for x in b)
        both = len(near.notches) > 0 and len(far.notches) > 0
        unfit = (
            abs(near.length / far.length - 1) > limit
            or (self.any_notch and not both)
            or ((len(run) > 1 or twins) and not notched + corners)
            or (twins and not corners)
        )
        if unfit:
            return None
        return _Match(
            a=a, b=b, near=near, far=far, corners=corners, notched=notched,
            turn=max(_turn(pattern, a, name) for name in b), twins=twins,
        )  # fmt: skip

    def side(self, names: Sequence[str], *, reverse: bool) -> _Side:
        """Measure edges in a row, each turned round if ``reverse``."""
        total, notches, joints = 0.0, [], []
        for name in names:
            length, at = self.sides[name]
            notches.append(total + (length - at[::-1] if reverse else at))
            total += length
            joints.append(total)
        return _Side(total, np.concatenate(notches), np.array(joints[:-1]))

    def sew(self, match: _Match) -> None:
        """Take the edges out and let their corners meet."""
        pairs = [
            (self.corner(match.a, end=False), self.corner(match.b[0], end=True)),
            (self.corner(match.a, end=True), self.corner(match.b[-1], end=False)),
        ]
        for one, other in pairs:
            self.meets[one] = other
        self.free = [name for name in self.free if name not in (match.a, *match.b)]
        self.seams.append(match)


def propose_seams(panels: Sequence[Panel]) -> Proposal:
    """Guess the seams of panels.

    Parameters
    ----------
    panels : as read from a pattern file

    Returns
    -------
    Proposal
        Seams of one edge with one edge or with up to four in a row. If the pattern has notches at
        all, an edge without one is not sewn.
    """
    edges = _edges(panels)
    pattern = Pattern(panels=tuple(panels), edges=edges, seams=())
    notched = any(panel.notches for panel in panels)
    sides = {name: (pattern.edge_length(name), _inner_notches(pattern, name)) for name in edges}
    sewing = _Sewing(pattern, notched, _twins(panels, sides, edges), sides, free=list(edges))
    rivals: dict[str, tuple[str, ...]] = {}
    # Single edges first; each seam found narrows the choice for its neighbours.
    for longest in (1, _RUN):
        while matches := list(_matches(sewing, longest)):
            best, also = _surest(matches)
            rivals[seam_name(pattern, best.a, best.b)] = also
            sewing.sew(best)
    names = {m.a: seam_name(pattern, m.a, m.b) for m in sewing.seams}
    return Proposal(
        pattern=Pattern(
            panels=tuple(panels),
            edges=edges,
            seams=tuple(Seam(name=names[m.a], a=m.a, b=m.b) for m in sewing.seams),
        ),
        reasons=MappingProxyType({names[m.a]: _reason(m) for m in sewing.seams}),
        rivals=MappingProxyType({k: v for k, v in rivals.items() if v}),
        free=tuple(sewing.free),
    )


def _surest(matches: Sequence[_Match]) -> tuple[_Match, tuple[str, ...]]:
    """Return the match with most evidence and fewest rivals, and the edges that fit as well."""
    most = min(m.evidence for m in matches)
    level = [m for m in matches if m.evidence == most]
    # In a symmetric pattern what is sure, such as the middle, tells left from right.
    rivals = {id(m): [r for r in level if r is not m and r.edges & m.edges] for m in level}
    best = min(level, key=lambda m: (len(rivals[id(m)]), m.fit))
    also = [r for r in rivals[id(best)] if r.fit == best.fit]
    return best, tuple("+".join(sorted(r.edges - best.edges)) for r in also)


def seam_name(pattern: Pattern, a: str, b: Sequence[str]) -> str:
    """Name a seam by its panels, and by its edges where two panels share several seams."""
    others = " + ".join(pattern.edges[name].panel for name in b)
    return f"{pattern.edges[a].panel} {a.rpartition('.')[2]} - {others}"


def _matches(sewing: _Sewing, longest: int) -> Iterator[_Match]:
    for run in sewing.runs():
        if len(run) > longest:
            continue
        for a in sewing.free:
            # Of two single edges, one order is enough.
            if len(run) == 1 and a > run[0]:
                continue
            match = sewing.match(a, run)
            if match is not None:
                yield match


def _edges(panels: Sequence[Panel]) -> MappingProxyType[str, Edge]:
    """An edge between each two corners that follow each other, long enough to be sewn."""
    edges = {}
    for panel in panels:
        stops = _stops(panel)
        for number, (start, end) in enumerate(zip(stops, [*stops[1:], stops[0]], strict=True), 1):
            name = f"{panel.name}.{number}"
            edges[name] = Edge(name=name, panel=panel.name, start=start, end=end)
    return MappingProxyType(edges)


def _stops(panel: Panel) -> list[int]:
    """Corners that are no closer than a cut is wide."""
    outline = panel.outline
    arc = arc_length(np.concatenate([outline, outline[:1]]))
    stops: list[int] = []
    for k in sorted(int(c) for c in panel.corners):
        if not stops or arc[k] - arc[stops[-1]] >= _SHORTEST:
            stops.append(k)
    if len(stops) > 1 and arc[-1] - arc[stops[-1]] + arc[stops[0]] < _SHORTEST:
        stops.pop()
    return stops or [0]


def _inner_notches(pattern: Pattern, name: str) -> FloatArray:
    """Arc lengths [m] of an edge's notches, without those that mark its ends."""
    at = np.sort(notches_on(pattern, name))
    return at[(at > _AT_END) & (at < pattern.edge_length(name) - _AT_END)]


def _twins(
    panels: Sequence[Panel],
    sides: Mapping[str, tuple[float, FloatArray]],
    edges: Mapping[str, Edge],
) -> frozenset[frozenset[str]]:
    """Pairs of panels that mirror each other: the same lengths, run through the other way."""
    lengths = {
        panel.name: [sides[e.name][0] for e in edges.values() if e.panel == panel.name]
        for panel in panels
    }
    return frozenset(
        frozenset((one, other))
        for one, other in combinations(lengths, 2)
        if len(lengths[one]) == len(lengths[other])
        and any(
            np.allclose(lengths[one], np.roll(lengths[other][::-1], k), rtol=_TWIN)
            for k in range(len(lengths[one]))
        )
    )


def _notches_meet(near: _Side, far: _Side) -> bool:
    """Whether each meets its own, or all of the near side meet notches or joints of the far."""
    one, other = near.notches / near.length, far.notches / far.length
    if not len(one):
        return False
    if len(one) == len(other):
        return bool(np.abs(one - other).max() < _NOTCH_MISFIT)
    marks = np.concatenate([other, far.joints / far.length])
    return len(far.joints) > 0 and bool(
        np.abs(one[:, None] - marks).min(axis=1).max() < _NOTCH_MISFIT
    )


def _turn(pattern: Pattern, a: str, b: str) -> float:
    """Angle [rad] between the grain lines once edge ``b`` lies, turned round, on edge ``a``."""
    grain = [pattern.panel(pattern.edges[n].panel).grain for n in (a, b)]
    chord = [pattern.edge_points(n)[-1] - pattern.edge_points(n)[0] for n in (a, b)]
    angle = [
        np.arctan2(g[1], g[0]) - np.arctan2(c[1], c[0]) for g, c in zip(grain, chord, strict=True)
    ]
    away = angle[0] - angle[1] + np.pi
    return float(abs((away + np.pi) % (2 * np.pi) - np.pi))


def _reason(match: _Match) -> str:
    near, far = match.near, match.far
    notches = "notches meet" if match.notched else "notches do not meet"
    ends = ("no end", "one end", "both ends")[match.corners]
    return (
        f"{1e3 * near.length:.1f} and {1e3 * far.length:.1f} mm; {len(near.notches)} and "
        f"{len(far.notches)} {notches}; {ends} at a seam found before"
    )
