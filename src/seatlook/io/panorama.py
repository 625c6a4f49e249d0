"""Skies as Radiance (``.hdr``, RGBE) or OpenEXR pictures of all directions."""

from __future__ import annotations

import re
import warnings
from pathlib import Path

import numpy as np
import numpy.typing as npt

from seatlook.errors import InputError, InputWarning
from seatlook.exr import read_exr
from seatlook.model import FloatArray


def read_panorama(path: Path) -> FloatArray:
    """Read an equirectangular picture as (h, w, 3) in its own unit, usually none.

    ``.exr`` needs the extra ``[exr]``; anything else is read as ``.hdr``: Ward 1991, *Real
    Pixels*, three mantissas and one exponent per pixel, rows run-length encoded.

    Raises
    ------
    InputError
        Not a Radiance or OpenEXR picture, another orientation than ``-Y h +X w``, not twice as
        wide as high, or cut short; no extra.

    Warns
    -----
    InputWarning
        Values below 0, which filters leave around a sun in OpenEXR pictures, are taken for 0.
    """
    if path.suffix.lower() == ".exr":
        pixels = read_exr(path).astype(np.float64)
        _check_size(path, *pixels.shape[:2])
        below = int((pixels < 0).sum())
        if below:
            warnings.warn(
                f"{path}: panorama: {below} of {pixels.size} values below 0 are taken for 0",
                InputWarning,
                stacklevel=2,
            )
        pixels = np.maximum(pixels, 0.0)
        return pixels if pixels.ndim == 3 else np.repeat(pixels[..., None], 3, axis=2)
    content = path.read_bytes()
    head = re.match(rb"#\?(?:RADIANCE|RGBE)\n(.*?)\n\n-Y (\d+) \+X (\d+)\n", content, re.DOTALL)
    if head is None or b"FORMAT=32-bit_rle_rgbe" not in head[1]:
        raise InputError.single(
            "panorama",
            got="another head",
            expected="a Radiance picture, 32-bit_rle_rgbe, -Y height +X width",
            file=path,
        )
    height, width = int(head[2]), int(head[3])
    _check_size(path, height, width)
    try:
        rgbe = _pixels(np.frombuffer(content, np.uint8, offset=head.end()), height, width)
    except IndexError:
        raise InputError.single(
            "panorama", got="a file cut short", expected=f"{height} rows of {width}", file=path
        ) from None
    scale = np.where(rgbe[..., 3] > 0, np.exp2(rgbe[..., 3].astype(float) - 136), 0.0)
    return np.asarray((rgbe[..., :3] + 0.5) * scale[..., None])


def _check_size(path: Path, height: int, width: int) -> None:
    if width != 2 * height:
        raise InputError.single(
            "panorama", got=f"{width} x {height}", expected="twice as wide as high", file=path
        )


def _pixels(data: npt.NDArray[np.uint8], height: int, width: int) -> npt.NDArray[np.uint8]:
    """Mantissas and exponents (h, w, 4); IndexError where the data end early."""
    out = np.empty((height, 4, width), dtype=np.uint8)
    at = 0
    for row in range(height):
        if tuple(data[at : at + 2]) != (2, 2) or data[at + 2] >= 128:
            if len(data) < at + 4 * width:
                raise IndexError
            out[row] = data[at : at + 4 * width].reshape(width, 4).T
            at += 4 * width
            continue
        at += 4
        for channel in range(4):
            at = _unpack(data, at, out[row, channel])
    return np.moveaxis(out, 1, 2)


def _unpack(data: npt.NDArray[np.uint8], at: int, line: npt.NDArray[np.uint8]) -> int:
    """Fill one line from runs and literals; returns where the next begins."""
    x = 0
    while x < len(line):
        count = int(data[at])
        if count > 128:
            line[x : x + count - 128] = data[at + 1]
            x, at = x + count - 128, at + 2
            continue
        if count == 0 or at + 1 + count > len(data) or x + count > len(line):
            raise IndexError
        line[x : x + count] = data[at + 1 : at + 1 + count]
        x, at = x + count, at + 1 + count
    return at
