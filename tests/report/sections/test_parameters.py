"""The parameter tables show the numbers of a scene as its files write them."""

from __future__ import annotations

import tomllib
from dataclasses import replace
from types import MappingProxyType

import numpy as np

from seatlook.model import Appearance, Curve, TextureMaps
from seatlook.report.sections.parameters import parameter_tables, parameter_toml
from support import scenes


def rows(table):
    return {key: (value, source) for key, value, source in table.rows}


def test_values_are_in_the_units_of_the_files():
    scene = scenes.two_panels(element_size=0.0065)
    cloth = scenes.material("cloth", thickness=0.0012, bending_warp=1.5e-4)
    cloth = replace(
        cloth,
        c_threshold=25.0,
        source=MappingProxyType({"thickness_mm": "gauge", "c_threshold_per_mm": "judgement"}),
        fabric=replace(
            cloth.fabric, warp=Curve(strain=np.array([0, 0.05]), stiffness=np.array([9e3, 5e3]))
        ),
    )
    scene = replace(
        scene,
        materials=MappingProxyType({"LEFT": cloth, "RIGHT": cloth}),
        textures=MappingProxyType(
            {"as built": None, "matt": Appearance(albedo=np.full(3, 0.25), texture_scale=0.002)}
        ),
    )
    tables = parameter_tables(scene)
    assert list(tables) == ["scene", "cover cloth", "foam foam", "texture matt"]
    assert rows(tables["scene"])["element_size_mm"] == ("6.50", None)
    assert rows(tables["scene"])["c_threshold_per_mm"] == ("0.0200", None)
    cover = rows(tables["cover cloth"])
    assert cover["thickness_mm"] == ("1.20", "gauge")
    assert cover["warp_n_per_m"] == ("9000, 5000 at 0, 0.0500", None)
    assert cover["weft_n_per_m"] == ("5000", None)
    assert cover["bending_warp_n_m"] == ("1.50e−4", None)
    assert cover["c_threshold_per_mm"] == ("0.0250", "judgement")
    assert rows(tables["foam foam"])["young_kpa"] == ("25", None)
    assert rows(tables["texture matt"])["texture_scale_mm"] == ("2", None)
    assert rows(tables["texture matt"])["albedo"] == ("0.250, 0.250, 0.250", None)


def test_maps_are_shown_as_the_file_names_them():
    pixels = np.full((2, 2, 3), 128, dtype=np.uint8)
    maps = TextureMaps(folder="linen", width=0.12, height=0.12, albedo=pixels)
    scene = replace(
        scenes.two_panels(),
        textures=MappingProxyType({"linen": Appearance(albedo=np.ones(3), maps=maps)}),
    )
    shown = rows(parameter_tables(scene)["texture linen"])
    assert (shown["maps"][0], shown["maps_width_mm"][0]) == ("linen", "120")
    written = tomllib.loads(parameter_toml(scene)["texture linen"])["appearance"]
    assert (written["maps"], written["maps_width_mm"]) == ("linen", 120.0)


def test_every_key_of_a_supplied_material_file_is_in_the_table():
    from seatlook import io

    for name in io.list_materials():
        material = io.read_material(name)
        scene = replace(
            scenes.two_panels(),
            materials=MappingProxyType({"LEFT": material, "RIGHT": material}),
        )
        shown = rows(parameter_tables(scene)[f"cover {name}"])
        assert set(material.source) <= set(shown)
        assert all(shown[key][1] == source for key, source in material.source.items())
