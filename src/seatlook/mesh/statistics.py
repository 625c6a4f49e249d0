"""Statistics of face values, weighted by the area of the faces."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]


def quantile(values: FloatArray, weight: FloatArray, share: float) -> float:
    """Return the smallest value with at least ``share`` of the weight at or below it.

    Examples
    --------
    >>> quantile(np.array([5.0, 0.0, 1.0]), np.array([0.02, 0.9, 0.08]), 0.95)
    1.0
    """
    order = np.argsort(values, kind="stable")
    cumulative = np.cumsum(weight[order]) / weight.sum()
    return float(values[order][min(int(np.searchsorted(cumulative, share)), len(values) - 1)])
