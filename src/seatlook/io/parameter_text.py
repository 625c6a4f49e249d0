"""Values of the core types as the files have them: keys with their units, and TOML."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from seatlook.files import write_text
from seatlook.io.toml import quoted
from seatlook.model import Curve, FoamMaterial, Hysteresis, Material, TextureMaps

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
    "shear_hysteresis": ("shear_hysteresis_n_per_m", 1.0),
    "bending_warp_hysteresis": ("bending_warp_hysteresis_n", 1.0),
    "bending_weft_hysteresis": ("bending_weft_hysteresis_n", 1.0),
    "bending_warp": ("bending_warp_n_m", 1.0),
    "bending_weft": ("bending_weft_n_m", 1.0),
    "bending_twist": ("bending_twist_n_m", 1.0),
    "c_threshold": ("c_threshold_per_mm", 1e-3),
    "first_wrinkle_radius": ("first_wrinkle_radius_mm", 1e3),
    "gloss_60": ("gloss_60_gu", 1.0),
    "texture_scale": ("texture_scale_mm", 1e3),
    "texture_depth": ("texture_depth_mm", 1e3),
    "perforation_pitch": ("perforation_pitch_mm", 1e3),
    "perforation_diameter": ("perforation_diameter_mm", 1e3),
    "maps_width": ("maps_width_mm", 1e3),
    "stress": ("stress_kpa", 1e-3),
    "unloading_stress": ("unloading_stress_kpa", 1e-3),
    "young": ("young_kpa", 1e-3),
    "element_size": ("element_size_mm", 1e3),
    "tolerance": ("tolerance_percent", 100.0),
    "smallest_notch": ("smallest_notch_mm", 1e3),
}


def write_material(path: Path, material: Material | FoamMaterial, *, head: str = "") -> None:
    """Write a material or a foam as a file that ``read_material`` reads.

    Parameters
    ----------
    head : text of a comment at the top

    A folder of measured maps is written as the material has it, seen from its own file.
    """
    sections = {"foam": material} if isinstance(material, FoamMaterial) else {
        "fabric": material.fabric, "appearance": material.appearance,
    }  # fmt: skip
    parts = ["".join(f"# {line}".rstrip() + "\n" for line in head.splitlines())]
    for name, values in sections.items():
        parts.append(block_of(name, values))
    if isinstance(material, Material):
        for name in ("c_threshold", "first_wrinkle_radius"):
            if getattr(material, name) is not None:
                parts[1] += line_of(name, getattr(material, name))
    sources = (f"{key} = {quoted(text)}\n" for key, text in material.source.items())
    parts.append("[source]\n" + "".join(sources))
    write_text(path, "\n".join(part for part in parts if part))


def file_key(name: str) -> tuple[str, float]:
    """Key of a field in the files, and the factor from SI to its unit there."""
    return _FILE_KEYS.get(name, (name, 1.0))


def block_of(name: str, values: Any) -> str:
    """Return a table of TOML with all fields of a core type, in the units of the files."""
    return f"[{name}]\n" + "".join(line_of(field, value) for field, value in fields_of(values))


def fields_of(values: Any) -> Iterator[tuple[str, Any]]:
    """Names and values of what a file would hold of a fabric, an appearance or a foam."""
    for field in dataclasses.fields(values):
        value = getattr(values, field.name)
        if isinstance(value, TextureMaps):
            yield from (("maps", value.folder), ("maps_width", value.width))
        elif field.name == "roughness" and getattr(values, "gloss_60", None) is not None:
            continue  # the gloss stands for it
        elif field.name not in ("name", "source") and value is not None:
            yield field.name, value


def line_of(name: str, value: Any) -> str:
    """Return one field as a line of TOML."""
    key, factor = file_key(name)
    return f"{key} = {exact(value, factor)}\n"


def exact(value: Any, factor: float) -> str:
    """Write a value as TOML has it, with every digit."""
    if isinstance(value, Curve):
        stiffness = exact(value.stiffness, factor)
        if len(value.strain) == 1:
            return stiffness[1:-1]
        return f"{{ strain = {exact(value.strain, 1)}, stiffness = {stiffness} }}"
    if isinstance(value, Hysteresis):
        pairs = (f"{name} = {_digits(one)}" for name, one in fields_of(value))
        return f"{{ {', '.join(pairs)} }}"
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
