"""A seat on a turntable: the camera goes round it, and the lights may go with the camera."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from seatlook.model._check import FloatArray
from seatlook.model.light.camera import Camera, stepped_back
from seatlook.model.light.lamps import Light, Rig, turned


def about_z(angle_deg: float) -> FloatArray:
    """Rotation (3, 3) about z, counter-clockwise seen from above."""
    angle = np.radians(angle_deg)
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def turned_camera(camera: Camera, angle_deg: float) -> Camera:
    """Camera that has gone round the vertical through its target.

    Examples
    --------
    >>> front = Camera(name="front", position=np.array([0.0, -2.0, 1.0]), target=np.zeros(3))
    >>> turned_camera(front, 30.0).position.round(3).tolist()
    [1.0, -1.732, 1.0]
    """
    rotation = about_z(angle_deg)
    position = camera.target + rotation @ (camera.position - camera.target)
    return replace(camera, position=position, up=rotation @ camera.up)


def turned_rig(rig: Rig, angle_deg: float, axis: FloatArray) -> Rig:
    """Rig whose lamps and panorama have gone round the vertical through ``axis`` (3,) [m].

    Its exposure is the same: the card at the seat turns with it.

    Examples
    --------
    >>> from seatlook.model import bulb
    >>> rig = Rig(name="bulb", lights=(bulb(position_mm=(1000, 0, 500)),))
    >>> turned_rig(rig, 180.0, np.zeros(3)).lights[0].vector.round(6).tolist()
    [-1.0, 0.0, 0.5]
    """
    rotation = about_z(angle_deg)
    lights = tuple(_turned_light(light, rotation, axis) for light in rig.lights)
    return replace(turned(rig, angle_deg), lights=lights)


def _turned_light(light: Light, rotation: FloatArray, axis: FloatArray) -> Light:
    middle = np.array([axis[0], axis[1], 0.0]) if light.near else np.zeros(3)
    vector = middle + rotation @ (light.vector - middle)
    return replace(light, vector=vector, sides=light.sides @ rotation.T)


def round_the_seat(camera: Camera, points: FloatArray, pictures: int) -> tuple[Camera, ...]:
    """Cameras evenly round ``points`` (n, 3) [m], all as far away as the worst of them needs.

    Parameters
    ----------
    camera : the first; its target becomes the axis, moved to the middle of the points

    Examples
    --------
    >>> corners = np.array([[x, y, 0.0] for x in (-1.0, 1.0) for y in (-0.2, 0.2)])
    >>> front = Camera(name="front", position=np.array([0.0, -2.0, 1.0]), target=np.zeros(3))
    >>> ring = round_the_seat(front, corners, 4)
    >>> len(ring), all(0 < c.pixel(p)[0] < 1280 for c in ring for p in corners)
    (4, True)
    """
    middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
    camera = replace(camera, position=camera.position + middle - camera.target, target=middle)
    angles = [360.0 * k / pictures for k in range(pictures)]
    ring = [turned_camera(camera, angle) for angle in angles]
    far = max(
        (stepped_back(one, points) for one in ring),
        key=lambda one: float(np.linalg.norm(one.position - one.target)),
    )
    reach = float(np.linalg.norm(far.position - far.target))
    away = camera.position - camera.target
    first = replace(camera, position=middle + reach / float(np.linalg.norm(away)) * away)
    return tuple(turned_camera(first, angle) for angle in angles)
