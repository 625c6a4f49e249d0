"""The model observer: every constant of the visibility score, and its contrast sensitivity."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from seatlook.model import FloatArray
from seatlook.model._check import in_range, positive

# Luminance [cd/m2] beyond which nobody measured: there sensitivity stays as it is.
DARKEST_MEASURED, BRIGHTEST_MEASURED = 1e-3, 1e4
# The table covers these, 2^-10 to 2^14 cd/m2.
LOWEST_OCTAVE, HIGHEST_OCTAVE, NODES_PER_OCTAVE = -10, 14, 128


@dataclass(frozen=True, slots=True, kw_only=True)
class Observer:
    """Constants of the score, fitted to published thresholds by ``gallery/observer.py``.

    Parameters
    ----------
    area_deg2 : float              field the sensitivity is taken for; larger ones are summed
    gain : float                   factor on the sensitivity
    masking_gain : float           k: how strongly a pattern in both pictures hides a change
    masking_neighbours : float     w: the same of a pattern one octave finer or coarser, in squares
    pooling : float                Minkowski exponent over bands and over the pixels of a region
    lowest_frequency : float       [cycles/deg] bands below it are shading, not wrinkles
    darkest : float [cd/m2]        contrast is taken over at least this luminance
    visible : (float, float)       values of D whose exceeded area is reported
    """

    calibrated: ClassVar[str] = "on detection and masking of published observers"

    area_deg2: float = 2.4
    gain: float = 1.26
    masking_gain: float = 0.4
    masking_neighbours: float = 2.0
    pooling: float = 3.0
    lowest_frequency: float = 0.2
    darkest: float = 1e-3
    visible: tuple[float, float] = (1.0, 3.0)

    def __post_init__(self) -> None:
        positive(self, "area_deg2", "gain", "lowest_frequency", "darkest")
        in_range(self, "masking_gain", 0.0, 1e3)
        in_range(self, "masking_neighbours", 0.0, 1e3)
        in_range(self, "pooling", 1.0, 100.0)


OBSERVER = Observer()

# VWI from which a zone's wrinkles are called visible: the threshold of the observer, at which
# people who know where to look, with all the time they want, are right in three of four trials.
# Below it nobody can say which of two seats has the wrinkles. A floor, not a limit of quality.
VISIBLE = 1.0
# Largest VWI of a cover without wrinkles beside its reference: well below what is visible.
NULL_LIMIT = 0.3 * VISIBLE
# Yardsticks: least and greatest VWI of the insert of the family's cushion in black leather, in
# three textures under three rigs; fitting, and beside a seam 3 % too long. From
# gallery/visible_faults.py, rounded to two figures.
FITTING, TOO_LONG = (0.096, 0.20), (2.7, 8.7)


def contrast_sensitivity(
    frequency: float | FloatArray, luminance: float | FloatArray, *, area_deg2: float
) -> FloatArray:
    """Contrast sensitivity S = 1 / threshold contrast, to a still pattern in the fovea.

    The sustained achromatic channel of castleCSF (Ashraf, Mantiuk, Chapiro and Wuerger, Journal of
    Vision 24(4), 2024) with its published constants: a parabola over log frequency, cut off below
    its peak, whose height and place depend on luminance, times the summation over area of Rovamo,
    Luntinen and Nasanen (Vision Research 33, 1993).

    Parameters
    ----------
    frequency : [cycles/deg] above 0
    luminance : [cd/m2] above 0; below 0.001 and above 10,000 as there; broadcasts with frequency
    area_deg2 : of the pattern

    Examples
    --------
    >>> contrast_sensitivity(3.0, 100.0, area_deg2=1.0).round()
    np.float64(129.0)
    """
    f, L = (
        np.asarray(frequency, dtype=float),
        np.clip(luminance, DARKEST_MEASURED, BRIGHTEST_MEASURED),
    )
    # The last factor is the limit of the published (1 + 5.58e-7/L)^-9.67e9.
    height = 56.4947 * (1 + 7.54726 / L) ** -0.144532 * -np.expm1(-5.58341e-7 * 9.66862e9 / L)
    peak = 1.78119 * (1 + 91.5718 / L) ** -0.256682
    parabola = 10 ** (-(np.log10(f / peak) ** 2) / 2**0.000213047)
    parabola = np.where(f < peak, np.maximum(parabola, 1 - 0.100207), parabola)
    summed = 157.103 / (1 + (f / 0.702338) ** 2)
    return np.asarray(height * parabola * f * np.sqrt(summed / (1 + summed / area_deg2)))[()]


@functools.lru_cache(maxsize=64)
def sensitivity_table(frequency: float, observer: Observer) -> FloatArray:
    """S at the nodes the kernel interpolates between: equal steps of L in every octave.

    With such nodes the place in the table follows from exponent and mantissa of L, so that no
    logarithm is taken per pixel.
    """
    octaves = np.arange(LOWEST_OCTAVE, HIGHEST_OCTAVE)[:, None]
    steps = 1 + np.arange(NODES_PER_OCTAVE) / NODES_PER_OCTAVE
    nodes = np.append((steps * 2.0**octaves).ravel(), 2.0**HIGHEST_OCTAVE)
    table = observer.gain * contrast_sensitivity(frequency, nodes, area_deg2=observer.area_deg2)
    table.setflags(write=False)
    return table
