"""The model observer: every constant of the visibility score, and its contrast sensitivity."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from seatlook.model import FloatArray
from seatlook.model._check import in_range, positive

# The table covers 2^-14 to 2^24 cd/m2, starlight to the sun's disc seen in a mirror finish.
LOWEST_OCTAVE, HIGHEST_OCTAVE, NODES_PER_OCTAVE = -14, 24, 32


@dataclass(frozen=True, slots=True, kw_only=True)
class Observer:
    """Constants of the score: from the literature or by judgement, none fitted to people.

    Parameters
    ----------
    field_deg : float              size of the stimulus X0 in the sensitivity formula [deg]
    masking_gain : float           k: how strongly a pattern in both pictures hides a change
    masking_exponent : float       q: growth of masking with the contrast of that pattern
    masking_root : float           p: d = signal / (1 + mask^q)^(1/p)
    pooling : float                Minkowski exponent over bands and over the pixels of a region
    lowest_frequency : float       [cycles/deg] bands below it are shading, not wrinkles
    darkest : float [cd/m2]        contrast is taken over at least this luminance
    visible : (float, float)       values of D whose exceeded area is reported
    """

    calibrated: ClassVar[bool] = False

    field_deg: float = 10.0
    masking_gain: float = 1.0
    masking_exponent: float = 2.0
    masking_root: float = 2.2
    pooling: float = 3.5
    lowest_frequency: float = 0.2
    darkest: float = 1e-3
    visible: tuple[float, float] = (3.0, 10.0)

    def __post_init__(self) -> None:
        positive(self, "field_deg", "masking_exponent", "masking_root", "lowest_frequency")
        positive(self, "darkest")
        in_range(self, "masking_gain", 0.0, 1e3)
        in_range(self, "pooling", 1.0, 100.0)


OBSERVER = Observer()


def contrast_sensitivity(
    frequency: float | FloatArray,
    luminance: float | FloatArray,
    *,
    field_deg: float = OBSERVER.field_deg,
) -> FloatArray:
    """Contrast sensitivity S = 1 / threshold contrast, of a standard observer.

    Barten's closed approximation (Proc. SPIE 5294, 2003):
    ``5200 exp(-0.0016 f^2 (1 + 100/L)^0.08)
    / sqrt((1 + 144/X0^2 + 0.64 f^2) (63/L^0.83 + 1/(1 - exp(-0.02 f^2))))``.

    Parameters
    ----------
    frequency : [cycles/deg] above 0; luminance : [cd/m2] above 0; they broadcast

    Examples
    --------
    >>> contrast_sensitivity(3.0, 1000.0).round()
    np.float64(715.0)
    """
    f2, L = np.square(frequency), np.asarray(luminance, dtype=float)
    optics = np.exp(-0.0016 * f2 * (1 + 100 / L) ** 0.08)
    summation = 1 + 144 / field_deg**2 + 0.64 * f2
    noise = 63 / L**0.83 - 1 / np.expm1(-0.02 * f2)
    return np.asarray(5200 * optics / np.sqrt(summation * noise))[()]


@functools.lru_cache(maxsize=64)
def sensitivity_table(frequency: float, field_deg: float) -> FloatArray:
    """S at the nodes the kernel interpolates between: equal steps of L in every octave.

    With such nodes the place in the table follows from exponent and mantissa of L, so that no
    logarithm is taken per pixel.
    """
    octaves = np.arange(LOWEST_OCTAVE, HIGHEST_OCTAVE)[:, None]
    steps = 1 + np.arange(NODES_PER_OCTAVE) / NODES_PER_OCTAVE
    nodes = np.append((steps * 2.0**octaves).ravel(), 2.0**HIGHEST_OCTAVE)
    table: FloatArray = np.asarray(contrast_sensitivity(frequency, nodes, field_deg=field_deg))
    table.setflags(write=False)
    return table
