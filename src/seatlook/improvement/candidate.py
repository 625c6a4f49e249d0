"""What may be changed: edges between notches, lengths of edges, hooks, the height of the foam."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal

import numpy as np

from seatlook.errors import InputError
from seatlook.improvement.cutting.outline import Outline, Side
from seatlook.model import Cover, FloatArray, Scene
from seatlook.model.scene import Freedom

Kind = Literal["offset", "length", "hook", "foam", "wire"]
# [m] between points of an edge that may move each on its own, where it has no notches.
SPACING = 0.06


@dataclass(frozen=True, slots=True, kw_only=True)
class Candidate:
    """One thing that may be changed by an amount [m].

    Parameters
    ----------
    kind : "offset" of a stretch of an edge, outward above 0; "length" of an edge; "hook", deeper
        above 0; "foam" below a panel, higher above 0
    name : of the edge, the hook or the panel
    panel : index of the panel; -1 for a hook
    number : of the side in its outline, and of the stretch in it; -1 where there is none
    """

    kind: Kind
    name: str
    panel: int = -1
    side: int = -1
    stretch: int = -1


def limits_of(freedom: Freedom) -> dict[Kind, float]:
    """Largest amount [m] of every kind."""
    return {
        "offset": freedom.edge,
        "length": freedom.length,
        "hook": freedom.hook,
        "wire": freedom.hook,
        "foam": freedom.foam,
    }


def frozen_names(scene: Scene) -> frozenset[str]:
    """Names that stay, those of the edges of frozen seams among them."""
    names = set(scene.improve.frozen)
    sewn = [{seam.a, *seam.b} for seam in scene.pattern.seams if seam.name in names]
    return frozenset(names.union(*sewn))


def free_candidates(
    scene: Scene, candidates: Sequence[Candidate], limits: Mapping[Kind, float]
) -> tuple[Candidate, ...]:
    """List candidates that are not frozen, neither by name nor by a limit of 0.

    Raises
    ------
    InputError
        None is left.
    """
    frozen = frozen_names(scene)
    free = tuple(c for c in candidates if c.name not in frozen and limits[c.kind] > 0.0)
    if not free:
        raise InputError.single(
            "improve", got="all frozen", expected="something that may change", file=scene.path
        )
    return free


def candidates_of(cover: Cover, outlines: Sequence[Outline]) -> tuple[Candidate, ...]:
    """List all that can be changed of a cover."""
    return tuple(_all(cover, outlines))


def _all(cover: Cover, outlines: Sequence[Outline]) -> Iterator[Candidate]:
    for outline in outlines:
        for number, side in enumerate(outline.sides):
            if not side.edge:
                continue
            place = {"name": side.edge, "panel": outline.panel, "side": number}
            for stretch in range(len(stops_of(side)) - 1):
                yield Candidate(kind="offset", stretch=stretch, **place)  # type: ignore[arg-type]
            yield Candidate(kind="length", **place)  # type: ignore[arg-type]
    for anchor in cover.anchors:
        if anchor.kind == "hook":
            yield Candidate(kind="hook", name=anchor.name)
    if cover.foam is not None:
        for panel, name in enumerate(cover.panel_names):
            yield Candidate(kind="foam", name=name, panel=panel)


def stops_of(side: Side) -> FloatArray:
    """Places [m] between which a side moves as one: ends, notches, and even steps between them."""
    parts = [
        np.linspace(a, b, max(1, round((b - a) / (1.5 * SPACING))) + 1)[:-1]
        for a, b in pairwise(side.stops)
    ]
    return np.append(np.concatenate(parts), side.length)


def share_of(side: Side, stretch: int, arc: FloatArray) -> FloatArray:
    """How much of the offset of a stretch is felt at lengths ``arc`` (k,) along a side, 0 to 1.

    Neighbouring stretches fade into each other, so that all of them together are a parallel line.
    """
    stops = stops_of(side)
    share = np.ones_like(arc)
    for at, sign in ((stretch, 1.0), (stretch + 1, -1.0)):
        if 0 < at < len(stops) - 1:
            width = 0.5 * min(stops[at] - stops[at - 1], stops[at + 1] - stops[at], SPACING)
            t = np.clip(0.5 + 0.5 * sign * (arc - stops[at]) / width, 0.0, 1.0)
            share *= t * t * (3.0 - 2.0 * t)
    return share


def words_of(side: Side, first: int, last: int) -> tuple[str, str]:
    """Say where a run of stretches of a side begins and ends."""
    stops = stops_of(side)
    return _place(side, stops[first]), _place(side, stops[last + 1])


def _place(side: Side, at: float) -> str:
    if at <= 0.0:
        return "its beginning"
    if at >= side.length:
        return "its end"
    near = np.flatnonzero(np.isclose(side.notches, at, atol=1e-6))
    return f"notch {near[0] + 1}" if len(near) else f"{1e3 * at:.0f} mm"


def outline_way(outline: Outline, candidate: Candidate) -> FloatArray:
    """How the vertices of an outline move for an amount of 1, (r, 2) [1]."""
    if candidate.kind == "length":
        return outline.lengthen(candidate.side)
    side = outline.sides[candidate.side]
    return outline.offset(candidate.side, lambda arc: share_of(side, candidate.stretch, arc))
