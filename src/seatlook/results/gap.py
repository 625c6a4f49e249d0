"""The gap between the finished cover and its foam, face by face and zone by zone."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from seatlook.errors import InputError
from seatlook.mesh.statistics import quantile
from seatlook.model import FloatArray, Solution
from seatlook.solver.foam.distance import distance_field


@dataclass(frozen=True, slots=True, kw_only=True)
class ZoneGap:
    """Gap [m] between a zone and the foam, or its design surface, weighted by rest area.

    Parameters
    ----------
    area : float [m2]      with a known gap
    measured : float       share of the zone's area that this is
    p95 : float            size of the gap that 95 % of the area do not exceed
    """

    zone: str
    area: float
    measured: float
    mean: float
    rms: float
    p95: float
    lowest: float
    highest: float


def gap(solution: Solution) -> FloatArray:
    """Signed gap (m,) [m] between every face and the foam, as a mean of its corners.

    It is 0 where the cover lies on the untouched foam: its mid surface half a thickness above.
    It is above 0 where the cover bridges a hollow or stands in a wrinkle, below 0 where it presses
    the foam in. Faces farther away than the foam's distance field reaches, such as a skirt, are
    nan.

    Raises
    ------
    InputError
        The cover has no foam.
    """
    cover = solution.cover
    if cover.foam is None:
        raise InputError.single("foam", got="nothing", expected="a cover with a foam below it")
    field = distance_field(cover.foam.vertices, cover.foam.faces)
    # At the vertices: the middle of a flat face lies below the curved cover it stands for.
    distance, _ = field.at(solution.positions)
    gaps = distance[cover.faces].mean(axis=1) - 0.5 * cover.thickness
    return np.where(np.isfinite(gaps), gaps, np.nan)


def zone_gaps(solution: Solution, gaps: FloatArray) -> tuple[ZoneGap, ...]:
    """Sum the gaps (m,) [m] of the faces up over every zone, where they are known.

    Parameters
    ----------
    gaps : (m,) float64 [m]   of ``gap``, or of ``deviation``; nan where not known
    """
    cover = solution.cover
    known = np.isfinite(gaps)
    rows = []
    for i, name in enumerate(cover.zone_names):
        zone = cover.zone == i
        measured = zone & known
        if not measured.any():
            continue
        area, value = cover.rest_area[measured], gaps[measured]
        rows.append(
            ZoneGap(
                zone=name,
                area=float(area.sum()),
                measured=float(area.sum() / cover.rest_area[zone].sum()),
                mean=float(np.average(value, weights=area)),
                rms=float(np.sqrt(np.average(value**2, weights=area))),
                p95=quantile(np.abs(value), area, 0.95),
                lowest=float(value.min()),
                highest=float(value.max()),
            )
        )
    return tuple(rows)
