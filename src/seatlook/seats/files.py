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
from seatlook.seats.demo import demo_design, demo_foam_mesh

DESIGN, FOAM, WIRES = "design.obj", "foam.obj", "wires.toml"
LEFT = (DESIGN, FOAM, WIRES, PATTERN, SEAMS, PLACEMENT, PANELS, CURVES, SCENE)


class DemoChoices(TypedDict, total=False):
    """How the demo seat is made.

    ``ease``: seam -> share by which one line is longer; ``short``: panel -> share by which it is
    narrower across its grain; ``tension``: share by which all panels are smaller; ``material``,
    and ``insert`` for the middle panel: supplied names; ``element_size_mm``, ``seed``;
    ``surface_size`` [m]: edge length of design surface and foam, which stay the same however the
    cover is meshed.
    """

    ease: Mapping[str, float]
    short: Mapping[str, float]
    tension: float
    material: str
    insert: str | None
    element_size_mm: float
    seed: int
    surface_size: float


def write_demo(out: Path | str, **choices: Unpack[DemoChoices]) -> Path:
    """Write the files of a seat cushion with a pattern that fits it; return its scene.

    Raises
    ------
    InputError
        A material, seam or panel that does not exist.
    """
    folder, size = Path(out), choices.get("surface_size", 0.006)
    material = choices.get("material", "leather-laminate")
    insert, tension = choices.get("insert") or material, choices.get("tension", 0.01)
    nothing: Mapping[str, float] = MappingProxyType({})
    ease, short = choices.get("ease", nothing), choices.get("short", nothing)
    thickness = io.read_material(material).fabric.thickness
    io.read_material(insert)
    foam = demo_foam_mesh(element_size=size, cover_thickness=thickness)
    write_panels(demo_design(element_size=size), folder / DESIGN)
    io.write_obj(foam.vertices, foam.faces, folder / FOAM)
    wires = {name: foam.curves[name] for name in ("trench_left", "trench_right")}
    io.write_curves(wires, folder / WIRES)
    spoiled = [*(f"ease {k} {v:.1%}" for k, v in ease.items()),
               *(f"short {k} {v:.1%}" for k, v in short.items())]  # fmt: skip
    _, made = flatten_scene(
        folder / DESIGN,
        folder / FOAM,
        folder,
        flattening={"tension": tension, "ease": ease, "short": short},
        wires=folder / WIRES,
        name=", ".join(["demo seat", *spoiled]),
        material=material,
        panels={"INSERT": insert},
        element_size_mm=choices.get("element_size_mm", 7.0),
        seed=choices.get("seed", 0),
        textures=("black-leather", "bright-leather", "suede"),
        force=True,
        bulbs=("bulb left", "bulb right"),
        remarks=(
            "The demo seat: a car-seat cushion about 0.5 m wide, with two bolsters.",
            f"Its cover is cut {100 * tension:g} % smaller than the foam asks so that it is taut.",
            *(f"Spoiled on purpose: {what}." for what in spoiled),
        ),
    )
    return made.scene
