"""Procedural relief of leather, suede and weave as tiled slope maps with filtered levels."""

from __future__ import annotations

import functools

import numpy as np

from seatlook.model import Appearance, FloatArray
from seatlook.pbr.kernels.grain import LEATHER, SUEDE, WEAVE, Textures

SIZE = 1024
CELLS = 64
# "none" has no map.
MAPS = {"leather": LEATHER, "suede": SUEDE, "weave": WEAVE}


def texture_index(appearance: Appearance) -> int:
    """Index of the map of an appearance, -1 where it has no relief."""
    if appearance.texture == "none" or appearance.texture_depth == 0:
        return -1
    return MAPS[appearance.texture]


@functools.cache
def load_textures() -> Textures:
    """Make all maps once per process."""
    reliefs = {LEATHER: _leather(), SUEDE: _suede(), WEAVE: _weave()}
    levels = SIZE.bit_length()
    sizes = [(SIZE >> k) ** 2 for k in range(levels)]
    start = np.concatenate([[0], np.cumsum(sizes)])
    texels = np.empty((len(MAPS), start[-1], 4), dtype=np.float32)
    for which, (height, share) in reliefs.items():
        low, high = np.percentile(height, [5, 95])
        for k, level in enumerate(_levels(height / (high - low), share)):
            texels[which, start[k] : start[k + 1]] = level
    return Textures(texels, start[:-1].astype(np.int64), SIZE, float(CELLS))


def _levels(height: FloatArray, share: FloatArray) -> list[FloatArray]:
    """Slopes, their variance and the colour share, each level half the one before."""
    step = 2 * CELLS / SIZE
    su = (np.roll(height, -1, axis=1) - np.roll(height, 1, axis=1)) / step
    sv = (np.roll(height, -1, axis=0) - np.roll(height, 1, axis=0)) / step
    stack = np.stack([su, sv, su**2 + sv**2, share], axis=-1)
    levels = []
    while True:
        level = stack.copy()
        level[..., 2] = np.maximum(
            0.0, 0.5 * (stack[..., 2] - stack[..., 0] ** 2 - stack[..., 1] ** 2)
        )
        levels.append(level.reshape(-1, 4))
        n = len(stack)
        if n == 1:
            return levels
        stack = stack.reshape(n // 2, 2, n // 2, 2, 4).mean(axis=(1, 3))


def _grid() -> tuple[FloatArray, FloatArray]:
    """Texel centres (SIZE, SIZE) in cells."""
    x = (np.arange(SIZE) + 0.5) * CELLS / SIZE
    return np.meshgrid(x, x)[0], np.meshgrid(x, x)[1]


def _noise(seed: int, length_u: float, length_v: float) -> FloatArray:
    """Tiled Gaussian noise of unit deviation and given correlation lengths [cells]."""
    rng = np.random.default_rng(seed)
    k = 2 * np.pi * np.fft.fftfreq(SIZE, d=CELLS / SIZE)
    gain = np.exp(-0.5 * ((k[None, :] * length_u) ** 2 + (k[:, None] * length_v) ** 2) / 2)
    gain[0, 0] = 0.0
    field = np.fft.ifft2(np.fft.fft2(rng.standard_normal((SIZE, SIZE))) * gain).real
    return np.asarray(field / field.std())


def _cell_distances(seed: int) -> tuple[FloatArray, FloatArray]:
    """Distance to the nearest and second nearest of one jittered point per cell; Worley 1996."""
    rng = np.random.default_rng(seed)
    jitter = 0.5 + 0.85 * (rng.random((CELLS, CELLS, 2)) - 0.5)
    x, y = _grid()
    # Bend the cells so that their borders curve as the folds between pebbles do.
    x, y = x + 0.16 * _noise(seed + 1, 0.7, 0.7), y + 0.16 * _noise(seed + 2, 0.7, 0.7)
    i, j = np.floor(x).astype(int), np.floor(y).astype(int)
    first = np.full(x.shape, np.inf)
    second = np.full(x.shape, np.inf)
    for dj in (-2, -1, 0, 1, 2):
        for di in (-2, -1, 0, 1, 2):
            point = jitter[(j + dj) % CELLS, (i + di) % CELLS]
            d = np.hypot(i + di + point[..., 0] - x, j + dj + point[..., 1] - y)
            second = np.minimum(second, np.maximum(first, d))
            first = np.minimum(first, d)
    return first, second


def _leather() -> tuple[FloatArray, FloatArray]:
    """Pebbles with creases between them and a fine wrinkle on top; hollows are a little darker."""
    first, second = _cell_distances(1)
    border = np.clip((second - first) / 0.45, 0.0, 1.0)
    dome = border * (2.0 - border)
    height = dome * (0.85 + 0.15 * _noise(5, 1.5, 1.5)) + 0.06 * _noise(4, 0.12, 0.12)
    return height, 0.72 + 0.28 * np.clip(dome * 1.3, 0.0, 1.0)


def _suede() -> tuple[FloatArray, FloatArray]:
    """Short fibres lying mostly along u, in tufts; the ground between them is darker."""
    fibres = _noise(11, 0.5, 0.12)
    tufts = _noise(12, 1.2, 0.8)
    height = 0.3 * fibres + 0.35 * tufts
    return height, np.clip(0.9 + 0.06 * fibres + 0.05 * tufts, 0.6, 1.0)


def _weave() -> tuple[FloatArray, FloatArray]:
    """Plain weave: warp and weft yarns take turns on top, one crossing per cell."""
    x, y = _grid()
    over = np.where((np.floor(x) + np.floor(y)) % 2 == 0, 1.0, 0.0)
    a, b = np.abs(np.sin(np.pi * x)), np.abs(np.sin(np.pi * y))
    # The yarn on top is round across and sinks at both ends.
    height = over * np.sqrt(a) * (0.4 + 0.6 * b) + (1 - over) * np.sqrt(b) * (0.4 + 0.6 * a)
    return height, 0.7 + 0.3 * height
