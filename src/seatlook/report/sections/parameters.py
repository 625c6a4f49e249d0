"""The parameter tables: every number of a run under the name it has in the files."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Iterator, Mapping
from types import MappingProxyType
from typing import Any

import numpy as np

from seatlook.model import Curve, Scene, TextureMaps
from seatlook.model.table import Table, number

# field -> (key in the files, factor from SI); a field that is not here is named alike and has no
# unit.
_FILE_KEYS: Mapping[str, tuple[str, float]] = {
    "thickness": ("thickness_mm", 1e3),
    "density": ("density_kg_per_m2", 1.0),
    "warp": ("warp_n_per_m", 1.0),
    "weft": ("weft_n_per_m", 1.0),
    "shear": ("shear_n_per_m", 1.0),
    "warp_unloading": ("warp_unloading_n_per_m", 1.0),
    "weft_unloading": ("weft_unloading_n_per_m", 1.0),
    "bending_warp": ("bending_warp_n_m", 1.0),
    "bending_weft": ("bending_weft_n_m", 1.0),
    "bending_twist": ("bending_twist_n_m", 1.0),
    "c_threshold": ("c_threshold_per_mm", 1e-3),
    "texture_scale": ("texture_scale_mm", 1e3),
    "texture_depth": ("texture_depth_mm", 1e3),
    "perforation_pitch": ("perforation_pitch_mm", 1e3),
    "perforation_diameter": ("perforation_diameter_mm", 1e3),
    "maps_width": ("maps_width_mm", 1e3),
    "stress": ("stress_kpa", 1e-3),
    "young": ("young_kpa", 1e-3),
    "element_size": ("element_size_mm", 1e3),
    "smallest_notch": ("smallest_notch_mm", 1e3),
}
_SCENE = ("element_size", "smallest_notch", "seed", "curvature", "c_threshold")
Row = tuple[str, str, str | None]


def parameter_tables(scene: Scene) -> MappingProxyType[str, Table]:
    """List the scene's settings, its cover materials, foam and textures, each with its source."""
    tables: dict[str, list[Row]] = {
        "scene": [(*_entry(name, getattr(scene, name)), None) for name in _SCENE]
    }
    for m in {m.name: m for m in scene.materials.values()}.values():
        tables[f"cover {m.name}"] = [*_rows(m.fabric, m.source), *_rows(m.appearance, m.source)]
        if m.c_threshold is not None:
            key, value = _entry("c_threshold", m.c_threshold)
            tables[f"cover {m.name}"].append((key, value, m.source.get(key)))
    foam = scene.foam.material
    tables[f"foam {foam.name}"] = list(_rows(foam, foam.source))
    for name, appearance in scene.textures.items():
        if appearance is not None:
            tables[f"texture {name}"] = list(_rows(appearance, {}))
    heads = ("key", "value", "source")
    return MappingProxyType(
        {owner: Table(heads=heads, rows=tuple(rows)) for owner, rows in tables.items()}
    )


def parameter_toml(scene: Scene) -> MappingProxyType[str, str]:
    """The same as TOML in the files' units, with every digit, to copy into a scene or material."""
    blocks = {
        "scene": "[mesh]\n"
        + "".join(_line(n, getattr(scene, n)) for n in ("element_size", "smallest_notch", "seed"))
        + "\n[wrinkle]\n"
        + "".join(_line(n, getattr(scene, n)) for n in ("curvature", "c_threshold"))
    }
    for m in {m.name: m for m in scene.materials.values()}.values():
        looks = _block("appearance", m.appearance)
        blocks[f"cover {m.name}"] = _block("fabric", m.fabric) + "\n" + looks
    foam = scene.foam.material
    blocks[f"foam {foam.name}"] = _block("foam", foam)
    for name, appearance in scene.textures.items():
        if appearance is not None:
            blocks[f"texture {name}"] = _block("appearance", appearance)
    return MappingProxyType(blocks)


def _block(name: str, values: Any) -> str:
    return f"[{name}]\n" + "".join(_line(field, value) for field, value in _fields(values))


def _fields(values: Any) -> Iterator[tuple[str, Any]]:
    """Names and values of what a file would hold of a fabric, an appearance or a foam."""
    for field in dataclasses.fields(values):
        value = getattr(values, field.name)
        if isinstance(value, TextureMaps):
            yield from (("maps", value.folder), ("maps_width", value.width))
        elif field.name not in ("name", "source") and value is not None:
            yield field.name, value


def _line(name: str, value: Any) -> str:
    key, factor = _FILE_KEYS.get(name, (name, 1.0))
    return f"{key} = {_toml(value, factor)}\n"


def _toml(value: Any, factor: float) -> str:
    if isinstance(value, Curve):
        stiffness = _toml(value.stiffness, factor)
        if len(value.strain) == 1:
            return stiffness[1:-1]
        return f"{{ strain = {_toml(value.strain, 1)}, stiffness = {stiffness} }}"
    if isinstance(value, np.ndarray):
        return f"[{', '.join(_digits(factor * float(v)) for v in value)}]"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, float):
        return _digits(factor * value)
    return json.dumps(value) if isinstance(value, str) else str(value)


def _digits(value: float) -> str:
    """Every digit that counts: a factor of 1000 must not leave 0.9000000000000001."""
    return repr(float(f"{value:.14g}"))


def _rows(values: Any, source: Mapping[str, str]) -> Iterator[Row]:
    for name, value in _fields(values):
        key, text = _entry(name, value)
        yield key, text, source.get(key)


def _entry(name: str, value: Any) -> tuple[str, str]:
    """Return the key and the value as the files have them."""
    key, factor = _FILE_KEYS.get(name, (name, 1.0))
    return key, _written(value, factor)


def _written(value: Any, factor: float) -> str:
    if isinstance(value, Curve):
        stiffness = _written(value.stiffness, factor)
        return (
            stiffness if len(value.strain) == 1 else f"{stiffness} at {_written(value.strain, 1)}"
        )
    if isinstance(value, np.ndarray):
        return ", ".join(number(factor * float(v)) for v in value)
    if isinstance(value, float):
        return number(factor * value)
    return str(value)
