"""The pattern as the page draws it: panels, edges, seams on both sides, guesses; in mm."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Sequence
from typing import Any, Literal

import numpy as np

from seatlook.assembly.ease import notches_on, seam_ease
from seatlook.assembly.seam_guess import Proposal, propose_seams
from seatlook.mesh import arc_length
from seatlook.model import Edge, FloatArray, Panel, Pattern, Seam
from seatlook.report.assembly_picture import SEAM_COLOURS

Values = dict[str, Any]
_DIGITS = 6  # of a mm, as seams files are written


def millimetres(points: FloatArray) -> list[Any]:
    """Places [m] as lists of mm."""
    rounded: list[Any] = (np.round(1e3 * points, _DIGITS) + 0.0).tolist()
    return rounded


def pattern_values(pattern: Pattern) -> Values:
    """Panels with their edges."""
    return {"units": "mm", "panels": [_panel(pattern, panel) for panel in pattern.panels]}


def _panel(pattern: Pattern, panel: Panel) -> Values:
    same = panel.cut_outline.shape == panel.outline.shape and np.array_equal(
        panel.cut_outline, panel.outline
    )
    middle, reach = panel.outline.mean(axis=0), 0.2 * np.ptp(panel.outline, axis=0).max()
    edges = [edge for edge in pattern.edges.values() if edge.panel == panel.name]
    return {
        "name": panel.name,
        "outline_mm": millimetres(panel.outline),
        "corners_mm": millimetres(panel.outline[panel.corners]),
        "cut_mm": None if same else millimetres(panel.cut_outline),
        "grain_mm": millimetres(middle + np.outer([-reach, reach], panel.grain)),
        "holes_mm": [millimetres(hole) for hole in panel.holes],
        "lines": [
            {"name": f"{panel.name}/{name}", "points_mm": millimetres(line)}
            for name, line in panel.internal_lines.items()
        ],
        "edges": [_edge(pattern, edge) for edge in edges],
    }


def _edge(pattern: Pattern, edge: Edge) -> Values:
    points = pattern.edge_points(edge.name)
    way, at = arc_length(points), notches_on(pattern, edge.name)
    places = np.column_stack([np.interp(at, way, column) for column in points.T])
    return {
        "name": edge.name,
        "points_mm": millimetres(points),
        "length_mm": round(1e3 * float(way[-1]), 3),
        "from": millimetres(points[0]),
        "to": millimetres(points[-1]),
        "notches": [
            {"at_mm": round(1e3 * float(a), 3), "point_mm": millimetres(place)}
            for a, place in zip(at, places, strict=True)
        ],
    }


def seam_values(pattern: Pattern) -> list[Values]:
    """Seams, numbered from 1, with both sides in the order in which they meet."""
    return [_seam(pattern, seam, k) for k, seam in enumerate(pattern.seams, start=1)]


def _seam(pattern: Pattern, seam: Seam, number: int) -> Values:
    ease = seam_ease(pattern, seam)
    colour = SEAM_COLOURS[(number - 1) % len(SEAM_COLOURS)]
    return {
        "name": seam.name,
        "number": number,
        "colour": "#{:02x}{:02x}{:02x}".format(*colour),
        "first": side_values(pattern, (seam.a,), reverse=False),
        "second": side_values(pattern, seam.b, reverse=seam.reverse),
        "reverse": seam.reverse,
        "pitch_mm": round(1e3 * seam.pitch, 6),
        "ease_percent": round(100 * ease.share, 3),
        "lengths_mm": [round(1e3 * ease.length_a, 3), round(1e3 * ease.length_b, 3)],
        "notches_matched": ease.matched,
        "kind": seam_kind(pattern, seam),
    }


def side_values(pattern: Pattern, edges: Sequence[str], *, reverse: bool) -> Values:
    """One side of a seam, run through as it meets the other one."""
    parts = _parts(pattern, edges, reverse=reverse)
    return {
        "panel": pattern.edges[edges[0]].panel,
        "edges": list(edges),
        "from_mm": millimetres(parts[0][0]),
        "to_mm": millimetres(parts[-1][-1]),
    }


def _parts(pattern: Pattern, edges: Sequence[str], *, reverse: bool) -> list[FloatArray]:
    return [pattern.edge_points(name)[:: -1 if reverse else 1] for name in edges]


def seam_kind(pattern: Pattern, seam: Seam) -> Literal["seam", "chain", "dart", "tube"]:
    """What is sewn: two edges, a chain, the two sides of a dart, or a panel to itself."""
    if len(seam.b) > 1:
        return "chain"
    a, b = pattern.edges[seam.a], pattern.edges[seam.b[0]]
    if a.panel != b.panel:
        return "seam"
    return "dart" if {a.start, a.end} & {b.start, b.end} else "tube"


def guess_values(pattern: Pattern, refused: Iterable[str]) -> list[Values]:
    """Seams that could be, of stretches that are not sewn yet, most probable first."""
    sewn = {name for seam in pattern.seams for name in (seam.a, *seam.b)}
    taken = [stretch for name in sewn for stretch in steps_of(pattern, name)]
    if len(set(taken)) == sum(len(panel.outline) for panel in pattern.panels):
        return []
    proposal, left_out = propose_seams(pattern.panels), {*refused}
    guesses = [
        guess
        for guess in _guesses(proposal)
        if guess["id"] not in left_out and not {*guess.pop("steps")} & {*taken}
    ]
    return sorted(guesses, key=lambda guess: -guess["probability"])


def steps_of(pattern: Pattern, edge: str) -> list[tuple[str, int]]:
    """Steps of a panel's outline that an edge runs along, each by its first vertex."""
    own = pattern.edges[edge]
    n = len(pattern.panel(own.panel).outline)
    return [(own.panel, (own.start + k) % n) for k in range((own.end - own.start) % n or n)]


def _guesses(proposal: Proposal) -> Iterable[Values]:
    for seam in proposal.pattern.seams:
        rivals = list(proposal.rivals.get(seam.name, ()))
        reason = proposal.reasons[seam.name].partition(": ")[2]
        sure = proposal.probabilities[seam.name]
        yield _guess(proposal.pattern, seam.name, ((seam.a,), seam.b), sure, reason, rivals)
    for doubt in proposal.doubtful:
        sides = tuple(doubt.a.split(" + ")), doubt.b
        name = "-".join(dict.fromkeys(proposal.pattern.edges[e].panel for s in sides for e in s))
        yield _guess(
            proposal.pattern, name, sides, doubt.probability, "not sure", list(doubt.rivals)
        )


def _guess(
    pattern: Pattern,
    name: str,
    sides: tuple[Sequence[str], Sequence[str]],
    probability: float,
    reason: str,
    rivals: list[str],
) -> Values:
    first, second = (
        side_values(pattern, edges, reverse=reverse)
        | {"points_mm": [millimetres(part) for part in _parts(pattern, edges, reverse=reverse)]}
        for edges, reverse in zip(sides, (False, True), strict=True)
    )
    places = repr([first["panel"], first["points_mm"], second["panel"], second["points_mm"]])
    return {
        "id": "g" + hashlib.sha256(places.encode()).hexdigest()[:12],
        "name": name,
        "first": first,
        "second": second,
        "lengths_mm": [
            round(1e3 * sum(pattern.edge_length(name) for name in side), 3) for side in sides
        ],
        "probability": round(probability, 3),
        "reason": reason,
        "rivals": rivals,
        "steps": [step for side in sides for name in side for step in steps_of(pattern, name)],
    }
