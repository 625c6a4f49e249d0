"""Colours as materials give them: linear numbers, sRGB in hex, or L*a*b*."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

import numpy as np

from seatlook.io.schema import Array, shown
from seatlook.io.toml import Document, Key
from seatlook.model.colour import linear_from_lab, srgb_decode


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
