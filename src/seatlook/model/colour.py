"""Transfer function of sRGB (IEC 61966-2-1), both ways."""

from __future__ import annotations

from typing import Any

import numpy as np

from seatlook.model._check import FloatArray


def srgb_encode(linear: FloatArray) -> FloatArray:
    """Opto-electronic transfer on [0, 1].

    Examples
    --------
    >>> srgb_encode(np.array([0.0, 0.0031308, 0.18, 1.0])).round(4).tolist()
    [0.0, 0.0404, 0.4614, 1.0]
    """
    return np.where(
        linear <= 0.0031308, 12.92 * linear, 1.055 * np.maximum(linear, 1e-9) ** (1 / 2.4) - 0.055
    )


def srgb_decode(encoded: Any) -> Any:
    """Linear values of encoded ones, both in [0, 1]; float32 stays float32.

    Examples
    --------
    >>> srgb_decode(np.array([0.0, 0.5, 1.0])).round(4).tolist()
    [0.0, 0.214, 1.0]
    """
    return np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)
