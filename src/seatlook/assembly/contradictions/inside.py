"""Panels and frame curves that lie in the foam."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from seatlook.assembly.contradictions.contradiction import Contradiction, Lines, place_text
from seatlook.mesh.closest import closest_places
from seatlook.model import Cover, FloatArray, Foam, Scene
from seatlook.solver.foam.distance import DistanceField

DEEPEST_CURVE = 0.010  # m: a cover that is held deeper counts as buried
DEEPEST_START, INSIDE = 0.020, 0.2  # m; share of a panel that may start deeper


def starts_inside(
    lines: Lines, cover: Cover, foam: Foam, field: DistanceField
) -> Iterator[Contradiction]:
    """Panels that start inside the foam."""
    depth = -field.at(cover.positions)[0][cover.faces].mean(axis=1)
    for number, name in enumerate(cover.panel_names):
        own = cover.panel == number
        area = cover.rest_area[own]
        share = float(area[depth[own] > DEEPEST_START].sum() / area.sum())
        if share > INSIDE:
            place = cover.positions[cover.faces[own][np.argmax(depth[own])]].mean(axis=0)
            surface = _on_surface(place, foam)
            yield lines.problem(
                "start inside",
                ("placement", name),
                [place, surface],
                f"{100 * share:.0f} % of the panel more than {1e3 * DEEPEST_START:g} mm inside the "
                f"foam, {1e3 * depth[own].max():.0f} mm at {place_text(place)}, where its surface "
                f"is at {place_text(surface)}",
                f"at most {100 * INSIDE:g} %",
            )


def curves_inside(
    lines: Lines, scene: Scene, cover: Cover, field: DistanceField
) -> Iterator[Contradiction]:
    """Frame curves that run through the foam; wires are looked at when the scene is read."""
    curve = {frame.name: frame.curve for frame in scene.frames}
    for anchor in cover.anchors:
        depth = -field.at(anchor.target)[0]
        if anchor.kind == "frame" and depth.max() > DEEPEST_CURVE:
            place = anchor.target[np.argmax(depth)]
            surface = _on_surface(place, scene.foam)
            yield lines.problem(
                "curve inside",
                (*lines.tie(anchor), "curve"),
                [place, surface],
                f"{curve[anchor.name]!r}, {1e3 * depth.max():.0f} mm inside the foam at "
                f"{place_text(place)}, where its surface is at {place_text(surface)}",
                f"a curve outside, or at most {1e3 * DEEPEST_CURVE:g} mm inside",
            )


def _on_surface(place: FloatArray, foam: Foam) -> FloatArray:
    """Place (3,) of the foam's surface nearest to one inside."""
    on = closest_places(place[None], foam.vertices, foam.faces, reach=np.inf)
    return np.asarray(place - on.offset[0])
