"""An open shell given a thickness below it."""

from __future__ import annotations

import manifold3d
import numpy as np
from scipy.spatial import cKDTree

from seatlook.errors import InputError
from seatlook.mesh.mending.skin import SLIVER_M, Skin
from seatlook.mesh.surface import FloatArray, IntArray, vertex_normals

_MOST_FACES = 100_000  # the union takes 1.2 ms a face
_SAME_M = 2 * SLIVER_M
_SHRINKINGS = 30


def thicken(skin: Skin, thickness: float) -> None:
    """Fill what lies up to ``thickness`` [m] below an open surface.

    The body is the union of the convex hulls of each face and the same face moved down along the
    normals of its corners. It never crosses itself, however sharply the surface is bent. Where the
    surface lies closer to itself than the thickness, as in a welt, the body would come out on its
    other side: then each corner goes down no farther than to the middle between both. How much of
    the surface is lost all the same is in the report.

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
    normals = vertex_normals(v, f)
    skin.vertices, skin.faces = _body(v, f, thickness * normals)
    lost = _lost(v, skin.vertices)
    if len(lost):
        vertices, faces = _body(v, f, _room(v, normals, thickness)[:, None] * normals)
        fewer = _lost(v, vertices)
        if len(fewer) < len(lost):
            skin.vertices, skin.faces, lost = vertices, faces, fewer
    skin.source = np.full(len(skin.faces), -1)
    skin.note(f"shell made {1e3 * thickness:g} mm thick", 1, v.mean(axis=0), asked=True)
    if len(lost):
        what = "vertices lost, where the shell is closer to itself than it is thick"
        skin.note(what, len(lost), v[lost[0]], asked=True)


def _body(v: FloatArray, f: IntArray, down: FloatArray) -> tuple[FloatArray, IntArray]:
    """Return the union of the hulls between each face and the same face moved against ``down``."""
    corners = np.concatenate([v[f], (v - down)[f]], axis=1)
    hulls = [manifold3d.Manifold.hull_points(points) for points in corners]
    body = manifold3d.Manifold.batch_boolean(hulls, manifold3d.OpType.Add)
    mesh = body.simplify(SLIVER_M).to_mesh64()
    vertices = np.array(mesh.vert_properties[:, :3], dtype=np.float64)
    return vertices, np.array(mesh.tri_verts, dtype=np.int64)


def _lost(v: FloatArray, vertices: FloatArray) -> IntArray:
    return np.flatnonzero(cKDTree(vertices).query(v)[0] > _SAME_M)


def _room(v: FloatArray, normals: FloatArray, most: float) -> FloatArray:
    """Radius (n,) [m] of the largest ball below each vertex that holds no other vertex.

    A ball that touches a vertex from below shrinks until the vertex nearest to its middle lies on
    it (Ma, Bae, Choi 2012, *3D medial axis point approximation*).
    """
    tree = cKDTree(v)
    radius = np.full(len(v), most)
    for _ in range(_SHRINKINGS):
        away, nearest = tree.query(v - radius[:, None] * normals)
        inside = away < (1.0 - 1e-6) * radius
        if not inside.any():
            break
        chord = v[inside] - v[np.asarray(nearest)[inside]]
        height = np.maximum((chord * normals[inside]).sum(axis=1), 1e-12)
        radius[inside] = np.minimum(radius[inside], (chord**2).sum(axis=1) / (2.0 * height))
    return radius
