"""Triangles of OBJ, STL, PLY and glTF files, as they stand there."""

from __future__ import annotations

import json
import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import trimesh

from seatlook.errors import InputError
from seatlook.files import read_file
from seatlook.io.schema import shown
from seatlook.model import FloatArray, IntArray


class Part(NamedTuple):
    """One object of a surface file.

    Parameters
    ----------
    name : of the object; empty in formats without names
    vertices : (n, 3), in the unit and axes of the file; faces : (m, 3) int64
    """

    name: str
    vertices: FloatArray
    faces: IntArray


def read_parts(path: Path) -> list[Part]:
    """Read the objects of a surface file, with all their places in the file applied.

    Raises
    ------
    InputError
        When the file is no mesh or holds nan, or faces of vertices that it does not hold.
    """
    content = read_file(path)
    reader = READERS.get(path.suffix.lower())
    if reader is None:
        expected = f"one of {', '.join(READERS)}"
        raise InputError.single("file", got=shown(path.suffix), expected=expected, file=path)
    try:
        objects = _objects(reader(path))
    except InputError:
        raise
    except Exception as error:  # on damaged files the library raises whatever it stumbles over
        raise _refusal(path, f"{type(error).__name__}: {error}") from error
    parts = [_part(path, name, mesh) for name, mesh in objects if len(mesh.faces)]
    if not parts:
        raise _refusal(path, f"no faces in {len(content)} bytes")
    return parts


def joined(parts: list[Part]) -> tuple[FloatArray, IntArray]:
    """Put the vertices (n, 3) and faces (m, 3) of all parts together."""
    first = np.cumsum([0, *(len(part.vertices) for part in parts)])
    faces = [part.faces + start for part, start in zip(parts, first, strict=False)]
    return np.concatenate([part.vertices for part in parts]), np.concatenate(faces)


def _part(path: Path, name: str, mesh: Any) -> Part:
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
    used, index = np.unique(faces, return_inverse=True)
    return Part(name, vertices[used], index.reshape(-1, 3))


def _objects(loaded: Any) -> list[tuple[str, Any]]:
    """List the meshes of what was loaded, in their places; those of a scene by their nodes."""
    if isinstance(loaded, trimesh.Trimesh):
        return [("", loaded)]
    if not isinstance(loaded, trimesh.Scene):
        return []
    nodes = [(str(node), *loaded.graph[node]) for node in loaded.graph.nodes_geometry]
    return [
        (node, loaded.geometry[geometry].copy().apply_transform(transform))
        for node, transform, geometry in nodes
        if isinstance(loaded.geometry[geometry], trimesh.Trimesh)
    ]


def _load_mesh(path: Path) -> Any:
    return trimesh.load_mesh(path, process=False, skip_materials=True)


def _load_gltf(path: Path) -> Any:
    packed = [
        name for name in _gltf_header(path).get("extensionsRequired", []) if name in _COMPRESSIONS
    ]
    if packed:
        raise InputError.single(
            "file",
            got=", ".join(packed),
            expected="vertices that are not compressed",
            file=path,
            hint="export it again without compression",
        )
    return trimesh.load_scene(path, process=False, skip_materials=True)


_COMPRESSIONS = ("KHR_draco_mesh_compression", "EXT_meshopt_compression")


def _gltf_header(path: Path) -> dict[str, Any]:
    """Return the JSON of a glTF file."""
    content = read_file(path)
    if content[:4] == b"glTF":
        (length,) = struct.unpack_from("<I", content, 12)
        content = content[20 : 20 + length]
    header = json.loads(content)
    if not isinstance(header, dict):
        raise TypeError("JSON without an object")
    return header


def named_files(path: Path) -> list[Path]:
    """Return the files beside a glTF file that hold its numbers."""
    if path.suffix.lower() != ".gltf":
        return []
    try:
        buffers = _gltf_header(path).get("buffers", [])
        names = [buffer["uri"] for buffer in buffers if "uri" in buffer]
    except (ValueError, TypeError, KeyError, struct.error, RecursionError):
        return []  # what is wrong with it, its reader says
    return [path.parent / name for name in names if not str(name).startswith("data:")]


# A new surface format is one reader here: a path in, a trimesh.Trimesh or trimesh.Scene out.
READERS: dict[str, Callable[[Path], Any]] = {
    **dict.fromkeys((".obj", ".stl", ".ply"), _load_mesh),
    **dict.fromkeys((".glb", ".gltf"), _load_gltf),
}


def _refusal(path: Path, got: str) -> InputError:
    expected = f"a surface of triangles ({', '.join(READERS)})"
    return InputError.single("file", got=got, expected=expected, file=path)
