"""The files of a seat that seatlook brings along: design, foam, wires, pattern, seams, scene."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import TypedDict, Unpack

from seatlook import io
from seatlook.chain.start.scene_file import CURVES, SCENE
from seatlook.chain.start.surface import flatten_scene
from seatlook.flattening.files import PANELS, PATTERN, PLACEMENT, SEAMS, write_panels
from seatlook.model.progress import Progress, silent
from seatlook.seats.cushion import Cushion
from seatlook.seats.demo import demo_design, demo_foam_mesh
from seatlook.seats.family import shaped
from seatlook.seats.meshing import cut_lines, design_surface, foam_mesh

DESIGN, FOAM, WIRES, LINES = "design.obj", "foam.obj", "wires.toml", "lines.toml"
LEFT = (DESIGN, FOAM, WIRES, LINES, PATTERN, SEAMS, PLACEMENT, PANELS, CURVES, SCENE)


class DemoChoices(TypedDict, total=False):
    """How the demo seat is made.

    ``shape`` of the family, its ``scale`` and the height of its ``bolster`` [m], None for the
    shape's own; ``ease``: seam -> share by which one line is longer; ``short``: panel -> share by
    which it is narrower across its grain; ``tension``: share by which all panels are smaller;
    ``material``, and ``insert`` for the middle panels: supplied names; ``element_size_mm``,
    or ``tolerance_percent`` instead, ``seed``; ``surface_size`` [m]: edge length of design surface
    and foam, which stay the same however the cover is meshed; 6 mm for the demo, else 8 mm times
    the scale; ``progress`` is called panel by panel.
    """

    shape: str
    scale: float
    bolster: float | None
    ease: Mapping[str, float]
    short: Mapping[str, float]
    tension: float
    material: str
    insert: str | None
    element_size_mm: float
    tolerance_percent: float | None
    seed: int
    surface_size: float
    progress: Progress


def write_demo(out: Path | str, **choices: Unpack[DemoChoices]) -> Path:
    """Write the files of a seat with a pattern that fits it; return its scene.

    Raises
    ------
    InputError
        A shape, material, seam or panel that does not exist; a size out of bounds.
    """
    folder, tension = Path(out), choices.get("tension", 0.01)
    material = choices.get("material", "leather-laminate")
    insert = choices.get("insert") or material
    nothing: Mapping[str, float] = MappingProxyType({})
    ease, short = choices.get("ease", nothing), choices.get("short", nothing)
    thickness = io.read_material(material).fabric.thickness
    io.read_material(insert)
    middle, seat = _write_shape(folder, thickness, choices)
    spoiled = [*(f"ease {k} {v:.1%}" for k, v in ease.items()),
               *(f"short {k} {v:.1%}" for k, v in short.items())]  # fmt: skip
    lines, wires = folder / LINES, folder / WIRES
    _, made = flatten_scene(
        folder / DESIGN,
        folder / FOAM,
        folder,
        flattening={
            "tension": tension,
            "ease": ease,
            "short": short,
            "seam_lines": lines if lines.exists() else None,
            "progress": choices.get("progress", silent),
        },
        wires=wires if wires.exists() else None,
        name=", ".join(["demo seat", *spoiled]),
        material=material,
        panels=dict.fromkeys(middle, insert),
        element_size_mm=choices.get("element_size_mm", 7.0),
        tolerance_percent=choices.get("tolerance_percent"),
        seed=choices.get("seed", 0),
        textures=("black-leather", "bright-leather", "suede"),
        force=True,
        bulbs=("bulb left", "bulb right"),
        remarks=(
            seat,
            f"Its cover is cut {100 * tension:g} % smaller than the foam asks so that it is taut.",
            *(f"Spoiled on purpose: {what}." for what in spoiled),
        ),
    )
    return made.scene


def _write_shape(
    folder: Path, thickness: float, choices: DemoChoices
) -> tuple[tuple[str, ...], str]:
    """Write design surface, foam, wires and lines; return the middle panels and what it is."""
    name, scale = choices.get("shape", "cushion"), choices.get("scale", 1.0)
    form = shaped(name, scale, choices.get("bolster"))
    usual = form == Cushion()
    size = choices.get("surface_size", 0.006 if usual else 0.008 * scale)
    if usual:
        surface = demo_design(element_size=size)
        foam = demo_foam_mesh(element_size=size, cover_thickness=thickness)
        seat = "The demo seat: a car-seat cushion about 0.5 m wide, with two bolsters."
    else:
        surface = design_surface(form, element_size=size)
        foam = foam_mesh(form, element_size=size, cover_thickness=thickness)
        seat = f"A demo seat: {name}, {scale:g} times its usual size."
    write_panels(surface, folder / DESIGN)
    io.write_obj(foam.vertices, foam.faces, folder / FOAM)
    tied = {wire: foam.curves[wire] for wire in form.drawing().wires}
    for file, curves in ((WIRES, tied), (LINES, cut_lines(form, element_size=size))):
        if curves:
            io.write_curves(curves, folder / file)
        else:  # one of another shape, written here before
            (folder / file).unlink(missing_ok=True)
    inserts = tuple(panel for panel in surface.panel_names if panel.startswith("INSERT"))
    return inserts or surface.panel_names[:1], seat
