"""How large a unit of a pattern file is."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Literal, get_args

from seatlook.errors import InputError

Units = Literal["metric", "english", "mm", "cm", "m", "inch"]
UNITS: tuple[str, ...] = get_args(Units)

MM_PER_UNIT = {
    "metric": 1.0, "mm": 1.0, "millimeter": 1.0, "millimeters": 1.0, "millimetres": 1.0,
    "cm": 10.0, "centimeter": 10.0, "centimeters": 10.0, "centimetres": 10.0,
    "m": 1000.0, "meter": 1000.0, "meters": 1000.0, "metres": 1000.0,
    "english": 25.4, "imperial": 25.4, "inch": 25.4, "inches": 25.4, "in": 25.4,
}  # fmt: skip
_INSUNITS = {"1": 25.4, "2": 304.8, "4": 1.0, "5": 10.0, "6": 1000.0, "10": 914.4, "14": 100.0}
_ONLY_MM = (250.0, 10_000.0)  # longest lines; in cm the piece would be 2.5 m or more
_COVERS = (("a cm", 10.0), ("an inch", 25.4), ("a mm", 1.0), ("a m", 1000.0))
_COVER_MM = (150.0, 3000.0)  # sizes of the largest piece of a cover
_MEASUREMENT = {"0": 25.4, "1": 1.0}


def millimetres_per_unit(
    path: Path,
    text: str | None,
    units: Units | None,
    header: Mapping[str, str],
    notes: list[str],
    largest: Callable[[], float],
) -> float:
    """Return millimetres per unit: by the UNITS text, ``units``, the header, or the size.

    The header comes late because drawing programs fill it with what they happen to be set to.
    ``largest`` gives the longest extent of a line in the file's units: a number that would be too
    large for a piece in any other unit is one of millimetres.

    Raises
    ------
    InputError
        When nothing says it, or the text is unknown.
    """
    stated = text or units
    if stated is not None:
        if stated.casefold() not in MM_PER_UNIT:
            raise InputError.single(
                "UNITS", got=repr(stated), expected="METRIC or ENGLISH", file=path
            )
        return MM_PER_UNIT[stated.casefold()]
    for variable, sizes in (("$INSUNITS", _INSUNITS), ("$MEASUREMENT", _MEASUREMENT)):
        size = sizes.get(header.get(variable, ""))
        if size is not None:
            notes.append(f"no UNITS text: a unit is {size:g} mm, by {variable}")
            return size
    size = largest()
    if _ONLY_MM[0] <= size <= _ONLY_MM[1]:
        notes.append(f"the file names no unit: read in mm, as its longest line is {size:.4g}")
        return 1.0
    readings = "; ".join(_in_each_unit(size))
    raise InputError.single(
        "UNITS", got="no such text", expected="METRIC or ENGLISH", file=path,
        hint='say units = "metric" if the file is in millimetres'
        + (f"; its longest line is {readings}" if readings else ""),
    )  # fmt: skip


def other_unit(scale: float, size: float, header: Mapping[str, str]) -> str:
    """Return in which unit a pattern would have the size [mm] of a cover, as a hint."""
    named = _INSUNITS.get(header.get("$INSUNITS", ""))
    fitting = _in_each_unit(size / scale, named, besides=scale)
    if fitting:
        return fitting[0]
    if size > _COVER_MM[1]:
        return f"{size / 10:.4g} mm at a tenth of the scale"
    return f"{10 * size:.4g} mm at ten times the scale"


def _in_each_unit(
    size: float, first: float | None = None, *, besides: float | None = None
) -> list[str]:
    """Return what a size in units of the file is, in each unit in which it is one of a cover."""
    return [
        f"{size * mm:.4g} mm if a unit is {name}"
        for name, mm in sorted(_COVERS, key=lambda one: one[1] != first)
        if mm != besides and _COVER_MM[0] <= size * mm <= _COVER_MM[1]
    ]
