"""One edge sewn to several of different panels: runs along the border of what is sewn so far."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import groupby

import numpy as np

from seatlook.assembly.seam_guess.evidence import (
    LONGEST_RUN_EASE,
    Background,
    Pair,
    Rates,
    weigh,
)
from seatlook.assembly.seam_guess.kin import Kin
from seatlook.assembly.seam_guess.outlines import Outlines, Side
from seatlook.assembly.seam_guess.sewing import Sewing, border_point, inner_point

_LONGEST_RUN = 4  # edges of one run
_LEAST = 2.0  # nat, that a chain must bring


def sew_chains(sewing: Sewing, outlines: Outlines, kin: Kin, rates: Rates) -> dict[int, float]:
    """Sew the chains that fit, best first; their numbers, and what each leads its rivals by."""
    background = Background(outlines)
    notched = any(p.notches for p in outlines.panels)
    leads: dict[int, float] = {}
    while True:
        options = []
        for pair in _chains(sewing, outlines, kin):
            weighed = weigh(pair, outlines, kin, rates, background, notched=notched)
            if weighed.score < -6.0:
                continue
            terms = weighed.terms | {"joints": _joints(weighed, sewing, outlines)}
            number = sewing.add(replace(weighed, terms=terms))
            options.append((sewing.gain(number), number))
        options = sorted(options, reverse=True)
        if not options or options[0][0] < _LEAST:
            return leads
        gain, best = options[0]
        own = set(sewing.atoms[best])
        rival = max((g for g, n in options[1:] if own & set(sewing.atoms[n])), default=0.0)
        sewing.sew(best)
        leads[best] = gain - max(rival, 0.0)


def _chains(sewing: Sewing, outlines: Outlines, kin: Kin) -> Iterator[Pair]:
    free = [s for s in outlines.sides if all(sewing.owner[a] < 0 for a in s.atoms)]
    lengths = np.array([s.length for s in free])
    for run in _runs(sewing, outlines):
        total = sum(side.length for side in run)
        fits = np.flatnonzero(np.abs(lengths - total) < LONGEST_RUN_EASE * total + 0.0005)
        used = {atom for side in run for atom in side.atoms}
        for k in fits.tolist():
            a = free[k]
            panels = {side.panel for side in run}
            if a.panel in panels or used & set(a.atoms):
                continue
            if any(kin.never(a.panel, panel) for panel in panels):
                continue
            yield Pair(a, run)


def _runs(sewing: Sewing, outlines: Outlines) -> Iterator[tuple[Side, ...]]:
    """Rows of free edges on the border, of two and more."""
    for first in range(len(outlines)):
        if sewing.owner[first] >= 0:
            continue
        run = [first]
        while len(run) < _LONGEST_RUN:
            ahead = _following(sewing, outlines, run[-1])
            if ahead is None or ahead in run:
                break
            run.append(ahead)
            by_panel = groupby(run, key=lambda atom: outlines.panel_of[atom])
            yield tuple(outlines.side(tuple(atoms)) for _, atoms in by_panel)


def _following(sewing: Sewing, outlines: Outlines, atom: int) -> int | None:
    """The free atom that comes next on the border."""
    stop = outlines.ahead[atom]
    for _ in range(len(outlines)):
        if sewing.owner[stop] < 0:
            return stop
        stop = sewing.next[stop]
        if stop < 0:
            return None
    return None


def _joints(pair: Pair, sewing: Sewing, outlines: Outlines) -> float:
    """Points of the border that come to lie inside, along the near side."""
    worth = 0.0
    for side in pair.b[:-1]:
        stops, _ = sewing.point(side.end)
        angle = float(outlines.angle[list(stops)].sum())
        before = border_point(angle, len(stops))
        worth += inner_point(angle + np.pi, len(stops) + 1) - before
    return worth
