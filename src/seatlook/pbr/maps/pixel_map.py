"""Pictures of values that belong to pixels, such as the visibility of wrinkles."""

from __future__ import annotations

import numpy as np

from seatlook.errors import InputError
from seatlook.model import Camera, FloatArray, Solution
from seatlook.pbr.maps.face_map import FACTOR, colour_table, coloured, with_bar
from seatlook.pbr.picture import Picture
from seatlook.pbr.shading.studio import studio

_BARE = 0.5  # linear grey where nothing is known


def render_pixel_map(
    solution: Solution,
    values: FloatArray,
    *,
    camera: Camera,
    title: str,
    value_range: tuple[float, float],
    unit: str = "",
) -> Picture:
    """Draw one value per pixel over the shape, with a colour bar (viridis).

    Parameters
    ----------
    values : (h, w) float64     nan is drawn grey
    value_range : (low, high)   what lies outside takes the colour of the end

    Raises
    ------
    InputError
        Another shape than the camera's, an empty range.
    NoOffscreenContext, RenderError
    """
    width, height = camera.size
    if values.shape != (height, width):
        raise InputError.single(
            "values", got=f"shape {values.shape}", expected=f"({height}, {width})"
        )
    low, high = value_range
    if not high > low:
        raise InputError.single("value_range", got=value_range, expected="low < high")
    stage = studio(solution)
    table = colour_table("viridis")
    value = np.repeat(np.repeat(values, FACTOR, axis=0), FACTOR, axis=1)
    pixels = coloured(value, stage, camera, table, value_range, bare=_BARE)
    return Picture(
        pixels=with_bar(pixels, table, value_range, title, unit), value_range=value_range
    )
