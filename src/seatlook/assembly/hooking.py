"""Which lines of a cover are hooked to which wires, by where they lie."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from seatlook import mesh
from seatlook.mesh.places import place_words
from seatlook.model import FloatArray, Hook

_SAMPLES = 33  # points of a line at which the wire is looked for
_AS_LONG = (0.8, 1.25)  # length of a wire's piece over that of the line beside it
_SHARED = 0.3  # share of the shorter of two pieces that lines may have of one wire
_GAP = 0.02  # m of a wire between two lines of one chain
_LEAST = 0.4  # share of a line that must be beside its wire
_AT_END = 1e-4  # m
_WHOLE = 0.002  # m; so little of a line or wire is not left over


@dataclass(frozen=True, slots=True)
class _Beside:
    """A line that runs beside a wire."""

    line: str
    length: float  # of the line [m]
    low: float  # part of it that is beside the wire, along the line [m]
    high: float
    start: float  # piece of the wire [m]; on a closed one it may go on past the end
    end: float
    along: bool  # whether the line runs the wire's way
    away: float  # mean distance [m]

    @property
    def before(self) -> float:
        """How much of the line [m] comes before the wire begins, on the wire's way."""
        return self.low if self.along else self.length - self.high

    @property
    def after(self) -> float:
        """How much of the line [m] goes on beyond the wire's end."""
        return self.length - self.high if self.along else self.low

    def moved(self, way: float) -> _Beside:
        """The same line, its piece farther on along the wire [m]."""
        return replace(self, start=self.start + way, end=self.end + way)


def hooks_beside(
    lines: Mapping[str, FloatArray], wires: Mapping[str, FloatArray], *, reach: float, stage: str
) -> tuple[Hook, ...]:
    """Hook lines to the wires that they run beside, those one after the other as a chain.

    Parameters
    ----------
    lines : name -> (k, 3) [m]     seams or internal lines, where they are to lie
    wires : name -> (k, 3) [m]
    reach : float [m]              largest mean distance of a line from its wire
    stage : in which the hooks are drawn in

    Returns
    -------
    tuple of Hook
        In the order of the wires. A chain that has a gap along the wire makes two hooks. Their
        junctions lie on the wire half way between the nearest places of two lines' ends. Those on a
        closed wire go on past its end: it may begin anywhere beside its lines. All slide if one is
        a chain: beside its junctions rings that are held would pull along the wire.

    Notes
    -----
    A line runs beside a wire when the piece of wire next to it is about as long as the line. Of
    several beside one piece the nearest is hooked; a line is hooked to the nearest of its wires.
    """
    beside: dict[str, list[_Beside]] = {wire: [] for wire in wires}
    for name, points in lines.items():
        found = {
            wire: piece
            for wire, curve in wires.items()
            if (piece := _beside(name, points, curve, reach)) is not None
        }
        if found:
            wire = min(found, key=lambda name: found[name].away)
            beside[wire].append(found[wire])
    hooks = []
    for wire, pieces in beside.items():
        whole = _round(wires[wire])
        chains = _chains(_nearest(pieces, whole), whole)
        words = place_words([lines[chain[0].line] for chain in chains])
        for chain, word in zip(chains, words, strict=True):
            name = f"{wire}.{word}" if word else wire
            hooks.append(_hook(name, wire, chain, wires[wire], stage))
    slides = any(hook.chain for hook in hooks)
    return tuple(replace(hook, slides=slides) for hook in hooks)


def _round(wire: FloatArray) -> float | None:
    """Length [m] after which a closed wire is where it was; None for one with ends."""
    return mesh.length(wire) if mesh.is_closed(wire) else None


def _beside(name: str, line: FloatArray, wire: FloatArray, reach: float) -> _Beside | None:
    """The piece of a wire beside a line, if there is one."""
    along = np.linspace(0.0, mesh.arc_length(line)[-1], _SAMPLES)
    arc = mesh.arc_length(line)
    points = np.column_stack([np.interp(along, arc, column) for column in line.T])
    away, place = mesh.nearest_places(wire, points)
    whole = _round(wire)
    if whole is None:
        part = _between_ends(place, mesh.length(wire))
        away, place, along = away[part], place[part], along[part]
        if len(along) < 2:
            return None
    else:
        place = np.unwrap(place, period=whole)
    piece = abs(place[-1] - place[0])
    run = along[-1] - along[0]
    straight = np.abs(np.diff(place)).sum() <= _AS_LONG[1] * piece
    low, high = _AS_LONG
    if not (straight and low * run <= piece <= high * run and away.mean() <= reach):
        return None
    if run < _LEAST * arc[-1]:
        return None
    start, end = sorted((float(place[0]), float(place[-1])))
    if whole is not None:  # what begins where the loop does begins at 0, not at the end of it
        turn = (start + _WHOLE) // whole * whole
        start, end = start - turn, end - turn
    return _Beside(
        line=name,
        length=float(arc[-1]),
        low=float(along[0]),
        high=float(along[-1]),
        start=start,
        end=end,
        along=bool(place[-1] > place[0]),
        away=float(away.mean()),
    )


def _between_ends(place: FloatArray, whole: float) -> slice:
    """Which of the places (s,) [m] along an open wire are beside it.

    Beyond the end of a wire all places are its end: only the last of them is beside it.
    """
    inner = np.flatnonzero((place > _AT_END) & (place < whole - _AT_END))
    if len(inner) < 2:
        return slice(0)
    return slice(max(inner[0] - 1, 0), min(inner[-1] + 2, _SAMPLES))


def _nearest(pieces: Sequence[_Beside], whole: float | None) -> list[_Beside]:
    """Of lines beside one piece of a wire, the nearest one; in order along the wire."""
    chosen: list[_Beside] = []
    turns = (0.0,) if whole is None else (-whole, 0.0, whole)
    for piece in sorted(pieces, key=lambda p: p.away):
        shared = [
            max(min(piece.end + t, c.end) - max(piece.start + t, c.start) for t in turns)
            for c in chosen
        ]
        long = [min(piece.end - piece.start, c.end - c.start) for c in chosen]
        if all(s <= _SHARED * n for s, n in zip(shared, long, strict=True)):
            chosen.append(piece)
    return sorted(chosen, key=lambda p: p.start)


def _chains(pieces: Sequence[_Beside], whole: float | None) -> list[list[_Beside]]:
    """Part pieces where the wire has a gap between them; a loop goes on from its end."""
    chains: list[list[_Beside]] = []
    for piece in pieces:
        if chains and piece.start - chains[-1][-1].end <= _GAP:
            chains[-1].append(piece)
        else:
            chains.append([piece])
    if whole is not None and len(chains) > 1:
        first = [piece.moved(whole) for piece in chains[0]]
        if first[0].start - chains[-1][-1].end <= _GAP:
            chains[-1].extend(first)
            del chains[0]
    return chains


def _hook(name: str, wire: str, chain: Sequence[_Beside], curve: FloatArray, stage: str) -> Hook:
    """The hook of a chain: junctions on the wire, and the part that lies beside it."""
    whole, total = mesh.length(curve), sum(piece.length for piece in chain)
    loop = _round(curve)
    first, last = chain[0], chain[-1]
    before, after = (
        (first.low, total - last.high) if len(chain) == 1 else (first.before, last.after)
    )
    start = before if before > _WHOLE else 0.0
    end = total - after if after > _WHOLE else None
    inner = [(a.end + b.start) / 2 for a, b in pairwise(chain)]
    if loop is None:
        ends = _ends(first.start, last.end, whole, (total if end is None else end) - start)
    else:
        ends = _ends_on_loop(first.start, last.end, loop)
    junctions = (ends[0], *inner, ends[1])
    alone = len(chain) == 1
    return Hook(
        name=name,
        line=first.line if alone else "",
        chain=() if alone else tuple(piece.line for piece in chain),
        wire=wire,
        stage=stage,
        junctions=() if alone and junctions == (0.0, whole) else junctions,
        start=start,
        end=end,
    )


def _ends_on_loop(start: float, end: float, whole: float) -> tuple[float, float]:
    """The piece of a loop [m]; where it is nearly all of it, it ends where it begins."""
    if abs(end - start - whole) > _GAP:
        return max(start, 0.0), end
    start = max((start + end - whole) / 2, 0.0)
    return (0.0, whole) if start < _WHOLE else (start, start + whole)


def _ends(start: float, end: float, whole: float, length: float) -> tuple[float, float]:
    """The piece of a wire [m], grown to an end of the wire where that fits a chain's length better.

    Lines of flat panels lie over a wire as they start: their ends are not right beside its own.
    """
    if start < _WHOLE or abs(end - length) < abs(end - start - length):
        start = 0.0
    if whole - end < _WHOLE or abs(whole - start - length) < abs(end - start - length):
        end = whole
    return start, end
