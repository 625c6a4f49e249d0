"""Colours as materials give them: linear numbers, sRGB in hex, or L*a*b*."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

import numpy as np

from seatlook.io.schema import Array, shown
from seatlook.io.toml import Document, Key
from seatlook.model.colour import srgb_decode


@dataclass(frozen=True, slots=True, kw_only=True)
class Colour:
    """Three linear numbers from 0 to 1, ``"#rrggbb"`` in sRGB, or ``"lab(L, a, b)"``."""

    required: bool = False
    default: None = None

    def read(self, document: Document, key: Key, value: Any) -> Any:
        """Linear sRGB (3,), or None where a problem was reported."""
        if not isinstance(value, str):
            return Array(shape=(3,), low=0.0, high=1.0).read(document, key, value)
        if re.fullmatch(r"#[0-9a-fA-F]{6}", value):
            return srgb_decode(np.array([int(value[i : i + 2], 16) for i in (1, 3, 5)]) / 255)
        number = r"\s*(-?\d+\.?\d*)\s*"
        lab = re.fullmatch(rf"lab\({number},{number},{number}\)", value)
        if lab is None:
            expected = '"#rrggbb", "lab(L, a, b)" or three linear numbers from 0 to 1'
            document.report(key, shown(value), expected)
            return None
        colour = linear_from_lab(np.array([float(x) for x in lab.groups()]))
        if colour.min() < -1e-3 or colour.max() > 1.001:
            document.report(key, shown(value), "a colour that sRGB holds")
            return None
        return np.clip(colour, 0.0, 1.0)


def linear_from_lab(lab: Any) -> Any:
    """Linear sRGB (3,) of CIE L*a*b* (3,) under D65 for the 2 degree observer (CIE 15:2018).

    Examples
    --------
    >>> linear_from_lab(np.array([50.0, 0.0, 0.0])).round(4).tolist()
    [0.1842, 0.1842, 0.1842]
    """
    lightness, a, b = lab
    f = (lightness + 16) / 116 + np.array([a / 500, 0.0, -b / 200])
    white = np.array([0.95047, 1.0, 1.08883])
    xyz = white * np.where(f > 6 / 29, f**3, 3 * (6 / 29) ** 2 * (f - 4 / 29))
    to_rgb = np.array(
        [
            [3.2404542, -1.5371385, -0.4985314],
            [-0.9692660, 1.8760108, 0.0415560],
            [0.0556434, -0.2040259, 1.0572252],
        ]
    )
    return to_rgb @ xyz
