"""The light that shows wrinkles most: a search over the hemisphere, coarse to fine."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from seatlook.errors import InputError
from seatlook.model import Camera, FloatArray, Rig, bulb, direction, sun
from seatlook.model.progress import Progress, silent
from seatlook.visibility.view import Looks, View

LOWEST_DEG = 10.0
_GOLDEN = np.pi * (3 - np.sqrt(5))

RigAt = Callable[[float, float], Rig]


@dataclass(frozen=True, slots=True, kw_only=True)
class WorstLight:
    """Result of a search.

    Parameters
    ----------
    azimuth_deg, elevation_deg : of the worst light
    vwi : its score, at the quality of the search
    tried : (k, 3) float64   azimuth, elevation [deg] and VWI of every light, in order of trial
    """

    azimuth_deg: float
    elevation_deg: float
    vwi: float
    tried: FloatArray


def bulb_rig(
    camera: Camera, *, lumen: float = 800.0, distance: float = 0.8, ambient_lux: float = 50.0
) -> RigAt:
    """Bulbs at ``distance`` [m] from what the camera looks at."""

    def at(azimuth_deg: float, elevation_deg: float) -> Rig:
        place = camera.target + distance * direction(azimuth_deg, elevation_deg)
        x, y, z = (1000 * place).tolist()
        lamp = bulb(lumen=lumen, position_mm=(x, y, z))
        return Rig(name="bulb", lights=(lamp,), ambient=ambient_lux / np.pi)

    return at


def sun_rig(*, illuminance_lux: float = 20_000.0, ambient_lux: float = 2_000.0) -> RigAt:
    """Suns of equal illuminance on a plane that faces them."""

    def at(azimuth_deg: float, elevation_deg: float) -> Rig:
        lamp = sun(
            illuminance_lux=illuminance_lux, azimuth_deg=azimuth_deg, elevation_deg=elevation_deg
        )
        return Rig(name="sun", lights=(lamp,), ambient=ambient_lux / np.pi)

    return at


def search_light(
    view: View, looks: Looks, rig_at: RigAt, *, coarse: int = 60, rounds: int = 3, keep: int = 2
) -> WorstLight:
    """Find the light under which the view's wrinkles score highest.

    See :func:`worst_direction`; a view of half the density in draft quality is meant for this.
    """
    return worst_direction(
        lambda azimuth, elevation: view.vwi(looks, rig_at(azimuth, elevation)),
        coarse=coarse,
        rounds=rounds,
        keep=keep,
    )


def worst_direction(
    value: Callable[[float, float], float], *, coarse: int = 60, rounds: int = 3, keep: int = 2
) -> WorstLight:
    """Maximise a function of azimuth and elevation [deg] over the hemisphere above 10 deg.

    Parameters
    ----------
    coarse : directions spread evenly in the first round
    rounds : of refinement; each tries six neighbours round the best at half the distance before
    keep : how many of the best are refined

    Examples
    --------
    >>> top = worst_direction(lambda azimuth, elevation: -abs(elevation - 40))
    >>> abs(top.elevation_deg - 40) < 2
    True
    """
    if coarse < 8 or rounds < 0 or keep < 1:
        raise InputError.single(
            "light search",
            got=(coarse, rounds, keep),
            expected="coarse >= 8, rounds >= 0, keep >= 1",
        )
    tried = [(*angles, value(*angles)) for angles in hemisphere(coarse)]
    # Mean distance of neighbours when `coarse` directions share the solid angle.
    spacing = float(np.sqrt(2 * np.pi * (1 - np.sin(np.radians(LOWEST_DEG))) / coarse))
    for _ in range(rounds):
        spacing /= 2
        best = sorted(tried, key=lambda entry: -entry[2])[:keep]
        for azimuth, elevation, _ in best:
            for angles in _ring(azimuth, elevation, spacing):
                if not _near(angles, tried, spacing / 2):
                    tried.append((*angles, value(*angles)))
    azimuth, elevation, most = max(tried, key=lambda entry: entry[2])
    return WorstLight(azimuth_deg=azimuth, elevation_deg=elevation, vwi=most, tried=np.array(tried))


def hemisphere(count: int) -> list[tuple[float, float]]:
    """Azimuth and elevation [deg] of ``count`` directions, equal solid angles (golden spiral)."""
    k = np.arange(count)
    floor = np.sin(np.radians(LOWEST_DEG))
    elevation = np.degrees(np.arcsin(floor + (1 - floor) * (k + 0.5) / count))
    azimuth = np.degrees(k * _GOLDEN) % 360
    return list(zip(azimuth.tolist(), elevation.tolist(), strict=True))


def _ring(azimuth_deg: float, elevation_deg: float, radius: float) -> list[tuple[float, float]]:
    """Six directions ``radius`` [rad] away; those below the lowest elevation are raised to it."""
    centre = direction(azimuth_deg, elevation_deg)
    side = np.array([np.cos(np.radians(azimuth_deg)), np.sin(np.radians(azimuth_deg)), 0.0])
    up = np.cross(centre, side)
    ring = []
    for angle in np.arange(6) * np.pi / 3:
        away = np.cos(angle) * side + np.sin(angle) * up
        x, y, z = np.cos(radius) * centre + np.sin(radius) * away
        elevation = max(float(np.degrees(np.arcsin(np.clip(z, -1.0, 1.0)))), LOWEST_DEG)
        ring.append((float(np.degrees(np.arctan2(x, -y)) % 360), elevation))
    return ring


def _near(
    angles: tuple[float, float], tried: list[tuple[float, float, float]], radius: float
) -> bool:
    here = direction(*angles)
    return any(float(here @ direction(a, e)) > np.cos(radius) for a, e, _ in tried)


def worst_lights(
    view: View, textures: Mapping[str, Looks], *, progress: Progress = silent
) -> dict[str, dict[str, WorstLight]]:
    """Search the sun direction and the bulb position that show the wrinkles of each texture most.

    Returns
    -------
    dict
        texture -> "sun" or "bulb" -> the worst light.
    """
    rigs = {"sun": sun_rig(), "bulb": bulb_rig(view.camera)}
    lights: dict[str, dict[str, WorstLight]] = {}
    for name, looks in textures.items():
        lights[name] = {}
        for kind, rig_at in rigs.items():
            progress("search light", texture=name, kind=kind)
            lights[name][kind] = search_light(view, looks, rig_at)
    return lights
