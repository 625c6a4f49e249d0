"""The rays of a camera."""

from __future__ import annotations

import numpy as np

from seatlook.errors import InputError
from seatlook.model import Camera
from seatlook.pbr.kernels.surface import Eye


def eye_of(camera: Camera, factor: int) -> Eye:
    """Rays through the centres of ``factor`` x ``factor`` samples per pixel.

    Raises
    ------
    InputError
        The camera sits on its target or looks along its up vector.
    """
    forward = camera.target - camera.position
    right = np.cross(forward, camera.up)
    if np.linalg.norm(right) <= 1e-9 * np.linalg.norm(camera.up) * np.linalg.norm(forward):
        raise InputError.single(
            f"camera {camera.name}",
            got=f"position {camera.position.tolist()}, up {camera.up.tolist()}",
            expected="a target away from the position and an up vector across the view",
        )
    forward = forward / np.linalg.norm(forward)
    right = right / np.linalg.norm(right)
    down = -np.cross(right, forward)
    width, height = camera.size[0] * factor, camera.size[1] * factor
    step = 2 * np.tan(np.radians(camera.vertical_fov_deg) / 2) / height
    first = forward - 0.5 * (width - 1) * step * right - 0.5 * (height - 1) * step * down
    return Eye(np.array(camera.position), first, step * right, step * down)
