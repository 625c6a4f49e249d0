"""Seams that turn a panel inside out, whose ties cross, or whose partners are exchanged."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations

import numpy as np

from seatlook.assembly.contradictions.contradiction import (
    Contradiction,
    Lines,
    gap_between,
    place_text,
)
from seatlook.assembly.sewn_surface import (
    WIDEST_POINT,
    SewnSurface,
    alike,
    exchanged,
    sewn_surface,
)
from seatlook.mesh import arc_length, edges
from seatlook.model import Cover, FloatArray, Panel, Points, Scene, Stitching

TWISTED = 0.95  # gap of a seam with one side turned round, over its gap; 1.15 and more on the demo
EXCHANGED = 0.5  # gap of two seams with exchanged partners, over their gap
FALLEN_APART = 0.8  # the same, where the cover is in fewer pieces with exchanged partners
_APART = 0.050  # m, mean gap from which partners can be exchanged
_SHARES = np.linspace(0.0, 1.0, 11)  # of a seam's length, where gaps are measured
_MIDDLE = len(_SHARES) // 2

Sides = tuple[FloatArray, FloatArray]  # places (11, 3) along both sides of a seam


def wrong_seams(lines: Lines, scene: Scene, cover: Cover) -> Iterator[Contradiction]:
    """Seams that turn a panel inside out or whose ties cross, and pairs that want to change."""
    sides = [(_at_shares(s, s.a, cover), _at_shares(s, s.b, cover)) for s in cover.stitchings]
    gaps = [gap_between(a, b) for a, b in sides]
    seams = scene.pattern.seams
    for number, (seam, (a, b), gap) in enumerate(zip(seams, sides, gaps, strict=True)):
        turned = gap_between(a, b[::-1])
        crossed = turned < TWISTED * gap
        if crossed or not seam.reverse:
            way = "whose ties cross" if crossed else "which turns a panel inside out"
            yield lines.seam(
                "twisted seam",
                number,
                [a[0], b[0]],
                f"{seam.name!r}, {way}: {1e3 * gap:.0f} mm from side to side, and "
                f"{1e3 * turned:.0f} mm with one side turned round ({place_text(a[0])} is sewn to "
                f"{place_text(b[0])})",
                "sides that run the same way: exchange from and to, or reverse",
            )
    certain, likely = (
        {(seams.index(one), seams.index(two)) for one, two in pairs}
        for pairs in exchanged(scene.pattern, _handles(scene))
    )
    for i, j in combinations(range(len(sides)), 2):
        other = _nearer(sides[i][0], sides[j][1]) + _nearer(sides[j][0], sides[i][1])
        gap = gaps[i] + gaps[j]
        nearer = other < EXCHANGED * gap or ((i, j) in likely and other < FALLEN_APART * gap)
        far = gap > 2 * _APART and nearer and alike(scene.pattern, seams[i], seams[j])
        if far or (i, j) in certain:
            why = "; sewn so, the panels make no cover" if (i, j) in certain else ""
            one, two = sides[i][0][_MIDDLE], sides[j][0][_MIDDLE]
            yield lines.seam(
                "exchanged seams",
                i,
                [one, two],
                f"{seams[i].name!r} and {seams[j].name!r}, {1e3 * gaps[i]:.0f} and "
                f"{1e3 * gaps[j]:.0f} mm from side to side at {place_text(one)} and "
                f"{place_text(two)}; with each other's partners {1e3 * other / 2:.0f} mm{why}",
                "each edge sewn to the partner beside it",
            )
    if not (certain or (surface := sewn_surface(scene.pattern, seams)).covers(_handles(scene))):
        yield _no_cover(lines, scene, cover, surface, sides)


def _no_cover(
    lines: Lines, scene: Scene, cover: Cover, surface: SewnSurface, sides: Sequence[Sides]
) -> Contradiction:
    """Seams that no exchange of two partners makes a cover of."""
    seams = scene.pattern.seams
    if surface.handles > _handles(scene):
        number = int(np.argmax([gap_between(a, b) for a, b in sides]))
        places = [side[_MIDDLE] for side in sides[number]]
        here, there = map(place_text, places)
        count = f"{surface.handles} handle{'s' if surface.handles > 1 else ''}"
        what = (
            f"panels that make a surface with {count}; the seam whose sides are farthest apart is "
            f"{seams[number].name!r}, from {here} to {there}"
        )
    else:
        meeting, angle = max(surface.points, key=lambda point: point[1])
        corners = sorted(meeting)
        places = [_at_outline(scene.pattern.panel(name), at, cover) for name, at in corners]
        ends = [[side[k] for side in pair for k in (0, -1)] for pair in sides]
        away = [np.linalg.norm(np.subtract(rows, places[0]), axis=1).min() for rows in ends]
        number = int(np.argmin(away))
        listed = ", ".join(
            f"{name} at {place_text(place)}"
            for (name, _), place in zip(corners, places, strict=True)
        )
        what = f"{np.degrees(angle):.0f} degrees at the point where these meet: {listed}"
    return lines.seam(
        "exchanged seams",
        number,
        places,
        what,
        f"none, and at most {np.degrees(WIDEST_POINT):.0f} degrees: each edge sewn to its partner",
    )


def _handles(scene: Scene) -> int:
    """Handles of the foam, such as 1 of a ring; a cover of it may have as many."""
    faces = scene.foam.faces
    return 1 - (len(np.unique(faces)) - len(edges(faces)) + len(faces)) // 2


def _at_outline(panel: Panel, at: float, cover: Cover) -> FloatArray:
    """Place (3,) on the cover as it starts of an arc length along a panel's outline."""
    ring = np.vstack([panel.outline, panel.outline[:1]])
    way = arc_length(ring)
    place = np.array([[np.interp(at % way[-1], way, column) for column in ring.T]])
    own = np.unique(cover.faces[cover.panel == cover.panel_names.index(panel.name)])
    away = np.linalg.norm(cover.rest[own] - panel.in_grain(place), axis=1)
    return np.asarray(cover.positions[own[away.argmin()]])


def _at_shares(seam: Stitching, side: Points, cover: Cover) -> FloatArray:
    """Places (11, 3) at equal shares of a seam's side, as it starts."""
    places = side.at(cover.positions)
    share = np.cumsum(seam.length) - 0.5 * seam.length
    share = (share - share[0]) / (share[-1] - share[0])
    return np.column_stack([np.interp(_SHARES, share, column) for column in places.T])


def _nearer(a: FloatArray, b: FloatArray) -> float:
    """Gap of two lines, run through the better way round."""
    return min(gap_between(a, b), gap_between(a, b[::-1]))
