"""The shapes a cover goes through while it is made, and moving pictures of them."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from PIL import Image

from seatlook.errors import InputError
from seatlook.files import reader, replacing
from seatlook.io.npz import read_npz, write_npz
from seatlook.io.schema import shown

Pixels = npt.NDArray[np.uint8]
Shapes = npt.NDArray[np.float32]

ANIMATIONS = (".gif", ".apng", ".webp", ".mp4")


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


def write_animation(frames: Iterable[Pixels], path: Path, *, seconds: float) -> None:
    """Write pictures of one size as a moving one that lasts ``seconds`` and begins again.

    Parameters
    ----------
    frames : each (h, w, 3), or (h, w, 4) with a channel of what is not transparent, which files
        that know no shares of it show on white
    path : ``.gif`` (256 colours a picture), ``.apng`` (exact), ``.webp`` (small), or ``.mp4``,
        which the program ffmpeg of the user writes

    Raises
    ------
    InputError
        Another file ending, no picture, pictures of several sizes, or no ffmpeg for ``.mp4``.
    """
    ending = check_animation(path)
    taken = list(frames)
    if not taken:
        raise InputError.single("animation", got="no picture", expected="one or more")
    sizes = {frame.shape[:2] for frame in taken}
    if len(sizes) > 1:
        got = " and ".join(f"{w} x {h}" for h, w in sorted(sizes))
        raise InputError.single("animation", got=got, expected="pictures of one size")
    if ending in (".gif", ".mp4"):
        taken = [_on_white(frame) for frame in taken]
    with replacing(path) as temporary:
        if ending == ".mp4":
            _write_mp4(taken, temporary, seconds)
        else:
            _write_with_pillow(taken, temporary, ending, seconds)


def check_animation(path: Path) -> str:
    """Return the ending of a moving picture that can be written here.

    Raises
    ------
    InputError
        Another file ending, or ``.mp4`` without ffmpeg.
    """
    ending = path.suffix.lower()
    if ending not in ANIMATIONS:
        expected = f"a name in {', '.join(ANIMATIONS)}"
        raise InputError.single("animation", got=shown(path.name), expected=expected)
    if ending == ".mp4":
        _find_ffmpeg()
    return ending


def _write_with_pillow(frames: list[Pixels], path: Path, ending: str, seconds: float) -> None:
    first, *others = map(Image.fromarray, frames)
    options: dict[str, Any] = {
        ".gif": {"format": "GIF", "disposal": 1},
        ".apng": {"format": "PNG", "compress_level": 6},
        ".webp": {"format": "WEBP", "quality": 90, "method": 4},
    }[ending]
    each = 1e3 * seconds / len(frames)
    duration = each if ending == ".apng" else round(each)
    first.save(path, save_all=True, append_images=others, duration=duration, loop=0, **options)


def _write_mp4(frames: list[Pixels], path: Path, seconds: float) -> None:
    """Have ffmpeg encode the pictures; H.264 wants an even number of pixels each way."""
    program = _find_ffmpeg()
    height, width, _ = frames[0].shape
    command = [
        program, "-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24",
        "-s", f"{width}x{height}", "-r", f"{len(frames) / seconds:.6f}", "-i", "-",
        "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-pix_fmt", "yuv420p", "-movflags", "+faststart",
        "-f", "mp4", str(path),
    ]  # fmt: skip
    raw = b"".join(frame.tobytes() for frame in frames)
    done = subprocess.run(command, input=raw, capture_output=True, check=False)
    if done.returncode != 0:
        said = " ".join(done.stderr.decode("utf-8", "replace").split())
        raise InputError.single(
            "animation",
            got=f"ffmpeg, which ended with {done.returncode}: {said[:300]}",
            expected="an ffmpeg that writes MP4",
            hint="write a .webp instead",
        )


def _find_ffmpeg() -> str:
    """Path of the user's ffmpeg; an input error where there is none."""
    program = shutil.which("ffmpeg")
    if program is None:
        raise InputError.single(
            "animation",
            got="no program ffmpeg",
            expected="ffmpeg, which writes .mp4",
            hint="install ffmpeg, or write a .webp, which browsers show too",
        )
    return program


def _on_white(frame: Pixels) -> Pixels:
    """Picture (h, w, 3) of one that may be transparent."""
    if frame.shape[2] == 3:
        return frame
    share = frame[..., 3:] / 255.0
    return np.rint(frame[..., :3] * share + 255.0 * (1.0 - share)).astype(np.uint8)
