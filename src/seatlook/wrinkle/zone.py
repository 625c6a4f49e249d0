"""Figures of each zone: how much wrinkles, why, and how far the number can be trusted."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from seatlook.mesh.statistics import quantile
from seatlook.model import FloatArray, Solution, WrinkleMap
from seatlook.wrinkle.recovery import recovery_error


@dataclass(frozen=True, slots=True, kw_only=True)
class ZoneRow:
    """Figures of one zone; means and shares are weighted by rest area.

    Parameters
    ----------
    area : [m2]
    w2_mean, w2_p95 : [1]; w2_area_share : share of the area with W2 above 1
    w_stretch_mean, w_compression_mean : [1]
    stretch_share : [1] in [0, 1]   part of the zone's W2 that is W_stretch; 0 where W2 is 0
    element_size : [m]              mean edge length h of the zone's faces at rest
    w2_error : [1]                  rms of W2 against its recovered field, an estimate of its error
    w2_net_mean, w2_net_p95, w2_net_area_share : [1]   the same figures of W2 without the design's
        own curvature; None where it was not evaluated
    """

    zone: str
    area: float
    w2_mean: float
    w2_p95: float
    w2_area_share: float
    w_stretch_mean: float
    w_compression_mean: float
    stretch_share: float
    element_size: float
    w2_error: float
    w2_net_mean: float | None = None
    w2_net_p95: float | None = None
    w2_net_area_share: float | None = None


def zone_table(
    solution: Solution, indices: WrinkleMap, net: FloatArray | None = None
) -> tuple[ZoneRow, ...]:
    """Summarise W2 and its causes zone by zone, empty zones left out.

    ``net`` (m,) is ``w2_net`` of the same solution, to stand beside W2.
    """
    cover = solution.cover
    area = cover.rest_area
    error = recovery_error(cover.rest, cover.faces, indices.w2)
    corners = cover.rest[cover.faces]
    side = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2).mean(axis=1)
    rows = []
    for i, name in enumerate(cover.zone_names):
        inside = cover.zone == i
        if not inside.any():
            continue
        weight = area[inside]
        w2 = indices.w2[inside]
        mean, stretch = _mean(w2, weight), _mean(indices.w_stretch[inside], weight)
        rows.append(
            ZoneRow(
                zone=name,
                area=float(weight.sum()),
                w2_mean=mean,
                w2_p95=quantile(w2, weight, 0.95),
                w2_area_share=_mean((w2 > 1).astype(float), weight),
                w_stretch_mean=stretch,
                w_compression_mean=_mean(indices.w_compression[inside], weight),
                stretch_share=stretch / mean if mean > 0 else 0.0,
                element_size=float(side[inside].mean()),
                w2_error=_mean(error[inside] ** 2, weight) ** 0.5,
                **({} if net is None else _net_figures(net[inside], weight)),
            )
        )
    return tuple(rows)


def map_top(indices: WrinkleMap) -> float:
    """Upper end of the range of W2 that a map shows: at least 1, where wrinkles begin."""
    # Eight in a thousand faces may lie above: a single pinched triangle must not wash out a map.
    return max(1.0, float(np.quantile(indices.w2, 0.992)))


def _net_figures(net: FloatArray, weight: FloatArray) -> dict[str, float]:
    return {
        "w2_net_mean": _mean(net, weight),
        "w2_net_p95": quantile(net, weight, 0.95),
        "w2_net_area_share": _mean((net > 1).astype(float), weight),
    }


def _mean(values: FloatArray, weight: FloatArray) -> float:
    return float(values @ weight / weight.sum())
