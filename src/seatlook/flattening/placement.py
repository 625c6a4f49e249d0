"""Where the flat panels wait before they are sewn: beside their patches, clear of the foam."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from seatlook.flattening.surface import Patch
from seatlook.mesh import face_areas
from seatlook.mesh.overlap import lifts
from seatlook.model import FloatArray, Pattern, Pose


def poses(
    patches: Sequence[Patch], flat: Mapping[str, FloatArray], pattern: Pattern
) -> dict[str, Pose]:
    """Return a pose for each panel: over its patch, and not in the others.

    A panel that reaches into a trench is wider than its patch looks, so on a nearly flat seat it
    would lie in its neighbour; it is raised.
    """
    result = {patch.name: place(patch, flat[patch.name]) for patch in patches}
    ways = lifts([pose.at(pattern.panel(name).outline) for name, pose in result.items()])
    return {name: pose.moved(way) for (name, pose), way in zip(result.items(), ways, strict=True)}


def place(patch: Patch, flat: FloatArray, *, lift: float = 0.028, clear: float = 0.012) -> Pose:
    """Return the rigid pose that lays a flat panel over its patch.

    Best fit in the least-squares sense (Kabsch 1976), weighted by area, then moved outward along
    the panel's normal.

    Parameters
    ----------
    patch : Patch; flat : (n, 2) [m]   the panel's vertices in pattern coordinates
    lift : float [m]    distance moved outward at least
    clear : float [m]   least height over the highest point of the patch
    """
    weight = np.bincount(
        patch.faces.ravel(),
        np.repeat(face_areas(patch.vertices, patch.faces), 3),
        minlength=len(patch.vertices),
    )
    weight = weight / weight.sum()
    sheet = np.column_stack([flat, np.zeros(len(flat))])
    from_centre, to_centre = weight @ sheet, weight @ patch.vertices
    u, _, vt = np.linalg.svd(
        (sheet - from_centre).T @ (weight[:, None] * (patch.vertices - to_centre))
    )
    sign = np.sign(np.linalg.det(u @ vt))
    # The singular vector of the flat sheet's zero thickness carries the sign, so faces stay up.
    rotation = vt.T @ np.diag([1.0, 1.0, sign]) @ u.T
    normal = rotation[:, 2]
    highest = float(((patch.vertices - to_centre) @ normal).max())
    offset = max(lift, highest + clear) * normal
    return Pose(rotation=rotation, translation=to_centre + offset - rotation @ from_centre)
