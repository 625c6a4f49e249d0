"""A sky given as a picture of all directions: its light on a plane, and as rough lobes see it."""

from __future__ import annotations

import functools

import numpy as np

from seatlook.model import FloatArray

# Rows of the small panorama that is lit with, and its levels of roughness.
_ROWS = 32
LEVELS = 7


def directions(rows: int, columns: int) -> FloatArray:
    """Unit vectors (rows, columns, 3) of the pixels: first row up, first column from azimuth 0."""
    polar = np.pi * (np.arange(rows) + 0.5) / rows
    azimuth = 2 * np.pi * (np.arange(columns) + 0.5) / columns
    level = np.sin(polar)[:, None]
    up = np.repeat(np.cos(polar)[:, None], columns, axis=1)
    return np.stack([level * np.sin(azimuth), -level * np.cos(azimuth), up], axis=-1)


def solid_angles(rows: int, columns: int) -> FloatArray:
    """Solid angle (rows, 1) [sr] of a pixel of each row; all of them make 4 pi."""
    edges = np.cos(np.pi * np.arange(rows + 1) / rows)
    return ((edges[:-1] - edges[1:]) * 2 * np.pi / columns)[:, None]


def irradiance_on(panorama: FloatArray, normal: FloatArray) -> FloatArray:
    """Irradiance (3,) [lux] of a panorama (h, w, 3) [cd/m2] on an open plane."""
    rows, columns = panorama.shape[:2]
    weight = np.maximum(directions(rows, columns) @ normal, 0.0) * solid_angles(rows, columns)
    return np.asarray((panorama * weight[..., None]).sum(axis=(0, 1)))


def shrunk(panorama: FloatArray, rows: int = _ROWS) -> FloatArray:
    """Panorama (rows, 2 rows, 3) of the same light: means weighted by solid angle."""
    for axis, count in ((1, 2 * rows), (0, rows)):
        panorama = np.moveaxis(panorama, axis, 0)
        size = len(panorama)
        # Each old pixel goes to the new ones that it overlaps.
        edges = np.arange(count + 1) * size / count
        area = np.ones(size) if axis == 1 else solid_angles(size, 1)[:, 0]
        total = np.concatenate(
            [np.zeros((1, *panorama.shape[1:])), np.cumsum(panorama * area[:, None, None], axis=0)]
        )
        weight = np.concatenate([[0.0], np.cumsum(area)])
        whole = np.minimum(edges.astype(int), size - 1)
        part = (edges - whole)[:, None, None]
        at = total[whole] + part * (total[whole + 1] - total[whole])
        mass = weight[whole] + part[:, 0, 0] * (weight[whole + 1] - weight[whole])
        panorama = np.moveaxis(np.diff(at, axis=0) / np.diff(mass)[:, None, None], 0, axis)
    return np.ascontiguousarray(panorama)


def levels_of(panorama: FloatArray) -> FloatArray:
    """Panorama (LEVELS, h, w, 3) as lobes of roughness 0 to 1 around each direction see it."""
    key = (panorama.shape, panorama.tobytes())
    return _levels(key)


def cosine_mean(panorama: FloatArray, normals: FloatArray) -> FloatArray:
    """Mean luminance (n, 3) of the half-spaces around unit normals (n, 3), weighted by cosine.

    By blocks of the picture, each as the sum of its light as vectors: exact for all that do not
    lie across the plane, and for an even picture.
    """
    small = shrunk(panorama)
    rows, columns = small.shape[:2]
    # The fourth channel is an even picture of luminance 1.
    light = np.dstack([small, np.ones((rows, columns))]) * solid_angles(rows, columns)[..., None]
    vectors = light[..., None] * directions(rows, columns)[:, :, None, :]
    blocks = vectors.reshape(rows // 2, 2, columns // 2, 2, 4, 3).sum(axis=(1, 3)).reshape(-1, 4, 3)
    out = np.empty((len(normals), 4))
    for start in range(0, len(normals), 4096):
        part = slice(start, start + 4096)
        for k in range(4):
            out[part, k] = np.maximum(normals[part] @ blocks[:, k].T, 0.0).sum(axis=1)
    return np.asarray(out[:, :3] / out[:, 3:])


@functools.lru_cache(maxsize=4)
def _levels(key: tuple[tuple[int, int, int], bytes]) -> FloatArray:
    small = shrunk(np.frombuffer(key[1]).reshape(key[0]))
    rows, columns = small.shape[:2]
    d = directions(rows, columns).reshape(-1, 3)
    area = np.repeat(solid_angles(rows, columns), columns, axis=1).ravel()
    cosine = np.clip(d @ d.T, -1.0, 1.0)
    levels = [small]
    for roughness in np.linspace(0, 1, LEVELS)[1:]:
        # Reflected directions of GGX microfacets seen along their mean: half the angle, with N.L.
        half = np.sqrt(0.5 * (1 + cosine))
        alpha2 = max(roughness**2, 0.03) ** 2
        weight = np.maximum(cosine, 0) / (half**2 * (alpha2 - 1) + 1) ** 2 * area
        levels.append(
            (weight @ small.reshape(-1, 3) / weight.sum(axis=1)[:, None]).reshape(small.shape)
        )
    return np.ascontiguousarray(levels)
