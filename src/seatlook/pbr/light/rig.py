"""Lights as the kernels take them, and the lux they give."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from seatlook.model import FloatArray, Light, Rig
from seatlook.pbr.kernels.area import ONE_SIDED, TWO_SIDED
from seatlook.pbr.kernels.light import Lights
from seatlook.pbr.light.panorama import cosine_mean, irradiance_on, levels_of

# Luminance of linear sRGB (ITU-R BT.709).
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
# Where the grey card lies, face up: the middle of a seat whose base is the world's origin.
SEAT = (0.0, 0.0, 0.1)
_UP = np.array([0.0, 0.0, 1.0])
# Points along and across a rectangle by which its light on the card is summed.
_POINTS = (256, 64)


def pack_lights(rig: Rig, factor: int = 1) -> Lights:
    """Stack the lights of a rig; intensity carries the colour.

    ``factor`` x ``factor`` samples of a pixel share the discs of the lights among themselves.
    """
    lights = rig.lights
    return Lights(
        np.array([_code(light) for light in lights], dtype=np.int64),
        np.array([light.vector for light in lights], dtype=np.float64).reshape(-1, 3),
        np.array([light.intensity * light.colour for light in lights]).reshape(-1, 3),
        np.array([_size(light) for light in lights], dtype=np.float64),
        np.array([light.sides for light in lights], dtype=np.float64).reshape(-1, 2, 3),
        disc_points(factor),
    )


def patched(rig: Rig) -> Rig:
    """Rig whose rectangles are four smaller ones each: for what is taken as small as its middle."""
    lights: list[Light] = []
    for light in rig.lights:
        if not light.is_rectangle:
            lights.append(light)
            continue
        a, b = light.sides
        lengthwise = np.linalg.norm(a) > 4 * np.linalg.norm(b)
        places = [(x, 0.0) for x in (-0.75, -0.25, 0.25, 0.75)]
        sides = np.array([a / 4, b])
        if not lengthwise:
            places = [(x, y) for x in (-0.5, 0.5) for y in (-0.5, 0.5)]
            sides = np.array([a / 2, b / 2])
        lights += [
            replace(
                light,
                intensity=light.intensity / 4,
                sides=sides,
                vector=light.vector + x * a + y * b,
            )
            for x, y in places
        ]
    return replace(rig, lights=tuple(lights))


def _code(light: Light) -> int:
    """Kind of a light, see ``Lights.near``."""
    if not light.is_rectangle:
        return int(light.near)
    return TWO_SIDED if light.two_sided else ONE_SIDED


def _size(light: Light) -> float:
    """Size of a light, of a rectangle that of a disc as large."""
    if not light.is_rectangle:
        return light.size
    long, short = np.linalg.norm(light.sides, axis=1)
    return float(np.sqrt(4 * long * short / np.pi))


# Order of 4 x 4 points, found by exchanging pairs, whose places on a disc vary together neither
# with those of samples in a pixel nor much with their squares and products.
_UNRELATED = [0, 7, 2, 8, 9, 13, 10, 15, 14, 4, 11, 6, 3, 5, 12, 1]


def disc_points(factor: int) -> FloatArray:
    """Points (factor^2, 2) of the unit disc, one per sample; Shirley and Chiu 1997.

    Scaled so that their own variance and that of the part each stands for, 1 / factor^2 of the
    disc, add up to the disc's 1/4 per axis. Samples further right or down in a pixel must not look
    at points further right or down, or highlights would move: 16 are put out of order, four
    cannot be.

    Examples
    --------
    >>> (disc_points(4) ** 2).sum(axis=1).mean().round(6), disc_points(1).tolist()
    (np.float64(0.46875), [[0.0, 0.0]])
    """
    if factor == 1:
        return np.zeros((1, 2))
    even = (2 * np.arange(factor) + 1) / factor - 1
    x, y = np.meshgrid(even, even)
    wide = np.abs(x) > np.abs(y)
    r = np.where(wide, x, y)
    q = np.pi / 4 * np.where(wide, y, x) / np.where(r == 0, 1.0, r)
    phi = np.where(wide, q, np.pi / 2 - q)
    points = np.stack([r * np.cos(phi), r * np.sin(phi)], axis=-1).reshape(-1, 2)
    if factor == 4:
        points = points[_UNRELATED]
    wanted = 0.5 * (1 - 1 / factor**2)
    return np.asarray(points * np.sqrt(wanted / (points**2).sum(axis=1).mean()))


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
    if light.is_rectangle:
        return _of_rectangle(light, to, n)
    distance = float(np.linalg.norm(to))
    return float(light.intensity * max(0.0, float(to @ n)) / distance**3)


def _of_rectangle(light: Light, to: FloatArray, n: FloatArray) -> float:
    """Illuminance [lux] of a rectangle whose middle lies at ``to`` from a plane, by its points."""
    a, b = light.sides
    x, y = ((2 * np.arange(count) + 1) / count - 1 for count in _POINTS)
    d = to + x[:, None, None] * a + y[:, None] * b
    ahead = -(to @ np.cross(a, b)) / np.linalg.norm(np.cross(a, b))
    ahead = np.abs(ahead) if light.two_sided else np.maximum(0.0, ahead)
    each = np.maximum(d @ n, 0.0) * ahead / (d * d).sum(axis=-1) ** 2
    return float(light.intensity * each.mean())


def lux_at_seat(
    rig: Rig, point: tuple[float, float, float] | FloatArray = SEAT
) -> dict[str, float]:
    """Illuminance [lux] on a grey card lying on the seat, per light, then ``sky`` and ``total``."""
    lux: dict[str, float] = {}
    for light in rig.lights:
        # Two may have one name.
        lux[light.name] = lux.get(light.name, 0.0) + illuminance(light, point)
    sky = float(sky_irradiance(rig) @ LUMINANCE)
    if sky > 0:
        lux["sky"] = sky
    return {**lux, "total": sum(lux.values())}


def white_of(rig: Rig, point: tuple[float, float, float] | FloatArray = SEAT) -> FloatArray:
    """Linear sRGB (3,) of luminance 1 of the light on the grey card: what a display calls white.

    A camera set to 6500 K would show everything under a 2700 K bulb orange; the eye does not.
    """
    total = _irradiance(rig, point, _UP)
    return np.asarray(total / (total @ LUMINANCE)) if total.min() > 0 else np.ones(3)


def white_card(rig: Rig, point: tuple[float, float, float] | FloatArray = SEAT) -> FloatArray:
    """Radiance (3,) [cd/m2] of a white card at the seat that faces the light.

    It faces where the light of all lamps and of the sky comes from on the whole: up under an even
    sky alone.

    Examples
    --------
    >>> from seatlook.model import booth
    >>> rig = Rig(name="b", lights=(booth(illuminant="D65", elevation_deg=45.0),))
    >>> round(float(np.pi * white_card(rig) @ LUMINANCE))
    1500
    """
    toward = np.array(
        [
            _irradiance(rig, point, axis) @ LUMINANCE - _irradiance(rig, point, -axis) @ LUMINANCE
            for axis in np.eye(3)
        ]
    )
    length = float(np.linalg.norm(toward))
    return _irradiance(rig, point, toward / length if length > 0 else _UP) / np.pi


def _irradiance(
    rig: Rig, point: tuple[float, float, float] | FloatArray, normal: FloatArray
) -> FloatArray:
    """Irradiance (3,) [lux] of lamps and open sky on a small plane."""
    total = sky_irradiance(rig, normal)
    for light in rig.lights:
        total = total + illuminance(light, point, normal) * light.colour
    return total


def sky_irradiance(rig: Rig, normal: FloatArray = _UP) -> FloatArray:
    """Irradiance (3,) [lux] of the open sky on a plane, without more said one that faces up."""
    if rig.panorama is not None:
        return irradiance_on(rig.panorama, normal)
    return np.pi * rig.ambient * sky_colour(rig)


def sky_colour(rig: Rig) -> FloatArray:
    """Linear sRGB (3,) of luminance 1 of an even sky: that of its lights, D65 without."""
    total = sum((light.intensity * light.colour for light in rig.lights), np.zeros(3))
    return np.asarray(total / (total @ LUMINANCE)) if total.min() > 0 else np.ones(3)


def sky_levels(rig: Rig) -> FloatArray:
    """Panorama of a rig as the kernels take it; no levels where the sky is even."""
    return np.zeros((0, 2, 4, 3)) if rig.panorama is None else levels_of(rig.panorama)


def sky_unhidden(rig: Rig, normals: FloatArray) -> FloatArray:
    """Mean luminance (n, 3) that planes with unit normals (n, 3) get of a rig's panorama."""
    if rig.panorama is None:
        return np.zeros((len(normals), 3))
    return cosine_mean(rig.panorama, normals)
