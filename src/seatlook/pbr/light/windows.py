"""The bright regions of a panorama as lights of their own, each with its own shadow.

What is left is smooth enough to be gathered by few rays: nothing in it is brighter than a few times
its mean. Light and colour of both together are those of the whole, and nothing is counted twice.
"""

from __future__ import annotations

import functools
from dataclasses import replace

import numpy as np

from seatlook.model import FloatArray, IntArray, Light, Rig
from seatlook.model.light.lamps import BRIGHTEST
from seatlook.pbr.light.panorama import directions, shrunk, solid_angles
from seatlook.pbr.light.rig import LUMINANCE

# Brighter than so many times the mean of all directions is a window.
_BRIGHT = 4.0
# Discs at most, and angular radius [rad] below which one is not parted for its shape.
MOST, _ROUND = 16, np.radians(6.5)
# Share of all light below which a region stays in the smooth part.
_LEAST = 0.003
# Rows of the picture in which windows are looked for; finer ones are a small sun at most.
_ROWS = 256


def with_windows(rig: Rig) -> Rig:
    """Rig whose panorama's bright regions are lights; the same rig where it has none."""
    if rig.panorama is None:
        return rig
    lights, rest = _windows((rig.panorama.shape, rig.panorama.tobytes()))
    return replace(rig, lights=(*rig.lights, *lights), panorama=rest) if lights else rig


@functools.lru_cache(maxsize=4)
def _windows(key: tuple[tuple[int, int, int], bytes]) -> tuple[tuple[Light, ...], FloatArray]:
    """Lights of a panorama, and what is left of it."""
    panorama = np.frombuffer(key[1]).reshape(key[0])
    if len(panorama) > _ROWS:
        panorama = shrunk(panorama, _ROWS)
    rows, columns = panorama.shape[:2]
    area = np.repeat(solid_angles(rows, columns), columns, axis=1).ravel()
    colour = panorama.reshape(-1, 3)
    bright = colour @ LUMINANCE
    level = _BRIGHT * (bright @ area) / area.sum()
    over = np.maximum(0.0, 1.0 - level / np.maximum(bright, 1e-300))
    pixels = np.flatnonzero(over)
    light = (over[:, None] * colour * area[:, None])[pixels]
    ways = directions(rows, columns).reshape(-1, 3)[pixels]
    lights: list[Light] = []
    rest, least = colour.copy(), _LEAST * (bright @ area)
    for part in _parts(ways, light @ LUMINANCE):
        one = _disc(f"window {len(lights) + 1}", ways[part], light[part], area[pixels[part]])
        if (light[part] @ LUMINANCE).sum() >= least and one is not None:
            lights.append(one)
            rest[pixels[part]] *= (1.0 - over[pixels[part]])[:, None]
    return tuple(lights), rest.reshape(panorama.shape)


def _parts(ways: FloatArray, light: FloatArray) -> list[IntArray]:
    """Parts of pixels, the one whose light is spread most cut across, again and again."""
    parts = [np.arange(len(ways))] if len(ways) else []
    spreads = [_spread(ways, light)] if len(ways) else []
    while parts and len(parts) < MOST:
        widest = int(
            np.argmax([s.sum() * light[p].sum() for p, (s, _) in zip(parts, spreads, strict=True)])
        )
        part, (spread, axes) = parts[widest], spreads[widest]
        if np.sqrt(2.0 * spread.sum()) <= _ROUND:
            break
        middle = np.average(ways[part], axis=0, weights=light[part])
        side = (ways[part] - middle) @ axes[:, -1] > 0.0
        halves = [part[side], part[~side]]
        parts[widest : widest + 1] = halves
        spreads[widest : widest + 1] = [_spread(ways[half], light[half]) for half in halves]
    return parts


def _spread(ways: FloatArray, light: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Variances (3,) of directions along their axes (3, 3), the widest last."""
    away = ways - np.average(ways, axis=0, weights=light)
    spread, axes = np.linalg.eigh((away * light[:, None]).T @ away / light.sum())
    return np.maximum(spread, 0.0), axes


def _disc(name: str, ways: FloatArray, light: FloatArray, area: FloatArray) -> Light | None:
    """Far lamp of the same light, colour, middle and variance; None if no lamp is so bright."""
    middle = (light @ LUMINANCE) @ ways
    middle /= np.linalg.norm(middle)
    lux = middle @ (ways.T @ light)
    # A pixel is a square, whose corners lie further away than its middle.
    spread = _spread(ways, light @ LUMINANCE)[0].sum() + area.mean() / 6.0
    total = float(lux @ LUMINANCE)
    if total > BRIGHTEST:
        return None
    size = 2.0 * np.arctan(np.sqrt(2.0 * spread))
    return Light(
        name=name, intensity=total, vector=middle, near=False, colour=lux / total, size=size
    )
