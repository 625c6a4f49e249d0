"""OpenEXR pictures: scene-linear radiance and skies, with the extra ``[exr]``."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from seatlook.errors import InputError
from seatlook.files import replacing


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


def read_exr(path: Path) -> npt.NDArray[np.float32]:
    """Read the colour of a picture as (h, w, 3), or (h, w) where it has one channel.

    Raises
    ------
    InputError
        The extra is not installed, the file is absent, no OpenEXR picture, cut short, or has
        neither colour nor one channel; a value is not finite.
    """
    library = _library(path)
    try:
        with library.File(str(path)) as file:
            channels = {name: channel.pixels for name, channel in file.channels().items()}
    except RuntimeError as error:
        raise InputError.single(
            "picture", got=str(error), expected="a whole OpenEXR picture", file=path
        ) from error
    pixels_of = next((channels[n] for n in ("RGB", "RGBA", "Y") if n in channels), None)
    if pixels_of is None and len(channels) == 1:
        (pixels_of,) = channels.values()
    if pixels_of is None:
        raise InputError.single(
            "channels", got=", ".join(channels), expected="R, G and B, or one", file=path
        )
    pixels = np.asarray(pixels_of[..., :3] if pixels_of.ndim == 3 else pixels_of, dtype=np.float32)
    if not np.isfinite(pixels).all():
        raise InputError.single("picture", got="nan or inf", expected="finite values", file=path)
    return pixels


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
