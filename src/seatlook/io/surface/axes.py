"""In which unit and with which vertical axis a surface file is written."""

from __future__ import annotations

from pathlib import Path
from typing import Literal, NamedTuple

import numpy as np

from seatlook.errors import InputError
from seatlook.model import FloatArray

Unit = Literal["mm", "cm", "m", "inch"]
Up = Literal["z", "y"]

METRES: dict[Unit, float] = {"mm": 1e-3, "cm": 1e-2, "m": 1.0, "inch": 0.0254}
UNITS: tuple[Unit, ...] = tuple(METRES)
UPS: tuple[Up, ...] = ("z", "y")
SMALLEST_M, LARGEST_M = 0.05, 3.0
_GLTF = (".glb", ".gltf")


class Axes(NamedTuple):
    """The unit of a file's numbers and its vertical axis.

    Parameters
    ----------
    unit : of the file's numbers
    up : the file's vertical axis; "y" is turned to z
    """

    unit: Unit
    up: Up

    def world(self, points: FloatArray) -> FloatArray:
        """Turn points (..., 3) of the file into metres with z up."""
        scaled = METRES[self.unit] * points
        return scaled if self.up == "z" else scaled[..., [0, 2, 1]] * [1.0, -1.0, 1.0]

    def place(self, point: FloatArray) -> str:
        """Spell a point (3,) [m] as the file has it, such as ``(12.5, 0, -3) mm``."""
        turned = point if self.up == "z" else point[[0, 2, 1]] * [1.0, 1.0, -1.0]
        numbers = ", ".join(f"{v:.6g}" for v in np.round(turned / METRES[self.unit], 4) + 0.0)
        return f"({numbers}) {self.unit}"

    def size(self, vertices: FloatArray) -> str:
        """Spell the extents of vertices (n, 3) [m] as the file has them: ``480 x 420 x 95 mm``."""
        width, depth, height = np.ptp(vertices, axis=0) / METRES[self.unit]
        extents = (width, depth, height) if self.up == "z" else (width, height, depth)
        return f"{' x '.join(f'{v:.4g}' for v in extents)} {self.unit}"


def file_axes(path: Path, points: FloatArray, unit: Unit | None, up: Up | None) -> Axes:
    """Return the axes of a file; what is not given is that of its format, or told by its size.

    glTF is in metres with y up by its standard. Else z is up, and the unit is that of the two, mm
    and m, in which the file is as large as a part of a seat.

    Raises
    ------
    InputError
        By ``unit`` it is no seat, or its size does not tell the unit: with the reading by each.
    """
    gltf = path.suffix.lower() in _GLTF
    up = up or ("y" if gltf else "z")
    size = float(np.ptp(points, axis=0).max())
    if unit is None and gltf:
        # Exporters that leave a model in mm are many; then its size tells it.
        unit = "m" if SMALLEST_M <= size <= LARGEST_M else None
    if unit is None:
        unit = _told_by_size(path, size)
    if not SMALLEST_M <= METRES[unit] * size <= LARGEST_M:
        raise InputError.single(
            "size",
            got=_reading(size, unit),
            expected=f"{SMALLEST_M:g} to {LARGEST_M:g} m",
            file=path,
            hint=f'unit = "{unit}" is taken{_others(size, unit)}',
        )
    return Axes(unit, up)


def _told_by_size(path: Path, size: float) -> Unit:
    guesses: tuple[Unit, ...] = ("m", "mm")
    for unit in guesses:
        if SMALLEST_M <= METRES[unit] * size <= LARGEST_M:
            return unit
    raise InputError.single(
        "unit",
        got=f"nothing, and a file {size:.4g} wide{_others(size, None)}",
        expected=f"one of {', '.join(UNITS)}",
        file=path,
    )


def _others(size: float, taken: Unit | None) -> str:
    """Name the units in which the file would be a seat."""
    fitting = [
        f'{_reading(size, unit)} in "{unit}"'
        for unit in UNITS
        if unit != taken and SMALLEST_M <= METRES[unit] * size <= LARGEST_M
    ]
    return f"; it is {' or '.join(fitting)}" if fitting else "; in no unit it is a seat's part"


def _reading(size: float, unit: Unit) -> str:
    return f"{METRES[unit] * size:.4g} m"
