"""OpenEXR pictures: scene-linear radiance and skies, with the extra ``[exr]``."""

from __future__ import annotations

import re
import struct
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from seatlook.errors import InputError
from seatlook.files import LARGEST_FILE, MIB, opened, reader, replacing, silenced

_WHOLE = "a whole OpenEXR picture"
_HEAD = 1 << 20  # bytes in which the head of a file ends


def write_exr(pixels: npt.NDArray[np.float32], path: Path) -> None:
    """Write luminances (h, w, 3) [cd/m2] as R, G, B of 32 bits, losslessly compressed.

    Raises
    ------
    InputError
        The extra is not installed.
    """
    library = _library(path)
    header = {
        "compression": library.ZIP_COMPRESSION,
        "type": library.scanlineimage,
        "whiteLuminance": 1.0,
    }
    with (
        replacing(path) as temporary,
        library.File(header, {"RGB": np.ascontiguousarray(pixels, dtype=np.float32)}) as file,
    ):
        file.write(str(temporary))


@reader("a whole OpenEXR picture")
def read_exr(path: Path) -> npt.NDArray[np.float16 | np.float32]:
    """Read the colour of a picture as (h, w, 3), or (h, w) where it has one channel, as stored.

    Raises
    ------
    InputError
        The extra is not installed, the file is absent, no OpenEXR picture, too large, cut short, or
        has neither colour nor one channel; a value is not finite.
    """
    library = _library(path)
    _check_size(path)
    try:
        with silenced(), library.File(str(path)) as file:
            channels = {name: channel.pixels for name, channel in file.channels().items()}
    except (RuntimeError, ValueError) as error:
        raise InputError.single("picture", got=str(error), expected=_WHOLE, file=path) from error
    pixels_of = next((channels[n] for n in ("RGB", "RGBA", "Y") if n in channels), None)
    if pixels_of is None and len(channels) == 1:
        (pixels_of,) = channels.values()
    if pixels_of is None:
        raise InputError.single(
            "channels", got=", ".join(channels), expected="R, G and B, or one", file=path
        )
    # A channel that was cut short comes without pixels.
    if pixels_of is None or pixels_of.ndim not in (2, 3):
        raise InputError.single("picture", got="no pixels", expected=_WHOLE, file=path)
    pixels: npt.NDArray[Any] = pixels_of[..., :3] if pixels_of.ndim == 3 else pixels_of
    if pixels.dtype.kind != "f":
        pixels = pixels.astype(np.float32)
    if not np.isfinite(pixels).all():
        raise InputError.single("picture", got="nan or inf", expected="finite values", file=path)
    return pixels


def _check_size(path: Path) -> None:
    """Ask for the size of the pixels in the head of the file, before there is room for them."""
    with opened(path, at_most=LARGEST_FILE) as stream:
        head = stream.read(_HEAD)
    bounds = re.search(rb"dataWindow\0box2i\0\x10\0\0\0(.{16})", head, re.DOTALL)
    channels = re.search(rb"channels\0chlist\0(.{4})", head, re.DOTALL)
    if not head.startswith(b"\x76\x2f\x31\x01") or bounds is None or channels is None:
        raise InputError.single("picture", got="another head", expected=_WHOLE, file=path)
    left, top, right, bottom = struct.unpack("<4i", bounds[1])
    width, height = right - left + 1, bottom - top + 1
    listed = head[channels.end() : channels.end() + struct.unpack("<I", channels[1])[0]]
    # Each channel: its name, an end, 4 bytes of type (1: half), 12 of others.
    kinds = re.findall(rb"[^\0]+\0(.)\0{3}.{12}", listed, re.DOTALL)
    size = width * height * sum(2 if kind == b"\1" else 4 for kind in kinds)
    if min(width, height) < 1 or not kinds or size > LARGEST_FILE:
        raise InputError.single(
            "picture", got=f"{width} x {height} pixels of {len(kinds)} channels",
            expected=f"at most {LARGEST_FILE // MIB} MiB of pixels", file=path,
        )  # fmt: skip


def _library(path: Path) -> Any:
    try:
        import OpenEXR
    except ImportError as error:
        raise InputError.single(
            "picture",
            got="OpenEXR, which needs a package that is not installed",
            expected="the extra: pip install 'seatlook[exr]'",
            file=path,
        ) from error
    return OpenEXR
