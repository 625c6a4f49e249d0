"""The file of tests: which curves belong to a material, how they were measured, in which units."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np

from seatlook.errors import InputError
from seatlook.files import reader
from seatlook.io.laboratory.columns import read_columns
from seatlook.io.laboratory.specimens import AXES, read_specimens
from seatlook.io.laboratory.types import Laboratory, LabTest, Look, Specimen
from seatlook.io.laboratory.units import KES_NUMBERS
from seatlook.io.material import material_path, read_foam_material, read_material
from seatlook.io.schema import (
    MM,
    Array,
    Flag,
    Kind,
    Number,
    Rows,
    Table,
    Text,
    Texts,
    read_table,
)
from seatlook.io.schema import shown as shown_value
from seatlook.io.toml import Document, Key, read_document
from seatlook.model import Fabric

_DEG = math.pi / 180.0
KINDS = (*AXES, "cantilever", "incline", "numbers")
_CURVES = ("strain", "force", "angle", "displacement", "curvature", "moment", "distance", "depth",
           "pressure", "thickness", "height", "contraction")  # fmt: skip
# kind -> keys that it needs beside its curves
_NEEDED: dict[str, tuple[str, ...]] = {
    "tensile": ("direction", "sides"),
    "shear": ("pretension_n_per_m",),
    "bias-extension": ("length_mm", "width_mm"),
    "bending": ("direction",),
    "cantilever": ("direction", "overhang_mm", "angle_deg"),
    "hanging-strip": ("direction",),
    "compression": ("at_pa",),
    "incline": ("angle_deg",),
    "numbers": ("direction",),
}
# key of the numbers kind -> what has to be said with it, for laboratories differ in it
_ASKED = {
    "lt": ("wt_gf_cm_per_cm2", "rt_percent", "peak_gf_per_cm", "sides"),
    "g_gf_per_cm_deg": ("g_between_deg", "full_2hg_gf_per_cm", "full_2hg5_gf_per_cm"),
    "b_gf_cm2_per_cm": ("full_2hb_gf_cm_per_cm", "hb_at_per_cm"),
}


@dataclass(frozen=True, slots=True, kw_only=True)
class _Column:
    """``{ column = "load" or 2, unit = "N" }``."""

    required: bool = False
    default: None = None

    def read(self, document: Document, key: Key, value: Any) -> tuple[str | int, str] | None:
        if not isinstance(value, dict):
            document.report(key, shown_value(value), '{ column = "HEAD" or 2, unit = "UNIT" }')
            return None
        for name in value.keys() - {"column", "unit"}:
            document.report((*key, name), "unknown key", "one of column, unit")
        column, unit = value.get("column"), value.get("unit")
        if isinstance(column, bool) or not isinstance(column, str | int) or column == "":
            document.report((*key, "column"), shown_value(column), "a head or a number from 1")
            column = None
        if not isinstance(unit, str):
            document.report((*key, "unit"), shown_value(unit), "a text")
            unit = None
        return None if column is None or unit is None else (column, unit)


_TEST: dict[str, Kind] = {
    "kind": Text(choices=KINDS, required=True),
    "direction": Text(choices=("warp", "weft", "bias")),
    "sides": Text(choices=("held", "free")),
    "files": Texts(or_one=True),
    "specimen": Text(),
    **{name: _Column() for name in _CURVES},
    "length_mm": Number(low=1, high=5000, scale=MM),
    "width_mm": Number(low=1, high=5000, scale=MM),
    "unusual": Flag(default=False),
    "knots": Array(shape=(None,), low=0.0, high=3.0),
    "pretension_n_per_m": Number(low=0, high=1e4),
    "at_pa": Number(low=0.1, high=1e7),
    "overhang_mm": Array(shape=(None,), low=1, high=5000, scale=MM),
    "angle_deg": Array(shape=(None,), low=0.5, high=85, scale=_DEG),
    "g_between_deg": Array(shape=(2,), low=0, high=8, scale=_DEG),
    "hb_at_per_cm": Number(low=0.1, high=2.5, scale=100.0),
    **{name: Number(above=0, high=1e5, scale=factor) for name, factor in KES_NUMBERS.items()},
}
_KEYS: dict[str, Kind] = {
    "base": Text(required=True),
    "laboratory": Text(required=True),
    "date": Text(required=True),
    "sheet": Table(
        {
            "thickness_mm": Number(low=0.01, high=20, scale=MM),
            "density_kg_per_m2": Number(low=1e-3, high=20),
        }
    ),
    "look": Table(
        {
            "lab": Array(shape=(3,), low=-128, high=128),
            "geometry": Text(choices=("45/0", "d/8 SCI", "d/8 SCE"), default="45/0"),
            "gloss_60_gu": Number(low=0, high=100),
            "goniometer": Text(),
        }
    ),
    "test": Rows(Table(_TEST), required=True),
}


@reader("a file of tests")
def read_laboratory(path: Path) -> Laboratory:
    """Read a file of tests and all curves that it names.

    Raises
    ------
    InputError
        Every fault of the file and its curves at once: unknown keys and units, missing directions,
        columns that are not there, curves that fall, are swapped, too short, or in another unit.
    """
    document = read_document(path)
    row = read_table(document, _KEYS)
    base = _base(document, row["base"])
    tests = [
        test
        for i, values in enumerate(row["test"])
        if (test := _test(document, ("test", i), values, base)) is not None
    ]
    if not row["test"] and "test" in document.data:
        document.report(("test",), "no test", "at least one [[test]]")
    look = _look(document, row["look"])
    document.finish()
    return Laboratory(
        file=document.file,
        base=row["base"],
        place=row["laboratory"],
        date=row["date"],
        thickness=row["sheet"]["thickness_mm"],
        density=row["sheet"]["density_kg_per_m2"],
        tests=tuple(tests),
        look=look,
    )


def _look(document: Document, row: dict[str, Any]) -> Look | None:
    """What stands in [look]: lab with gloss_60_gu, or the file of a goniometer."""
    if "look" not in document.data:
        return None
    lab, gloss, name = row["lab"], row["gloss_60_gu"], row["goniometer"]
    if (name is None) == (lab is None or gloss is None):
        document.report(("look",), "too little or too much",
                        "lab with gloss_60_gu, or goniometer")  # fmt: skip
        return None
    if name is None:
        return Look(lab=lab, geometry=row["geometry"], gloss_60=gloss, file=document.file)
    try:
        columns = read_columns(document.file.parent / name)
        table = np.column_stack([columns.numbers(columns.index(i + 1)) for i in range(6)])
    except InputError as error:
        document.note(("look", "goniometer"), error)
        return None
    table[:, :3] *= _DEG
    return Look(angles=table, file=columns.file)


def _base(document: Document, name: str | None) -> Fabric | None:
    """The fabric that stands in for what was not measured; None for a foam, or what is wrong."""
    if name is None:
        return None
    with document.blame(("base",)):
        path = material_path(name, beside=document.file.parent)
        if "foam" in read_document(path).data:
            read_foam_material(path)
        else:
            return read_material(path).fabric
    return None


def _test(
    document: Document, key: Key, values: dict[str, Any], base: Fabric | None
) -> LabTest | None:
    """Build one test; problems go to the document."""
    kind = values["kind"]
    if kind is None:
        return None
    before = len(document.problems)
    axes = AXES.get(kind, ())
    needed = [*dict.fromkeys(name for name, _ in axes), *_NEEDED.get(kind, ())]
    needed += ["files"] if axes else []
    if kind == "numbers":
        needed += _asked(document, key, values)
    for name in needed:
        if values[name] is None and name not in document.data["test"][key[1]]:
            choices = getattr(_TEST[name], "choices", ())
            expected = f"one of {', '.join(choices)}" if choices else f"a value: {kind} asks for it"
            document.report((*key, name), "nothing", expected)
    knots = values["knots"]
    if knots is not None and (knots[0] != 0 or (np.diff(knots) <= 0).any()):
        document.report((*key, "knots"), shown_value(knots.tolist()), "rising strains from 0")
    if len(document.problems) > before:
        return None
    read = read_specimens(document, key, values, base) if axes else _typed(document, key, values)
    specimens = tuple(read)
    if len(document.problems) > before:
        return None
    scalars = ("pretension_n_per_m", "at_pa", "hb_at_per_cm", *KES_NUMBERS)
    numbers = {name: values[name] for name in scalars if values[name] is not None}
    if values["g_between_deg"] is not None:
        numbers |= dict(zip(("g_from", "g_to"), values["g_between_deg"].tolist(), strict=True))
    return LabTest(
        kind=kind, name=f"test[{key[1]}]", direction=values["direction"],
        sides=values["sides"] or "held", length=values["length_mm"], width=values["width_mm"],
        specimens=specimens, numbers=MappingProxyType(numbers), knots=knots,
    )  # fmt: skip


def _asked(document: Document, key: Key, values: dict[str, Any]) -> list[str]:
    """Keys that must be said with the single numbers that are given."""
    given = [name for name in _ASKED if values[name] is not None]
    if not given:
        document.report(key, "no number", f"one of {', '.join(_ASKED)}")
    return [needed for name in given for needed in _ASKED[name]]


def _typed(document: Document, key: Key, values: dict[str, Any]) -> Iterator[Specimen]:
    """Tests of a few numbers that stand in the file itself."""
    x, y = values["overhang_mm"], values["angle_deg"]
    if y is None:
        return
    x = y if x is None else x
    if len(y) == 1 < len(x):
        y = np.full(len(x), y[0])  # a tester of one fixed angle
    if len(x) != len(y):
        document.report((*key, "angle_deg"), f"{len(y)} numbers", f"1 or {len(x)}, as overhang_mm")
        return
    line = np.full(len(x), document.line((*key, "angle_deg")) or 1, dtype=np.int64)
    yield Specimen(x=x, y=y, file=document.file, lines=line)
