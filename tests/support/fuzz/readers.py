"""The readers whose lines are counted while files of their formats are damaged."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Reader:
    """What reads some formats.

    Parameters
    ----------
    modules : of seatlook, whose lines are counted; a name that ends in / is a whole folder
    entries : names of the functions to begin with
    """

    modules: tuple[str, ...]
    entries: tuple[str, ...]


TOML = ("io/toml", "io/schema")
READERS: dict[str, Reader] = {
    "scene": Reader(("io/scene/", *TOML), ("load_scene",)),
    "seams": Reader(("io/pattern/seams", "io/pattern/allowance"), ("read_seams",)),
    "curves": Reader(("io/curves",), ("read_curves",)),
    "material": Reader(("io/material", "io/colour"), ("read_material", "read_foam_material")),
    "tests": Reader(("io/laboratory/",), ("read_laboratory",)),
    "sweep": Reader(("io/sweep",), ("read_sweep",)),
    "votes": Reader(("jury/votes",), ("merge_votes",)),
    "result": Reader(
        ("io/export/result", "io/export/film", "io/npz"), ("read_result", "read_shapes")
    ),
    "surface": Reader(("io/surface/",), ("read_foam", "read_surface")),
    "DXF": Reader(
        ("io/pattern/dxf", "io/pattern/flat", "io/pattern/mirror", "io/pattern/report",
         "io/pattern/units", "io/pattern/drawing/", "io/pattern/pieces/"), ("read_dxf",)
    ),
    "d3plot": Reader(
        ("io/lsdyna/d3plot/", "io/lsdyna/element_tables"), ("read_d3plot",)
    ),
    "deck": Reader(("io/lsdyna/deck/", "io/lsdyna/element_tables"), ("read_keyword",)),
    "fabric card": Reader(
        ("io/lsdyna/fabric_deck", "io/lsdyna/fabric_card"), ("read_fabric_card", "material_of")
    ),
    "texture maps": Reader(("io/texture_maps",), ("read_texture_maps",)),
    "panorama": Reader(("io/panorama", "exr"), ("read_panorama", "read_exr")),
}  # fmt: skip
