"""The foam: a closed surface from OBJ, STL or PLY."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from types import MappingProxyType
from typing import Any, Literal

import numpy as np
import trimesh

from seatlook.errors import InputError
from seatlook.io._schema import shown
from seatlook.io._toml import read_file
from seatlook.io.curves import read_curves
from seatlook.io.surface import METRES, Unit, check_size
from seatlook.model import Foam, FoamMaterial

Up = Literal["z", "y"]


def read_foam(
    path: Path,
    *,
    material: FoamMaterial,
    unit: Unit,
    up: Up = "z",
    curves: Path | None = None,
) -> Foam:
    """Read a cushion's surface and the curves on it.

    Parameters
    ----------
    path : OBJ, STL or PLY, one closed body
    unit : of the file's numbers
    up : the file's vertical axis; "y" is turned to z
    curves : file with the wires and frame curves, in mm and with z up

    Raises
    ------
    InputError
        When the file is no mesh, holds nan, is not closed, is of several bodies, its faces do not
        agree on a side, or its largest extent is not within 0.05 to 3 m. A closed surface whose
        faces all look inward is turned.
    """
    mesh = _load(path)
    vertices = METRES[unit] * np.asarray(mesh.vertices, dtype=np.float64)
    if up == "y":
        vertices = vertices[:, [0, 2, 1]] * [1.0, -1.0, 1.0]
    faces = np.asarray(mesh.faces, dtype=np.int64)
    _check_closed(path, mesh)
    check_size(path, vertices, unit)
    if mesh.volume < 0:
        faces = faces[:, ::-1]
    return Foam(
        vertices=vertices,
        faces=faces,
        material=material,
        curves=MappingProxyType({} if curves is None else read_curves(curves)),
    )


def _load(path: Path) -> Any:
    """Load a mesh, its nan refused and its equal vertices merged."""
    content = read_file(path)
    reader = READERS.get(path.suffix.lower())
    if reader is None:
        expected = f"one of {', '.join(READERS)}"
        raise InputError.single("file", got=shown(path.suffix), expected=expected, file=path)
    try:
        mesh = reader(path)
    except Exception as error:  # on damaged files the library raises whatever it stumbles over
        raise _refusal(path, f"{type(error).__name__}: {error}") from error
    if not isinstance(mesh, trimesh.Trimesh) or len(mesh.faces) == 0:
        raise _refusal(path, f"no faces in {len(content)} bytes")
    bad = np.flatnonzero(~np.isfinite(mesh.vertices).all(axis=1))
    if len(bad):
        raise InputError.single(
            f"vertex {bad[0] + 1}",
            got=f"{mesh.vertices[bad[0]].tolist()} ({len(bad)} such vertices)",
            expected="finite coordinates",
            file=path,
        )
    mesh.merge_vertices(merge_tex=True, merge_norm=True)
    # An edge of no length leaves a face that touches itself; its neighbours still close.
    a, b, c = mesh.faces.T
    mesh.update_faces((a != b) & (b != c) & (c != a))
    mesh.remove_unreferenced_vertices()
    return mesh


def _load_with_trimesh(path: Path) -> Any:
    return trimesh.load_mesh(path, process=False, skip_materials=True)


# A new surface format is one reader here: a path in, a trimesh.Trimesh out.
READERS: dict[str, Callable[[Path], Any]] = dict.fromkeys(
    (".obj", ".stl", ".ply"), _load_with_trimesh
)


def _refusal(path: Path, got: str) -> InputError:
    expected = f"a surface of triangles ({', '.join(READERS)})"
    return InputError.single("file", got=got, expected=expected, file=path)


def _check_closed(path: Path, mesh: Any) -> None:
    edges, count = np.unique(mesh.edges_sorted, axis=0, return_counts=True)
    open_edges = edges[count != 2]
    if len(open_edges):
        place = mesh.vertices[open_edges[0]].mean(axis=0).round(3).tolist()
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
