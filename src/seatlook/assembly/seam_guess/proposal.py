"""What was guessed, in words: named edges, seams with reasons and rivals, and what is not sure."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from types import MappingProxyType

import numpy as np

from seatlook.assembly.seam_guess.evidence import Pair
from seatlook.assembly.seam_guess.guess import Verdict, judge
from seatlook.assembly.seam_guess.kin import find_kin
from seatlook.assembly.seam_guess.outlines import Outlines, Side
from seatlook.mesh.places import place_words
from seatlook.model import Edge, FloatArray, Panel, Pattern, Seam

SURE = 0.9  # probability from which a seam is written; below it is listed as not sure
_PLACES = ("right", "top-right", "top", "top-left", "left", "bottom-left", "bottom", "bottom-right")


@dataclass(frozen=True, slots=True, kw_only=True)
class Doubtful:
    """Edges that may be sewn to each other, but not surely.

    Parameters
    ----------
    a, b : names of edges, as in ``Seam``
    probability : float
    rivals : what would do as well, each the names of edges joined by " + "
    """

    a: str
    b: tuple[str, ...]
    probability: float
    rivals: tuple[str, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Proposal:
    """Named edges, the seams guessed, why, and what else would have done.

    Parameters
    ----------
    pattern : panels with an edge between each two corners, and the seams
    reasons : seam name -> one sentence for the reader
    rivals : seam name -> names of edges that would fit as well
    free : names of edges sewn to nothing
    probabilities : seam name -> how sure it is, at least ``SURE``
    doubtful : seams that are less sure, most probable first; their edges are among the free ones
    """

    pattern: Pattern
    reasons: MappingProxyType[str, str]
    rivals: MappingProxyType[str, tuple[str, ...]]
    free: tuple[str, ...]
    probabilities: MappingProxyType[str, float] = field(
        default_factory=lambda: MappingProxyType({})
    )
    doubtful: tuple[Doubtful, ...] = ()


def propose_seams(panels: Sequence[Panel]) -> Proposal:
    """Guess the seams of panels.

    Parameters
    ----------
    panels : as read from a pattern file

    Returns
    -------
    Proposal
        Seams of one edge with one edge or with up to four in a row, of a panel with another or,
        for darts and tubes, with itself. Corners inside a sewn edge are merged. Seams that are
        less probable than ``SURE`` are left out and listed as doubtful.

    Notes
    -----
    See docs/method/seam-guess.md.
    """
    outlines = Outlines(panels)
    verdicts = judge(outlines, find_kin(outlines))
    sure = [v for v in verdicts if v.probability >= SURE]
    names = _Names(outlines, [v.pair for v in sure])
    seams, reasons, rivals, probabilities = [], {}, {}, {}
    unsewn = Pattern(panels=tuple(panels), edges=names.edges, seams=())
    labels = _seam_names(names, unsewn, sure)
    for verdict, name in zip(sure, labels, strict=True):
        a, b = names.ends(verdict.pair)
        seams.append(Seam(name=name, a=a, b=b))
        reasons[name] = reason(verdict)
        probabilities[name] = verdict.probability
        if others := (*verdict.rivals, *verdict.alike):
            rivals[name] = tuple(dict.fromkeys(names.other(verdict.pair, r) for r in others))
    doubtful = [v for v in verdicts if v.probability < SURE]
    doubtful.sort(key=lambda v: -v.probability)
    sewn = {name for seam in seams for name in (seam.a, *seam.b)}
    return Proposal(
        pattern=replace(unsewn, seams=tuple(seams)),
        reasons=MappingProxyType(reasons),
        rivals=MappingProxyType(rivals),
        free=tuple(name for name in names.edges if name not in sewn),
        probabilities=MappingProxyType(probabilities),
        doubtful=tuple(names.doubtful(v) for v in doubtful),
    )


class _Names:
    """Edges of the pattern and what they are called: the panel, and where on it they lie."""

    def __init__(self, outlines: Outlines, sewn: Sequence[Pair]) -> None:
        self._outlines = outlines
        self._of: dict[int, str] = {}  # atom -> the edge that holds it
        merged = {s.atoms for pair in sewn for s in (pair.a, *pair.b) if len(s.atoms) > 1}
        held = {atom for atoms in merged for atom in atoms}
        runs = sorted([*merged, *((a,) for a in range(len(outlines)) if a not in held)])
        edges: dict[str, Edge] = {}
        given: Counter[str] = Counter()
        for atoms in runs:
            side = outlines.side(atoms)
            place = f"{outlines.panels[side.panel].name}.{_place(outlines, side)}"
            given[place] += 1
            name = place if given[place] == 1 else f"{place}-{given[place]}"
            edges[name] = Edge(
                name=name, panel=outlines.panels[side.panel].name,
                start=outlines.place(side.first), end=outlines.place(side.end),
            )  # fmt: skip
            self._of |= dict.fromkeys(atoms, name)
        self.edges = MappingProxyType(edges)

    def of(self, side: Side) -> tuple[str, ...]:
        """Edges of a side, in the order of its outline."""
        return tuple(dict.fromkeys(self._of[atom] for atom in side.atoms))

    def ends(self, pair: Pair) -> tuple[str, tuple[str, ...]]:
        """Edge a and edges b of a pair that is sewn, b in the order in which they meet a."""
        far = tuple(self._of[side.first] for side in pair.b)
        return self._of[pair.a.first], far[::-1]

    def other(self, pair: Pair, rival: Pair) -> str:
        """Name what a rival would take instead."""
        own = set(pair.atoms)
        sides = [s for s in (rival.a, *rival.b) if not own & set(s.atoms)] or [rival.a, *rival.b]
        return " + ".join(name for side in sides for name in self.of(side))

    def doubtful(self, verdict: Verdict) -> Doubtful:
        pair = verdict.pair
        near = self.of(pair.a)
        far = tuple(name for side in pair.b[::-1] for name in self.of(side)[::-1])
        return Doubtful(
            a=" + ".join(near),
            b=far,
            probability=verdict.probability,
            rivals=tuple(
                dict.fromkeys(self.other(pair, r) for r in (*verdict.rivals, *verdict.alike))
            ),
        )


def _place(outlines: Outlines, side: Side) -> str:
    """Where an edge lies on its panel as it is drawn, by the way it faces."""
    outward = side.chord - np.pi / 2
    return _PLACES[round(outward / (np.pi / 4)) % 8]


def _seam_names(names: _Names, pattern: Pattern, verdicts: Sequence[Verdict]) -> list[str]:
    """Name seams by their panels, and by their place on the first where several have the same."""
    sides = [names.ends(verdict.pair) for verdict in verdicts]
    panels = [tuple(dict.fromkeys(names.edges[name].panel for name in (a, *b))) for a, b in sides]
    labels = ["-".join(own) for own in panels]
    order = [panel.name for panel in pattern.panels]
    for group in {frozenset(own) for own in panels}:
        rows = [k for k, own in enumerate(panels) if frozenset(own) == group]
        first = min(group, key=order.index)
        lines = []
        for k in rows:
            a, b = sides[k]
            lines.append(_drawn(pattern, next(e for e in (a, *b) if names.edges[e].panel == first)))
        for k, word in zip(rows, place_words(lines), strict=True):
            labels[k] = ".".join(filter(None, (labels[k], word)))
    repeated = Counter(labels)
    return [
        label if repeated[label] == 1 else f"{label}.{a}"
        for label, (a, _) in zip(labels, sides, strict=True)
    ]


def _drawn(pattern: Pattern, edge: str) -> FloatArray:
    """Points (k, 3) of an edge for which the words of places are those of its panel's drawing."""
    x, y = pattern.edge_points(edge).T
    return np.column_stack([-x, np.zeros_like(x), y])


def reason(verdict: Verdict) -> str:
    """Why a seam was guessed, in one sentence."""
    pair = verdict.pair
    parts = [f"{1e3 * pair.a.length:.1f} and {1e3 * pair.b_length:.1f} mm"]
    if pair.meeting or pair.missing:
        parts.append(_notch_words(pair.meeting, pair.missing))
    parts.append(f"{_WORDS[verdict.ends]} at other seams")
    if pair.terms.get("bend", 0.0) > 0.6:
        parts.append("curves fit")
    if verdict.mirrored:
        parts.append("its mirror image is sewn too")
    if pair.a.panel == pair.b[0].panel and len(pair.b) == 1:
        dart = pair.a.end == pair.b[0].first or pair.b[0].end == pair.a.first
        parts.append("a dart" if dart else "closes a tube")
    turns = sum(len(side.turns) for side in (pair.a, *pair.b))
    if turns:
        parts.append("1 corner merged" if turns == 1 else f"{turns} corners merged")
    return f"probability {verdict.probability:.2f}: " + "; ".join(parts)


_WORDS = ("no end", "one end", "both ends")


def _notch_words(meeting: int, missing: int) -> str:
    """Say how many notches meet one on the other side, and how many do not."""
    if not meeting:
        return "no notch meets"
    if not missing:
        return "the notch meets" if meeting == 1 else f"all {meeting} notches meet"
    met = "1 notch meets" if meeting == 1 else f"{meeting} notches meet"
    return f"{met}, {missing} {'does' if missing == 1 else 'do'} not"
