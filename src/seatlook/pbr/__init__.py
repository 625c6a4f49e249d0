"""Physically based pictures of a solved cover, and maps of values on it.

Public names load on first use: VTK and Numba stay out of ``import seatlook``.
"""

from __future__ import annotations

import importlib
from typing import Any

__all__ = [
    "Image",
    "Picture",
    "Studio",
    "bake_grain",
    "ev100",
    "illuminance",
    "lux_at_seat",
    "offscreen_backend",
    "render",
    "render_checker",
    "render_map",
    "sketch",
]

_PUBLIC: dict[str, str] = {
    "Image": "seatlook.pbr.picture",
    "Picture": "seatlook.pbr.picture",
    "Studio": "seatlook.pbr.shading.studio",
    "bake_grain": "seatlook.pbr.reflectance.relief",
    "ev100": "seatlook.pbr.light.exposure",
    "illuminance": "seatlook.pbr.light.rig",
    "lux_at_seat": "seatlook.pbr.light.rig",
    "offscreen_backend": "seatlook.pbr.backend",
    "render": "seatlook.pbr.shading.studio",
    "render_checker": "seatlook.pbr.maps.checker",
    "render_map": "seatlook.pbr.maps.face_map",
    "sketch": "seatlook.pbr.maps.preview",
}


def __getattr__(name: str) -> Any:
    if name in _PUBLIC:
        return getattr(importlib.import_module(_PUBLIC[name]), name)
    raise AttributeError(f"module 'seatlook.pbr' has no attribute {name!r}")


def __dir__() -> list[str]:
    return [*globals(), *_PUBLIC]
