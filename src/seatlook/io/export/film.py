"""The shapes a cover goes through while it is made, and moving pictures of them."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Sequence
from pathlib import Path

import imageio.v3
import numpy as np
import numpy.typing as npt

from seatlook.errors import InputError
from seatlook.files import write_bytes
from seatlook.io.schema import shown
from seatlook.io.toml import read_file

Pixels = npt.NDArray[np.uint8]
Shapes = npt.NDArray[np.float32]


def write_shapes(path: Path, times: Sequence[float], shapes: Shapes) -> None:
    """Write the positions (k, n, 3) [m] at ``times`` (k,) [s]; single precision, for pictures."""
    buffer = io.BytesIO()
    np.savez_compressed(buffer, times=np.array(times, dtype=float), positions=shapes)
    write_bytes(path, buffer.getvalue())


def read_shapes(path: Path) -> tuple[npt.NDArray[np.float64], Shapes]:
    """Read times (k,) [s] and positions (k, n, 3) [m].

    Raises
    ------
    InputError
        When the file is absent, damaged or something else.
    """
    content = read_file(path)
    try:
        with np.load(io.BytesIO(content), allow_pickle=False) as archive:
            times, positions = archive["times"], archive["positions"]
    except (OSError, EOFError, KeyError, ValueError, zipfile.BadZipFile) as error:
        raise InputError.single(
            "file", got=f"{type(error).__name__}: {error}", expected="shapes of a stage", file=path
        ) from error
    if positions.ndim != 3 or positions.shape[2] != 3 or len(times) != len(positions):
        raise InputError.single(
            "file", got=f"positions {positions.shape}", expected=f"({len(times)}, n, 3)", file=path
        )
    return times, positions.astype(np.float32, copy=False)


def write_animation(frames: Sequence[Pixels], path: Path, *, seconds: float) -> None:
    """Write pictures (h, w, 3) of one size as an animated ``.gif`` that lasts ``seconds``.

    Raises
    ------
    InputError
        Another file ending, or no picture.
    """
    if path.suffix.lower() != ".gif":
        raise InputError.single("animation", got=shown(path.name), expected="a name in .gif")
    if not len(frames):
        raise InputError.single("animation", got="no picture", expected="one or more")
    content = imageio.v3.imwrite(
        "<bytes>",
        np.stack(list(frames)),
        extension=".gif",
        plugin="pillow",
        duration=1e3 * seconds / len(frames),
        loop=0,
    )
    write_bytes(path, content)
