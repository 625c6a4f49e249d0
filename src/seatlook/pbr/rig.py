"""Lights as the kernels take them, and the lux they give."""

from __future__ import annotations

import numpy as np

from seatlook.model import FloatArray, Light, Rig
from seatlook.pbr.kernels.shade import Lights

# Luminance of linear sRGB (ITU-R BT.709).
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
# Where the grey card lies, face up: the middle of a seat whose base is the world's origin.
SEAT = (0.0, 0.0, 0.1)


def pack_lights(rig: Rig) -> Lights:
    """Stack the lights of a rig; intensity carries the colour."""
    lights = rig.lights
    return Lights(
        np.array([int(light.near) for light in lights], dtype=np.int64),
        np.array([light.vector for light in lights], dtype=np.float64).reshape(-1, 3),
        np.array([light.intensity * light.colour for light in lights]).reshape(-1, 3),
    )


def illuminance(
    light: Light,
    point: tuple[float, float, float] | FloatArray = SEAT,
    normal: tuple[float, float, float] | FloatArray = (0.0, 0.0, 1.0),
) -> float:
    """Illuminance E [lux] of one light on a small plane, 0 from behind.

    Parameters
    ----------
    point : (3,) [m]; normal : (3,) unit vector

    Examples
    --------
    >>> from seatlook.model import bulb
    >>> round(illuminance(bulb(lumen=800, position_mm=(0, 0, 600))), 1)
    254.6
    """
    n = np.asarray(normal, dtype=float)
    if not light.near:
        return float(light.intensity * max(0.0, float(light.vector @ n)))
    to = light.vector - np.asarray(point, dtype=float)
    distance = float(np.linalg.norm(to))
    return float(light.intensity * max(0.0, float(to @ n)) / distance**3)


def lux_at_seat(
    rig: Rig, point: tuple[float, float, float] | FloatArray = SEAT
) -> dict[str, float]:
    """Illuminance [lux] on a grey card lying on the seat, per light, then ``sky`` and ``total``."""
    lux = {light.name: illuminance(light, point) for light in rig.lights}
    if rig.ambient > 0:
        lux["sky"] = np.pi * rig.ambient
    return {**lux, "total": sum(lux.values())}


def white_of(rig: Rig, point: tuple[float, float, float] | FloatArray = SEAT) -> FloatArray:
    """Linear sRGB (3,) of luminance 1 of the light on the grey card: what a display calls white.

    A camera set to 6500 K would show everything under a 2700 K bulb orange; the eye does not.
    """
    lux = [illuminance(light, point) for light in rig.lights]
    total = np.pi * rig.ambient * sky_colour(rig)
    for e, light in zip(lux, rig.lights, strict=True):
        total = total + e * light.colour
    return np.asarray(total / (total @ LUMINANCE)) if total.min() > 0 else np.ones(3)


def sky_colour(rig: Rig) -> FloatArray:
    """Linear sRGB (3,) of luminance 1 of the sky: that of the lights it scatters, D65 without."""
    total = sum((light.intensity * light.colour for light in rig.lights), np.zeros(3))
    return np.asarray(total / (total @ LUMINANCE)) if total.min() > 0 else np.ones(3)
