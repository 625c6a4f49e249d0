"""The parameter tables: every number of a run under the name it has in the files."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from types import MappingProxyType
from typing import Any

import numpy as np

from seatlook.io.parameter_text import block_of, fields_of, file_key, line_of
from seatlook.model import Curve, Hysteresis, Scene
from seatlook.model.table import Table, number

_SCENE = ("smallest_notch", "seed", "curvature", "c_threshold")
Row = tuple[str, str, str | None]


def parameter_tables(scene: Scene) -> MappingProxyType[str, Table]:
    """List the scene's settings, its cover materials, foam and textures, each with its source."""
    tables: dict[str, list[Row]] = {
        "scene": [
            (*_entry(name, getattr(scene, name)), None) for name in (scene.mesh_asked_by, *_SCENE)
        ]
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
        + "".join(
            line_of(n, getattr(scene, n)) for n in (scene.mesh_asked_by, "smallest_notch", "seed")
        )
        + "\n[wrinkle]\n"
        + "".join(line_of(n, getattr(scene, n)) for n in ("curvature", "c_threshold"))
    }
    for m in {m.name: m for m in scene.materials.values()}.values():
        looks = block_of("appearance", m.appearance)
        blocks[f"cover {m.name}"] = block_of("fabric", m.fabric) + "\n" + looks
    foam = scene.foam.material
    blocks[f"foam {foam.name}"] = block_of("foam", foam)
    for name, appearance in scene.textures.items():
        if appearance is not None:
            blocks[f"texture {name}"] = block_of("appearance", appearance)
    return MappingProxyType(blocks)


def _rows(values: Any, source: Mapping[str, str]) -> Iterator[Row]:
    for name, value in fields_of(values):
        key, text = _entry(name, value)
        yield key, text, source.get(key)


def _entry(name: str, value: Any) -> tuple[str, str]:
    """Return the key and the value as the files have them."""
    key, factor = file_key(name)
    return key, written(value, factor)


def written(value: Any, factor: float) -> str:
    """Write a value for a reader."""
    if isinstance(value, Curve):
        stiffness = written(value.stiffness, factor)
        return stiffness if len(value.strain) == 1 else f"{stiffness} at {written(value.strain, 1)}"
    if isinstance(value, Hysteresis):
        return ", ".join(f"{name} {number(float(one))}" for name, one in fields_of(value))
    if isinstance(value, np.ndarray):
        return ", ".join(number(factor * float(v)) for v in value)
    if isinstance(value, float):
        return number(factor * value)
    return str(value)
