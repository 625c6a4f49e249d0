"""Tension, out and back: the stiffness at knots of strain from the records of strips."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from seatlook.identify.fit import (
    Joint,
    Unknowns,
    criterion,
    drift_rows,
    drifted,
    fit_joint,
)
from seatlook.io.laboratory.types import LabTest, Specimen
from seatlook.model import Curve, FloatArray

# Knots as shares of the largest strain, from few to many.
_LADDER = ((0.0, 1.0), (0.0, 0.5, 1.0), (0.0, 0.25, 0.5, 1.0), (0.0, 0.1, 0.25, 0.5, 0.75, 1.0))
_STIFFEST = 1e8  # N/m
_LOOSEST = 1e-4  # of the secant: a stiffness stays above 0
_BACK = 4  # points of a way back that is read
_BINS = 10  # of strain, in which deviations are averaged


@dataclass(frozen=True, slots=True)
class Record:
    """A specimen in order: e engineering strain, F force per width [N/m], ``turn`` at the peak."""

    e: FloatArray
    F: FloatArray
    turn: int

    @property
    def returns(self) -> bool:
        """Whether the way back was recorded."""
        return len(self.e) - self.turn > _BACK


@dataclass(frozen=True, slots=True)
class Tension:
    """What tension tests of one direction say.

    Parameters
    ----------
    loading : Curve, and ``unloading`` if the way back was recorded
    sigma : (k,) standard error of the stiffness at its knots
    residual : RMS over the peak force, of all specimens
    worst : (strain, share of the peak) where the mean record leaves the curve most
    """

    loading: Curve
    unloading: Curve | None
    sigma: FloatArray
    residual: float
    worst: tuple[float, float]
    range: float
    peak: float


def identify_tension(test: LabTest) -> Tension:
    """Fit loading and unloading of all specimens of a test.

    The strain at which a specimen becomes taut, the zero of the force and its drift belong to the
    specimen, the curves to the cloth. Force is nominal, strain engineering; both are turned into
    those of the law, second Piola-Kirchhoff over Green strain. Of a free strip the curve is that of
    the strip, still without what its contraction takes.
    """
    records = [record(one) for one in test.specimens]
    if not all(one.returns for one in records):
        records = [Record(r.e[: r.turn + 1], r.F[: r.turn + 1], r.turn) for r in records]
    reach = min(float(green(one.e.max() - _slack(one))) for one in records)
    if test.knots is not None:
        return _merged(records, _fit(records, test.knots), test.knots, reach)
    fits = [(np.array(shares) * reach, _fit(records, np.array(shares) * reach))
            for shares in _LADDER]  # fmt: skip
    knots, best = min(fits, key=lambda one: _score(records, *one))
    return _merged(records, best, knots, reach)


def record(specimen: Specimen) -> Record:
    """Return a specimen with strain and force counted positive and the strain from its start."""
    e = specimen.x * np.sign(specimen.x[int(np.abs(specimen.x).argmax())])
    turn = int(e.argmax())
    F = specimen.y * (np.sign(np.polyfit(e[: turn + 1], specimen.y[: turn + 1], 1)[0]) or 1.0)
    return Record(e - e[: turn + 1].min(), F, turn)


def green(e: FloatArray | float) -> FloatArray:
    """Green strain of an engineering strain."""
    return np.asarray(e + 0.5 * np.square(e))


def force(curve: Curve, e: FloatArray) -> FloatArray:
    """Nominal force per width [N/m] of a strip at engineering strains; 0 where it is slack.

    Examples
    --------
    >>> force(Curve.linear(1000.0), np.array([-0.1, 0.1])).round(6).tolist()
    [0.0, 115.5]
    """
    taut = np.maximum(e, 0.0)
    return np.asarray((1.0 + taut) * curve.tension(green(taut)))


def force_back(loading: Curve, unloading: Curve, e: FloatArray, peak: float) -> FloatArray:
    """Nominal force per width [N/m] on the way back from the engineering strain ``peak``."""
    E, top = green(np.maximum(e, 0.0)), float(green(peak))
    start = strain_at(unloading, float(loading.tension(np.array([top]))[0]))
    return np.asarray((1.0 + e) * unloading.tension(np.maximum(E - top + start, 0.0)))


def strain_at(curve: Curve, tension: float) -> float:
    """Green strain at which a curve reaches a tension [N/m]."""
    at = curve.tension(curve.strain)
    i = int(np.searchsorted(at, tension, side="right")) - 1
    step = np.diff(curve.strain)
    rise = (curve.stiffness[i + 1] - curve.stiffness[i]) / step[i] if i < len(step) else 0.0
    k, rest = float(curve.stiffness[i]), tension - float(at[i])
    return float(curve.strain[i] + 2.0 * rest / (k + np.sqrt(max(k * k + 2.0 * rise * rest, 0.0))))


def _slack(one: Record) -> float:
    """Strain at which a specimen becomes taut, roughly: where 3 % of the peak are reached."""
    F = one.F[: one.turn + 1] - one.F[: max(one.turn // 20, 1)].min()
    taut = int((0.03 * F.max() < F).argmax())
    return float(one.e[max(taut - 1, 0)])


def _curves(values: FloatArray, knots: FloatArray, returns: bool) -> tuple[Curve, Curve | None]:
    """Curves of the unknowns: stiffness at knots, then what the way back adds to each."""
    k = len(knots)
    loading = Curve(strain=knots, stiffness=values[:k])
    if not returns:
        return loading, None
    return loading, Curve(strain=knots, stiffness=values[:k] + values[k : 2 * k])


def _model(
    one: Record, knots: FloatArray, returns: bool
) -> Callable[[FloatArray, FloatArray], FloatArray]:
    """What a specimen reads, by the stiffnesses of the cloth and its own slack, zero and drift."""

    def reading(shared: FloatArray, own: FloatArray) -> FloatArray:
        loading, unloading = _curves(shared, knots, returns)
        e = one.e - own[0]
        F = force(loading, e)
        back = slice(one.turn + 1, None)
        if unloading is not None:
            F[back] = force_back(loading, unloading, e[back], float(e[one.turn]))
        return np.asarray(F + drifted(own[1:], len(F)))

    return reading


def _fit(records: Sequence[Record], knots: FloatArray) -> Joint:
    """Fit all specimens with these knots; a way back counts only if all have one."""
    returns = records[0].returns
    peak = float(np.mean([one.F.max() for one in records]))
    secant = peak / max(float(np.mean([green(one.e[one.turn]) for one in records])), 1e-9)
    rows = [(secant, _LOOSEST * secant, _STIFFEST, secant, np.inf)] * len(knots)
    if returns:
        rows += [(secant, 0.0, _STIFFEST, secant, np.inf)] * len(knots)
    own = []
    for one in records:
        most = max(0.5 * float(one.e.max()), 1e-9)
        slack = (min(_slack(one), most), 0.0, most, 0.002, np.inf)
        own.append(Unknowns.rows(slack, *drift_rows(float(one.F.max()))))
    models = [_model(one, knots, returns) for one in records]
    return fit_joint(models, [one.F for one in records], Unknowns.rows(*rows), own)


def _score(records: Sequence[Record], knots: FloatArray, fitted: Joint) -> float:
    """How good a choice of knots is; the lower, the better."""
    return criterion(fitted.residuals, [len(one.F) for one in records], 2 * len(knots))


def _merged(records: Sequence[Record], fitted: Joint, knots: FloatArray, reach: float) -> Tension:
    k = len(knots)
    returns = len(fitted.shared.values) > k
    loading, unloading = _curves(fitted.shared.values, knots, returns)
    mean = float(fitted.own[:, 0].mean())
    rests = []
    for one, own in zip(records, fitted.own, strict=True):
        model = own[0] * _model(one, knots, returns)(fitted.shared.values / mean, own[1:])
        rests.append((one, (one.F - model) / np.ptp(one.F)))
    return Tension(
        loading, unloading, fitted.shared.sigma[:k],
        float(np.sqrt(np.mean(np.square(fitted.residuals)))), _worst(rests), reach,
        float(np.mean([one.F.max() for one in records])),
    )  # fmt: skip


def _worst(rests: Sequence[tuple[Record, FloatArray]]) -> tuple[float, float]:
    """Where the records leave the curve most on the mean, noise averaged out."""
    strain = np.concatenate([one.e for one, _ in rests])
    share = np.concatenate([rest for _, rest in rests])
    way = np.concatenate([np.arange(len(rest)) > one.turn for one, rest in rests])
    worst = (0.0, 0.0)
    for back in (False, True):
        here = way == back
        edges = np.linspace(0.0, strain.max(), _BINS + 1)
        place = np.clip(np.digitize(strain[here], edges) - 1, 0, _BINS - 1)
        for i in np.unique(place):
            mean = float(share[here][place == i].mean())
            if (place == i).sum() >= _BACK and abs(mean) > abs(worst[1]):
                worst = float(0.5 * (edges[i] + edges[i + 1])), mean
    return worst
