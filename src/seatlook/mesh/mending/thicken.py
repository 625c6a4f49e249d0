"""An open shell given a thickness below it."""

from __future__ import annotations

import manifold3d
import numpy as np
from scipy.spatial import cKDTree

from seatlook.errors import InputError
from seatlook.mesh.mending.skin import SLIVER_M, Skin
from seatlook.mesh.surface import vertex_normals

_MOST_FACES = 100_000  # the union takes 1.2 ms a face
_SAME_M = 2 * SLIVER_M


def thicken(skin: Skin, thickness: float) -> None:
    """Fill what lies up to ``thickness`` [m] below an open surface.

    The body is the union of the convex hulls of each face and the same face moved down along the
    normals of its corners. It never crosses itself, however sharply the surface is bent. Where the
    surface lies closer to itself than the thickness, the body comes out on its other side; how much
    of the surface is lost by that is in the report.

    Raises
    ------
    InputError
        More faces than the union can take.
    """
    if len(skin.faces) > _MOST_FACES:
        raise InputError.single(
            "thicken",
            got=f"{len(skin.faces)} faces",
            expected=f"at most {_MOST_FACES}",
            hint="make the mesh coarser",
        )
    v, f = skin.vertices, skin.faces
    lower = v - thickness * vertex_normals(v, f)
    hulls = [manifold3d.Manifold.hull_points(p) for p in np.concatenate([v[f], lower[f]], axis=1)]
    body = manifold3d.Manifold.batch_boolean(hulls, manifold3d.OpType.Add)
    mesh = body.simplify(SLIVER_M).to_mesh64()
    skin.vertices = np.array(mesh.vert_properties[:, :3], dtype=np.float64)
    skin.faces = np.array(mesh.tri_verts, dtype=np.int64)
    skin.source = np.full(len(skin.faces), -1)
    skin.note(f"shell made {1e3 * thickness:g} mm thick", 1, v.mean(axis=0), asked=True)
    lost = np.flatnonzero(cKDTree(skin.vertices).query(v)[0] > _SAME_M)
    if len(lost):
        what = "vertices lost, where the shell is closer to itself than it is thick"
        skin.note(what, len(lost), v[lost[0]], asked=True)
