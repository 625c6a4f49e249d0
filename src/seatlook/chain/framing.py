"""A view and a light for a cover that no scene describes; views in which places are seen."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from seatlook.mesh import face_normals, face_vectors
from seatlook.mesh.sight import is_seen
from seatlook.model import VIEWS, Camera, FloatArray, Light, Rig, Solution, framed_view

_FOV = 16.2  # [deg] vertical, that of the named views
_TILT = np.radians(35.0)  # of the view against the mean normal
_LIGHT_TILT = np.radians(55.0)  # of the light, to the other side
_SUN = 97_000.0  # [lx] on a facing plane
_SKY = 4_000.0  # [cd/m2]
_LIFT = 1e-3  # [m] above the cloth, so that a place does not hide itself


@dataclass(frozen=True, slots=True, kw_only=True)
class Mark:
    """Where a place of a cover is seen.

    Parameters
    ----------
    camera : the one asked for, if it sees the place; else the named view that sees it most
        squarely; None where the cover hides it from all of them
    x, y : float [pixels]    in that camera's picture, from the top left
    """

    camera: Camera | None
    x: float = 0.0
    y: float = 0.0


def marks(solution: Solution, places: Sequence[FloatArray], camera: Camera) -> tuple[Mark, ...]:
    """Find places (3,) [m] of a cover in the picture of a camera, or in a view that sees them."""
    if not places:
        return ()
    at = np.array(places)
    centre = solution.positions[solution.cover.faces].mean(axis=1)
    face = [int(np.linalg.norm(centre - place, axis=1).argmin()) for place in at]
    normal = face_normals(solution.positions, solution.cover.faces)[face]
    views = [framed_view(name, solution.positions, size=camera.size) for name in VIEWS]
    cameras = [camera, *(view for view in views if view.name != camera.name)]
    squarely = np.array([_squarely(solution, view, at, normal) for view in cameras])
    chosen = np.where(squarely[0] > 0, 0, squarely.argmax(axis=0))
    return tuple(
        Mark(camera=cameras[c], **dict(zip("xy", cameras[c].pixel(place), strict=True)))
        if squarely[c, k] > 0
        else Mark(camera=None)
        for k, (c, place) in enumerate(zip(chosen.tolist(), at, strict=True))
    )


def _squarely(
    solution: Solution, camera: Camera, places: FloatArray, normal: FloatArray
) -> FloatArray:
    """Cosine (k,) from the normals (k, 3) of places to the camera; 0 for those it cannot see."""
    away = camera.position - places
    cosine = np.einsum("kd,kd->k", away, normal) / np.linalg.norm(away, axis=1)
    pixels, depth = camera.pixels(places)
    inside = (depth > 0) & ((pixels >= 0) & (pixels < camera.size)).all(axis=1)
    seen = is_seen(
        places + _LIFT * normal, camera.position, solution.positions, solution.cover.faces
    )
    return np.where(inside & seen, np.maximum(cosine, 0.0), 0.0)


def fitted_view(solution: Solution, *, size: tuple[int, int] = (1280, 720)) -> Camera:
    """Return a camera that sees all of the cover from its visible side, a little from aside."""
    normal, aside, up = _axes(solution)
    used = np.zeros(len(solution.positions), dtype=bool)
    used[solution.cover.faces] = True
    x = solution.positions[used]
    middle = 0.5 * (x.min(axis=0) + x.max(axis=0))
    radius = float(np.linalg.norm(x - middle, axis=1).max())
    narrow = min(1.0, size[0] / size[1])
    distance = 1.05 * radius / np.sin(0.5 * np.radians(_FOV) * narrow)
    toward = np.cos(_TILT) * normal + np.sin(_TILT) * (0.5 * aside - up) / np.hypot(0.5, 1.0)
    return Camera(
        name="fitted",
        position=middle + distance * toward,
        target=middle,
        up=up,
        vertical_fov_deg=_FOV,
        size=size,
    )


def side_light(solution: Solution) -> Rig:
    """Return sun from the far side, low enough to show relief, and sky."""
    normal, aside, up = _axes(solution)
    toward = np.cos(_LIGHT_TILT) * normal + np.sin(_LIGHT_TILT) * (up - 0.5 * aside) / np.hypot(
        0.5, 1.0
    )
    sun = Light(name="sun", intensity=_SUN, vector=toward, near=False, size=np.radians(0.5332))
    # The seat's grey card lies level; these parts may stand or hang.
    lux = _SUN * np.cos(_LIGHT_TILT) + np.pi * _SKY
    return Rig(name="side light", lights=(sun,), ambient=_SKY, ev100=float(np.log2(lux / 2.5)))


def _axes(solution: Solution) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Mean visible normal; across it a horizontal axis, and the third, upward or away."""
    area = face_vectors(solution.positions, solution.cover.faces)
    total = area.sum(axis=0)
    size = float(np.linalg.norm(total))
    # A closed part looks everywhere alike.
    whole = float(np.linalg.norm(area, axis=1).sum())
    normal = total / size if size > 0.05 * whole else np.array([0.0, -0.6, 0.8])
    up = np.array([0.0, 0.0, 1.0]) if abs(normal[2]) < 0.9 else np.array([0.0, 1.0, 0.0])
    aside = np.cross(up, normal)
    aside /= np.linalg.norm(aside)
    return normal, aside, np.cross(normal, aside)
