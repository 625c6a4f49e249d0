"""Figures of each zone: how much wrinkles, why, and how far the number can be trusted."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
import numpy.typing as npt

from seatlook.model import Cover, Criteria, FloatArray, WrinkleMap
from seatlook.wrinkle.recovery import recovery_error
from seatlook.wrinkle.registry import INDICES, STATISTICS, mean


@dataclass(frozen=True, slots=True, kw_only=True)
class ZoneRow:
    """Figures of one zone; means and shares are weighted by rest area.

    ``row["w2_mean"]`` is a figure; the registry of indices says which there are.

    Parameters
    ----------
    criterion : mode and threshold of its W2, "tensor, 0.02 per mm"
    area : [m2]
    element_size : [m]              mean edge length h of the zone's faces at rest
    stretch_share : [1] in [0, 1]   part of the zone's W2 that is W_stretch; 0 where W2 is 0
    w2_face_rms : [1]               rms of W2 against its recovered field, face by face; it says
        nothing of the error of the mean
    resolved : whether the mesh carries all of the zone
    w2_mesh_error : [1]             error of the mean W2 by its mesh; None where not measured
    w2_scatter : [1]                95 % half-width of the mean W2 for other seeds; None likewise
    figures : name -> value         of every index of the registry
    """

    zone: str
    criterion: str
    area: float
    element_size: float
    stretch_share: float
    w2_face_rms: float
    resolved: bool = True
    w2_mesh_error: float | None = None
    w2_scatter: float | None = None
    figures: MappingProxyType[str, float]

    def __getitem__(self, name: str) -> float:
        return self.figures[name]

    def values(self) -> dict[str, str | float | bool]:
        """Return the row as plain values, units in the names; companions that are known."""
        companions = {"w2_mesh_error": self.w2_mesh_error, "w2_scatter": self.w2_scatter}
        return {
            "zone": self.zone,
            "criterion": self.criterion,
            "area_cm2": 1e4 * self.area,
            "element_size_mm": 1e3 * self.element_size,
            "stretch_share": self.stretch_share,
            "w2_face_rms": self.w2_face_rms,
            "resolved": self.resolved,
            **{name: value for name, value in companions.items() if value is not None},
            **self.figures,
        }


def zone_table(
    cover: Cover,
    values: Mapping[str, FloatArray],
    *,
    criteria: Criteria,
    unresolved: npt.NDArray[np.bool_] | None = None,
    known: Mapping[str, float] = MappingProxyType({}),
) -> tuple[ZoneRow, ...]:
    """Summarise indices zone by zone, empty zones left out.

    Parameters
    ----------
    values : name of an index of the registry -> (m,) in its unit; W2 and W_stretch among them
    criteria : by which they were evaluated
    unresolved : (m,) bool   faces that the mesh does not carry
    known : figures of a result, with the companions of its zones where they were measured
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
                criterion=criteria.words(cover.panel[inside]),
                area=float(weight.sum()),
                element_size=float(side[inside].mean()),
                stretch_share=stretch / w2 if w2 > 0 else 0.0,
                w2_face_rms=mean(error[inside] ** 2, weight) ** 0.5,
                resolved=unresolved is None or not unresolved[inside].any(),
                **_companions(name, known),
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


def companion_keys(zone: str) -> tuple[str, str]:
    """Names of a zone's mesh error and scatter among the figures of a result."""
    return f"zone/{zone}/w2_mesh_error", f"zone/{zone}/w2_scatter"


def _companions(zone: str, known: Mapping[str, float]) -> dict[str, float | None]:
    error, scatter = (known.get(key) for key in companion_keys(zone))
    return {"w2_mesh_error": error, "w2_scatter": scatter}


def map_top(indices: WrinkleMap) -> float:
    """Upper end of the range of W2 that a map shows: at least 1, where wrinkles begin."""
    # Eight in a thousand faces may lie above: a single pinched triangle must not wash out a map.
    return max(1.0, float(np.quantile(indices.w2, 0.992)))
