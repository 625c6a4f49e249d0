"""Candidates that change together: a run of stretches of an edge, and what mirrors it."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from types import MappingProxyType

import numpy as np

from seatlook.improvement.candidate import Candidate, Kind, stops_of, words_of
from seatlook.improvement.changes import Amounts, Changes, added
from seatlook.improvement.cutting.outline import Outline
from seatlook.model import FloatArray, Solution

_MIRRORED = 0.012  # m, by which the middles of two edges may miss each other's mirror image
_AS_LONG = 0.01  # of its length, by which they may differ
_EQUAL = 5e-5  # m, by which lines that are sewn may differ
_SHORTEST = 3e-4  # m that an edge was moved by, if it was
MENDS = 0.2  # of what sewn lines differ by, squared, from which a move is a repair
_ALIKE = 0.5  # of the larger slope: a pair whose slopes differ by more is not moved as one


@dataclass(frozen=True, slots=True, kw_only=True)
class Move:
    """A correction that is made as one, by one amount [m].

    Parameters
    ----------
    kind : of its candidates
    names : of the edges, hooks or panels; two for a symmetric pair
    places : (begin, end) in words for each of these
    share : candidate -> its amount for an amount of 1
    follows : lengths that change with these, so that sewn lines still agree
    seams : numbers of the seams whose ease it changes
    closes : amount [m] that makes sewn lines agree that do not; 0 where nothing does
    mends : share of the squares of all such differences that goes with it
    """

    kind: Kind
    names: tuple[str, ...]
    places: tuple[tuple[str, str], ...]
    share: Mapping[Candidate, float]
    follows: Mapping[Candidate, float] = field(default_factory=lambda: MappingProxyType({}))
    seams: frozenset[int] = frozenset()
    closes: float = 0.0
    mends: float = 0.0

    @property
    def every(self) -> dict[Candidate, float]:
        """All that changes, for an amount of 1."""
        return added(self.share, self.follows)

    def total(self, values: Mapping[Candidate, float]) -> float:
        """Sum of values per candidate, for an amount of 1."""
        return sum(part * values[candidate] for candidate, part in self.every.items())

    def amounts(self, amount: float) -> dict[Candidate, float]:
        """Amount of every candidate [m]."""
        return {candidate: amount * part for candidate, part in self.every.items()}


def sewable(
    changes: Changes, slope: Mapping[Candidate, float], frozen: frozenset[str]
) -> tuple[dict[Candidate, float], dict[Candidate, Amounts]]:
    """Slopes with all that must follow for the seams' sake, and what follows.

    Candidates whose partners cannot follow are left out.

    Parameters
    ----------
    slope : candidate -> derivative, of all that may follow too
    frozen : names of edges that stay
    """
    follows = {c: changes.partners.followers(c, frozen) for c in slope}
    able: dict[Candidate, Amounts] = {c: f for c, f in follows.items() if f is not None}
    return {c: slope[c] + sum(v * slope[o] for o, v in f.items()) for c, f in able.items()}, able


def followed(
    changes: Changes, move: Move, follows: Mapping[Candidate, Amounts], made: Amounts
) -> Move:
    """The same move with what follows each of its candidates, and where it closes its seams.

    Parameters
    ----------
    made : amounts [m] that have been made
    """
    partners = changes.partners
    parts = [
        {other: part * v for other, v in follows[candidate].items()}
        for candidate, part in move.share.items()
    ]
    seams = {n for c in move.share if (n := partners.seam_of(c)) is not None}
    closes = [partners.closing(c, made) / part for c, part in move.share.items()]
    # Mirrored seams that differ by different amounts are not closed by one.
    closing = float(np.mean(closes)) if seams and max(closes) - min(closes) <= _EQUAL else 0.0
    away = partners.differences(made)
    wrong = float(sum(away[number] ** 2 for number in seams))
    return replace(
        move,
        follows=added(*parts),
        seams=frozenset(seams),
        closes=closing,
        mends=wrong / float(np.dot(away, away)) if abs(closing) > _SHORTEST else 0.0,
    )


def mending(
    changes: Changes, candidates: Collection[Candidate], made: Amounts, limit: float
) -> tuple[Move, ...]:
    """Whole edges that were moved, as sewn lines say that do not agree: back where they do.

    Parameters
    ----------
    candidates : that may change
    limit : float [m] of an offset
    """
    partners, edges = changes.partners, dict[tuple[int, int], list[Candidate]]()
    for candidate in candidates:
        if candidate.kind == "offset":
            edges.setdefault((candidate.panel, candidate.side), []).append(candidate)
    away, moves = partners.differences(made), list[Move]()
    for (panel, number), stretches in edges.items():
        side = changes.outlines[panel].sides[number]
        slope = np.sum([partners.slope(c) for c in stretches], axis=0)
        fit = float(np.dot(slope, away))
        whole = len(stretches) == len(stops_of(side)) - 1
        if not whole or not fit:
            continue
        amount = -fit / float(np.dot(slope, slope))
        mends = -amount * fit / float(np.dot(away, away))
        if mends > MENDS and _SHORTEST < abs(amount) <= limit:
            moves.append(
                Move(
                    kind="offset", names=(side.edge,), places=(("its beginning", "its end"),),
                    share=dict.fromkeys(stretches, 1.0), closes=amount, mends=mends,
                )
            )  # fmt: skip
    return tuple(moves)


def moves_of(
    changes: Changes, slope: Mapping[Candidate, float], *, pairs: bool = True
) -> tuple[Move, ...]:
    """Gather candidates into moves.

    Of every edge: the run of neighbouring stretches that, moved the same way, changes most; and its
    length. Edges, hooks and panels that mirror each other move as one where both gain by it.

    Parameters
    ----------
    slope : candidate -> derivative; what is not in it does not move
    """
    single = list(_single(changes, slope))
    if not pairs:
        return tuple(single)
    partner = _partners(changes.solution, changes)
    by_key = {(move.kind, move.names[0]): move for move in single}
    done: set[tuple[str, str]] = set()
    moves = []
    for move in single:
        key = (move.kind, move.names[0])
        other = by_key.get((move.kind, partner.get(move.names[0], "")))
        if key in done:
            continue
        if other is None or other is move or not _alike(move, other, slope):
            moves.append(move)
            continue
        done.add((other.kind, other.names[0]))
        moves.append(
            Move(
                kind=move.kind,
                names=move.names + other.names,
                places=move.places + other.places,
                share={**move.share, **other.share},
            )
        )
    return tuple(moves)


def _single(changes: Changes, slope: Mapping[Candidate, float]) -> Iterator[Move]:
    edges: dict[tuple[int, int], list[Candidate]] = {}
    for candidate in slope:
        if candidate.kind == "offset":
            edges.setdefault((candidate.panel, candidate.side), []).append(candidate)
            continue
        yield Move(
            kind=candidate.kind, names=(candidate.name,), places=(("", ""),), share={candidate: 1.0}
        )
    for (panel, number), stretches in edges.items():
        side = changes.outlines[panel].sides[number]
        first, last = _best_run([slope[c] for c in stretches])
        yield Move(
            kind="offset",
            names=(side.edge,),
            places=(words_of(side, stretches[first].stretch, stretches[last].stretch),),
            share=dict.fromkeys(stretches[first : last + 1], 1.0),
        )


def _best_run(values: Sequence[float]) -> tuple[int, int]:
    """First and last place of the run with the largest sum in size."""
    total = np.concatenate([[0.0], np.cumsum(values)])
    size = np.abs(total[None, :] - total[:, None])
    first, end = np.unravel_index(int(np.argmax(np.triu(size, 1))), size.shape)
    return int(first), int(end) - 1


def _alike(a: Move, b: Move, slope: Mapping[Candidate, float]) -> bool:
    """Whether two moves change the objective the same way, and by about as much."""
    small, large = sorted((a.total(slope), b.total(slope)), key=abs)
    return small * large > 0.0 and abs(small) >= (1.0 - _ALIKE) * abs(large)


def _partners(solution: Solution, changes: Changes) -> dict[str, str]:
    """Name of the mirror image of every edge, hook and panel that has one, across the middle.

    The middle is that of the solved seat; +x is the occupant's left.
    """
    x = solution.positions
    middle = 0.5 * (x[:, 0].min() + x[:, 0].max())
    panels = _images(_panels(solution), middle)
    found = panels | _images(_hooks(solution), middle)
    names = solution.cover.panel_names
    for name, place, size in _panels(solution):
        # A panel across the middle is its own image; both sides of a seam lie in one place.
        other = panels.get(name) or (name if _is_image(place, size, place, size, middle) else "")
        if other:
            own, far = (_edges(x, changes.outlines[names.index(p)]) for p in (name, other))
            found |= _images(own, middle, far)
    return {name: other for name, other in found.items() if other != name}


_Thing = tuple[str, FloatArray, float]  # name, place [m], size [m]


def _images(
    things: Sequence[_Thing], middle: float, others: Sequence[_Thing] | None = None
) -> dict[str, str]:
    """Names of things and of what mirrors them, themselves left out."""
    return {
        name: other
        for name, place, size in things
        for other, there, large in (things if others is None else others)
        if other != name and _is_image(place, size, there, large, middle)
    }


def _is_image(
    place: FloatArray, size: float, there: FloatArray, large: float, middle: float
) -> bool:
    image = place * [-1.0, 1.0, 1.0] + [2.0 * middle, 0.0, 0.0]
    near = float(np.linalg.norm(image - there)) <= _MIRRORED
    return near and abs(size - large) <= _AS_LONG * size


def _edges(x: FloatArray, outline: Outline) -> list[_Thing]:
    return [
        (side.edge, x[outline.vertices[side.at]].mean(axis=0), side.length)
        for side in outline.sides
        if side.edge
    ]


def _hooks(solution: Solution) -> list[_Thing]:
    return [
        (anchor.name, anchor.target.mean(axis=0), float(anchor.length.sum()))
        for anchor in solution.cover.anchors
        if anchor.kind == "hook"
    ]


def _panels(solution: Solution) -> list[_Thing]:
    cover, things = solution.cover, list[_Thing]()
    for panel, name in enumerate(cover.panel_names):
        area = np.where(cover.panel == panel, cover.rest_area, 0.0)
        middles = solution.positions[cover.faces].mean(axis=1)
        things.append((name, area @ middles / area.sum(), float(np.sqrt(area.sum()))))
    return things
