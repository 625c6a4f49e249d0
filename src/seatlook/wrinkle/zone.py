"""Figures of each zone: how much wrinkles, why, and how far the number can be trusted."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from seatlook.model import FloatArray, Solution, WrinkleMap


@dataclass(frozen=True, slots=True, kw_only=True)
class ZoneRow:
    """Figures of one zone; means and shares are weighted by rest area.

    Parameters
    ----------
    area : [m2]
    w2_mean, w2_p95 : [1]; w2_area_share : share of the area with W2 above 1
    w_stretch_mean, w_compression_mean : [1]
    """

    zone: str
    area: float
    w2_mean: float
    w2_p95: float
    w2_area_share: float
    w_stretch_mean: float
    w_compression_mean: float


def zone_table(solution: Solution, indices: WrinkleMap) -> tuple[ZoneRow, ...]:
    """Summarise W2 and its causes zone by zone, empty zones left out."""
    cover = solution.cover
    area = cover.rest_area
    rows = []
    for i, name in enumerate(cover.zone_names):
        inside = cover.zone == i
        if not inside.any():
            continue
        weight = area[inside]
        w2 = indices.w2[inside]
        rows.append(
            ZoneRow(
                zone=name,
                area=float(weight.sum()),
                w2_mean=_mean(w2, weight),
                w2_p95=quantile(w2, weight, 0.95),
                w2_area_share=_mean((w2 > 1).astype(float), weight),
                w_stretch_mean=_mean(indices.w_stretch[inside], weight),
                w_compression_mean=_mean(indices.w_compression[inside], weight),
            )
        )
    return tuple(rows)


def _mean(values: FloatArray, weight: FloatArray) -> float:
    return float(values @ weight / weight.sum())


def quantile(values: FloatArray, weight: FloatArray, share: float) -> float:
    """Return the smallest value with at least ``share`` of the weight at or below it.

    Examples
    --------
    >>> quantile(np.array([5.0, 0.0, 1.0]), np.array([0.02, 0.9, 0.08]), 0.95)
    1.0
    """
    order = np.argsort(values, kind="stable")
    reached = np.cumsum(weight[order]) / weight.sum()
    return float(values[order][min(int(np.searchsorted(reached, share)), len(values) - 1)])
