"""The shapes a cover goes through while it is made, and moving pictures of them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import imageio.v3
import numpy as np
import numpy.typing as npt

from seatlook.errors import InputError
from seatlook.files import reader, write_bytes
from seatlook.io.npz import read_npz, write_npz
from seatlook.io.schema import shown

Pixels = npt.NDArray[np.uint8]
Shapes = npt.NDArray[np.float32]


def write_shapes(path: Path, times: Sequence[float], shapes: Shapes) -> None:
    """Write the positions (k, n, 3) [m] at ``times`` (k,) [s]; single precision, for pictures."""
    write_npz({"times": np.array(times, dtype=float), "positions": shapes}, path)


@reader("shapes of a stage")
def read_shapes(path: Path) -> tuple[npt.NDArray[np.float64], Shapes]:
    """Read times (k,) [s] and positions (k, n, 3) [m].

    Raises
    ------
    InputError
        When the file is absent, damaged or something else.
    """
    arrays = read_npz(path, expected="shapes of a stage")
    if sorted(arrays) != ["positions", "times"]:
        raise InputError.single(
            "file", got=shown(sorted(arrays)), expected="times and positions", file=path
        )
    times, positions = arrays["times"], arrays["positions"]
    if times.dtype.kind != "f" or positions.dtype.kind != "f":
        raise InputError.single(
            "file", got=f"{times.dtype}, {positions.dtype}", expected="numbers", file=path
        )
    if positions.ndim != 3 or positions.shape[2] != 3 or times.shape != positions.shape[:1]:
        raise InputError.single(
            "file", got=f"times {times.shape}, positions {positions.shape}",
            expected="(k,) and (k, n, 3)", file=path,
        )  # fmt: skip
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
