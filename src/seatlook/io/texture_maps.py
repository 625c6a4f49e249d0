"""Folders of measured maps under the names that ambientCG and Poly Haven give them."""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from seatlook.errors import InputError, Problem
from seatlook.exr import read_exr
from seatlook.files import LARGEST_FILE, opened, reader, silenced
from seatlook.model import TextureMaps
from seatlook.model.colour import srgb_decode, srgb_encode
from seatlook.model.texture import Pixels

# How a file's name ends, resolution and format left out, for what it holds. ``arm``: occlusion,
# roughness and metalness as red, green and blue. Occlusion, height and others are not read.
_NAMES = {
    "albedo": r"(base_?)?colou?r|albedo|diff(use)?|coll?_?\d*",
    "roughness": r"rough(ness)?",
    "metalness": r"metal(ness|lic)?",
    "normal": r"(nor(mal)?_?gl|normal|nor)",
    "normal_dx": r"nor(mal)?_?dx",
    "arm": r"arm|orm",
}
_SUFFIXES = (".png", ".jpg", ".jpeg", ".tif", ".tiff", ".exr")
LARGEST_PIXELS = 2**27  # of a picture; 8192 x 8192 are half of it
# Finer is not seen from where a seat is looked at, and four times the memory.
LARGEST = 2048
_LINEAR = srgb_decode(np.arange(256) / 255).astype(np.float32)
_STRIP = 64  # rows that are averaged at a time
# A map that is black throughout but for what JPEG adds.
_BLACK = 4
# How far [1/255] the channels of a grey picture may be apart, again for JPEG.
_COLOURED = 24


def map_files(folder: Path) -> dict[str, Path]:
    """Return what is held -> file, for the maps of a folder that would be read.

    Raises
    ------
    InputError
        There is no such folder, no map in it, or two for one thing.
    """
    if not folder.is_dir():
        raise InputError.single("maps", got="no such folder", expected="a folder", file=folder)
    files: dict[str, Path] = {}
    problems = []
    for path in sorted(folder.iterdir()):
        role = _role(path)
        if role is None:
            continue
        first = files.setdefault(role, path)
        if first is not path:
            expected = f"one file for the {role.replace('_dx', '')}; {first.name} is another"
            problems.append(Problem(key="maps", got=path.name, expected=expected, file=folder))
    if problems:
        raise InputError(problems)
    if "normal" in files:
        files.pop("normal_dx", None)
    if {"roughness", "metalness"} <= set(files):
        files.pop("arm", None)
    if not files:
        names = "NAME_Color, NAME_Roughness, NAME_Metalness, NAME_NormalGL (ambientCG) or "
        names += "name_diff, name_rough, name_metal, name_nor_gl, name_arm (Poly Haven)"
        raise InputError.single("maps", got="no map", expected=f"pictures {names}", file=folder)
    # In this order, so that a map of its own comes before the same in ``arm``.
    return {role: files[role] for role in _NAMES if role in files}


def _role(path: Path) -> str | None:
    if path.suffix.lower() not in _SUFFIXES:
        return None
    words = [w for w in re.split(r"[_\-\s.]+", path.stem.lower()) if not re.fullmatch(r"\d+k", w)]
    stem = "_".join(w for w in words if w not in ("jpg", "png", "exr"))
    for role, names in _NAMES.items():
        if re.search(rf"(^|_)({names})$", stem):
            return role
    return None


@reader("a folder of texture maps")
def read_texture_maps(folder: Path, *, width: float, name: str | None = None) -> TextureMaps:
    """Read a folder of measured maps.

    Pictures have 8 or 16 bits a channel (16 are rounded to 8) or are OpenEXR with the extra
    ``[exr]``: then albedo is linear. Any size and proportions, the same proportions throughout;
    above 2048 pixels they are averaged. A metalness map that is black throughout is left out.

    Parameters
    ----------
    width : [m] of the piece that a picture shows; its height follows
    name : how messages and tables call the folder; None: as it is

    Raises
    ------
    InputError
        Of every file that cannot be used, with the reason.
    """
    files = map_files(folder)
    maps: dict[str, Pixels] = {}
    shapes: dict[Path, tuple[int, int]] = {}
    problems: list[Problem] = []
    for role, path in files.items():
        try:
            pixels, shapes[path] = _pixels(path, is_albedo=role == "albedo")
            maps = _CHECKED[role](path, pixels) | maps
        except InputError as error:
            problems += error.problems
    problems += _out_of_proportion(shapes)
    if problems:
        raise InputError(problems)
    if "metalness" in maps and maps["metalness"].max() <= _BLACK:
        del maps["metalness"]
    rows, columns = next(iter(shapes.values()))
    return TextureMaps(
        folder=name or str(folder), width=width, height=width * rows / columns, **maps
    )


def _pixels(path: Path, *, is_albedo: bool) -> tuple[Pixels, tuple[int, int]]:
    """Eight-bit pixels (h, w) or (h, w, 3), no side above ``LARGEST``, and the file's own size."""
    if path.suffix.lower() == ".exr":
        values = read_exr(path)
        shape = values.shape[0], values.shape[1]
        return _averaged(partial(_strip_of_exr, values, is_albedo), shape, is_albedo), shape
    from PIL import Image, UnidentifiedImageError

    try:
        with opened(path, at_most=LARGEST_FILE) as stream, warnings.catch_warnings():
            # The library warns of pictures far below the limit here.
            warnings.simplefilter("ignore", Image.DecompressionBombWarning)
            with silenced(), Image.open(stream) as picture:
                _check_picture(path, picture)
                shape = picture.size[1], picture.size[0]
                return _averaged(partial(_strip_of_picture, picture), shape, is_albedo), shape
    except UnidentifiedImageError as error:
        raise _refusal(path, "no picture", "a PNG, JPEG, TIFF or OpenEXR picture") from error
    except (InputError, Warning):
        raise
    # Pillow raises whatever it stumbles over on content that is cut short, damaged or too large.
    except Exception as error:
        raise _refusal(path, str(error) or type(error).__name__, "a whole picture") from error


def _check_picture(path: Path, picture: Any) -> None:
    width, height = picture.size
    if width * height > LARGEST_PIXELS:
        raise _refusal(path, f"{width} x {height} pixels", f"at most {LARGEST_PIXELS} pixels")
    if picture.mode == "F":
        raise _refusal(path, "floating point", "8 or 16 bits a channel")


def _strip_of_exr(values: npt.NDArray[Any], is_albedo: bool, first: int, last: int) -> Pixels:
    strip = np.clip(values[first:last].astype(np.float64), 0.0, 1.0)
    return _eight_bits(255 * (srgb_encode(strip) if is_albedo else strip))


def _strip_of_picture(picture: Any, first: int, last: int) -> Pixels:
    strip = picture.crop((0, first, picture.size[0], last))
    if strip.mode.startswith("I"):
        return _eight_bits(np.asarray(strip).astype(np.float64) / 257)
    return np.asarray(strip.convert("L" if strip.mode in ("1", "L", "LA") else "RGB"))


def _averaged(
    strip: Callable[[int, int], Pixels], shape: tuple[int, int], is_albedo: bool
) -> Pixels:
    """Put strips of rows together: means over whole blocks until no side is above ``LARGEST``."""
    step = -(-max(shape) // LARGEST)
    rows, columns = (max(n // step, 1) for n in shape)
    down, across = (min(step, n) for n in shape)
    if step == 1:
        return strip(0, rows)
    means = []
    for first in range(0, rows, _STRIP):
        last = min(first + _STRIP, rows)
        pixels = strip(first * down, last * down)[:, : columns * across]
        values = _LINEAR[pixels] if is_albedo else pixels
        shape_of_means = (last - first, columns, *pixels.shape[2:])
        # Down first: rows lie one behind the other.
        total = values.reshape(last - first, down, -1).sum(axis=1, dtype=np.float32)
        total = total.reshape(last - first, columns, across, -1).sum(axis=2)
        mean = total.reshape(shape_of_means).astype(np.float64) / (down * across)
        means.append(_eight_bits(255 * srgb_encode(mean) if is_albedo else mean))
    return np.concatenate(means)


def _eight_bits(values: npt.NDArray[np.float64]) -> Pixels:
    return np.rint(np.clip(values, 0, 255)).astype(np.uint8)


def _refusal(path: Path, got: str, expected: str) -> InputError:
    return InputError.single("picture", got=got, expected=expected, file=path)


def _albedo(path: Path, pixels: Pixels) -> dict[str, Pixels]:
    return {"albedo": pixels if pixels.ndim == 3 else np.repeat(pixels[..., None], 3, axis=2)}


def _grey(path: Path, pixels: Pixels) -> Pixels:
    if pixels.ndim == 2:
        return pixels
    apart = np.ptp(pixels.astype(np.int16), axis=2)
    if np.percentile(apart, 99) > _COLOURED:
        raise _refusal(path, "a coloured picture", "a grey one")
    return np.ascontiguousarray(pixels[..., 1])


def _normal(path: Path, pixels: Pixels) -> dict[str, Pixels]:
    if pixels.ndim == 2:
        raise _refusal(path, "a grey picture", "normals in red, green and blue, no height")
    if pixels[..., 2].mean() < 160:
        raise _refusal(
            path, f"blue of {pixels[..., 2].mean():.0f} on average", "normals of a flat piece"
        )
    return {"normal": pixels}


def _normal_dx(path: Path, pixels: Pixels) -> dict[str, Pixels]:
    """DirectX has y downwards."""
    out = np.array(_normal(path, pixels)["normal"])
    out[..., 1] = 255 - out[..., 1]
    return {"normal": out}


def _arm(path: Path, pixels: Pixels) -> dict[str, Pixels]:
    if pixels.ndim == 2:
        raise _refusal(path, "a grey picture", "occlusion, roughness, metalness in its channels")
    return {
        "roughness": np.ascontiguousarray(pixels[..., 1]),
        "metalness": np.ascontiguousarray(pixels[..., 2]),
    }


_CHECKED: dict[str, Any] = {
    "albedo": _albedo,
    "roughness": lambda path, pixels: {"roughness": _grey(path, pixels)},
    "metalness": lambda path, pixels: {"metalness": _grey(path, pixels)},
    "normal": _normal,
    "normal_dx": _normal_dx,
    "arm": _arm,
}


def _out_of_proportion(shapes: dict[Path, tuple[int, int]]) -> list[Problem]:
    """Problems of the pictures that do not show the same piece as the first."""
    problems = []
    for path, (rows, columns) in shapes.items():
        first, (height, width) = next(iter(shapes.items()))
        # A pixel more or less is rounding.
        if abs(columns * height - rows * width) > max(height, width):
            expected = f"the proportions of {first.name}, {width} x {height}"
            got = f"{columns} x {rows} pixels"
            problems.append(Problem(key="picture", got=got, expected=expected, file=path))
    return problems
