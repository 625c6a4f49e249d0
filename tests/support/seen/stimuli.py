"""Patterns that observers were shown, as contrast (h, w) about 0 on a uniform ground."""

from __future__ import annotations

import numpy as np

from seatlook.model import FloatArray


def axes(size_deg: float, pixels_per_degree: float) -> tuple[FloatArray, FloatArray]:
    """Places (h, w) [deg] of the pixels of a square, right and up from its middle."""
    count = max(32, 2 * round(size_deg * pixels_per_degree / 2))
    along = (np.arange(count) - (count - 1) / 2) / pixels_per_degree
    x, y = np.meshgrid(along, -along)
    return x, y


def grating(
    x: FloatArray, y: FloatArray, cycles_per_deg: float, *, turned_deg: float = 0.0
) -> FloatArray:
    """Bars of full contrast, upright ones at 0 deg; a bright one through the middle."""
    turned = np.radians(turned_deg)
    return np.asarray(
        np.cos(2 * np.pi * cycles_per_deg * (np.cos(turned) * x + np.sin(turned) * y))
    )


def gabor(
    x: FloatArray, y: FloatArray, cycles_per_deg: float, sigma_deg: float, **options: float
) -> FloatArray:
    """Make a grating below a round Gaussian."""
    below = np.exp(-(x**2 + y**2) / (2 * sigma_deg**2))
    return np.asarray(below * grating(x, y, cycles_per_deg, **options))


def noise(
    count: int, pixels_per_degree: float, *, up_to_cycles_per_deg: float, seed: int
) -> FloatArray:
    """White noise (count, count) below a frequency, of rms 1."""
    field = np.fft.fft2(np.random.default_rng(seed).normal(size=(count, count)))
    along = np.fft.fftfreq(count, 1 / pixels_per_degree)
    field[np.hypot(along[:, None], along) > up_to_cycles_per_deg] = 0
    values = np.fft.ifft2(field).real
    return np.asarray(values / values.std())
