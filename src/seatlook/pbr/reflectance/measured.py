"""Measured map sets as the kernels take them: slopes, alpha squared, and levels of both."""

from __future__ import annotations

import functools
from collections.abc import Iterable

import numpy as np
import numpy.typing as npt

from seatlook.model import Appearance, FloatArray, TextureMaps
from seatlook.model.colour import srgb_decode
from seatlook.model.texture import Pixels
from seatlook.pbr.kernels.measured import Measured

Texels = npt.NDArray[np.float32]

# Steeper than 76 degrees is the rounding of a normal that nearly lies.
_STEEPEST = 4.0


def map_sets(appearances: Iterable[Appearance]) -> tuple[TextureMaps, ...]:
    """Return the map sets of some appearances, each once; a material's ``maps`` counts them."""
    return tuple(dict.fromkeys(a.maps for a in appearances if a.maps is not None))


@functools.lru_cache(maxsize=32)
def mean_albedo(maps: TextureMaps) -> FloatArray:
    """Mean base colour (3,), linear; 1 where there is no map of it."""
    if maps.albedo is None:
        return np.ones(3)
    channels = np.moveaxis(maps.albedo, 2, 0)
    count = np.array([np.bincount(channel.ravel(), minlength=256) for channel in channels])
    linear = srgb_decode(np.arange(256) / 255)
    return np.asarray(np.maximum(count @ linear / count.sum(axis=1), 1e-4))


# A gallery draws one material after the other: the last two looks are cached.
@functools.lru_cache(maxsize=2)
def load_maps(sets: tuple[TextureMaps, ...]) -> Measured:
    """Pack map sets; that of 2048 x 2048 pixels takes 180 MB."""
    pyramids = [_levels(maps) for maps in sets]
    depth = max((len(p) for p in pyramids), default=1)
    levels = np.zeros((len(sets), depth, 3), dtype=np.int64)
    start = 0
    for k, pyramid in enumerate(pyramids):
        for n, level in enumerate(pyramid):
            levels[k, n] = start, *level.shape[:2]
            start += level.shape[0] * level.shape[1]
        levels[k, len(pyramid) :] = levels[k, len(pyramid) - 1]
    texels = np.empty((start, 8), dtype=np.float32)
    for k, pyramid in enumerate(pyramids):
        for n, level in enumerate(pyramid):
            first = levels[k, n, 0]
            texels[first : first + level.shape[0] * level.shape[1]] = level.reshape(-1, 8)
    size = np.array([[maps.width, maps.height] for maps in sets]).reshape(-1, 2)
    return Measured(texels, levels, size)


def _levels(maps: TextureMaps) -> list[Texels]:
    """Levels (h, w, 8) from fine to one texel; the last channel becomes the slopes' variance."""
    stack, out = _finest(maps), []
    while True:
        level = stack.copy()
        level[..., 7] = np.maximum(0.0, 0.5 * (stack[..., 7] - (stack[..., 5:7] ** 2).sum(axis=-1)))
        out.append(level)
        rows, columns = stack.shape[:2]
        if rows == columns == 1:
            return out
        down, across = min(rows, 2), min(columns, 2)
        stack = stack.reshape(rows // down, down, columns // across, across, 8).mean(axis=(1, 3))


def _finest(maps: TextureMaps) -> Texels:
    """Colour over its mean, alpha squared, metalness, slopes and their squared length."""
    shapes = [getattr(maps, name).shape[:2] for name in maps.given]
    rows, columns = (_power_of_two(max(s[axis] for s in shapes)) for axis in range(2))
    out = np.ones((rows, columns, 8), dtype=np.float32)
    out[..., 5:] = 0.0
    if maps.albedo is not None:
        out[..., :3] = _fitted(srgb_decode(_share(maps.albedo)), rows, columns)
        out[..., :3] /= mean_albedo(maps).astype(np.float32)
    if maps.roughness is not None:
        out[..., 3:4] = _fitted(_share(maps.roughness)[..., None] ** 4, rows, columns)
    if maps.metalness is not None:
        out[..., 4:5] = _fitted(_share(maps.metalness)[..., None], rows, columns)
    if maps.normal is not None:
        out[..., 5:8] = _fitted(_slopes(maps.normal), rows, columns)
    return out


def _power_of_two(n: int) -> int:
    return 1 << (n - 1).bit_length()


def _share(pixels: Pixels) -> Texels:
    """From 0 to 1, first row at v = 0."""
    return pixels[::-1].astype(np.float32) / np.float32(255)


def _slopes(normal: Pixels) -> Texels:
    """Slopes (h, w, 3) along u and v, without what they have on average, and squared length."""
    # 127 and 128 stand for an upright normal: what 8 bits leave over must not tilt the panel.
    n = 2 * _share(normal) - 1
    up = np.maximum(n[..., 2:3], np.hypot(n[..., 0:1], n[..., 1:2]) / _STEEPEST)
    slope = -n[..., :2] / np.maximum(up, 1e-6)
    slope -= slope.mean(axis=(0, 1))
    return np.concatenate([slope, (slope**2).sum(axis=-1, keepdims=True)], axis=-1)


def _fitted(values: Texels, rows: int, columns: int) -> Texels:
    """Values (h, w, c) on rows x columns texels, by the area in which old and new overlap."""
    for axis, count in ((0, rows), (1, columns)):
        size = values.shape[axis]
        if size == count:
            continue
        values = np.moveaxis(values, axis, 0)
        total = np.concatenate(
            [np.zeros((1, *values.shape[1:])), np.cumsum(values, axis=0, dtype=np.float64)]
        )
        edges = np.arange(count + 1) * size / count
        whole = np.minimum(edges.astype(int), size - 1)
        part = (edges - whole)[:, None, None]
        at = total[whole] + part * (total[whole + 1] - total[whole])
        values = np.moveaxis(np.diff(at, axis=0) * (count / size), 0, axis).astype(np.float32)
    return values
