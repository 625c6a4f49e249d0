"""Materials: ``materials/<name>.toml`` with [fabric], [appearance] and [source], or [foam]."""

from __future__ import annotations

import re
import tomllib
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np

from seatlook.errors import InputError, did_you_mean
from seatlook.files import reader
from seatlook.io.colour import Colour
from seatlook.io.schema import MM, THRESHOLD, Array, Kind, Number, Table, Text, read_table, shown
from seatlook.io.texture_maps import read_texture_maps
from seatlook.io.toml import Document, Key, read_document
from seatlook.model import (
    Appearance,
    Curve,
    Fabric,
    FoamMaterial,
    Hysteresis,
    Material,
    TextureMaps,
)

_SOFTEST, _STIFFEST = 1e-3, 1e9  # N/m


@dataclass(frozen=True, slots=True, kw_only=True)
class _StiffnessCurve:
    """A number, or ``{ strain = [0, ...], stiffness = [...] }``."""

    required: bool = False
    default: None = None

    def read(self, document: Document, key: Key, value: Any) -> Curve | None:
        if not isinstance(value, dict):
            stiffness = Number(low=_SOFTEST, high=_STIFFEST).read(document, key, value)
            return None if stiffness is None else Curve.linear(stiffness)
        strain = Array(shape=(None,), low=0.0, high=10.0, required=True)
        stiffnesses = Array(shape=(None,), low=_SOFTEST, high=_STIFFEST, required=True)
        row = Table({"strain": strain, "stiffness": stiffnesses}).read(document, key, value)
        if row["strain"] is None or row["stiffness"] is None:
            return None
        try:
            return Curve(strain=row["strain"], stiffness=row["stiffness"])
        except InputError as error:
            document.note(key, error)
            return None


@dataclass(frozen=True, slots=True, kw_only=True)
class _ShearHysteresis:
    """A number, the width, or ``{ width = ..., growth = ..., strain = ... }``."""

    required: bool = False
    default: None = None

    def read(self, document: Document, key: Key, value: Any) -> Hysteresis | None:
        width = Number(low=_SOFTEST, high=_STIFFEST, required=True)
        if not isinstance(value, dict):
            number = width.read(document, key, value)
            return None if number is None else Hysteresis(width=number)
        keys: dict[str, Kind] = {
            "width": width,
            "growth": Number(low=0.0, high=_STIFFEST, default=0.0),
            "strain": Number(low=1e-5, high=1.0, default=0.01),
        }
        row = Table(keys).read(document, key, value)
        if None in row.values():
            return None
        try:
            return Hysteresis(**row)
        except InputError as error:
            document.note(key, error)
            return None


_FABRIC: dict[str, Kind] = {
    "thickness_mm": Number(low=0.01, high=20, scale=MM, required=True),
    "density_kg_per_m2": Number(low=1e-3, high=20, required=True),
    "warp_n_per_m": _StiffnessCurve(required=True),
    "weft_n_per_m": _StiffnessCurve(required=True),
    "shear_n_per_m": _StiffnessCurve(required=True),
    "warp_unloading_n_per_m": _StiffnessCurve(),
    "weft_unloading_n_per_m": _StiffnessCurve(),
    "shear_hysteresis_n_per_m": _ShearHysteresis(),
    "poisson": Number(low=-2, high=2, required=True),
    "compression_ratio": Number(above=0, high=1, required=True),
    "bending_warp_n_m": Number(low=1e-10, high=1, required=True),
    "bending_weft_n_m": Number(low=1e-10, high=1, required=True),
    "bending_twist_n_m": Number(low=1e-10, high=1, required=True),
    "bending_poisson": Number(low=-2, high=2, required=True),
    "bending_warp_hysteresis_n": Number(low=0, high=1e3),
    "bending_weft_hysteresis_n": Number(low=0, high=1e3),
    "c_threshold_per_mm": THRESHOLD,
    "first_wrinkle_radius_mm": Number(low=0.1, high=1e5, scale=MM),
}
_APPEARANCE: dict[str, Kind] = {
    # Required where no map gives them.
    "albedo": Colour(),
    "metalness": Number(low=0, high=1),
    "roughness": Number(low=0.08, high=1),
    "f0": Number(low=0, high=0.2, default=0.04),
    "sheen": Colour(),
    "sheen_roughness": Number(low=0.4, high=1, default=0.5),
    "coat": Number(low=0, high=1, default=0.0),
    "coat_roughness": Number(low=0.08, high=1, default=0.3),
    "anisotropy": Number(low=-1, high=1, default=0.0),
    "texture": Text(choices=("none", "leather", "suede", "weave"), default="none"),
    "texture_scale_mm": Number(low=0.01, high=100, scale=MM, default=1.0),
    "texture_depth_mm": Number(low=0, high=10, scale=MM, default=0.0),
    "perforation_pitch_mm": Number(low=0.1, high=100, scale=MM, default=6.0),
    "perforation_diameter_mm": Number(low=0, high=50, scale=MM, default=0.0),
    "maps": Text(),
    "measured": Text(choices=("45/0", "d/8 SCI", "d/8 SCE")),
    "gloss_60_gu": Number(low=0, high=100),
    "maps_width_mm": Number(low=1, high=10_000, scale=MM),
}
_FOAM: dict[str, Kind] = {
    "strain": Array(shape=(None,), low=0.0, high=1.0, required=True),
    "stress_kpa": Array(shape=(None,), low=0.0, high=1e6, scale=1e3, required=True),
    "young_kpa": Number(low=1e-3, high=1e8, scale=1e3, required=True),
    "poisson": Number(low=-0.99, high=0.499, required=True),
    "friction": Number(low=0, high=2, required=True),
    "unloading_stress_kpa": Array(shape=(None,), low=0.0, high=1e6, scale=1e3),
}


def materials_dir() -> Path:
    """Return the folder of the materials that come with seatlook.

    An installed package carries it inside; an editable one has it beside ``src``.
    """
    package = Path(__file__).parents[1]
    installed = package / "materials"
    return installed if installed.is_dir() else package.parents[1] / "materials"


def list_materials() -> tuple[str, ...]:
    """Return the names of the cover materials that come with seatlook.

    Examples
    --------
    >>> "black-leather" in list_materials()
    True
    """
    return _names("fabric")


def list_foam_materials() -> tuple[str, ...]:
    """Return the names of the foams that come with seatlook."""
    return _names("foam")


@reader("a material")
def read_material(name_or_path: str | Path) -> Material:
    """Read a cover material by name, or from a TOML file.

    Parameters
    ----------
    name_or_path : a name of ``list_materials()``, or a path that ends in ``.toml``

    Raises
    ------
    InputError
        For an unknown name, and for every key that is unknown, missing, of the wrong type or out
        of range; for a stiffness matrix that is not positive definite.

    Examples
    --------
    >>> read_material("black-leather").fabric.thickness
    0.0012
    """
    document = read_document(material_path(name_or_path))
    row = read_table(
        document,
        {
            "fabric": Table(_FABRIC, required=True),
            "appearance": Table(_APPEARANCE, required=True),
            "source": _source({**_FABRIC, **_APPEARANCE}),
        },
    )
    fabric, look = row["fabric"], row["appearance"]
    maps = _texture_maps(document, look)
    document.finish()
    c_threshold = fabric.pop("c_threshold_per_mm")
    radius = fabric.pop("first_wrinkle_radius_mm")
    if c_threshold is not None and radius is not None:
        document.report(
            ("fabric", "first_wrinkle_radius_mm"), "c_threshold_per_mm as well", "one of them"
        )
    with document.blame(("fabric",)):
        built = Fabric(**{_without_unit(k): v for k, v in fabric.items()})
    with document.blame(("appearance",)):
        given = {_without_unit(k): v for k, v in look.items() if v is not None}
        appearance = Appearance(**given, maps=maps)
    document.finish()
    return Material(
        name=document.file.stem,
        fabric=built,
        appearance=appearance,
        c_threshold=c_threshold,
        first_wrinkle_radius=radius,
        source=_given(row["source"]),
    )


def _texture_maps(document: Document, look: dict[str, Any]) -> TextureMaps | None:
    """Take the keys of the maps out of ``look``; what a map gives is multiplied by 1 by default."""
    folder, width = look.pop("maps"), look.pop("maps_width_mm")
    given: tuple[str, ...] = ()
    maps = None
    if (folder is None) != (width is None):
        missing = "maps_width_mm" if width is None else "maps"
        document.report(("appearance", missing), "nothing", "maps and maps_width_mm, or neither")
    elif folder is not None:
        with document.blame(("appearance", "maps")):
            maps = read_texture_maps(document.file.parent / folder, width=width, name=folder)
            given = maps.given
    # What is there and wrong is reported already, and so is a folder that cannot be read.
    written = document.data.get("appearance", look)
    if look["gloss_60_gu"] is not None:
        given = (*given, "roughness")
        if "roughness" in written:
            document.report(("appearance", "gloss_60_gu"), "roughness as well", "one of them")
    for name, one in (("albedo", np.ones(3)), ("roughness", 1.0)):
        if look[name] is None and name in given:
            look[name] = one
        elif name not in written and (folder is None or maps is not None):
            expected = "an array of numbers" if name == "albedo" else "a number"
            document.report(("appearance", name), "nothing", expected)
    if look["metalness"] is None:
        look["metalness"] = 1.0 if "metalness" in given else 0.0
    return maps


@reader("a foam material")
def read_foam_material(name_or_path: str | Path) -> FoamMaterial:
    """Read a foam by name, or from a TOML file with a [foam] table.

    Raises
    ------
    InputError
        As ``read_material``; also for a compression curve that does not rise from (0, 0).

    Examples
    --------
    >>> read_foam_material("foam-seat").young
    20000.0
    """
    document = read_document(material_path(name_or_path))
    row = read_table(document, {"foam": Table(_FOAM, required=True), "source": _source(_FOAM)})
    document.finish()
    foam = row["foam"]
    for name in ("stress_kpa", "unloading_stress_kpa"):
        if foam[name] is not None and len(foam[name]) != len(foam["strain"]):
            expected = f"{len(foam['strain'])}, one for each strain"
            document.report(("foam", name), f"{len(foam[name])} numbers", expected)
    document.finish()
    with document.blame(("foam",)):
        material = FoamMaterial(
            name=document.file.stem,
            source=_given(row["source"]),
            **{_without_unit(k): v for k, v in foam.items()},
        )
    document.finish()
    return material


def material_path(name_or_path: str | Path, *, beside: Path | None = None) -> Path:
    """Return the file of a material: a supplied one, or a path seen from folder ``beside``.

    Raises
    ------
    InputError
        When the name is not one of the supplied materials.
    """
    text = str(name_or_path)
    if text.endswith(".toml"):
        return (beside or Path()) / text
    path = materials_dir() / f"{text}.toml"
    if path.name != f"{text}.toml" or not path.is_file():
        names = (*list_materials(), *list_foam_materials())
        raise InputError.single(
            "material",
            got=shown(text),
            expected=f"one of {', '.join(names)}, or a path ending in .toml",
            hint=did_you_mean(text, names),
        )
    return path


def _names(table: str) -> tuple[str, ...]:
    files = sorted(materials_dir().glob("*.toml"))
    return tuple(f.stem for f in files if table in tomllib.loads(f.read_text(encoding="utf-8")))


def _source(keys: dict[str, Kind]) -> Table:
    return Table(dict.fromkeys(keys, Text()))


def _given(source: dict[str, str | None]) -> MappingProxyType[str, str]:
    return MappingProxyType({k: v for k, v in source.items() if v is not None})


def _without_unit(key: str) -> str:
    return re.sub(r"_(mm|kg_per_m2|n_per_m|n_m|n|kpa|gu)$", "", key)
