"""How much cloth lies in waves along a line of a solved panel: arc minus chord."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import gaussian_filter1d

from seatlook import mesh
from seatlook.model import FloatArray, Solution
from seatlook.wrinkle.recovery import DESIGN_WAVELENGTH
from seatlook.wrinkle.section import located

_STEP = 0.3  # of h between samples
# A Gaussian of so many times the cut-off length lets half of a wave of that length pass.
_SIGMA = np.sqrt(2.0 * np.log(2.0)) / (2.0 * np.pi)


def waves_along(
    solution: Solution, panel: int, line: FloatArray, *, wavelength: float = DESIGN_WAVELENGTH
) -> float:
    """Length [m] that a line of a panel has more in waves than without them.

    Waves are what is shorter than ``wavelength`` [m]; half of one of that length counts.

    Parameters
    ----------
    line : (k, 2) float64 [m]     in rest coordinates; parts outside the panel are left out
    """
    cover = solution.cover
    at = mesh.resample(line, _STEP * cover.element_size)
    face, weight = located(cover, panel, at)
    inside = face >= 0
    if inside.sum() < 3:
        return 0.0
    points = np.einsum("kc,kcd->kd", weight[inside], solution.positions[cover.faces[face[inside]]])
    step = mesh.length(at) / (len(at) - 1)
    wave = _high_passed(points, _SIGMA * wavelength / step)
    along = np.gradient(points, axis=0)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    wave -= np.einsum("kd,kd->k", wave, along)[:, None] * along
    return float(0.5 * (np.diff(wave, axis=0) ** 2).sum() / step)


def _high_passed(points: FloatArray, sigma: float) -> FloatArray:
    """Points (k, d) minus their mean over some neighbours; ends are turned about themselves."""
    reach = min(int(4.0 * sigma) + 1, len(points) - 1)
    before = 2.0 * points[0] - points[reach:0:-1]
    after = 2.0 * points[-1] - points[-2 : -2 - reach : -1]
    padded = np.concatenate([before, points, after])
    smooth = gaussian_filter1d(padded, sigma, axis=0, mode="nearest", truncate=4.0)
    return np.asarray(points - smooth[reach : reach + len(points)])
