"""The files of a seat that seatlook brings along: design, foam, wires, pattern, seams, scene."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import TypedDict, Unpack

from seatlook import io
from seatlook.flattening import flatten
from seatlook.flattening.files import placement_tables, write_flat_pattern, write_panels
from seatlook.io.templates import write_template
from seatlook.seats.demo import demo_design, demo_foam_mesh

SCENE = "scene.toml"
LEFT = ("design.obj", "foam.obj", "wires.toml", "pattern.dxf", "seams.toml", SCENE)
_TEMPLATE = Path(__file__).with_name("demo_scene.toml.j2")


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
    surface = demo_design(element_size=size)
    flat = flatten(surface, tension=tension, ease=ease, short=short)
    foam = demo_foam_mesh(element_size=size, cover_thickness=thickness)
    write_panels(surface, folder / "design.obj")
    io.write_obj(foam.vertices, foam.faces, folder / "foam.obj")
    io.write_curves(foam.curves, folder / "wires.toml")
    write_flat_pattern(flat, folder)
    write_template(
        _TEMPLATE,
        folder / SCENE,
        material=material,
        insert=insert,
        element_size_mm=choices.get("element_size_mm", 7.0),
        seed=choices.get("seed", 0),
        tension=tension,
        placement=placement_tables(flat.placement),
        spoiled=[*(f"ease {k} {v:.1%}" for k, v in ease.items()),
                 *(f"short {k} {v:.1%}" for k, v in short.items())],
    )  # fmt: skip
    return folder / SCENE
