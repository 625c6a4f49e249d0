"""Cameras of named views, far enough away for a seat of any size."""

from __future__ import annotations

from types import MappingProxyType

import numpy as np

from seatlook.errors import InputError
from seatlook.model._check import FloatArray
from seatlook.model.light import Camera, direction

DISTANCE = 1.1  # m, of the demo seat
_RADIUS = 0.349  # m, of the sphere around the demo's foam
_ROUND = 2  # digits of the ratio to it: 1 for the demo's foam below a cover of any thickness
_MARGIN = 1.01  # free room around a seat for which the sphere's distance is too short


def named_view(
    name: str,
    *,
    target: FloatArray,
    size: tuple[int, int] = (1280, 720),
    distance: float = DISTANCE,
) -> Camera:
    """Camera of a named view, looking at ``target`` [m] from ``distance`` [m].

    Examples
    --------
    >>> round(named_view("top", target=np.zeros(3)).pixels_per_degree)
    45
    """
    if name not in VIEWS:
        raise InputError.single("camera.view", got=name, expected=f"one of {', '.join(VIEWS)}")
    azimuth, elevation, share = VIEWS[name]
    up = np.array([0.0, 1.0, 0.0]) if elevation > 89 else np.array([0.0, 0.0, 1.0])
    return Camera(
        name=name,
        position=np.asarray(target) + distance * share * direction(azimuth, elevation),
        target=target,
        up=up,
        size=size,
    )


def framed_view(name: str, points: FloatArray, *, size: tuple[int, int] = (1280, 720)) -> Camera:
    """Camera of a named view that shows all of ``points`` (n, 3) [m], looking at their middle.

    The distance goes with the radius of the sphere around the middle of their bounding box.
    A long or tall seat that would still reach out of the picture is seen from farther away;
    ``detail`` shows a part and is left as it is.

    Raises
    ------
    InputError
        An unknown view.

    Examples
    --------
    >>> corners = np.array([[-1.0, -1.0, -1.0], [1.0, 1.0, 1.0]])
    >>> views = [framed_view("top", scale * corners) for scale in (1.0, 2.0)]
    >>> [round(float(view.position[2]), 2) for view in views]
    [10.91, 21.85]
    """
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    distance = sphere_distance(points)
    camera = named_view(name, target=middle, size=size, distance=distance)
    reach, share = _MARGIN * _whole(camera, points), VIEWS[name][2]
    if share < 1.0 or reach <= distance * share:
        return camera
    return named_view(name, target=middle, size=size, distance=reach / share)


def sphere_distance(points: FloatArray) -> float:
    """Viewing distance [m], in the ratio of the sphere around ``points`` (n, 3) to the demo's."""
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    radius = float(np.linalg.norm(points - middle, axis=1).max())
    return DISTANCE * max(round(radius / _RADIUS, _ROUND), 10.0**-_ROUND)


def _whole(camera: Camera, points: FloatArray) -> float:
    """Least distance [m] from the target at which the camera sees all points."""
    toward = camera.position - camera.target
    toward = toward / np.linalg.norm(toward)
    right = np.cross(camera.up, toward)
    right = right / np.linalg.norm(right)
    upward = np.cross(toward, right)
    half = np.tan(np.radians(camera.vertical_fov_deg) / 2)
    away = points - camera.target
    aside = np.abs(away @ right) / (half * camera.size[0] / camera.size[1])
    above = np.abs(away @ upward) / half
    return float((away @ toward + np.maximum(aside, above)).max())


# azimuth, elevation [deg], share of the viewing distance
VIEWS: MappingProxyType[str, tuple[float, float, float]] = MappingProxyType(
    {
        "driver_door": (75.0, 38.0, 1.75),
        "front_34": (35.0, 40.0, 1.9),
        "rear_34": (215.0, 40.0, 1.9),
        "top": (0.0, 90.0, 2.0),
        "detail": (35.0, 45.0, 0.6),
    }
)
