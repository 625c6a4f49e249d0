"""The finished shape against the one that was meant: the foam, covered without a gap."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from seatlook.errors import InputError
from seatlook.mesh.statistics import quantile
from seatlook.model import FloatArray, Solution
from seatlook.solver.foam.distance import distance_field


@dataclass(frozen=True, slots=True, kw_only=True)
class ZoneStandoff:
    """How far a zone is off [m], from the foam or its design, weighted by rest area.

    Parameters
    ----------
    area : float [m2]      with a known distance
    measured : float       share of the zone's area that this is
    p95 : float            95 % of the area are off by no more than this, to either side
    """

    zone: str
    area: float
    measured: float
    mean: float
    rms: float
    p95: float
    lowest: float
    highest: float


def standoff(solution: Solution) -> FloatArray:
    """Signed distance (m,) [m] of every face, as a mean of its corners, from the shape meant.

    That shape is the untouched foam with the cover lying on it: the mid surface half a thickness
    above the foam. It is above 0 where the cover bridges a hollow or stands in a wrinkle, below 0
    where it presses the foam in.

    Faces farther away than the foam's distance field reaches, such as a skirt, are nan.

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
    off = distance[cover.faces].mean(axis=1) - 0.5 * cover.thickness
    return np.where(np.isfinite(off), off, np.nan)


def zone_standoff(solution: Solution, off: FloatArray) -> tuple[ZoneStandoff, ...]:
    """Sum the distances (m,) [m] of the faces up over every zone, where they are known."""
    cover = solution.cover
    known = np.isfinite(off)
    rows = []
    for i, name in enumerate(cover.zone_names):
        inside = cover.zone == i
        mine = inside & known
        if not mine.any():
            continue
        area, value = cover.rest_area[mine], off[mine]
        rows.append(
            ZoneStandoff(
                zone=name,
                area=float(area.sum()),
                measured=float(area.sum() / cover.rest_area[inside].sum()),
                mean=float(np.average(value, weights=area)),
                rms=float(np.sqrt(np.average(value**2, weights=area))),
                p95=quantile(np.abs(value), area, 0.95),
                lowest=float(value.min()),
                highest=float(value.max()),
            )
        )
    return tuple(rows)
