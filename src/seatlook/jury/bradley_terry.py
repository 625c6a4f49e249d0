"""Bradley-Terry with Davidson's ties: strengths from paired choices, one or many sets at once.

With ``a = (theta_i - theta_j) / 2`` and ``Z = e^a + e^-a + nu`` a pair gives i with probability
``e^a / Z``, j with ``e^-a / Z`` and a tie with ``nu / Z`` (Davidson 1970). Strengths are in logits;
divided by ``ln 3`` they count steps at which three of four decided choices go one way.

A ridge ``penalty / 2 * (sum theta^2 + ln(nu)^2)`` keeps strengths finite where an item always wins.
It is weak, so there the value means nothing: :func:`groups` shows where.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.sparse.csgraph import connected_components

from seatlook.errors import InputError, SolverError
from seatlook.model import FloatArray

STEP = float(np.log(3.0))
PENALTY = 0.01
_MOST_ITERATIONS = 100


@dataclass(frozen=True, slots=True, kw_only=True)
class Strengths:
    """Fitted strengths of ``...`` sets of choices.

    Parameters
    ----------
    theta : (..., n) float64 [logit]           mean 0 in every set
    log_tie : (...,) float64 or None           ln(nu); None where no set holds a tie
    covariance : (..., n, n) float64           of theta, from the penalised Fisher information
    """

    theta: FloatArray
    log_tie: FloatArray | None
    covariance: FloatArray


def fit_strengths(
    wins: FloatArray,
    ties: FloatArray | None = None,
    *,
    penalty: float = PENALTY,
    start: FloatArray | None = None,
) -> Strengths:
    """Fit strengths by Newton's method on the penalised likelihood, which is concave.

    Parameters
    ----------
    wins : (..., n, n) float64 >= 0    ``wins[i, j]``: how often i was chosen over j
    ties : (..., n, n) float64 >= 0    symmetric: how often i and j were called equal
    start : (n,) float64               where to begin, such as the fit of similar choices

    Raises
    ------
    InputError
        Counts below 0 or not finite, ties that are not symmetric, a comparison with itself.

    Examples
    --------
    >>> wins = np.array([[0.0, 30.0], [10.0, 0.0]])
    >>> float((fit_strengths(wins).theta[0] / STEP).round(2))
    0.5
    """
    wins = np.asarray(wins, dtype=float)
    ties = np.zeros_like(wins) if ties is None else np.asarray(ties, dtype=float)
    _check(wins, ties, penalty)
    shape, n = wins.shape[:-2], wins.shape[-1]
    problem = _Problem(
        difference=(wins - np.swapaxes(wins, -1, -2)).reshape(-1, n, n),
        number=(wins + np.swapaxes(wins, -1, -2) + ties).reshape(-1, n, n),
        ties=ties.reshape(-1, n, n).sum(axis=(1, 2)) / 2,
        penalty=penalty,
    )
    x = np.zeros((len(problem.number), n + 1))
    if start is not None:
        x[:, :n] = start
    x, hessian = _newton(problem, x)
    centre = np.eye(n) - 1 / n
    covariance = centre @ np.linalg.inv(hessian)[:, :n, :n] @ centre
    theta = x[:, :n] - x[:, :n].mean(axis=1, keepdims=True)
    return Strengths(
        theta=theta.reshape(*shape, n),
        log_tie=x[:, n].reshape(shape) if problem.has_ties else None,
        covariance=covariance.reshape(*shape, n, n),
    )


def components(compared: FloatArray) -> list[list[int]]:
    """Return the items that are linked by any comparison, as lists; one list is what a fit needs.

    Parameters
    ----------
    compared : (n, n)   wins + ties

    Examples
    --------
    >>> components(np.array([[0, 1, 0], [0, 0, 0], [0, 0, 0]]))
    [[0, 1], [2]]
    """
    return _parts(compared, "weak")


def groups(wins: FloatArray, ties: FloatArray | None = None) -> list[list[int]]:
    """Return the items that beat each other round and about; strengths are finite within one.

    Ford's condition (1957): between two groups all decided choices went one way, so the distance
    between them has no upper bound. A tie counts for both sides.

    Examples
    --------
    >>> groups(np.array([[0, 3, 2], [0, 0, 1], [0, 1, 0]]))
    [[0], [1, 2]]
    """
    return _parts(np.asarray(wins) + (0 if ties is None else np.asarray(ties)), "strong")


def _parts(links: FloatArray, connection: Literal["weak", "strong"]) -> list[list[int]]:
    graph = (np.asarray(links) > 0).astype(float)
    count, label = connected_components(graph, directed=True, connection=connection)
    parts = [np.flatnonzero(label == k).tolist() for k in range(count)]
    return sorted(parts, key=lambda part: part[0])


@dataclass(frozen=True, slots=True, kw_only=True)
class _Problem:
    """Counts of b sets: ``difference`` and ``number`` (b, n, n), ``ties`` (b,)."""

    difference: FloatArray
    number: FloatArray
    ties: FloatArray
    penalty: float

    @property
    def has_ties(self) -> bool:
        return bool(self.ties.any())

    def shares(self, x: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return ln Z, P(i) - P(j) and P(tie) of every pair, (b, n, n)."""
        a = (x[:, :-1, None] - x[:, None, :-1]) / 2
        nu = np.exp(x[:, -1])[:, None, None] if self.has_ties else 0.0
        up, down = np.exp(a), np.exp(-a)
        Z = up + down + nu
        return np.log(Z), (up - down) / Z, nu / Z

    def value(self, x: FloatArray) -> FloatArray:
        """Penalised log-likelihood (b,); each pair stands twice in the counts."""
        log_z, _, _ = self.shares(x)
        a = (x[:, :-1, None] - x[:, None, :-1]) / 2
        pairs = (self.difference * a - self.number * log_z).sum(axis=(1, 2)) / 2
        return np.asarray(pairs + self.ties * x[:, -1] - self.penalty / 2 * (x**2).sum(axis=1))

    def derivatives(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Gradient (b, n + 1) and negative Hessian (b, n + 1, n + 1)."""
        n = x.shape[1] - 1
        _, lead, tie = self.shares(x)
        gradient, hessian = np.empty_like(x), np.zeros((len(x), n + 1, n + 1))
        gradient[:, :n] = (self.difference - self.number * lead).sum(axis=2) / 2
        gradient[:, n] = self.ties - (self.number * tie).sum(axis=(1, 2)) / 2
        curved = self.number * (1 - tie - lead**2) / 4
        hessian[:, :n, :n] = -curved
        hessian[:, range(n), range(n)] += curved.sum(axis=2)
        cross = -(self.number * lead * tie).sum(axis=2) / 2
        hessian[:, :n, n] = hessian[:, n, :n] = cross
        hessian[:, n, n] = (self.number * tie * (1 - tie)).sum(axis=(1, 2)) / 2
        hessian[:, range(n + 1), range(n + 1)] += self.penalty
        return gradient - self.penalty * x, hessian


def _newton(problem: _Problem, x: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Climb with steps of at most 2 logits, halved in those sets where they lead down."""
    value = problem.value(x)
    for _ in range(_MOST_ITERATIONS):
        gradient, hessian = problem.derivatives(x)
        step = np.linalg.solve(hessian, gradient[..., None])[..., 0]
        largest = np.abs(step).max(axis=1, keepdims=True)
        if largest.max() < 1e-9:
            return x, hessian
        step *= np.minimum(1.0, 2.0 / np.maximum(largest, 1e-300))
        for _ in range(30):
            trial = problem.value(x + step)
            worse = trial < value - 1e-12 * np.abs(value)
            if not worse.any():
                break
            step[worse] /= 2
        x, value = x + step, trial
    raise SolverError(f"strengths did not converge in {_MOST_ITERATIONS} Newton steps")


def _check(wins: FloatArray, ties: FloatArray, penalty: float) -> None:
    if wins.ndim < 2 or wins.shape[-1] != wins.shape[-2] or wins.shape != ties.shape:
        raise InputError.single(
            "wins, ties", got=f"shapes {wins.shape}, {ties.shape}", expected="twice (..., n, n)"
        )
    for name, counts in (("wins", wins), ("ties", ties)):
        if not (np.isfinite(counts).all() and (counts >= 0).all()):
            raise InputError.single(name, got="nan, inf or below 0", expected="counts from 0 up")
        if np.einsum("...ii->...i", counts).any():
            raise InputError.single(name, got="an item against itself", expected="0 there")
    if not np.array_equal(ties, np.swapaxes(ties, -1, -2)):
        raise InputError.single("ties", got="ties[i, j] != ties[j, i]", expected="symmetric counts")
    if not penalty > 0:
        raise InputError.single("penalty", got=penalty, expected="above 0")
