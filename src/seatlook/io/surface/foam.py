"""The foam: a closed surface from a file."""

from __future__ import annotations

from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np
import trimesh

from seatlook.errors import InputError
from seatlook.io.curves import read_curves
from seatlook.io.surface.axes import Axes, Unit, Up, file_axes
from seatlook.io.surface.formats import joined, read_parts
from seatlook.mesh import face_vectors
from seatlook.model import FloatArray, Foam, FoamMaterial, IntArray

_NOTHING = 1e-9  # volume over the cube of the extent; a sheet folded flat has rounding only
MERGE_M = 1e-7  # STL repeats each corner in every face, rounded to 4 bytes


class FoamSurface(NamedTuple):
    """A cushion's closed surface, and how its file was read.

    Parameters
    ----------
    vertices : (n, 3) [m], z up; faces : (m, 3) int64, outward
    axes : of the file
    """

    vertices: FloatArray
    faces: IntArray
    axes: Axes


def read_foam(
    path: Path,
    *,
    material: FoamMaterial,
    unit: Unit | None = None,
    up: Up | None = None,
    curves: Path | None = None,
) -> Foam:
    """Read a cushion's surface (``read_foam_surface``) and the curves on it.

    Parameters
    ----------
    curves : file with the wires and frame curves, in mm and with z up
    """
    surface = read_foam_surface(path, unit=unit, up=up)
    return Foam(
        vertices=surface.vertices,
        faces=surface.faces,
        material=material,
        curves=MappingProxyType({} if curves is None else read_curves(curves)),
    )


def read_foam_surface(path: Path, *, unit: Unit | None = None, up: Up | None = None) -> FoamSurface:
    """Read a cushion's surface.

    Parameters
    ----------
    path : OBJ, STL, PLY or glTF, one closed body
    unit, up : of the file; by its format and size if not given (``file_axes``)

    Raises
    ------
    InputError
        When the file is no mesh, holds nan, is not closed, is of several bodies, its faces do not
        agree on a side, nothing is inside, or its largest extent is not within 0.05 to 3 m. A
        closed surface whose faces all look inward is turned. Places are those of the file.
    """
    points, faces = joined(read_parts(path))
    axes = file_axes(path, points, unit, up)
    vertices, faces = _merged(axes.world(points), faces)
    mesh = trimesh.Trimesh(vertices=vertices, faces=faces, process=False)
    _check_closed(path, mesh, axes)
    if _volume(path, vertices, faces) < 0:
        faces = faces[:, ::-1]
    return FoamSurface(vertices, faces, axes)


def _merged(vertices: FloatArray, faces: IntArray) -> tuple[FloatArray, IntArray]:
    """Merge vertices that agree within MERGE_M and drop the faces this leaves without area."""
    cells = np.round(vertices / MERGE_M).astype(np.int64)
    _, first, index = np.unique(cells, axis=0, return_index=True, return_inverse=True)
    faces = index.reshape(-1)[faces]
    a, b, c = faces.T
    return vertices[first], faces[(a != b) & (b != c) & (c != a)]


def _check_closed(path: Path, mesh: Any, axes: Axes) -> None:
    edges, count = np.unique(mesh.edges_sorted, axis=0, return_counts=True)
    open_edges = edges[count != 2]
    if len(open_edges):
        place = axes.place(mesh.vertices[open_edges[0]].mean(axis=0))
        raise InputError.single(
            "surface",
            got=f"{len(open_edges)} edges without exactly two faces, the first at {place}",
            expected="a closed surface",
            file=path,
        )
    if not mesh.is_winding_consistent:
        raise InputError.single(
            "surface",
            got="neighbouring faces that look to different sides",
            expected="all faces outward",
            file=path,
        )
    if mesh.body_count != 1:
        got = f"{mesh.body_count} bodies"
        raise InputError.single("surface", got=got, expected="one body", file=path)


def _volume(path: Path, vertices: FloatArray, faces: IntArray) -> float:
    """Volume [m3] inside, negative where the faces look inward; InputError where there is none."""
    middle = vertices[faces].mean(axis=1)
    volume = float((face_vectors(vertices, faces) * middle).sum()) / 3.0
    if not abs(volume) > _NOTHING * float(np.ptp(vertices, axis=0).max()) ** 3:
        raise InputError.single(
            "surface", got="nothing inside", expected="a body with a volume", file=path
        )
    return volume
