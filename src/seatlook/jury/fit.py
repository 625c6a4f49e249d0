"""From the votes of a jury to strengths with intervals, with all judges and with the screened."""

from __future__ import annotations

import itertools
from dataclasses import dataclass, field
from types import MappingProxyType

import numpy as np
from scipy.stats import norm, t

from seatlook.errors import InputError
from seatlook.jury.bradley_terry import STEP, components, fit_strengths, groups
from seatlook.jury.consistency import Agreement, agreement
from seatlook.jury.judges import RULE, JudgeRecord, Rule, judge_records, tables
from seatlook.jury.votes import Ballots
from seatlook.model import FloatArray

RESAMPLES = 1000
LEVEL = 0.95


@dataclass(frozen=True, slots=True, kw_only=True)
class Estimate:
    """A strength or a difference in steps: 1 step = three of four decided choices.

    Parameters
    ----------
    half_width : of the 95 % interval from resampled judges, None with fewer than two judges
    fisher_half_width : of the interval that takes all votes as independent
    bounded : False where votes set no limit and the weak prior alone decides the value
    """

    value: float
    half_width: float | None
    fisher_half_width: float
    bounded: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class Difference:
    """Two neighbours in the ranking, the stronger first."""

    upper: str
    lower: str
    steps: Estimate

    @property
    def separated(self) -> bool:
        """Whether the 95 % interval leaves out 0 (the wider one, where there are two)."""
        if not self.steps.bounded:
            return True
        return self.steps.value > max(self.steps.half_width or 0.0, self.steps.fisher_half_width)


@dataclass(frozen=True, slots=True, kw_only=True)
class _Estimator:
    """Strengths theta (n,) with both covariances (n, n) [logit]."""

    names: tuple[str, ...]
    theta: FloatArray
    fisher: FloatArray
    by_judge: FloatArray | None
    judges: int
    home: dict[str, int]

    def strength(self, name: str) -> Estimate:
        return self._estimate({name: 1.0}, bounded=len(set(self.home.values())) == 1)

    def difference(self, first: str, second: str) -> Estimate:
        bounded = self.home[first] == self.home[second]
        return self._estimate({first: 1.0, second: -1.0}, bounded=bounded)

    def _estimate(self, weights: dict[str, float], *, bounded: bool) -> Estimate:
        c = np.array([weights.get(name, 0.0) for name in self.names]) / STEP
        tail = (1 + LEVEL) / 2
        half_width = None
        if self.by_judge is not None:
            # Student's t: the spread of a few judges is itself uncertain.
            half_width = float(t.ppf(tail, self.judges - 1) * np.sqrt(c @ self.by_judge @ c))
        return Estimate(
            value=float(c @ self.theta),
            half_width=half_width,
            fisher_half_width=float(norm.ppf(tail) * np.sqrt(c @ self.fisher @ c)),
            bounded=bounded,
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Fit:
    """Strengths from a set of judges, strongest first.

    Parameters
    ----------
    strengths : name -> Estimate, mean 0; "stronger" = chosen more under the question
    neighbours : differences between ranks; read these, not the bare ranking
    groups : names, best group first; between groups no vote went the other way
    tie_share : share of ties among the votes
    agreement : None with fewer than three judges who judged every pair
    """

    judges: tuple[str, ...]
    votes: int
    strengths: MappingProxyType[str, Estimate]
    neighbours: tuple[Difference, ...]
    groups: tuple[tuple[str, ...], ...]
    tie_share: float
    agreement: Agreement | None
    _estimator: _Estimator = field(repr=False, compare=False)

    def difference(self, first: str, second: str) -> Estimate:
        """Strength of ``first`` over ``second``, with its interval."""
        return self._estimator.difference(first, second)


@dataclass(frozen=True, slots=True, kw_only=True)
class JuryResult:
    """One question answered: with all judges, and without those the rule leaves out.

    Parameters
    ----------
    screened : None where nobody is left out, or where too little is left (a notice says so)
    side_bias : share of left in all decided votes, and its 95 % half-width
    """

    question: str
    records: tuple[JudgeRecord, ...]
    everyone: Fit
    screened: Fit | None
    side_bias: tuple[float, float]
    notices: tuple[str, ...]


def fit_votes(
    ballots: Ballots,
    question: str,
    *,
    rule: Rule = RULE,
    resamples: int = RESAMPLES,
    seed: int = 0,
) -> JuryResult:
    """Fit strengths to the votes on one question.

    Parameters
    ----------
    resamples : sets of judges drawn with replacement for the intervals
    seed : of that drawing

    Raises
    ------
    InputError
        No votes on the question, or stimuli that no chain of comparisons links; the parts are
        named.
    """
    records = judge_records(ballots, question, rule=rule)
    if not records:
        raise InputError.single("votes", got=f"none on {question!r}", expected="at least one")
    names = ballots.questionnaire.names
    answers = [v for v in ballots.votes if v.question == question]
    everyone = tuple(r.judge for r in records)
    remaining = tuple(r.judge for r in records if not r.excluded)
    notices = list(ballots.notices)
    screened = None
    if not any(r.catches for r in records):
        notices.append("no catch pair was answered: no judge can be left out")
    elif remaining != everyone:
        wins, ties = tables(answers, names, remaining)
        if remaining and len(components((wins + ties).sum(axis=0))) == 1:
            screened = _fit(wins, ties, names, remaining, resamples, seed)
        else:
            notices.append("without the judges left out the comparisons are no longer linked")
    wins, ties = tables(answers, names, everyone)
    decided = [v for v in answers if v.chosen is not None and v.kind != "catch"]
    left = float(np.mean([v.chosen == v.left for v in decided])) if decided else 0.5
    spread = float(norm.ppf((1 + LEVEL) / 2) * np.sqrt(0.25 / max(len(decided), 1)))
    result = _fit(wins, ties, names, everyone, resamples, seed)
    if len(result.groups) > 1:
        notices.append(_unbounded(result))
    return JuryResult(
        question=question,
        records=records,
        everyone=result,
        screened=screened,
        side_bias=(left, spread),
        notices=tuple(notices),
    )


def _fit(
    wins: FloatArray,
    ties: FloatArray,
    names: tuple[str, ...],
    judges: tuple[str, ...],
    resamples: int,
    seed: int,
) -> Fit:
    """Fit one set of judges; wins and ties are (judges, n, n)."""
    total, tied = wins.sum(axis=0), ties.sum(axis=0)
    _check_linked(total + tied, names)
    fitted = fit_strengths(total, tied)
    parts = sorted(groups(total, tied), key=lambda part: -fitted.theta[part].mean())
    estimator = _Estimator(
        names=names,
        theta=fitted.theta,
        fisher=fitted.covariance,
        by_judge=_judge_covariance(wins, ties, fitted.theta, resamples, seed),
        judges=len(judges),
        home={names[item]: k for k, part in enumerate(parts) for item in part},
    )
    ranked = [names[i] for i in np.argsort(-fitted.theta, kind="stable")]
    complete = [w for w in wins + ties / 2 if np.array_equal(w + w.T, 1 - np.eye(len(names)))]
    return Fit(
        judges=judges,
        votes=int(total.sum() + tied.sum() / 2),
        strengths=MappingProxyType({name: estimator.strength(name) for name in ranked}),
        neighbours=tuple(
            Difference(upper=upper, lower=lower, steps=estimator.difference(upper, lower))
            for upper, lower in itertools.pairwise(ranked)
        ),
        groups=tuple(tuple(names[i] for i in part) for part in parts),
        tie_share=float(tied.sum() / (2 * total.sum() + tied.sum())),
        agreement=agreement(np.array(complete)) if len(complete) >= 3 else None,
        _estimator=estimator,
    )


def _judge_covariance(
    wins: FloatArray, ties: FloatArray, theta: FloatArray, resamples: int, seed: int
) -> FloatArray | None:
    """Covariance (n, n) of the strengths over resampled judges; None with fewer than two.

    Judges are drawn and not votes, because the votes of one judge are correlated.
    """
    judges = len(wins)
    if judges < 2:
        return None
    drawn = np.random.default_rng(seed).multinomial(
        judges, np.full(judges, 1 / judges), size=resamples
    )
    repeated = fit_strengths(
        np.tensordot(drawn, wins, axes=1), np.tensordot(drawn, ties, axes=1), start=theta
    )
    # A sample of m drawn from m varies less than judges do, by (m - 1) / m.
    return np.asarray(np.cov(repeated.theta.T) * judges / (judges - 1))


def _check_linked(compared: FloatArray, names: tuple[str, ...]) -> None:
    parts = components(compared)
    if len(parts) > 1:
        listed = "; ".join(", ".join(names[i] for i in part) for part in parts)
        raise InputError.single(
            "votes",
            got=f"{len(parts)} sets of stimuli that were never compared: {listed}",
            expected="a chain of comparisons between any two",
        )


def _unbounded(fit: Fit) -> str:
    listed = " > ".join("{" + ", ".join(part) + "}" for part in fit.groups)
    return f"no vote went against {listed}: the votes do not show how far apart these sets are"
