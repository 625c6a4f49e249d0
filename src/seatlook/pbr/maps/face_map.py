"""Pictures of values on the cover: perceptually even colours, a bar with units, the same camera."""

from __future__ import annotations

import matplotlib
import numpy as np
import numpy.typing as npt
from PIL import Image as Pillow
from PIL import ImageDraw, ImageFont

from seatlook.errors import InputError, did_you_mean
from seatlook.model import Camera, FloatArray, Solution
from seatlook.model.colour import srgb_decode, srgb_encode
from seatlook.pbr.kernels import colour
from seatlook.pbr.kernels import surface as kernel
from seatlook.pbr.picture import Picture
from seatlook.pbr.shading.eye import eye_of
from seatlook.pbr.shading.studio import Studio, studio

FACTOR = 2  # samples per pixel and axis
# The surround of pictures as well, so that map and picture lie over each other without a glare.
PAPER, _INK, _BARE = 97, (242, 242, 242), 205
_SEQUENTIAL = ("viridis", "cividis", "magma")
COLORMAPS = ("diverging", *_SEQUENTIAL)


def render_map(
    solution: Solution,
    values: FloatArray,
    *,
    camera: Camera,
    title: str,
    unit: str = "",
    value_range: tuple[float, float] | None = None,
    colormap: str | None = None,
) -> Picture:
    """Draw one value per face with a colour bar.

    Parameters
    ----------
    values : (m,) float64           nan is drawn grey
    value_range : (low, high)       None: the 99th percentile of |values|, from 0, or from its
        negative for the diverging map; what lies outside takes the colour of the end
    colormap : ``viridis``, ``cividis``, ``magma``, or ``diverging`` (white at the middle); None:
        diverging where the range holds 0 inside, else viridis

    Returns
    -------
    Picture
        Display-referred; shade from above makes the shape readable and leaves hue and order of
        the colours alone.

    Raises
    ------
    InputError
        Wrong number of values, an empty range, an unknown colour map.
    NoOffscreenContext, RenderError
    """
    faces = solution.cover.faces
    if values.shape != (len(faces),):
        raise InputError.single("values", got=f"shape {values.shape}", expected=f"({len(faces)},)")
    if colormap is None:
        inside = value_range is not None and value_range[0] < 0 < value_range[1]
        colormap = "diverging" if inside else "viridis"
    low, high = _range(values, value_range, colormap)
    stage = studio(solution)
    table = colour_table(colormap)
    pixels = coloured(_flat(stage, camera, values), stage, camera, table, (low, high))
    return Picture(
        pixels=with_bar(pixels, table, (low, high), title, unit), value_range=(low, high)
    )


def _range(
    values: FloatArray, value_range: tuple[float, float] | None, colormap: str
) -> tuple[float, float]:
    if colormap not in COLORMAPS:
        raise InputError.single(
            "colormap",
            got=repr(colormap),
            expected=f"one of {', '.join(COLORMAPS)}",
            hint=did_you_mean(colormap, COLORMAPS),
        )
    if value_range is None:
        finite = np.abs(values[np.isfinite(values)])
        high = float(np.percentile(finite, 99)) if finite.size else 0.0
        high = high or 1.0
        value_range = (-high if colormap == "diverging" else 0.0, high)
    low, high = value_range
    if not high > low:
        raise InputError.single("value_range", got=value_range, expected="low < high")
    return low, high


def _flat(stage: Studio, camera: Camera, values: FloatArray) -> FloatArray:
    """Value of the solver's face (m,) at each sample, nan off the cover."""
    drawn, count = stage.faces(camera, FACTOR), stage.surface.faces
    cover = (drawn >= 0) & (drawn < count)
    row = np.where(cover, drawn // (count // len(values)), len(values))
    return np.append(values, np.nan).take(row)


def blended(stage: Studio, camera: Camera, corner: FloatArray) -> FloatArray:
    """Value at each sample from those at the corners (m, 3) of the solver's faces, nan off it."""
    ids = stage.faces(camera, FACTOR)
    value = np.full(ids.shape, np.nan)
    mesh, count = stage.surface.mesh, stage.surface.faces
    kernel.paint(mesh, eye_of(camera, FACTOR), ids, corner, count, value)
    return value


def coloured(
    value: FloatArray,
    stage: Studio,
    camera: Camera,
    table: FloatArray,
    value_range: tuple[float, float],
    *,
    bare: float = (_BARE / 255) ** 2.2,
) -> npt.NDArray[np.uint8]:
    """Pixels (h, w, 3) of values per sample, darker where the surface turns away.

    Parameters
    ----------
    table : (k, 3) linear colours from one end of the range to the other
    bare : linear grey of what has no value
    """
    ids, cosine = stage.faces(camera, FACTOR), stage.facing(camera, FACTOR)
    mean = np.empty((ids.shape[0] // FACTOR, ids.shape[1] // FACTOR, 3))
    paper = (PAPER / 255) ** 2.2
    colour.coloured(value, cosine, ids, *value_range, table, bare, paper, FACTOR, mean)
    return np.rint(255 * srgb_encode(np.clip(mean, 0, 1))).astype(np.uint8)


def titled(pixels: npt.NDArray[np.uint8], title: str) -> Pillow.Image:
    """Write the title at the top left."""
    picture = Pillow.fromarray(pixels)
    size = _letters(pixels.shape[0])
    draw = ImageDraw.Draw(picture)
    draw.text((size, size // 2), title, fill=_INK, font=ImageFont.load_default(size))
    return picture


def _letters(height: int) -> int:
    return max(9, height // 36)


def colour_table(colormap: str) -> FloatArray:
    """Colours (256, 3) in linear sRGB, from low to high."""
    if colormap != "diverging":
        srgb = matplotlib.colormaps[colormap](np.linspace(0, 1, 256))[:, :3]
        return np.asarray(srgb_decode(srgb))
    return _diverging(np.linspace(-1, 1, 256))


def _diverging(x: FloatArray) -> FloatArray:
    """Blue, near white, brown-red: lightness falls evenly from the middle, in Oklab (2020)."""
    t = np.abs(x)
    lightness = 0.97 - 0.60 * t
    chroma = 0.15 * np.sin(0.5 * np.pi * np.minimum(1.0, 1.25 * t))
    hue = np.where(x < 0, np.radians(255.0), np.radians(38.0))
    a, b = chroma * np.cos(hue), chroma * np.sin(hue)
    to_lms = np.array(
        [
            [1.0, 0.3963377774, 0.2158037573],
            [1.0, -0.1055613458, -0.0638541728],
            [1.0, -0.0894841775, -1.2914855480],
        ]
    )
    to_rgb = np.array(
        [
            [4.0767416621, -3.3077115913, 0.2309699292],
            [-1.2684380046, 2.6097574011, -0.3413193965],
            [-0.0041960863, -0.7034186147, 1.7076147010],
        ]
    )
    lms = (np.stack([lightness, a, b], axis=-1) @ to_lms.T) ** 3
    return np.asarray(np.clip(lms @ to_rgb.T, 0.0, 1.0))


def with_bar(
    pixels: npt.NDArray[np.uint8],
    table: FloatArray,
    value_range: tuple[float, float],
    title: str,
    unit: str,
) -> npt.NDArray[np.uint8]:
    """Title at the top left, colour bar with five ticks along the right."""
    height, width = pixels.shape[:2]
    picture = titled(pixels, title)
    draw = ImageDraw.Draw(picture)
    size = _letters(height)
    font = ImageFont.load_default(size)
    top, bottom = height // 5, height - height // 5
    left = width - 6 * size
    draw.rectangle((left - size, top - 2 * size, width, bottom + size), fill=(PAPER,) * 3)
    bar = np.rint(255 * srgb_encode(table)).astype(np.uint8)
    rows = np.linspace(len(bar) - 1, 0, bottom - top).astype(np.int64)
    picture.paste(Pillow.fromarray(np.repeat(bar[rows][:, None], size, axis=1)), (left, top))
    draw.rectangle((left - 1, top - 1, left + size, bottom), outline=_INK)
    low, high = value_range
    for k in range(5):
        y = bottom - (bottom - top) * k // 4
        draw.line((left + size, y, left + size + size // 3, y), fill=_INK)
        text = f"{low + (high - low) * k / 4:.3g}"
        draw.text((left + size + size // 2, y), text, fill=_INK, font=font, anchor="lm")
    draw.text((left, top - size), unit or "[-]", fill=_INK, font=font, anchor="lm")
    return np.asarray(picture)
