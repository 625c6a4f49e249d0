"""The foam: a closed surface from OBJ, STL or PLY."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from types import MappingProxyType
from typing import Any, Literal

import numpy as np
import trimesh

from seatlook.errors import InputError
from seatlook.io.curves import read_curves
from seatlook.io.schema import shown
from seatlook.io.surface import METRES, Unit, check_size
from seatlook.io.toml import read_file
from seatlook.mesh import face_vectors
from seatlook.model import FloatArray, Foam, FoamMaterial, IntArray

Up = Literal["z", "y"]

_NOTHING = 1e-9  # volume over the cube of the extent; a sheet folded flat has rounding only
MERGE_M = 1e-7  # STL repeats each corner in every face, rounded to 4 bytes


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
        agree on a side, nothing is inside, or its largest extent is not within 0.05 to 3 m. A
        closed surface whose faces all look inward is turned.
    """
    vertices, faces = _load(path)
    vertices = METRES[unit] * vertices
    check_size(path, vertices, unit)
    if up == "y":
        vertices = vertices[:, [0, 2, 1]] * [1.0, -1.0, 1.0]
    vertices, faces = _merged(vertices, faces)
    mesh = trimesh.Trimesh(vertices=vertices, faces=faces, process=False)
    _check_closed(path, mesh)
    if _volume(path, vertices, faces) < 0:
        faces = faces[:, ::-1]
    return Foam(
        vertices=vertices,
        faces=faces,
        material=material,
        curves=MappingProxyType({} if curves is None else read_curves(curves)),
    )


def _load(path: Path) -> tuple[FloatArray, IntArray]:
    """Load vertices (n, 3) in the file's unit and faces (m, 3), all finite and in range."""
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
    vertices = np.array(mesh.vertices, dtype=np.float64)
    faces = np.array(mesh.faces, dtype=np.int64)
    if vertices.shape[1:] != (3,):
        raise _refusal(path, f"vertices of {vertices.shape[1]} coordinates")
    bad = np.flatnonzero(~np.isfinite(vertices).all(axis=1))
    if len(bad):
        raise InputError.single(
            f"vertex {bad[0] + 1}",
            got=f"{vertices[bad[0]].tolist()} ({len(bad)} such vertices)",
            expected="finite coordinates",
            file=path,
        )
    if faces.min() < 0 or faces.max() >= len(vertices):
        raise _refusal(path, f"a face with vertex {faces.max() + 1} of {len(vertices)}")
    return vertices[np.unique(faces)], np.unique(faces, return_inverse=True)[1].reshape(-1, 3)


def _merged(vertices: FloatArray, faces: IntArray) -> tuple[FloatArray, IntArray]:
    """Merge vertices that agree within MERGE_M and drop the faces this leaves without area."""
    cells = np.round(vertices / MERGE_M).astype(np.int64)
    _, first, index = np.unique(cells, axis=0, return_index=True, return_inverse=True)
    faces = index.reshape(-1)[faces]
    a, b, c = faces.T
    return vertices[first], faces[(a != b) & (b != c) & (c != a)]


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


def _volume(path: Path, vertices: FloatArray, faces: IntArray) -> float:
    """Volume [m3] inside, negative where the faces look inward; InputError where there is none."""
    middle = vertices[faces].mean(axis=1)
    volume = float((face_vectors(vertices, faces) * middle).sum()) / 3.0
    if not abs(volume) > _NOTHING * float(np.ptp(vertices, axis=0).max()) ** 3:
        raise InputError.single(
            "surface", got="nothing inside", expected="a body with a volume", file=path
        )
    return volume
