"""Supplied textures, and both leathers as the drawn patch has them."""

from __future__ import annotations

from dataclasses import replace

from seatlook import io
from seatlook.model import Appearance


def looks() -> dict[str, Appearance]:
    """Supplied textures, and both leathers without their grain."""
    black, bright, suede = (
        io.read_material(name).appearance for name in ("black-leather", "bright-leather", "suede")
    )
    smooth = replace(bright, texture="none")
    return {
        "black": black,
        "bright": bright,
        "suede": suede,
        "smooth black": replace(black, texture="none"),
        "smooth bright": smooth,
        "bright rough": replace(smooth, roughness=0.85, coat=0.0),
    }
