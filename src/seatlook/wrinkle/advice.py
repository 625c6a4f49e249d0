"""What to do about wrinkles, in the words of the trade: which edge, which way, how many mm."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import Literal

import numpy as np

from seatlook.model import Cover, FloatArray, Points, Solution
from seatlook.wrinkle.seam_excess import SeamStretch, owners
from seatlook.wrinkle.worst import Kind, Wrinkle

Confidence = Literal["high", "medium", "low"]
Action = Literal["take out", "let out", "loosen"]
EQUAL = 0.005  # share of its length by which a sewn line may be longer without a word
_SMALLEST = 5e-4  # [m] that nobody cuts
_CLEAR = 2.0  # times by which one side must be farther from the cover's strain than the other
_SURE = 3.0  # times its scatter from which an amount is sure
_BESIDE = 0.08  # [m] from a seam up to which a wrinkle may come from it

NONE: dict[Kind, str] = {
    "wrinkle": "none: nothing is clearly too long or too tight here",
    "tie": "none: it is at a tie",
    "corner": "none: it is at a corner of the panel",
    "spot": "none: it is smaller than two elements",
}
NOT_RESOLVED = "none: the mesh does not resolve this wrinkle"


@dataclass(frozen=True, slots=True, kw_only=True)
class Advice:
    """One correction.

    Parameters
    ----------
    action : "take out" or "let out" of a panel's edge, or "loosen" a pull
    panel : whose edge, or in which the wrinkle is
    seam : of the edge; "" where it is no seam
    place : between which notches, or where on the panel
    amount, scatter : float [m]
    confidence : "high" where the amount is over three times its scatter and one side alone is off
    position : (3,) float64 [m]     the middle of the place in space
    wrinkles : ranks, from 1, of the wrinkles that it is to take away
    sentence : all of it for a reader
    """

    action: Action
    panel: str
    seam: str
    place: str
    amount: float
    scatter: float
    confidence: Confidence
    position: FloatArray
    wrinkles: tuple[int, ...]
    sentence: str


def advise(
    solution: Solution, stretches: Sequence[SeamStretch], wrinkles: Sequence[Wrinkle]
) -> tuple[Advice, ...]:
    """Advise on seams first, the largest excess first, then on wrinkles that no seam explains.

    There is none where the mesh does not resolve what it would rest on, nor at ties and corners.
    """
    seams = sorted(_of_seams(solution, stretches, wrinkles), key=lambda a: -a.amount)
    explained = {rank for advice in seams for rank in advice.wrinkles}
    rest = [
        _of_wrinkle(solution, rank, wrinkle)
        for rank, wrinkle in enumerate(wrinkles, 1)
        if wrinkle.kind == "wrinkle" and wrinkle.resolved and rank not in explained
    ]
    return (*seams, *(advice for advice in rest if advice is not None))


def advice_on(wrinkle: Wrinkle, rank: int, advice: Sequence[Advice]) -> str:
    """Return the sentence for a wrinkle; why there is none where there is none."""
    if wrinkle.kind == "wrinkle" and not wrinkle.resolved:
        return NOT_RESOLVED
    found = [a.sentence for a in advice if rank in a.wrinkles]
    return "; ".join(found) or NONE[wrinkle.kind]


def _of_seams(
    solution: Solution, stretches: Sequence[SeamStretch], wrinkles: Sequence[Wrinkle]
) -> Iterator[Advice]:
    """Advice on seams, neighbouring stretches with the same long side together."""
    level = cover_strain(stretches)
    for (good, *_), group in groupby(
        stretches, key=lambda s: (is_clear(s), s.seam, s.long_panel, s.short_panel)
    ):
        parts = tuple(group)
        if good and sum(s.excess for s in parts) > _SMALLEST:
            yield _on_seam(parts, level, _explained(solution, parts[0], wrinkles))


def _on_seam(parts: Sequence[SeamStretch], level: float, ranks: tuple[int, ...]) -> Advice:
    """Cut the side whose strain is farther from that of the cover; half of each if it is open."""
    seam, long, short = parts[0].seam, parts[0].long_panel, parts[0].short_panel
    amount = sum(s.excess for s in parts)
    scatter = float(np.linalg.norm([s.scatter for s in parts]))
    weight = [s.length for s in parts]
    off_long, off_short = (
        abs(float(np.average(strains, weights=weight)) - level)
        for strains in ([s.long_strain for s in parts], [s.short_strain for s in parts])
    )
    tight = off_short > _CLEAR * off_long
    sided = tight or off_long > _CLEAR * off_short
    panel = short if tight else long
    largest = max(parts, key=lambda s: s.excess)
    at_long, at_short = _edges(largest)
    edge, other_edge = (at_short, at_long) if tight else (at_long, at_short)
    action: Action = "let out" if tight else "take out"
    way = f"let {_mm(amount)} into" if tight else f"take {_mm(amount)} out of"
    half = "" if sided else f", or half of it, and the other half on the edge of {other_edge}"
    place = f"from {parts[0].begin} to {parts[-1].end}"
    return Advice(
        action=action, panel=panel, seam=seam, place=place, amount=amount, scatter=scatter,
        confidence=_confidence(amount, scatter, sided),
        position=largest.middle, wrinkles=ranks,
        sentence=(
            f"seam {seam}, {place}: {at_long} is {_mm(amount, scatter)} longer than {at_short}; "
            f"{way} the edge of {edge}{half}"
        ),
    )  # fmt: skip


def _edges(stretch: SeamStretch) -> tuple[str, str]:
    """How the longer and the shorter edge are said: by panel, and by place where both are of one.

    A panel that closes a tube, or is darted, is sewn to itself: its name does not say which edge.
    """
    names = stretch.long_panel, stretch.short_panel
    if names[0] != names[1]:
        return names
    long, short = (
        f"{name} at pattern u, v = {1e3 * u:.0f}, {1e3 * v:.0f} mm"
        for name, (u, v) in zip(names, (stretch.long_uv, stretch.short_uv), strict=True)
    )
    return long, short


def is_clear(stretch: SeamStretch) -> bool:
    """Whether an excess is resolved, beyond its scatter, and large enough to be cut."""
    return (
        stretch.resolved
        and stretch.excess > stretch.scatter
        and stretch.excess > EQUAL * stretch.length
    )


def cover_strain(stretches: Sequence[SeamStretch]) -> float:
    """Strain that most of the cover's seams have on both sides; 0 without seams."""
    strains = [s.long_strain for s in stretches] + [s.short_strain for s in stretches]
    return float(np.median(strains)) if strains else 0.0


def _explained(
    solution: Solution, stretch: SeamStretch, wrinkles: Sequence[Wrinkle]
) -> tuple[int, ...]:
    """Ranks of the wrinkles beside a seam, on its two panels."""
    seam, panels = stretch.seam, {stretch.long_panel, stretch.short_panel}
    lines = [s.a.at(solution.positions) for s in solution.cover.stitchings if s.name == seam]
    points = np.concatenate(lines)
    return tuple(
        rank
        for rank, w in enumerate(wrinkles, 1)
        if w.kind == "wrinkle"
        and w.panel in panels
        and (w.near == seam or np.linalg.norm(points - w.position, axis=1).min() < _BESIDE)
    )


def _of_wrinkle(solution: Solution, rank: int, wrinkle: Wrinkle) -> Advice | None:
    """Advice on a wrinkle that no seam explains; None where it is none beyond its scatter."""
    stretched = wrinkle.cause == "stretch"
    amount, scatter = _pulled(solution, wrinkle) if stretched else (wrinkle.excess, wrinkle.scatter)
    if not amount > max(scatter, _SMALLEST):
        return None
    u, v = (f"{1e3 * value:.0f}" for value in wrinkle.uv)
    place = f"at pattern u, v = {u}, {v} mm"
    direction = wrinkle.along if stretched else wrinkle.across
    ends = _ends(solution.cover, wrinkle, direction)
    if stretched:
        hooks = [f"{a.kind} {a.name}" for a in solution.cover.anchors if a.name in ends]
        which = hooks[0] if hooks else f"the panel between {' and '.join(ends)}"
        sentence = (
            f"{wrinkle.panel}, {place}: pulled {_mm(amount, scatter)} too far along the wrinkle; "
            f"loosen {which} by {_mm(amount)}, or build the foam up below it"
        )
    else:
        sentence = (
            f"{wrinkle.panel}, {place}: {_mm(amount, scatter)} too much cloth across the wrinkle; "
            f"take {_mm(amount)} out of the panel between {' and '.join(ends)}"
        )
    return Advice(
        action="loosen" if stretched else "take out", panel=wrinkle.panel, seam="", place=place,
        amount=amount, scatter=scatter,
        confidence=_confidence(amount, scatter, sided=wrinkle.cause != "both" and not stretched),
        position=wrinkle.position, wrinkles=(rank,), sentence=sentence,
    )  # fmt: skip


def _pulled(solution: Solution, wrinkle: Wrinkle) -> tuple[float, float]:
    """How much more the panel is stretched along a wrinkle than elsewhere, [m], and its scatter."""
    cover = solution.cover
    panel = cover.panel == cover.panel_names.index(wrinkle.panel)
    green = np.einsum("i,fij,j->f", wrinkle.along, solution.strain_mid, wrinkle.along)
    strain = np.sqrt(1.0 + 2.0 * green) - 1.0
    off = cover.rest[cover.faces].mean(axis=1) - wrinkle.rest
    near = panel & (np.abs(off @ wrinkle.along) < 0.5 * wrinkle.length)
    near &= np.abs(off @ wrinkle.across) < wrinkle.width
    more = strain[near] - np.median(strain[panel])
    if len(more) < 2:
        return 0.0, np.inf
    error = float(more.std(ddof=1) / np.sqrt(len(more)))
    return wrinkle.length * float(more.mean()), 2.0 * wrinkle.length * error


def _ends(cover: Cover, wrinkle: Wrinkle, direction: FloatArray) -> tuple[str, ...]:
    """Name what a line through a wrinkle meets at the two borders of its panel."""
    owner = owners(cover)
    panel = cover.panel_names.index(wrinkle.panel)
    lines: list[tuple[str, Points]] = [
        (f"the edge to {cover.panel_names[owner[far.vertices[0, 0]]]}", side)
        for s in cover.stitchings
        for side, far in ((s.a, s.b), (s.b, s.a))
    ]
    lines += [(a.name, a.points) for a in cover.anchors]
    found = []
    for sign in (-1.0, 1.0):
        best = min(
            (
                (_off_axis(points.at(cover.rest) - wrinkle.rest, sign * direction), name)
                for name, points in lines
                if len(points) and owner[points.vertices[0, 0]] == panel
            ),
            default=(np.inf, ""),
        )
        found.append(best[1] if np.isfinite(best[0]) else "its free edge")
    return tuple(dict.fromkeys(found))


def _off_axis(off: FloatArray, direction: FloatArray) -> float:
    """Sine of the angle from a direction to the point (k, 2) that is nearest to it."""
    ahead = off @ direction
    size = np.linalg.norm(off, axis=1)
    return float(np.where(ahead > 0, 1.0 - ahead / np.maximum(size, 1e-9), np.inf).min())


def _confidence(amount: float, scatter: float, sided: bool) -> Confidence:
    if amount > _SURE * scatter:
        return "high" if sided else "medium"
    return "medium" if sided else "low"


def _mm(amount: float, scatter: float | None = None) -> str:
    """Write a length, to a tenth of a millimetre."""
    doubt = "" if scatter is None else f" ± {1e3 * scatter:.1f}"
    return f"{1e3 * amount:.1f}{doubt} mm"
