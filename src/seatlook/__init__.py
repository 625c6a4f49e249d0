"""Where a car-seat cover wrinkles, why, and whether anyone will see it."""

from __future__ import annotations

import importlib
from typing import Any

from seatlook._version import __version__ as __version__

# name -> module; loaded on first use, so that "seatlook --help" stays light.
_PUBLIC: dict[str, str] = {
    "Camera": "seatlook.model",
    "Cover": "seatlook.model",
    "InputError": "seatlook.errors",
    "Rig": "seatlook.model",
    "Scene": "seatlook.model",
    "SeatlookError": "seatlook.errors",
    "Solution": "seatlook.model",
    "WrinkleMap": "seatlook.model",
    "assemble": "seatlook.assembly",
    "bulb": "seatlook.model",
    "compare": "seatlook.comparison.compare",
    "evaluate": "seatlook.chain.evaluation",
    "load_scene": "seatlook.io",
    "named_view": "seatlook.model",
    "read_material": "seatlook.io",
    "read_result": "seatlook.io",
    "render": "seatlook.pbr",
    "render_map": "seatlook.pbr",
    "solve": "seatlook.solver",
    "sun": "seatlook.model",
    "surface_strains": "seatlook.wrinkle",
    "wrinkle_indices": "seatlook.wrinkle",
    "write_report": "seatlook.report.evaluation_page",
    "write_result": "seatlook.io",
    "zone_table": "seatlook.wrinkle",
}

__all__ = list(_PUBLIC)


def __getattr__(name: str) -> Any:
    if name in _PUBLIC:
        return getattr(importlib.import_module(_PUBLIC[name]), name)
    raise AttributeError(f"module 'seatlook' has no attribute {name!r}")


def __dir__() -> list[str]:
    return [*globals(), *_PUBLIC]
