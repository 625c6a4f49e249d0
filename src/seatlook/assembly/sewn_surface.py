"""The surface that seams make of flat panels, without any pose: handles, and angles at its points.

A cover is a disc, or a sphere with holes. Partners that were exchanged give it a handle, or lead
two of its points together into one with twice the angle.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import combinations, pairwise
from typing import TypeVar

import numpy as np

from seatlook.mesh import arc_length
from seatlook.model import Edge, FloatArray, Panel, Pattern, Seam

WIDEST_POINT = np.radians(520.0)  # a box has 270 degrees, the inner corner of a step 450
_ARM = 0.015  # m from a point, over which the angle of an outline is taken
_SAME = 1e-6  # m of a closed outline's length, between places that are one
_GAP = 1e-4  # m of a border without a name
_FIT = 1e-3  # share of its length by which a seam may fit worse with another partner

Place = tuple[str, float]  # panel, arc length along its outline
Piece = tuple[Place, Place]  # from one place to the next, in the order of the outline
T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class SewnSurface:
    """What panels become when they are sewn; every seam taken to run the right way round.

    Parameters
    ----------
    handles : 0 for a disc, a sphere, or either with holes
    points : places that become one, with the sum of the panels' angles there [rad]
    parts : how many pieces it falls into
    """

    handles: int
    parts: int
    points: tuple[tuple[frozenset[Place], float], ...]

    def covers(self, handles: int = 0) -> bool:
        """Whether it can be a cover of a body with so many handles."""
        return self.handles <= handles and all(angle <= WIDEST_POINT for _, angle in self.points)


def sewn_surface(pattern: Pattern, seams: Iterable[Seam]) -> SewnSurface:
    """Sew panels by seams and look at what comes out; panels without a seam are left out."""
    outlines = _Outlines(pattern)
    twins: dict[Piece, Piece] = {}
    for seam in seams:
        for one, other in outlines.pairs(seam):
            twins[one], twins[other] = other, one
    if any(twins[other] != one for one, other in twins.items()):
        return SewnSurface(0, 0, ())  # an edge in two seams is refused where seams are read
    pieces = outlines.pieces(twins)
    point = _points(pieces, twins)
    panels = {panel for (panel, _), _ in pieces}
    joined = _classes(panels, [(one[0][0], other[0][0]) for one, other in twins.items()])
    edges = len(pieces) - len(twins) // 2
    euler = len(set(point.values())) - edges + len(panels)
    parts = len(set(joined.values()))
    handles = (2 * parts - len(_rims(pieces, twins)) - euler) // 2
    gathered: dict[Place, list[Place]] = {}
    for place, name in point.items():
        gathered.setdefault(name, []).append(place)
    return SewnSurface(
        handles,
        parts,
        tuple((frozenset(ps), sum(map(outlines.angle, ps))) for ps in gathered.values()),
    )


def free_borders(pattern: Pattern) -> tuple[tuple[str, ...], ...]:
    """Closed borders of the sewn panels, each the names of its free edges one after the other.

    A panel without any seam has one of its own. Borders with a stretch that has no name are left
    out.
    """
    outlines = _Outlines(pattern)
    twins = {x: y for seam in pattern.seams for p in outlines.pairs(seam) for x, y in (p, p[::-1])}
    rims = _rims(outlines.pieces(twins), twins)
    sewn = {panel for (panel, _), _ in twins}
    lone = [panel.name for panel in pattern.panels if panel.name not in sewn]
    rims += [[((name, 0.0), (name, 0.0))] for name in lone]
    found = [[outlines.edges_on(piece) for piece in rim] for rim in rims]
    return tuple(tuple(name for part in rim for name in part) for rim in found if all(rim))


def exchanged(
    pattern: Pattern, handles: int = 0
) -> tuple[list[tuple[Seam, Seam]], list[tuple[Seam, Seam]]]:
    """Pairs of seams, each of which fits the other's partner as well as its own.

    Parameters
    ----------
    handles : of the body below, such as 1 of a ring

    Returns
    -------
    certain : with which the sewn panels can be no cover, and without which they can
    likely : with which they fall into more pieces than without; so do two covers in one scene
    """
    seams = pattern.seams
    now = sewn_surface(pattern, seams)
    certain: list[tuple[Seam, Seam]] = []
    likely: list[tuple[Seam, Seam]] = []
    covers = now.covers(handles)
    if covers and now.parts <= 1:
        return certain, likely
    for one, two in combinations(seams, 2):
        if not alike(pattern, one, two, tolerance=_FIT):
            continue
        swapped = replace(one, b=two.b), replace(two, b=one.b)
        others = [seam for seam in seams if seam not in (one, two)]
        then = sewn_surface(pattern, [*others, *swapped])
        if then.covers(handles) and not covers:
            certain.append((one, two))
        elif then.covers(handles) and then.parts < now.parts:
            likely.append((one, two))
    return certain, likely


def alike(pattern: Pattern, one: Seam, two: Seam, *, tolerance: float = 0.1) -> bool:
    """Whether two seams fit each other's partner as well as their own, to a share of the length."""
    swapped = replace(one, b=two.b), replace(two, b=one.b)
    fits = [_misfit(pattern, seam) for seam in (one, two, *swapped)]
    return max(fits[2:]) <= max(fits[:2]) + tolerance


class _Outlines:
    """Places on the outlines of panels, by arc length from the first vertex."""

    def __init__(self, pattern: Pattern) -> None:
        self.pattern = pattern
        self._panels = {panel.name: panel for panel in pattern.panels}
        self._arc = {name: arc_length(_ring(panel)) for name, panel in self._panels.items()}

    def pairs(self, seam: Seam) -> list[tuple[Piece, Piece]]:
        """Stretches of both sides that lie on each other, each in the order of its outline."""
        far = [self.pattern.edges[name] for name in seam.b]
        shares = np.array([self.pattern.edge_length(name) for name in seam.b])
        stops = np.concatenate([[0.0], np.cumsum(shares) / shares.sum()])
        near = self.pattern.edges[seam.a]
        begin, length = self._begin(near), self.pattern.edge_length(seam.a)
        return [
            (
                (self._place(near, begin + low * length), self._place(near, begin + high * length)),
                self._ends(edge),
            )
            for (low, high), edge in zip(pairwise(stops), far, strict=True)
        ]

    def pieces(self, twins: Iterable[Piece]) -> dict[Piece, Piece]:
        """Sewn and free stretches of all outlines that are sewn -> the next one of the outline."""
        sewn: dict[str, list[Piece]] = {}
        for piece in twins:
            sewn.setdefault(piece[0][0], []).append(piece)
        following = {}
        for own in sewn.values():
            ring: list[Piece] = []
            own.sort(key=lambda piece: piece[0][1])
            for piece, then in zip(own, [*own[1:], own[0]], strict=True):
                ring.append(piece)
                if piece[1] != then[0]:
                    ring.append((piece[1], then[0]))
            following.update(dict(zip(ring, [*ring[1:], ring[0]], strict=True)))
        return following

    def edges_on(self, piece: Piece) -> list[str]:
        """Names of the edges that make up a stretch, in its order; none if they leave a gap."""
        (panel, start), (_, end) = piece
        whole = float(self._arc[panel][-1])
        length = (end - start) % whole or whole
        found = []
        for edge in self.pattern.edges.values():
            at = (self._begin(edge) - start + _SAME) % whole
            if edge.panel == panel and at < length - _SAME:
                found.append((at, edge.name))
        total = sum(self.pattern.edge_length(name) for _, name in found)
        return [name for _, name in sorted(found)] if abs(total - length) < _GAP else []

    def angle(self, place: Place) -> float:
        """Inner angle of an outline at a place [rad], over arms long enough to round a corner."""
        name, at = place
        arc = self._arc[name]
        ring = _ring(self._panels[name])

        def point(s: float) -> FloatArray:
            return np.array([np.interp(s % arc[-1], arc, column) for column in ring.T])

        arm = min(_ARM, arc[-1] / 8)
        behind, ahead = point(at - arm) - point(at), point(at + arm) - point(at)
        cross = ahead[0] * behind[1] - ahead[1] * behind[0]
        return float(np.arctan2(cross, ahead @ behind) % (2 * np.pi))

    def _ends(self, edge: Edge) -> Piece:
        begin = self._begin(edge)
        length = self.pattern.edge_length(edge.name)
        return self._place(edge, begin), self._place(edge, begin + length)

    def _begin(self, edge: Edge) -> float:
        return float(self._arc[edge.panel][edge.start])

    def _place(self, edge: Edge, at: float) -> Place:
        whole = float(self._arc[edge.panel][-1])
        at = at % whole
        # A place near a vertex that an edge ends in is this vertex.
        return edge.panel, 0.0 if whole - at < _SAME else round(at / _SAME) * _SAME


def _ring(panel: Panel) -> FloatArray:
    return np.vstack([panel.outline, panel.outline[:1]])


def _points(
    pieces: Iterable[Piece],
    twins: dict[Piece, Piece],
) -> dict[Place, Place]:
    """Place -> one that stands for all it is sewn to."""
    places = {place for piece in pieces for place in piece}
    pairs = [
        pair
        for (start, end), (begin, stop) in twins.items()
        for pair in ((start, stop), (end, begin))
    ]
    return _classes(places, pairs)


def _rims(
    pieces: dict[Piece, Piece],
    twins: dict[Piece, Piece],
) -> list[list[Piece]]:
    """Closed lines that the free stretches make, each in the order of the outlines."""
    free = {piece: None for piece in pieces if piece not in twins}
    rims = []
    while free:
        rim = [next(iter(free))]
        while True:
            free.pop(rim[-1])
            piece = pieces[rim[-1]]
            while piece in twins:
                piece = pieces[twins[piece]]
            if piece == rim[0]:
                break
            rim.append(piece)
        rims.append(rim)
    return rims


def _classes(items: Iterable[T], pairs: Iterable[tuple[T, T]]) -> dict[T, T]:
    """Item -> the one that stands for all that pairs join it with."""
    above = {item: item for item in items}

    def top(item: T) -> T:
        while above[item] != item:
            item = above[item]
        return item

    for one, other in pairs:
        above[top(one)] = top(other)
    return {item: top(item) for item in above}


def _misfit(pattern: Pattern, seam: Seam) -> float:
    """Difference of a seam's sides over the longer of them."""
    sides: Sequence[float] = (
        pattern.edge_length(seam.a),
        sum(pattern.edge_length(name) for name in seam.b),
    )
    return abs(sides[0] - sides[1]) / max(sides)
