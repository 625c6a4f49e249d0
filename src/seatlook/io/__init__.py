"""Files in and out; one module per format, loaded when its first name is used."""

from __future__ import annotations

import importlib
from typing import Any

# name -> module
_PUBLIC: dict[str, str] = {
    "GroupedMesh": "surface",
    "export": "exports",
    "list_foam_materials": "material",
    "list_materials": "material",
    "load_scene": "scene",
    "materials_dir": "material",
    "read_curves": "curves",
    "read_d3plot": "d3plot",
    "read_dxf": "dxf",
    "read_foam": "mesh",
    "read_foam_material": "material",
    "read_keyword": "keyword",
    "read_material": "material",
    "read_panels": "seams",
    "read_pattern": "seams",
    "read_result": "result",
    "read_shapes": "film",
    "read_shells": "shells",
    "read_surface": "surface",
    "write_animation": "film",
    "write_curves": "curves",
    "write_dxf": "dxf_write",
    "write_dynain": "dynain",
    "write_numbers": "table",
    "write_obj": "surface",
    "write_result": "result",
    "write_seams": "seams",
    "write_shapes": "film",
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
