"""Folders of measured maps under the names that ambientCG and Poly Haven give them."""

from __future__ import annotations

import io
import re
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from seatlook.errors import InputError, Problem
from seatlook.exr import read_exr
from seatlook.io.toml import read_file
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
# Finer is not seen from where a seat is looked at, and four times the memory.
LARGEST = 2048
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
    shapes: dict[Path, tuple[int, ...]] = {}
    problems: list[Problem] = []
    for role, path in files.items():
        try:
            pixels = _pixels(path, linear=role == "albedo")
            shapes[path] = pixels.shape
            maps = _CHECKED[role](path, pixels) | maps
        except InputError as error:
            problems += error.problems
    problems += _out_of_proportion(shapes)
    if problems:
        raise InputError(problems)
    if "metalness" in maps and maps["metalness"].max() <= _BLACK:
        del maps["metalness"]
    rows, columns = next(iter(shapes.values()))[:2]
    reduced = {role: _reduced(role, pixels) for role, pixels in maps.items()}
    return TextureMaps(
        folder=name or str(folder), width=width, height=width * rows / columns, **reduced
    )


def _pixels(path: Path, *, linear: bool) -> Pixels:
    """Eight-bit pixels (h, w) or (h, w, 3) of a picture file; ``linear`` floats become sRGB."""
    if path.suffix.lower() == ".exr":
        values = np.clip(read_exr(path).astype(np.float64), 0.0, 1.0)
        return _eight_bits(255 * (srgb_encode(values) if linear else values))
    from PIL import Image, UnidentifiedImageError

    content = read_file(path)
    try:
        with Image.open(io.BytesIO(content)) as picture:
            if picture.mode == "F":
                raise _refusal(path, "floating point", "8 or 16 bits a channel")
            if picture.mode.startswith("I"):
                return _eight_bits(np.asarray(picture).astype(np.float64) / 257)
            grey = picture.mode in ("1", "L", "LA")
            return np.asarray(picture.convert("L" if grey else "RGB"))
    except UnidentifiedImageError as error:
        raise _refusal(path, "no picture", "a PNG, JPEG, TIFF or OpenEXR picture") from error
    # Pillow raises these on content that is cut short, damaged or absurdly large.
    except (OSError, SyntaxError, ValueError, Image.DecompressionBombError) as error:
        if isinstance(error, InputError):
            raise
        raise _refusal(path, str(error), "a whole picture") from error


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


def _out_of_proportion(shapes: dict[Path, tuple[int, ...]]) -> list[Problem]:
    """Problems of the pictures that do not show the same piece as the first."""
    problems = []
    for path, (rows, columns, *_) in shapes.items():
        first, (height, width, *_) = next(iter(shapes.items()))
        # A pixel more or less is rounding.
        if abs(columns * height - rows * width) > max(height, width):
            expected = f"the proportions of {first.name}, {width} x {height}"
            got = f"{columns} x {rows} pixels"
            problems.append(Problem(key="picture", got=got, expected=expected, file=path))
    return problems


def _reduced(role: str, pixels: Pixels) -> Pixels:
    """Mean over whole blocks until no side is above ``LARGEST``."""
    step = -(-max(pixels.shape[:2]) // LARGEST)
    if step == 1:
        return pixels
    rows, columns = (max(n // step, 1) for n in pixels.shape[:2])
    down, across = (min(step, n) for n in pixels.shape[:2])
    values = pixels[: rows * down, : columns * across].astype(np.float32) / 255
    if role == "albedo":
        values = srgb_decode(values)
    mean = values.reshape(rows, down, columns, across, -1).mean(axis=(1, 3))
    if role == "albedo":
        mean = srgb_encode(mean)
    return _eight_bits(255 * mean.reshape(rows, columns, *pixels.shape[2:]).astype(np.float64))
