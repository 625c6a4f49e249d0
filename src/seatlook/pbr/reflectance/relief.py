"""Procedural relief of leather, suede and weave as tiled slope maps with filtered levels."""

from __future__ import annotations

import functools
import itertools
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from seatlook.model import Appearance, FloatArray, Solution, TextureMaps
from seatlook.model.colour import srgb_encode
from seatlook.pbr.kernels.cells import two_nearest
from seatlook.pbr.kernels.grain import LEATHER, SUEDE, WEAVE, Textures

SIZE = 1024
CELLS = 64
# Where each of the levels begins, each with a quarter of the texels of the one before.
_START = np.cumsum([0, *((SIZE >> k) ** 2 for k in range(SIZE.bit_length()))])
# "none" has no map.
MAPS = {"leather": LEATHER, "suede": SUEDE, "weave": WEAVE}


def texture_index(appearance: Appearance) -> int:
    """Index of the map of an appearance, -1 where it has no relief."""
    if appearance.texture == "none" or appearance.texture_depth == 0:
        return -1
    return MAPS[appearance.texture]


def load_textures(*which: int) -> Textures:
    """Relief maps of which some are filled in; each is made once per process."""
    for one in which:
        _make(one)
    return Textures(_texels(), _START[:-1], SIZE, float(CELLS))


@functools.cache
def _texels() -> npt.NDArray[np.float32]:
    return np.zeros((len(MAPS), _START[-1], 4), dtype=np.float32)


@functools.cache
def _make(which: int) -> None:
    height, share = {LEATHER: _leather, SUEDE: _suede, WEAVE: _weave}[which]()
    low, high = np.percentile(height, [5, 95])
    _texels()[which] = packed_levels(slopes(height / (high - low), share))


def slopes(height: FloatArray, share: FloatArray) -> FloatArray:
    """Finest level (h, w, 4) of a relief in cells: slopes, their squared length, colour share."""
    step = 2 * CELLS / SIZE
    su = (np.roll(height, -1, axis=1) - np.roll(height, 1, axis=1)) / step
    sv = (np.roll(height, -1, axis=0) - np.roll(height, 1, axis=0)) / step
    return np.stack([su, sv, su**2 + sv**2, share], axis=-1)


def packed_levels(stack: FloatArray) -> npt.NDArray[np.float32]:
    """All levels (q, 4) of a map (SIZE, SIZE, 4): third channel becomes the slopes' variance."""
    out = np.empty((_START[-1], 4), dtype=np.float32)
    for start, stop in itertools.pairwise(_START):
        level = stack.reshape(-1, 4)
        out[start:stop] = level
        out[start:stop, 2] = np.maximum(
            0.0, 0.5 * (level[:, 2] - level[:, 0] ** 2 - level[:, 1] ** 2)
        )
        n = len(stack) // 2
        if n:
            stack = stack.reshape(n, 2, n, 2, 4).mean(axis=(1, 3))
    return out


def bake_grain(solution: Solution) -> Solution:
    """Write the grain of all materials into maps, for programs that have no such formula.

    Materials with measured maps keep those alone.
    """
    made = {m.name: replace(m, appearance=baked(m.appearance)) for m in solution.cover.materials}
    materials = tuple(made[m.name] for m in solution.cover.materials)
    return replace(solution, cover=replace(solution.cover, materials=materials))


def baked(appearance: Appearance) -> Appearance:
    """Return the same appearance with its grain as maps of one tile, at half its resolution."""
    which = texture_index(appearance)
    if which < 0 or appearance.maps is not None:
        return appearance
    size = SIZE // 2
    texels = load_textures(which).texels[which, _START[1] : _START[2]]
    # First row at the top.
    level = np.asarray(texels.reshape(size, size, 4)[::-1], dtype=np.float64)
    steep = appearance.texture_depth / appearance.texture_scale
    normal = np.dstack([-steep * level[..., :2], np.ones((size, size))])
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
    share = np.repeat(srgb_encode(level[..., 3:]), 3, axis=2)
    tile = CELLS * appearance.texture_scale
    # What the finest level had and this one has not.
    alpha2 = appearance.roughness**4 + 2 * steep**2 * float(level[..., 2].mean())
    return replace(
        appearance,
        texture="none",
        roughness=min(1.0, alpha2**0.25),
        maps=TextureMaps(
            folder=f"grain of {appearance.texture}",
            width=tile,
            height=tile,
            albedo=np.rint(255 * share).astype(np.uint8),
            normal=np.rint(255 * (normal + 1) / 2).astype(np.uint8),
        ),
    )


def _grid() -> tuple[FloatArray, FloatArray]:
    """Texel centres (SIZE, SIZE) in cells."""
    x = (np.arange(SIZE) + 0.5) * CELLS / SIZE
    return np.meshgrid(x, x)[0], np.meshgrid(x, x)[1]


def _noise(seed: int, length_u: float, length_v: float) -> FloatArray:
    """Tiled Gaussian noise of unit deviation and given correlation lengths [cells]."""
    rng = np.random.default_rng(seed)
    k, half = (2 * np.pi * f(SIZE, d=CELLS / SIZE) for f in (np.fft.fftfreq, np.fft.rfftfreq))
    gain = np.exp(-0.25 * (k[:, None] * length_v) ** 2) * np.exp(-0.25 * (half * length_u) ** 2)
    gain[0, 0] = 0.0
    field = np.fft.irfft2(np.fft.rfft2(rng.standard_normal((SIZE, SIZE))) * gain, s=(SIZE, SIZE))
    return np.asarray(field / field.std())


def _cell_distances(seed: int) -> tuple[FloatArray, FloatArray]:
    """Distance to the nearest and second nearest of one jittered point per cell; Worley 1996."""
    rng = np.random.default_rng(seed)
    jitter = 0.5 + 0.85 * (rng.random((CELLS, CELLS, 2)) - 0.5)
    x, y = _grid()
    # Bend the cells so that their borders curve as the folds between pebbles do.
    x, y = x + 0.16 * _noise(seed + 1, 0.7, 0.7), y + 0.16 * _noise(seed + 2, 0.7, 0.7)
    first, second = np.empty(x.shape), np.empty(x.shape)
    two_nearest(jitter, x, y, first, second)
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
