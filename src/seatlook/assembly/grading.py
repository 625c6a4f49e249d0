"""Element sizes of a panel that vary from place to place."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.interpolate import LinearNDInterpolator, NearestNDInterpolator

from seatlook.model import FloatArray


@dataclass(frozen=True)
class Grading:
    """Sizes known at some places of a panel, linear between them.

    Parameters
    ----------
    points : (k, 2) float64 [m]   places in pattern coordinates, outline and inside
    sizes : (k,) float64 [m]      element size at each

    Examples
    --------
    >>> corners = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    >>> fine_below = Grading(corners, np.array([0.01, 0.01, 0.03, 0.03]))
    >>> fine_below(np.array([[0.5, 0.5], [0.5, -1.0]])).round(3)
    array([0.02, 0.01])
    """

    points: FloatArray
    sizes: FloatArray

    def __call__(self, points: FloatArray) -> FloatArray:
        """Sizes (n,) [m] at points (n, 2); beyond the places those of the nearest."""
        size = np.asarray(self._inside(points))
        outside = np.isnan(size)
        if outside.any():
            size[outside] = self._nearest(points[outside])
        return size

    @property
    def finest(self) -> float:
        """Smallest size anywhere [m]."""
        return float(self.sizes.min())

    @property
    def coarsest(self) -> float:
        """Largest size anywhere [m]."""
        return float(self.sizes.max())

    @cached_property
    def _inside(self) -> LinearNDInterpolator:
        return LinearNDInterpolator(self.points, self.sizes)

    @cached_property
    def _nearest(self) -> NearestNDInterpolator:
        return NearestNDInterpolator(self.points, self.sizes)
