"""The foam: a closed surface from a file, mended where it is not."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from seatlook.errors import InputError, InputWarning
from seatlook.files import kept, reader
from seatlook.io.curves import read_curves
from seatlook.io.surface.axes import Axes, Unit, Up, file_axes
from seatlook.io.surface.formats import joined, read_parts
from seatlook.mesh.mending.bodies import face_volumes, least_volume
from seatlook.mesh.mending.mend import AS_IT_IS, Mending, is_clean, mend_body
from seatlook.mesh.mending.skin import Mend, Skin
from seatlook.model import FloatArray, Foam, FoamMaterial, IntArray

MERGE_M = 1e-7  # STL repeats each corner in every face, rounded to 4 bytes


class FoamSurface(NamedTuple):
    """A cushion's surface, and how its file was read.

    Parameters
    ----------
    vertices : (n, 3) [m], z up; faces : (m, 3) int64, outward
    axes : of the file
    mended : what was mended, in order
    """

    vertices: FloatArray
    faces: IntArray
    axes: Axes
    mended: tuple[Mend, ...]


@reader("a closed surface")
def read_foam(
    path: Path,
    *,
    material: FoamMaterial,
    unit: Unit | None = None,
    up: Up | None = None,
    curves: Path | None = None,
    mending: Mending = AS_IT_IS,
) -> Foam:
    """Read a cushion's surface (``read_foam_surface``) and the curves on it.

    What was mended unasked is an ``InputWarning``.

    Parameters
    ----------
    curves : file with the wires and frame curves, in mm and with z up
    """
    surface = read_foam_surface(path, unit=unit, up=up, mending=mending)
    unasked = [
        f"{m.number} {m.what} at {surface.axes.place(m.place)}"
        for m in surface.mended
        if not m.asked
    ]
    if unasked:
        warnings.warn(f"{path}: mended: {'; '.join(unasked)}", InputWarning, 2)
    return Foam(
        vertices=surface.vertices,
        faces=surface.faces,
        material=material,
        curves=MappingProxyType({} if curves is None else read_curves(curves)),
    )


@reader("a closed surface")
@kept
def read_foam_surface(
    path: Path,
    *,
    unit: Unit | None = None,
    up: Up | None = None,
    mending: Mending = AS_IT_IS,
) -> FoamSurface:
    """Read a cushion's surface, and mend it.

    Faces that lie on the same again, slivers, cracks of up to 0.3 mm, edges of more than two
    faces, loose specks and faces that look to another side than their neighbours are mended
    always; holes and several bodies as ``mending`` says.

    Parameters
    ----------
    path : OBJ, STL, PLY or glTF
    unit, up : of the file; by its format and size if not given (``file_axes``)

    Raises
    ------
    InputError
        When the file is no mesh or holds nan, its largest extent is not within 0.05 to 3 m, or it
        is open, of several bodies, or without an inside after mending. Places are the file's.
    """
    points, faces = joined(read_parts(path))
    axes = file_axes(path, points, unit, up)
    vertices, faces = _merged(axes.world(points), faces)
    skin = Skin(vertices, faces, np.arange(len(faces)))
    with blamed(path):
        if mending.thicken or mending.smooth or not is_clean(vertices, faces):
            mend_body(skin, mending, axes.place)
        elif _volume(vertices, faces) < 0:
            skin.faces = faces[:, ::-1]
    return FoamSurface(skin.vertices, skin.faces, axes, tuple(skin.report))


@contextmanager
def blamed(path: Path) -> Iterator[None]:
    """Name the file in what is found wrong with its surface."""
    try:
        yield
    except InputError as error:
        raise InputError(replace(p, file=p.file or path) for p in error.problems) from error


def _merged(vertices: FloatArray, faces: IntArray) -> tuple[FloatArray, IntArray]:
    """Merge vertices that agree within MERGE_M and drop the faces this leaves without area."""
    cells = np.round(vertices / MERGE_M).astype(np.int64)
    _, first, index = np.unique(cells, axis=0, return_index=True, return_inverse=True)
    faces = index.reshape(-1)[faces]
    a, b, c = faces.T
    return vertices[first], faces[(a != b) & (b != c) & (c != a)]


def _volume(vertices: FloatArray, faces: IntArray) -> float:
    """Volume [m3] inside, negative where the faces look inward; InputError where there is none."""
    volume = float(face_volumes(vertices, faces).sum())
    if not abs(volume) > least_volume(vertices):
        raise InputError.single("surface", got="nothing inside", expected="a body with a volume")
    return volume
