"""All contradictions of a scene, of every kind."""

from __future__ import annotations

from collections.abc import Iterable

from seatlook.assembly.contradictions.contradiction import Contradiction, Lines
from seatlook.assembly.contradictions.inside import curves_inside, starts_inside
from seatlook.assembly.contradictions.seams import wrong_seams
from seatlook.assembly.contradictions.ties import far_hooks, ties_apart
from seatlook.errors import InputError
from seatlook.mesh import face_areas
from seatlook.model import Cover, Scene
from seatlook.solver.foam.distance import distance_field

LARGEST, SMALLEST = 4.0, 0.01  # area of the panels over that of the foam; .55 on the demo


def contradictions(scene: Scene, cover: Cover) -> tuple[Contradiction, ...]:
    """Find what a solve could not mend and the scene does not allow.

    These are ties that send one point to two places, a hook far from its wire, a curve through the
    foam, panels that start inside the foam, seams twisted or exchanged.
    """
    lines = Lines(scene)
    found = list(wrong_seams(lines, scene, cover))
    found += ties_apart(lines, cover)
    if cover.foam is not None:
        field = distance_field(cover.foam.vertices, cover.foam.faces)
        found += starts_inside(lines, cover, cover.foam, field)
        found += curves_inside(lines, scene, cover, field)
        found += far_hooks(lines, scene, cover)
    return tuple(one for one in found if one.name not in scene.allowed)


def out_of_scale(scene: Scene) -> tuple[Contradiction, ...]:
    """Find a pattern that is far too large or small for the foam, if the scene does not allow it.

    It is looked at before the cover is meshed, which would take too long.
    """
    lines, foam = Lines(scene), face_areas(scene.foam.vertices, scene.foam.faces).sum()
    area = sum(panel.area for panel in scene.pattern.panels)
    ratio = float(area / foam)
    if "scale" in scene.allowed or SMALLEST <= ratio <= LARGEST:
        return ()
    return (
        lines.problem(
            "scale",
            ("pattern", "file"),
            [],
            f"panels of {1e4 * area:.4g} cm2, {ratio:.3g} times the foam's area",
            f"{SMALLEST:g} to {LARGEST:g} times: is one of them in another unit?",
        ),
    )


def refuse(found: Iterable[Contradiction]) -> None:
    """Refuse contradictions, all of them at once.

    Raises
    ------
    InputError
        There is one; each with file, line and both places.
    """
    problems = [one.problem for one in found]
    if problems:
        raise InputError(problems)
