"""The specimens of a test: the columns of its CSV files, in SI."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from seatlook.errors import InputError
from seatlook.io.laboratory import units
from seatlook.io.laboratory.columns import Columns, read_columns
from seatlook.io.laboratory.plausible import check_secant, check_specimen
from seatlook.io.laboratory.types import Specimen
from seatlook.io.laboratory.units import Units
from seatlook.io.schema import known
from seatlook.io.toml import Document, Key
from seatlook.model import Fabric

# kind -> (key of x, its units), (key of y, its units)
AXES: dict[str, tuple[tuple[str, Units], tuple[str, Units]]] = {
    "tensile": (("strain", units.STRAIN), ("force", units.FORCE_PER_WIDTH)),
    "shear": (("angle", units.ANGLE), ("force", units.FORCE_PER_WIDTH)),
    "bias-extension": (("displacement", units.LENGTH), ("force", units.FORCE)),
    "bending": (("curvature", units.CURVATURE), ("moment", units.MOMENT_PER_WIDTH)),
    "hanging-strip": (("distance", units.LENGTH), ("depth", units.LENGTH)),
    "compression": (("pressure", units.PRESSURE), ("thickness", units.LENGTH)),
    "foam": (("strain", units.STRAIN), ("pressure", units.PRESSURE)),
    "surface": (("height", units.LENGTH), ("height", units.LENGTH)),
}


def read_specimens(
    document: Document, key: Key, values: dict[str, Any], base: Fabric | None
) -> Iterator[Specimen]:
    """Yield the specimens of all files of a test; faults are noted in the document.

    Parameters
    ----------
    values : of the table of the test, as the schema has read them
    base : what strips are compared with, if it is a cloth
    """
    for name in values["files"]:
        try:
            columns = read_columns(document.file.parent / name)
        except InputError as error:
            document.note((*key, "files"), error)
            continue
        with document.blame(key):
            yield from _specimens(document, key, values, columns, base)


def _specimens(
    document: Document, key: Key, values: dict[str, Any], columns: Columns, base: Fabric | None
) -> Iterator[Specimen]:
    (x_name, x_units), (y_name, y_units) = AXES[values["kind"]]
    asked = [(x_name, x_units), (y_name, y_units)]
    if values["contraction"] is not None:
        asked.append(("contraction", units.STRAIN))
    read = [_column(document, key, values, columns, *one) for one in asked]
    curves = [values_ for values_ in read if values_ is not None]
    if len(curves) < len(read):
        return
    axes = [values[name] for name, _ in asked[:2]]
    places = [columns.name(columns.index(column)) for column, _ in axes]
    written = [unit for _, unit in axes]
    factors = [of[unit].factor for unit, (_, of) in zip(written, asked, strict=False)]
    for rows in _groups(document, key, values, columns):
        specimen = Specimen(
            x=curves[0][rows], y=curves[1][rows], file=columns.file, lines=columns.lines[rows],
            across=curves[2][rows] if len(curves) > 2 else None,
        )  # fmt: skip
        check_specimen(values["kind"], specimen, places, written, factors)
        if values["kind"] == "tensile" and not values["unusual"] and base is not None:
            strain = float(np.abs(specimen.x).max())
            expected = _base_force(base, values["direction"], strain)
            check_secant(specimen, places[1], written[1], strain, expected)
        yield specimen


def _base_force(base: Fabric, direction: str, strain: float) -> float:
    """Force per width [N/m] of the base; at 45 degrees between that of its shear and its yarns."""
    green = np.array([strain + 0.5 * strain**2])
    warp, weft = (float(curve.tension(green)[0]) for curve in (base.warp, base.weft))
    if direction != "bias":
        return (1.0 + strain) * {"warp": warp, "weft": weft}[direction]
    shear = float(base.shear.tension(2.0 * green)[0])
    return float(np.sqrt(shear * min(warp, weft)))


def _column(
    document: Document,
    key: Key,
    values: dict[str, Any],
    columns: Columns,
    name: str,
    known_units: Units,
) -> np.ndarray | None:
    """Read one column in SI; None where that is not possible, which is reported."""
    column, unit = values[name]
    if not known(document, (*key, name, "unit"), unit, known_units, "a unit"):
        return None
    scale = known_units[unit]
    if scale.per and values[f"{scale.per}_mm"] is None:
        document.report((*key, f"{scale.per}_mm"), "nothing", f"a number: {name} is in {unit}")
        return None
    try:
        index = columns.index(column)
        written = units.unit_in_head(columns.head(index))
        if written in known_units and written != unit:
            raise InputError.single(
                columns.name(index),
                got=f"the unit {written}",
                expected=f"{unit}, as {document.file.name} says",
                file=columns.file,
                line=1,
            )
        size = values[f"{scale.per}_mm"] if scale.per else 1.0
        return np.asarray(columns.numbers(index) * (scale.factor / size))
    except InputError as error:
        document.note((*key, name), error)
        return None


def _groups(
    document: Document, key: Key, values: dict[str, Any], columns: Columns
) -> Iterator[np.ndarray]:
    """Yield the rows of every specimen of a file."""
    if values["specimen"] is None:
        yield np.arange(len(columns.rows))
        return
    with document.blame((*key, "specimen")):
        index = columns.index(values["specimen"])
        names = np.array([row[index] if index < len(row) else "" for row in columns.rows])
        for one in dict.fromkeys(names.tolist()):
            yield np.flatnonzero(names == one)
