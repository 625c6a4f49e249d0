"""A surface file mended and written as OBJ."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from seatlook.errors import InputError
from seatlook.io.surface.axes import Unit, Up
from seatlook.io.surface.design import GroupedMesh, read_surface_axes, write_obj, write_surface
from seatlook.io.surface.foam import FoamSurface, blamed, read_foam_surface
from seatlook.mesh.mending.mend import AS_IT_IS, Mending, mend_sheet
from seatlook.mesh.mending.skin import Skin
from seatlook.model import IntArray


def mend_file(
    path: Path,
    out: Path,
    *,
    unit: Unit | None = None,
    up: Up | None = None,
    mending: Mending = AS_IT_IS,
    sheet: bool = False,
) -> FoamSurface:
    """Mend a surface and write it as OBJ, in mm with z up.

    Parameters
    ----------
    path, unit, up, mending : as ``read_foam_surface`` takes them
    sheet : make a design surface: its longest border may stay open, panels keep their names

    Raises
    ------
    InputError
        As ``read_foam_surface``; ``out`` is no OBJ file.
    """
    if out.suffix.lower() != ".obj":
        raise InputError.single("--out", got=out.name, expected="a name that ends in .obj")
    if not sheet:
        mended = read_foam_surface(path, unit=unit, up=up, mending=mending)
        write_obj(mended.vertices, mended.faces, out)
        return mended
    drawn, axes = read_surface_axes(path, unit=unit, up=up, ungrouped="PANEL")
    skin = Skin(drawn.vertices, drawn.faces, np.arange(len(drawn.faces)))
    with blamed(path):
        mend_sheet(skin, mending)
    panel = _panels(skin, drawn)
    write_surface(GroupedMesh(skin.vertices, skin.faces, panel, drawn.panel_names), out)
    return FoamSurface(skin.vertices, skin.faces, axes, tuple(skin.report))


def _panels(skin: Skin, drawn: GroupedMesh) -> IntArray:
    """Panel (m,) of each face; a new face takes that of the nearest one of the file."""
    new = skin.source < 0
    panel = drawn.panel[skin.source]
    if new.any():
        near = cKDTree(drawn.vertices[drawn.faces].mean(axis=1))
        panel[new] = drawn.panel[near.query(skin.vertices[skin.faces[new]].mean(axis=1))[1]]
    return panel
