"""A checker or stripes drawn on the pattern, to see how the cover distorts a texture."""

from __future__ import annotations

from typing import Literal, get_args

import numpy as np

from seatlook.errors import InputError
from seatlook.model import Camera, Solution
from seatlook.pbr.maps.face_map import blended, coloured, titled
from seatlook.pbr.picture import Picture
from seatlook.pbr.shading.studio import studio

Motif = Literal["checker", "stripe"]
_TONES = np.repeat([[0.72], [0.05]], 3, axis=1)
_BARE = 0.6


def render_checker(
    solution: Solution, *, camera: Camera, size: float = 0.010, motif: Motif = "checker"
) -> Picture:
    """Draw squares, or stripes along the warp, that are equally large on the flat pattern.

    Parameters
    ----------
    size : float [m]   side of a square, or width of a stripe

    Returns
    -------
    Picture
        Display-referred, shaded from the camera; ``value_range`` is (0, size in mm).

    Raises
    ------
    InputError
        A size of 0 or less, an unknown motif.
    NoOffscreenContext, RenderError
    """
    if not size > 0:
        raise InputError.single("size", got=size, expected="above 0")
    if motif not in get_args(Motif):
        raise InputError.single("motif", got=repr(motif), expected="'checker' or 'stripe'")
    stage = studio(solution)
    corners = solution.cover.uv[solution.cover.faces]
    u, v = (blended(stage, camera, np.ascontiguousarray(corners[:, :, k])) for k in (0, 1))
    cell = np.floor(v / size) + (np.floor(u / size) if motif == "checker" else 0.0)
    what = "squares" if motif == "checker" else "stripes along the warp"
    pixels = coloured(cell % 2, stage, camera, _TONES, (0.0, 1.0), bare=_BARE)
    picture = titled(pixels, f"{what} of {1e3 * size:g} mm on the pattern")
    return Picture(pixels=np.asarray(picture), value_range=(0.0, 1e3 * size))
