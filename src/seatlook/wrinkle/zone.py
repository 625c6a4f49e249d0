"""Figures of each zone: how much wrinkles, why, and how far the number can be trusted."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
import numpy.typing as npt

from seatlook.model import Cover, FloatArray, WrinkleMap
from seatlook.wrinkle.recovery import recovery_error
from seatlook.wrinkle.registry import INDICES, STATISTICS, mean


@dataclass(frozen=True, slots=True, kw_only=True)
class ZoneRow:
    """Figures of one zone; means and shares are weighted by rest area.

    ``row["w2_mean"]`` is a figure; the registry of indices says which there are.

    Parameters
    ----------
    area : [m2]
    element_size : [m]              mean edge length h of the zone's faces at rest
    stretch_share : [1] in [0, 1]   part of the zone's W2 that is W_stretch; 0 where W2 is 0
    w2_face_rms : [1]               rms of W2 against its recovered field, face by face; it says
        nothing of the error of the mean
    resolved : whether the mesh carries all of the zone
    figures : name -> value         of every index of the registry
    """

    zone: str
    area: float
    element_size: float
    stretch_share: float
    w2_face_rms: float
    resolved: bool = True
    figures: MappingProxyType[str, float]

    def __getitem__(self, name: str) -> float:
        return self.figures[name]

    def values(self) -> dict[str, str | float | bool]:
        """Return the whole row as plain values, the figures last."""
        return {
            "zone": self.zone,
            "area": self.area,
            "element_size": self.element_size,
            "stretch_share": self.stretch_share,
            "w2_face_rms": self.w2_face_rms,
            "resolved": self.resolved,
            **self.figures,
        }


def zone_table(
    cover: Cover,
    values: Mapping[str, FloatArray],
    *,
    unresolved: npt.NDArray[np.bool_] | None = None,
) -> tuple[ZoneRow, ...]:
    """Summarise indices zone by zone, empty zones left out.

    Parameters
    ----------
    values : name of an index of the registry -> (m,) in its unit; W2 and W_stretch among them
    unresolved : (m,) bool   faces that the mesh does not carry
    """
    area = cover.rest_area
    error = recovery_error(cover.rest, cover.faces, values["w2"])
    corners = cover.rest[cover.faces]
    side = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2).mean(axis=1)
    rows = []
    for number, name in enumerate(cover.zone_names):
        inside = cover.zone == number
        if not inside.any():
            continue
        weight = area[inside]
        w2, stretch = (mean(values[index][inside], weight) for index in ("w2", "w_stretch"))
        rows.append(
            ZoneRow(
                zone=name,
                area=float(weight.sum()),
                element_size=float(side[inside].mean()),
                stretch_share=stretch / w2 if w2 > 0 else 0.0,
                w2_face_rms=mean(error[inside] ** 2, weight) ** 0.5,
                resolved=unresolved is None or not unresolved[inside].any(),
                figures=MappingProxyType(
                    {
                        figure: STATISTICS[statistic](values[index.name][inside], weight)
                        for index in INDICES.values()
                        if index.name in values
                        for figure, statistic in zip(index.figures, index.statistics, strict=True)
                    }
                ),
            )
        )
    return tuple(rows)


def map_top(indices: WrinkleMap) -> float:
    """Upper end of the range of W2 that a map shows: at least 1, where wrinkles begin."""
    # Eight in a thousand faces may lie above: a single pinched triangle must not wash out a map.
    return max(1.0, float(np.quantile(indices.w2, 0.992)))
