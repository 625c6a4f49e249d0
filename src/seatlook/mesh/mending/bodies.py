"""Several bodies: one of them chosen, or all united."""

from __future__ import annotations

from typing import NamedTuple

import manifold3d
import numpy as np

from seatlook.errors import InputError
from seatlook.mesh.mending.skin import SLIVER_M, Skin
from seatlook.mesh.surface import FloatArray, IntArray, face_vectors

_NOTHING = 1e-9  # volume over the cube of the extent; a sheet folded flat has rounding only


class Body(NamedTuple):
    """One connected piece of a surface.

    Parameters
    ----------
    faces : (k,) int64, rows of the surface
    volume : [m3]
    """

    faces: IntArray
    volume: float


def find_bodies(skin: Skin, piece: IntArray) -> list[Body]:
    """Return the pieces of closed surfaces, the largest first; number 1 is the first."""
    volumes = np.bincount(piece, face_volumes(skin.vertices, skin.faces))
    bodies = [Body(np.flatnonzero(piece == i), float(v)) for i, v in enumerate(volumes)]
    # To a cubic millimetre: of equal ones, the first in the file is the first.
    return sorted(bodies, key=lambda body: -round(abs(body.volume), 9))


def face_volumes(vertices: FloatArray, faces: IntArray) -> FloatArray:
    """Volume (m,) [m3] between each face and the origin; their sum is that inside."""
    middle = vertices[faces].mean(axis=1)
    return np.asarray((face_vectors(vertices, faces) * middle).sum(axis=1) / 3.0)


def least_volume(vertices: FloatArray) -> float:
    """Volume [m3] below which a surface (n, 3) has nothing inside."""
    return _NOTHING * float(np.ptp(vertices, axis=0).max()) ** 3


def choose(skin: Skin, bodies: list[Body], number: int) -> None:
    """Keep one body, by its number from 1.

    Raises
    ------
    InputError
        There is no such body.
    """
    if not 1 <= number <= len(bodies):
        raise InputError.single("body", got=number, expected=f"1 to {len(bodies)}")
    keep = np.zeros(len(skin.faces), dtype=bool)
    keep[bodies[number - 1].faces] = True
    skin.note("bodies left out", len(bodies) - 1, skin.middle(int(np.argmin(keep))), asked=True)
    skin.keep(keep)


def unite(skin: Skin, bodies: list[Body]) -> None:
    """Unite bodies where they overlap or touch; what is inside another one disappears.

    Raises
    ------
    InputError
        A body crosses itself so that it has no inside.
    """
    solids = [_solid(skin, body) for body in bodies]
    for solid in solids:
        if solid.status() != manifold3d.Error.NoError or solid.is_empty():
            raise InputError.single(
                "body", got="a body that crosses itself", expected="bodies with an inside",
                hint="leave it out by --body",
            )  # fmt: skip
    union = manifold3d.Manifold.batch_boolean(solids, manifold3d.OpType.Add).simplify(SLIVER_M)
    mesh = union.to_mesh64()
    place = skin.middle(int(bodies[-1].faces[0]))
    skin.vertices = np.array(mesh.vert_properties[:, :3], dtype=np.float64)
    skin.faces = np.array(mesh.tri_verts, dtype=np.int64)
    skin.source = np.array(mesh.face_id, dtype=np.int64)
    parts = len(union.decompose())
    apart = f", in {parts} parts that do not touch" if parts > 1 else ""
    skin.note(f"bodies united{apart}", len(bodies), place, asked=True)


def _solid(skin: Skin, body: Body) -> manifold3d.Manifold:
    used, faces = np.unique(skin.faces[body.faces], return_inverse=True)
    return manifold3d.Manifold(
        manifold3d.Mesh64(
            np.ascontiguousarray(skin.vertices[used]),
            faces.reshape(-1, 3).astype(np.uint64),
            face_id=skin.source[body.faces].astype(np.uint64),
        )
    )
