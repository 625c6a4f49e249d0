"""Bounded least squares with priors, and what is known of the numbers afterwards."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares
from scipy.stats import t as student

from seatlook.model import Curve, FloatArray

# Of the peak: how well an instrument is set to zero, and how far that may wander in one test.
_ZERO, _DRIFT = 0.002, 0.02
_FEW = 3  # specimens from which scatter is taken from repeats
_TWO_SIGMA = 0.9545
_NOISE = 0.01  # of the peak: what priors are weighed by
_STEP = 1e-6  # of a number's scale, for derivatives
_SCALE = 0.1  # how far one specimen may be stiffer than another


@dataclass(frozen=True, slots=True)
class Unknowns:
    """Numbers that are sought.

    Parameters
    ----------
    start, low, high : (p,) float64
    scale : (p,) float64    of the order of each number
    prior : (p,) float64    standard deviation around ``start``, inf where nothing is known before
    """

    start: FloatArray
    low: FloatArray
    high: FloatArray
    scale: FloatArray
    prior: FloatArray

    @classmethod
    def rows(cls, *rows: tuple[float, float, float, float, float]) -> Unknowns:
        """Collect rows of (start, low, high, scale, prior)."""
        return cls(*np.array(rows, dtype=np.float64).T)


@dataclass(frozen=True, slots=True)
class Fit:
    """A specimen's numbers (p,), their covariance (p, p) and the RMS of the residual."""

    values: FloatArray
    covariance: FloatArray
    residual: float


@dataclass(frozen=True, slots=True)
class Estimate:
    """Numbers (p,) of all specimens, and the standard error (p,) of each."""

    values: FloatArray
    sigma: FloatArray


def fit(model: Callable[[FloatArray], FloatArray], y: FloatArray, unknowns: Unknowns) -> Fit:
    """Fit ``model(values) = y`` within bounds.

    Priors weigh as much as the noise says, which is estimated by a first pass.
    """
    known = np.flatnonzero(np.isfinite(unknowns.prior))
    noise = 0.01 * max(float(np.ptp(y)), 1e-300)
    solved = None
    for _ in range(2):
        weight = noise / unknowns.prior[known]

        def misfit(values: FloatArray, weight: FloatArray = weight) -> FloatArray:
            return np.concatenate(
                [model(values) - y, weight * (values[known] - unknowns.start[known])]
            )

        begin = unknowns.start if solved is None else solved.x
        solved = least_squares(
            misfit, np.clip(begin, unknowns.low, unknowns.high), x_scale=unknowns.scale,
            bounds=(unknowns.low, unknowns.high), xtol=1e-10, ftol=1e-10, gtol=1e-10, max_nfev=200,
        )  # fmt: skip
        rest = solved.fun[: len(y)]
        freedom = max(len(y) - len(begin) + len(known), 1)
        noise = max(float(np.sqrt(rest @ rest / freedom)), 1e-9 * float(np.ptp(y)))
    assert solved is not None
    J = np.asarray(solved.jac) * unknowns.scale
    inverse = np.linalg.pinv(J.T @ J, rcond=1e-14, hermitian=True)
    covariance = noise**2 * inverse * np.outer(unknowns.scale, unknowns.scale)
    return Fit(np.asarray(solved.x), covariance, float(np.sqrt(np.mean(rest**2))))


def together(fits: Sequence[Fit]) -> Estimate:
    """Mean of the specimens; its error from their scatter, or from the residuals of a few."""
    values = np.array([one.values for one in fits])
    own = np.array([np.diag(one.covariance) for one in fits])
    if len(fits) < _FEW:
        return Estimate(values.mean(axis=0), np.sqrt(own.sum(axis=0)) / len(fits))
    scatter = values.std(axis=0, ddof=1) / np.sqrt(len(fits))
    return Estimate(values.mean(axis=0), scatter * few(len(fits)))


def few(count: int) -> float:
    """Factor by which twice a standard error from few specimens holds as often as from many."""
    return float(student.ppf(0.5 + 0.5 * _TWO_SIGMA, count - 1) / 2.0)


Model = Callable[[FloatArray, FloatArray], FloatArray]


@dataclass(frozen=True, slots=True)
class Joint:
    """Numbers (p,) that all specimens share, those of each (n, q), RMS over the peak of each."""

    shared: Estimate
    own: FloatArray
    residuals: tuple[float, ...]


def fit_joint(
    models: Sequence[Model],
    readings: Sequence[FloatArray],
    shared: Unknowns,
    own: Sequence[Unknowns],
) -> Joint:
    """Fit all specimens at once: one cloth, and of each specimen its own slack, zero and drift.

    A specimen's reading is also a factor times that of the cloth; their mean is 1, and their
    scatter goes into the errors of the shared numbers.
    """
    task = _Together(models, readings, shared, own)
    bounds = task.every("low"), task.every("high")
    start, scale = np.clip(task.start, *bounds), task.every("scale")
    solved = least_squares(
        task.misfit, start, task.slopes, bounds, x_scale=scale, xtol=1e-9, ftol=1e-9, gtol=1e-9,
        max_nfev=60,
    )  # fmt: skip
    n, p, q = len(models), len(shared.start), task.width
    factors = solved.x[p:].reshape(n, q)
    sizes = [len(y) for y in readings]
    rests = np.split(solved.fun[: sum(sizes)], np.cumsum(sizes)[:-1])
    square = sum(float(r @ r) for r in rests) / max(sum(sizes) - len(start) + n, 1)
    J = np.asarray(solved.jac) * scale
    inverse = np.linalg.pinv(J.T @ J, rcond=1e-14, hermitian=True)
    variances = square * np.diag(inverse) * scale**2
    mean = float(factors[:, 0].mean())
    variance = variances[:p]
    if n >= _FEW:
        # What the factors scatter by, less what noise makes them scatter.
        scatter = np.var(factors[:, 0] / mean, ddof=1) - np.mean(variances[p::q])
        variance = variance + solved.x[:p] ** 2 * max(float(scatter), 0.0) * few(n) ** 2 / n
    residuals = tuple(float(np.sqrt(np.mean(r**2))) for r in rests)
    return Joint(Estimate(solved.x[:p] * mean, np.sqrt(variance)), factors, residuals)


class _Together:
    """All readings over their peaks, and their slopes by the shared and the own unknowns."""

    def __init__(
        self,
        models: Sequence[Model],
        readings: Sequence[FloatArray],
        shared: Unknowns,
        own: Sequence[Unknowns],
    ) -> None:
        self._models, self._readings, self._shared = models, readings, shared
        self._peaks = [max(float(np.ptp(y)), 1e-300) for y in readings]
        self._parts = [shared, *(_with_factor(one) for one in own)]
        self.width = len(own[0].start) + 1
        self.start, self._prior = self.every("start"), self.every("prior")
        self._known = np.flatnonzero(np.isfinite(self._prior))

    def every(self, name: str) -> FloatArray:
        """Return one column of all unknowns, the shared ones first."""
        return np.concatenate([getattr(part, name) for part in self._parts])

    def misfit(self, values: FloatArray) -> FloatArray:
        """Return what the readings lack, then how far the unknowns are from their priors."""
        rests = [
            (own[0] * model(common, own[1:]) - y) / peak
            for model, y, peak, (common, own) in zip(
                self._models, self._readings, self._peaks, self._blocks(values), strict=True
            )
        ]
        away = _NOISE * ((values - self.start) / self._prior)[self._known]
        return np.concatenate([*rests, away])

    def slopes(self, values: FloatArray) -> FloatArray:
        """Return the derivative of ``misfit``; a specimen knows nothing of the others."""
        rows = [self._block(i, len(values), *one) for i, one in enumerate(self._blocks(values))]
        held = np.zeros((len(self._known), len(values)))
        held[np.arange(len(self._known)), self._known] = _NOISE / self._prior[self._known]
        return np.vstack([*rows, held])

    def _blocks(self, values: FloatArray) -> list[tuple[FloatArray, FloatArray]]:
        p, q = len(self._shared.start), self.width
        return [(values[:p], values[p + i * q : p + (i + 1) * q]) for i in range(len(self._models))]

    def _block(self, i: int, count: int, common: FloatArray, own: FloatArray) -> FloatArray:
        """Rows of specimen ``i``."""
        p, q, model = len(common), self.width, self._models[i]
        out = np.zeros((len(self._readings[i]), count))
        base = model(common, own[1:])
        for j in range(p):
            step = _STEP * self._shared.scale[j]
            moved = common + step * (np.arange(p) == j)
            out[:, j] = own[0] * (model(moved, own[1:]) - base) / step
        out[:, p + i * q] = base
        for j in range(1, q):
            step = _STEP * self._parts[i + 1].scale[j]
            moved = own[1:] + step * (np.arange(1, q) == j)
            out[:, p + i * q + j] = own[0] * (model(common, moved) - base) / step
        return out / self._peaks[i]


def _with_factor(own: Unknowns) -> Unknowns:
    row = Unknowns.rows((1.0, 0.3, 3.0, 0.1, _SCALE))
    return Unknowns(
        *(
            np.concatenate([getattr(row, name), getattr(own, name)])
            for name in ("start", "low", "high", "scale", "prior")
        )
    )


def criterion(residuals: Sequence[float], counts: Sequence[int], parameters: int) -> float:
    """Bayesian information criterion of curves that all specimens share; the lower, the better.

    ``residuals``: RMS over the peak, of each specimen; ``parameters``: of the shared curves.
    """
    total = sum(counts)
    square = sum(n * max(r, 1e-12) ** 2 for n, r in zip(counts, residuals, strict=True)) / total
    return float(total * np.log(square) + parameters * np.log(total))


def drift_rows(peak: float) -> list[tuple[float, float, float, float, float]]:
    """Zero of the reading and its drift over the test, as rows of unknowns."""
    free = (-peak, peak)
    return [(0.0, *free, 0.01 * peak, share * peak) for share in (_ZERO, _DRIFT)]


def drifted(values: FloatArray, count: int) -> FloatArray:
    """What the zero reading adds along a record of ``count`` points."""
    return np.asarray(values[0] + values[1] * np.linspace(0.0, 1.0, count))


def unit_tension(knots: FloatArray, i: int, strain: FloatArray) -> FloatArray:
    """Tension by a stiffness of 1 N/m at one knot: curves are linear in their stiffness."""
    one = np.ones(len(knots))
    two = one + (np.arange(len(knots)) == i)
    both = (Curve(strain=knots, stiffness=values).tension(strain) for values in (two, one))
    return np.asarray(np.subtract(*both))
