"""Skies as Radiance (``.hdr``, RGBE) or OpenEXR pictures of all directions."""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

import numpy as np
import numpy.typing as npt

from seatlook.errors import InputError, InputWarning
from seatlook.exr import read_exr
from seatlook.files import read_file, reader
from seatlook.model import FloatArray

LARGEST_PIXELS = 2**26  # of a Radiance picture; 8192 x 4096 are half of it
# Finer is averaged: no lobe of a cover is as narrow as the 0.09 degrees of such a pixel.
FINEST_ROWS = 2048


@reader("a Radiance or OpenEXR picture of all directions")
def read_panorama(path: Path) -> FloatArray:
    """Read an equirectangular picture as (h, w, 3) in its own unit, usually none.

    ``.exr`` needs the extra ``[exr]``; anything else is read as ``.hdr``: Ward 1991, *Real
    Pixels*, three mantissas and one exponent per pixel, rows run-length encoded. Pictures of more
    than 2048 rows are averaged to that many.

    Raises
    ------
    InputError
        Not a Radiance or OpenEXR picture, another orientation than ``-Y h +X w``, not twice as
        wide as high, too large, or cut short; no extra.

    Warns
    -----
    InputWarning
        Values below 0, which filters leave around a sun in OpenEXR pictures, are taken for 0.
    """
    if path.suffix.lower() == ".exr":
        return _read_exr(path)
    content = read_file(path)
    head = re.match(
        rb"#\?(?:RADIANCE|RGBE)\n(.{0,65536}?)\n\n-Y (\d{1,6}) \+X (\d{1,6})\n", content, re.DOTALL
    )
    if head is None or b"FORMAT=32-bit_rle_rgbe" not in head[1]:
        raise InputError.single(
            "panorama",
            got="another head",
            expected="a Radiance picture, 32-bit_rle_rgbe, -Y height +X width",
            file=path,
        )
    height, width = int(head[2]), int(head[3])
    _check_size(path, height, width)
    if height * width > LARGEST_PIXELS:
        raise InputError.single(
            "panorama", got=f"{width} x {height} pixels", expected=f"at most {LARGEST_PIXELS}",
            file=path, hint="8192 x 4096 show more than a cover can reflect",
        )  # fmt: skip
    at = head.end()

    def following_row(_: int) -> FloatArray:
        nonlocal at
        rgbe, at = _row(content, at, width)
        scale = np.where(rgbe[3] > 0, np.exp2(rgbe[3].astype(float) - 136), 0.0)
        return np.asarray(((rgbe[:3] + 0.5) * scale).T)

    try:
        return _averaged(following_row, height, width)
    except IndexError:
        raise InputError.single(
            "panorama", got="a file cut short", expected=f"{height} rows of {width}", file=path
        ) from None


def _read_exr(path: Path) -> FloatArray:
    pixels = read_exr(path)
    _check_size(path, *pixels.shape[:2])
    below = int(np.count_nonzero(pixels < 0))
    if below:
        warnings.warn(
            f"{path}: panorama: {below} of {pixels.size} values below 0 are taken for 0",
            InputWarning,
            stacklevel=4,
        )

    def row(number: int) -> FloatArray:
        values = np.maximum(pixels[number].astype(np.float64), 0.0)
        return values if values.ndim == 2 else np.repeat(values[:, None], 3, axis=1)

    return _averaged(row, *pixels.shape[:2])


def _check_size(path: Path, height: int, width: int) -> None:
    if width != 2 * height or not height:
        raise InputError.single(
            "panorama", got=f"{width} x {height}", expected="twice as wide as high", file=path
        )


def _averaged(row: Callable[[int], FloatArray], height: int, width: int) -> FloatArray:
    """Put rows (width, 3) together, to means where there are more than ``FINEST_ROWS``."""
    rows = min(height, FINEST_ROWS)
    edges = np.arange(rows + 1) * height // rows
    columns = np.arange(2 * rows) * width // (2 * rows)
    across = np.diff(columns, append=width)[:, None]
    out = np.empty((rows, 2 * rows, 3))
    for number, (first, last) in enumerate(pairwise(edges.tolist())):
        total = row(first)
        for further in range(first + 1, last):
            total = total + row(further)
        out[number] = np.add.reduceat(total, columns, axis=0) / (across * (last - first))
    return out


def _row(data: bytes, at: int, width: int) -> tuple[npt.NDArray[np.uint8], int]:
    """Mantissas and exponents (4, w) of a row, and where the next begins; IndexError at the end."""
    packed = data[at : at + 2] == b"\2\2" and data[at + 2] < 128
    if not packed:
        plain = np.frombuffer(data[at : at + 4 * width], np.uint8)
        if len(plain) < 4 * width:
            raise IndexError
        return plain.reshape(width, 4).T, at + 4 * width
    out = bytearray(4 * width)
    at += 4
    for channel in range(4):
        at = _unpack(data, at, out, channel * width, (channel + 1) * width)
    return np.frombuffer(out, np.uint8).reshape(4, width), at


def _unpack(data: bytes, at: int, out: bytearray, x: int, end: int) -> int:
    """Fill ``out`` from x to end from runs and literals; returns where the next begins."""
    while x < end:
        count = data[at]
        if count > 128:
            piece = data[at + 1 : at + 2] * (count - 128)
            at += 2
        else:
            piece = data[at + 1 : at + 1 + count]
            at += 1 + count
        # A literal of nothing never ends; one beyond the data or the row is damage.
        if (
            not piece
            or len(piece) != (count - 128 if count > 128 else count)
            or x + len(piece) > end
        ):
            raise IndexError
        out[x : x + len(piece)] = piece
        x += len(piece)
    return at
