"""The foam as it is drawn: pressed below the cover, with its edges kept sharp."""

from __future__ import annotations

import numpy as np
from scipy.spatial import KDTree

from seatlook.mesh import face_normals
from seatlook.mesh.surface import spread
from seatlook.model import Appearance, FloatArray, Foam, IntArray
from seatlook.pbr.kernels.surface import Mesh

# Open-cell polyether, cream; judgement.
FOAM = Appearance(albedo=np.array([0.62, 0.57, 0.42]), roughness=0.95, f0=0.02)
# Where a seat stands on something, what is left to be seen of the foam lies in the dark of a gap.
HIDDEN_FOAM = Appearance(albedo=np.full(3, 0.01), roughness=0.95, f0=0.0)

# The foam lies this far [m] below the cover, wherever the cover is this near.
_BELOW, _NEAR = 0.003, 0.03
_STEP = 0.004  # m between the places of the cover that are looked at
_ROUNDS = 3  # to be below all panels that meet at an edge or a corner
# Faces whose normals differ by more than 40 degrees meet in an edge.
_EDGE_COSINE = np.cos(np.radians(40.0))


def pressed(foam: Foam, cover: Mesh) -> FloatArray:
    """Foam vertices (n, 3) moved inward to where the solved cover has pressed them.

    The stored foam is at rest: drawn as it is, it would stick out of the cover that it carries.
    Where panels meet, it goes below each of them: below the nearest alone, it would stick out of
    the other beside a sharp edge.
    """
    x = np.array(foam.vertices)
    places, face = spread(cover.vertices, cover.faces, _STEP)
    normals, panel = face_normals(cover.vertices, cover.faces)[face], cover.panel[face]
    panels = np.unique(panel)
    distance = np.full((len(panels), len(x)), np.inf)
    nearest = np.zeros(distance.shape, dtype=np.int64)
    for k, name in enumerate(panels):
        own = np.flatnonzero(panel == name)
        distance[k], place = KDTree(places[own]).query(x, distance_upper_bound=_NEAR)
        nearest[k] = own[np.minimum(place, len(own) - 1)]
    meet = np.isfinite(distance) & (distance <= distance.min(axis=0) + _STEP)
    for _ in range(_ROUNDS):
        for place, here in zip(nearest, meet, strict=True):
            n = normals[place]
            out = ((x - places[place]) * n).sum(axis=1) + _BELOW
            x -= np.where(here & (out > 0), out, 0.0)[:, None] * n
    return x


def corner_normals(x: FloatArray, faces: IntArray) -> FloatArray:
    """Unit normals (3 m, 3) of all face corners, area-weighted over the faces on the same side."""
    a, b, c = (x[faces[:, k]] for k in range(3))
    area = np.cross(b - a, c - a)
    unit = area / np.maximum(np.linalg.norm(area, axis=1, keepdims=True), 1e-30)
    corner = faces.ravel()
    order = np.argsort(corner, kind="stable")
    count = np.bincount(corner, minlength=len(x))
    start = np.cumsum(count) - count
    # Every corner against every corner at the same vertex.
    left = np.repeat(order, count[corner[order]])
    run = np.cumsum(count[corner[order]]) - count[corner[order]]
    right = order[start[corner[left]] + np.arange(len(left)) - np.repeat(run, count[corner[order]])]
    same = (unit[left // 3] * unit[right // 3]).sum(axis=1) > _EDGE_COSINE
    share = area[right[same] // 3]
    n = np.column_stack(
        [np.bincount(left[same], share[:, k], minlength=3 * len(faces)) for k in range(3)]
    )
    length = np.linalg.norm(n, axis=1, keepdims=True)
    return np.where(length > 0, n / np.maximum(length, 1e-30), (0.0, 0.0, 1.0))


def with_foam(mesh: Mesh, foam: Foam, panel: int, *, cover: FloatArray) -> Mesh:
    """Mesh with the foam's faces behind its own; every corner gets a vertex.

    The first vertices of the mesh press on the foam, from where they are in ``cover`` (n, 3): not
    lifted by what lies between. The seam allowance behind them does not press.
    """
    faces = np.array(foam.faces)
    own = (mesh.faces < len(cover)).all(axis=1)
    x = pressed(foam, mesh._replace(vertices=cover, faces=mesh.faces[own], panel=mesh.panel[own]))
    n, k = len(mesh.vertices), faces.size
    return Mesh(
        np.vstack([mesh.vertices, x[faces.ravel()]]),
        np.vstack([mesh.normals, corner_normals(x, faces)]),
        np.vstack([mesh.warp, np.zeros((k, 3))]),
        np.vstack([mesh.uv, np.zeros((k, 2))]),
        np.vstack([mesh.faces, n + np.arange(k).reshape(-1, 3)]),
        np.concatenate([mesh.panel, np.full(len(faces), panel)]),
        np.vstack([mesh.seam, np.full((k, 3), np.inf)]),
    )
