"""Colours: transfer function of sRGB (IEC 61966-2-1) and L*a*b* (CIE 15:2018), both ways."""

from __future__ import annotations

from typing import Any

import numpy as np

from seatlook.model._check import FloatArray

WHITE = np.array([0.95047, 1.0, 1.08883])  # D65, 2 degree observer
TO_SRGB = np.array(
    [
        [3.2404542, -1.5371385, -0.4985314],
        [-0.9692660, 1.8760108, 0.0415560],
        [0.0556434, -0.2040259, 1.0572252],
    ]
)
_BEND = 6 / 29


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


def linear_from_lab(lab: Any) -> Any:
    """Linear sRGB (3,) of CIE L*a*b* (3,) under D65 for the 2 degree observer (CIE 15:2018).

    Examples
    --------
    >>> linear_from_lab(np.array([50.0, 0.0, 0.0])).round(4).tolist()
    [0.1842, 0.1842, 0.1842]
    """
    lightness, a, b = lab
    f = (lightness + 16) / 116 + np.array([a / 500, 0.0, -b / 200])
    return TO_SRGB @ (WHITE * np.where(f > _BEND, f**3, 3 * _BEND**2 * (f - 4 / 29)))


def lab_from_linear(linear: FloatArray) -> FloatArray:
    """CIE L*a*b* (..., 3) under D65 of linear sRGB (..., 3).

    Examples
    --------
    >>> lab_from_linear(np.array([0.2, 0.1, 0.05])).round(1).tolist()
    [40.8, 10.8, 20.5]
    """
    t = np.asarray(linear) @ np.linalg.inv(TO_SRGB).T / WHITE
    f = np.where(t > _BEND**3, np.cbrt(t), t / (3 * _BEND**2) + 4 / 29)
    x, y, z = np.moveaxis(f, -1, 0)
    return np.stack([116 * y - 16, 500 * (x - y), 200 * (y - z)], axis=-1)


def delta_e_2000(first: FloatArray, second: FloatArray) -> FloatArray:
    """Colour difference CIEDE2000 (ISO/CIE 11664-6) of L*a*b* (..., 3).

    Examples
    --------
    >>> first, second = np.array([50.0, 2.6772, -79.7751]), np.array([50.0, 0.0, -82.7485])
    >>> delta_e_2000(first, second).round(4)
    np.float64(2.0425)
    """
    (l1, a1, b1), (l2, a2, b2) = np.moveaxis(first, -1, 0), np.moveaxis(second, -1, 0)
    c = ((np.hypot(a1, b1) + np.hypot(a2, b2)) / 2) ** 7
    g = 1.5 - 0.5 * np.sqrt(c / (c + 25.0**7))
    c1, c2 = np.hypot(g * a1, b1), np.hypot(g * a2, b2)
    h1, h2 = np.degrees(np.arctan2(b1, g * a1)) % 360, np.degrees(np.arctan2(b2, g * a2)) % 360
    grey = c1 * c2 == 0
    turn = np.where(grey, 0.0, (h2 - h1 + 180) % 360 - 180)
    hue = 2 * np.sqrt(c1 * c2) * np.sin(np.radians(turn) / 2)
    mean = np.where(grey, h1 + h2, h1 + turn / 2)
    lightness, chroma = ((l1 + l2) / 2 - 50) ** 2, (c1 + c2) / 2
    t = 1 - 0.17 * _cos(mean - 30) + 0.24 * _cos(2 * mean)
    t += 0.32 * _cos(3 * mean + 6) - 0.20 * _cos(4 * mean - 63)
    dl = (l2 - l1) / (1 + 0.015 * lightness / np.sqrt(20 + lightness))
    dc, dh = (c2 - c1) / (1 + 0.045 * chroma), hue / (1 + 0.015 * chroma * t)
    blue = 60 * np.exp(-(((mean % 360 - 275) / 25) ** 2))
    rotation = -2 * np.sqrt(chroma**7 / (chroma**7 + 25.0**7)) * np.sin(np.radians(blue))
    return np.asarray(np.sqrt(dl**2 + dc**2 + dh**2 + rotation * dc * dh))


def _cos(degrees: FloatArray) -> FloatArray:
    return np.asarray(np.cos(np.radians(degrees)))
