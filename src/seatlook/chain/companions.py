"""The two companions of a zone's mean W2: the error of its mesh, and the scatter over seeds."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np
from scipy.stats import norm, t

from seatlook.model import Solution
from seatlook.results.needed_sizes import SMALL
from seatlook.wrinkle import ZoneRow
from seatlook.wrinkle.zone import companion_keys

SURE = 0.95  # of single solves that differ from the mean of all seeds by less than the scatter
ORDERS = (1.0, 2.0)  # between which means converge: of a kink, and of a smooth wave
_CAUTION = 0.4  # by which an observed order is taken lower: scatter makes it uncertain
SEEDS = 2  # that tell the scatter, with the result's own
_USUAL = (
    3e-3  # m: a standard deviation, as a share of the mean, is usually this over a zone's width
)
_EARLIER = 2.0  # seeds and zones of other covers that it stands for; gallery/zone_errors.py
_POOLED = 10.0  # seeds of a zone that the pooled variance stands for
APART = 1.3  # times as large elements, from which a difference of two meshes is one of sizes
_FALLING = (
    2.0  # times the estimate errs a mean that falls from the coarser to the finer mesh, at most
)
_ORDER = 1.5  # of two meshes' means: 2 where there are waves, 1 at the kink of a hooked seam
_SHORT = 1.8e-3  # m2: a seam band of 60 mm, no place of which is two widths away from its ends
_SEEDS = "scatter_seeds"  # figure of a result
_POWER = 0.8  # chance to see a difference that is there, of the number of seeds


@dataclass(frozen=True, slots=True)
class ZoneMean:
    """Mean W2 of a zone with both companions, all [1].

    Parameters
    ----------
    error : of the mesh; nan where it is not known
    scatter : 95 % half-width of what another seed gives; nan where it is not known
    criterion : mode and threshold of its W2, as in ``ZoneRow``
    """

    zone: str
    w2_mean: float
    error: float
    scatter: float = math.nan
    criterion: str = ""

    @property
    def bound(self) -> float:
        """How far the mean may be from that of all seeds on a mesh without error."""
        return self.error + self.scatter


def observed_order(
    fine: Sequence[ZoneRow],
    middle: Sequence[ZoneRow],
    coarse: Sequence[Sequence[ZoneRow]],
    ratio: float,
    zones: Sequence[str],
) -> float:
    """Order at which the means of some zones converge, between 1 and 2.

    Differences of single zones are mostly scatter; their root mean square over all zones of a kind
    is not. Where scatter hides the order it comes out low, which is the safe side.

    Parameters
    ----------
    coarse : rows of each seed of the coarsest mesh, whose mean is taken
    ratio : of neighbouring element sizes
    """
    a, b, c = _means(fine), _means(middle), _mean_of_seeds(coarse)
    steps = np.array([(b[z] - a[z], c[z] - b[z]) for z in zones if z in a and z in b and z in c])
    steps = steps[np.isfinite(steps).all(axis=1)] if len(steps) else np.zeros((0, 2))
    if not len(steps):
        return ORDERS[0]
    near, far = np.sqrt(np.square(steps).mean(axis=0))
    if near == 0.0:
        return ORDERS[1]
    order = math.log(max(far / near, 1e-9)) / math.log(ratio)
    return float(np.clip(order, *ORDERS))


def mesh_errors(
    fine: Sequence[ZoneRow],
    middle: Sequence[ZoneRow],
    coarse: Sequence[Sequence[ZoneRow]],
    ratio: float,
    orders: Mapping[str, float],
) -> dict[str, float]:
    """Error of the mean W2 of each zone of the finest mesh; nan for a zone of one mesh only.

    The difference between the two finer meshes, extrapolated at the zone's order; or that of the
    two coarser ones, scaled by the same order, if it says more. What seeds scatter is taken out of
    both, as it is a companion of its own. Meshes may agree by chance, so no
    zone errs by less than the root mean square share of all zones of its order.

    Parameters
    ----------
    coarse, ratio : as in ``observed_order``
    orders : zone -> its order
    """
    a, b, c = _means(fine), _means(middle), _mean_of_seeds(coarse)
    noise = _deviation_of_seeds(coarse)
    away = {}
    for zone, mean in a.items():
        spread = noise.get(zone, 0.0) * mean
        step = abs(mean - b.get(zone, math.nan))
        before = abs(b.get(zone, math.nan) - c.get(zone, math.nan))
        # A difference of two solves holds the scatter of both, a mean of seeds next to none.
        own = [_without(step, math.sqrt(2.0) * spread), _without(before, spread)]
        own[1] /= ratio ** orders[zone]
        away[zone] = float(np.nanmax(own)) if math.isfinite(step) else math.nan
    result = {}
    for zone, mean in a.items():
        alike = [z for z in a if orders[z] == orders[zone] and a[z] > 0.0]
        shares = np.array([away[z] / a[z] for z in alike])
        known = shares[np.isfinite(shares)]
        usual = float(np.sqrt(np.square(known).mean())) * mean if len(known) else 0.0
        result[zone] = max(away[zone], usual) / (ratio ** (orders[zone] - _CAUTION) - 1.0)
        if math.isnan(away[zone]):
            result[zone] = math.nan
    return result


@dataclass(frozen=True, slots=True, kw_only=True)
class TwoMeshes:
    """What two meshes found in a zone.

    Parameters
    ----------
    mean, before : W2 [1] on the finer and on the coarser mesh; ``before`` is nan without a face
    ratio : of the element sizes [1] where the zone wrinkles, coarser over finer
    estimate : error [1] of waves as short as the fabric makes them, relative to the mean
    area : [m2]
    """

    zone: str
    mean: float
    before: float
    ratio: float
    estimate: float
    area: float


def two_mesh_errors(zones: Sequence[TwoMeshes]) -> dict[str, float]:
    """Error of the mean W2 of each zone of a mesh, from one that is coarser where it wrinkles.

    Waves as short as the fabric makes them err by the estimate that sized the mesh: no zone errs by
    less. Where the means rise, a zone errs by their difference, extrapolated, if that is more: at
    the kink of a seam means converge more slowly than on a wave, at its ends at first order. Where
    they fall, single elements
    were folded sharply on the coarser mesh, which says little of the finer one: twice the estimate
    is the most. W2 is nowhere below zero, so no mean that falls errs by more than itself.
    """
    errors = {}
    for zone in zones:
        share = zone.estimate
        if zone.ratio >= APART and math.isfinite(zone.before) and zone.mean > 0.0:
            order = ORDERS[0] if zone.area < _SHORT else _ORDER
            rise = (zone.mean - zone.before) / (zone.ratio**order - 1.0) / zone.mean
            if rise >= 0.0:
                share = max(rise, share)
            else:
                share = min(max(-rise, share), _FALLING * share, 1.0)
        errors[zone.zone] = share * zone.mean
    return errors


def scatters(areas: Mapping[str, float], seeds: Sequence[Mapping[str, float]]) -> dict[str, float]:
    """95 % half-width of the mean W2 of each zone for another seed.

    Parameters
    ----------
    areas : zone -> [m2]
    seeds : zone -> mean W2, of each seed on a mesh of the same sizes; the first is that of the
        result. Two or more

    Notes
    -----
    A zone is a mean over places that wrinkle by chance, so its variance goes with one over its
    area. Variance times area is pooled over the zones of the cover and with what was found on other
    covers; a zone's own variance counts beside it, as by so many seeds (moderated variances: Smyth
    2004, Stat. Appl. Genet. Mol. Biol. 3, 3). Two seeds then tell as much as a dozen.

    Examples
    --------
    >>> areas = {"small": 0.001, "large": 0.1}
    >>> width = scatters(areas, [{"small": 0.2, "large": 0.2}, {"small": 0.2, "large": 0.2}])
    >>> round(width["small"] / width["large"], 1)
    10.0
    """
    own, free = seeds[0], len(seeds) - 1
    shares = {}
    for zone in own:
        values = np.array([one[zone] for one in seeds if zone in one])
        if len(values) == len(seeds):
            shares[zone] = float(values.std(ddof=1)) / max(float(values.mean()), SMALL)
    pooled = _EARLIER * _USUAL**2 + free * sum(shares[z] ** 2 * areas[z] for z in shares)
    pooled /= _EARLIER + free * len(shares)
    result = {}
    for zone, mean in own.items():
        square = _POOLED * pooled / areas[zone] + free * shares.get(zone, 0.0) ** 2
        square /= _POOLED + (free if zone in shares else 0)
        result[zone] = half_width(len(seeds)) * math.sqrt(square) * max(mean, SMALL)
    return result


def scatter(seeds: Sequence[Sequence[ZoneRow]], row: ZoneRow) -> float:
    """95 % half-width of the mean W2 of one zone for another seed; nan from fewer than two.

    Seeds were solved on a coarser mesh, so their share of the mean counts, by Student's t.
    """
    values = np.array([v for rows in seeds if (v := _means(rows).get(row.zone)) is not None])
    if len(values) < 2:
        return math.nan
    if values.mean() <= 0.0:
        return 0.0
    width = float(t.ppf(0.5 + 0.5 * SURE, len(values) - 1)) * math.sqrt(1.0 + 1.0 / len(values))
    return width * float(values.std(ddof=1) / values.mean()) * row["w2_mean"]


def half_width(seeds: int) -> float:
    """95 % half-width of one solve about the mean of all, in pooled standard deviations."""
    return float(t.ppf(0.5 + 0.5 * SURE, _POOLED + seeds - 1))


def seeds_needed(spread: float, share: float = 0.2) -> int:
    """Seeds of each of two covers from which a difference of means is seen, four times in five.

    Parameters
    ----------
    spread : standard deviation over seeds, as a share of the mean
    share : the difference, as a share of the mean

    Examples
    --------
    >>> seeds_needed(0.05), seeds_needed(0.28)
    (1, 25)
    """
    width = float(norm.ppf(SURE) + norm.ppf(_POWER))
    return max(1, math.ceil(2.0 * (width * spread / share) ** 2))


def differs(a: ZoneRow, b: ZoneRow) -> bool | None:
    """Whether two zones' means are apart by more than both errors and both scatters.

    None where a companion is not known.
    """
    companions = (a.w2_mesh_error, b.w2_mesh_error, a.w2_scatter, b.w2_scatter)
    if any(value is None for value in companions):
        return None
    mesh = sum(value for value in companions[:2] if value is not None)
    spread = math.hypot(*(value for value in companions[2:] if value is not None))
    return abs(a["w2_mean"] - b["w2_mean"]) > mesh + spread


def seeds_for(row: ZoneRow, figures: Mapping[str, float], share: float = 0.2) -> int | None:
    """Seeds from which a difference of a zone's mean by some share is seen; None if not known."""
    count = int(figures.get(_SEEDS, 0.0))
    if row.w2_scatter is None or count < 2 or row["w2_mean"] <= 0.0:
        return None
    return seeds_needed(row.w2_scatter / half_width(count) / row["w2_mean"], share)


def with_companions(
    solution: Solution, zones: Sequence[ZoneMean], seeds: int | None = None
) -> Solution:
    """A result that carries the companions of its zones among its figures."""
    figures = dict(solution.figures)
    if seeds is not None:
        figures[_SEEDS] = float(seeds)
    for zone in zones:
        for key, value in zip(companion_keys(zone.zone), (zone.error, zone.scatter), strict=True):
            figures |= {key: value} if math.isfinite(value) else {}
    return replace(solution, figures=MappingProxyType(figures))


def compare_means(
    fine: Sequence[ZoneRow],
    coarse: Sequence[ZoneRow],
    errors: Mapping[str, float] | None = None,
) -> tuple[tuple[ZoneMean, ...], float]:
    """Return the mean W2 of every zone with its error, and the error over all zones.

    A zone without a face on the coarser mesh has no error: nan, and does not count.

    Parameters
    ----------
    errors : zone -> its error; the difference between both meshes if not given
    """
    other = _means(coarse)
    zones = tuple(
        ZoneMean(
            row.zone,
            row["w2_mean"],
            abs(row["w2_mean"] - other.get(row.zone, math.nan))
            if errors is None
            else errors[row.zone],
        )
        for row in fine
    )
    area = np.array([row.area for row in fine])
    mean = float(np.array([row["w2_mean"] for row in fine]) @ area / area.sum())
    error = np.array([zone.error for zone in zones])
    known = np.isfinite(error)
    square = float(error[known] ** 2 @ area[known] / area[known].sum())
    return zones, math.sqrt(square) / mean if mean > 0.0 else 0.0


def _without(difference: float, noise: float) -> float:
    """Take noise out of a difference, as variances add up."""
    return math.sqrt(max(difference**2 - noise**2, 0.0)) if math.isfinite(difference) else math.nan


def _deviation_of_seeds(seeds: Sequence[Sequence[ZoneRow]]) -> dict[str, float]:
    """Standard deviation over seeds as a share of the mean; none from fewer than two."""
    means = _mean_of_seeds(seeds)
    if len(seeds) < 2:
        return {}
    rows = [_means(one) for one in seeds]
    return {
        zone: float(np.std([one[zone] for one in rows], ddof=1)) / mean
        for zone, mean in means.items()
        if mean > 0.0
    }


def _mean_of_seeds(seeds: Sequence[Sequence[ZoneRow]]) -> dict[str, float]:
    """Mean over seeds of the zones that all of them have."""
    means = [_means(rows) for rows in seeds]
    common = set.intersection(*map(set, means)) if means else set()
    return {zone: float(np.mean([one[zone] for one in means])) for zone in common}


def _means(rows: Sequence[ZoneRow]) -> dict[str, float]:
    return {row.zone: row["w2_mean"] for row in rows}
