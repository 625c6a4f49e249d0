"""Files in and out; one module per format, loaded when its first name is used."""

from __future__ import annotations

import importlib
from typing import Any

# name -> module
_PUBLIC: dict[str, str] = {
    "GroupedMesh": "surface",
    "export_cover": "export.writers",
    "list_foam_materials": "material",
    "list_materials": "material",
    "load_scene": "scene.read",
    "materials_dir": "material",
    "read_curves": "curves",
    "read_d3plot": "lsdyna.d3plot",
    "read_dxf": "pattern.dxf",
    "read_foam": "mesh",
    "read_foam_material": "material",
    "read_keyword": "lsdyna.keyword",
    "read_material": "material",
    "read_panels": "pattern.seams",
    "read_pattern": "pattern.seams",
    "read_result": "export.result",
    "read_shapes": "export.film",
    "read_shells": "lsdyna.shells",
    "read_surface": "surface",
    "write_animation": "export.film",
    "write_curves": "curves",
    "write_dxf": "pattern.dxf_write",
    "write_dynain": "lsdyna.dynain",
    "write_numbers": "table",
    "write_obj": "surface",
    "write_result": "export.result",
    "write_seams": "pattern.seams",
    "write_shapes": "export.film",
    "write_surface": "surface",
    "write_table": "table",
}

__all__ = list(_PUBLIC)


def __getattr__(name: str) -> Any:
    if name in _PUBLIC:
        return getattr(importlib.import_module(f"seatlook.io.{_PUBLIC[name]}"), name)
    raise AttributeError(f"module 'seatlook.io' has no attribute {name!r}")


def __dir__() -> list[str]:
    return [*globals(), *_PUBLIC]
