"""Named curves in space: the wires in the trenches, the frame below."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from seatlook.files import reader, write_text
from seatlook.io.schema import Flag, Kind, Named, Table, place_mm, read_table
from seatlook.io.toml import Document, quoted, read_document
from seatlook.model import FloatArray

_KEYS: dict[str, Kind] = {
    "curve": Named(Table({"points_mm": place_mm(3, many=True)}), required=True)
}

_PANELS: dict[str, Kind] = {
    "panel": Named(Table({"point_mm": place_mm(3), "bare": Flag(default=False)}))
}


class SeamLines(NamedTuple):
    """Lines along which a surface is cut, and what the panels are.

    Parameters
    ----------
    lines : name -> (k, 3) [m]
    panels : name -> point (3,) [m] inside the panel
    bare : those of the panels that are foam without cover
    """

    lines: dict[str, FloatArray]
    panels: dict[str, FloatArray]
    bare: tuple[str, ...]


@reader("a file of curves")
def read_curves(path: Path) -> dict[str, FloatArray]:
    """Read ``[curve.NAME] points_mm = [[x, y, z], ...]``.

    Returns
    -------
    name -> (k, 3) [m], k >= 2; a closed curve repeats its first point

    Raises
    ------
    InputError
        For a key that is unknown, missing or of the wrong type, and for a curve without length.
    """
    document = read_document(path)
    curves = _curves(document, read_table(document, _KEYS))
    document.finish()
    return curves


@reader("a file of curves")
def read_seam_lines(path: Path) -> SeamLines:
    """Read a curves file that may also name panels: ``[panel.NAME] point_mm = [x, y, z]``.

    With ``bare = true`` a panel is foam that no cover lies on.

    Raises
    ------
    InputError
        As :func:`read_curves`.
    """
    document = read_document(path)
    row = read_table(document, _KEYS | _PANELS)
    lines = _curves(document, row)
    document.finish()
    panels = row["panel"]
    return SeamLines(
        lines,
        {name: panel["point_mm"] for name, panel in panels.items()},
        tuple(name for name, panel in panels.items() if panel["bare"]),
    )


def _curves(document: Document, row: dict[str, Any]) -> dict[str, FloatArray]:
    """Return the points of all curves; reports those without length."""
    for name, curve in row["curve"].items():
        points = curve["points_mm"]
        if points is not None and not np.ptp(points, axis=0).any():
            got = f"{len(points)} points at one place"
            document.report(("curve", name, "points_mm"), got, "a curve")
    return {name: curve["points_mm"] for name, curve in row["curve"].items()}


def write_curves(curves: Mapping[str, FloatArray], path: Path) -> None:
    """Write curves (k, 3) [m] in millimetres."""
    blocks = []
    for name, curve in curves.items():
        points = "\n".join(f"  {p}," for p in (1e3 * curve).tolist())
        blocks.append(f"[curve.{quoted(name)}]\npoints_mm = [\n{points}\n]")
    write_text(path, "\n\n".join(blocks) + "\n")
