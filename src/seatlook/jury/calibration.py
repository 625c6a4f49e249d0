"""Does a score predict what people choose: fitted to some covers, tested on the one left out."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Any

import numpy as np
from scipy.optimize import minimize

from seatlook.errors import InputError, Problem
from seatlook.jury.questionnaire import PREFERENCE, SEEN, WRINKLES
from seatlook.jury.votes import Ballots
from seatlook.model import FloatArray
from seatlook.visibility.cross_check import Measures

MEASURES = ("vwi", "log_ratio", "dissimilarity")
CHANCE = float(np.log(0.5))
_RESAMPLES = 2000


@dataclass(frozen=True, slots=True, kw_only=True)
class Link:
    """P(i is chosen over j) = logistic(gain (x_i^exponent - x_j^exponent))."""

    gain: float
    exponent: float

    def log_likelihood(self, better: FloatArray, worse: FloatArray) -> FloatArray:
        """Per vote, (n,), given the measure of the chosen and of the other picture."""
        lead = self.gain * (better**self.exponent - worse**self.exponent)
        return np.asarray(-np.logaddexp(0.0, -lead))


@dataclass(frozen=True, slots=True, kw_only=True)
class Calibration:
    """How well each measure predicts votes on covers it was not fitted to.

    Parameters
    ----------
    links : measure -> link fitted to all votes
    held_out : measure -> mean log-likelihood per vote of the cover left out; chance is ln 1/2
    advantage : VWI over the log ratio in that figure, with the ends of its 95 % interval over
        resampled judges
    votes : predictions made; a pair that shows two covers is predicted twice, without each
    """

    links: MappingProxyType[str, Link]
    held_out: MappingProxyType[str, float]
    advantage: tuple[float, float, float]
    geometries: tuple[str, ...]
    votes: int

    @property
    def verdict(self) -> str:
        """What may be claimed."""
        _, low, high = self.advantage
        if self.held_out["vwi"] <= CHANCE:
            return "VWI predicts no better than a coin"
        if low > 0:
            return "VWI predicts better than the log ratio"
        return (
            "VWI predicts worse than the log ratio"
            if high < 0
            else "VWI does not beat the log ratio"
        )


def calibrate(
    ballots: Ballots,
    measures: Mapping[str, Measures],
    *,
    question: str = WRINKLES,
    seed: int = 0,
) -> Calibration:
    """Fit gain and exponent of every measure by maximum likelihood, one cover left out at a time.

    Parameters
    ----------
    measures : name of a stimulus -> its measures
    question : under "preference" the less visible picture is expected to be chosen

    Raises
    ------
    InputError
        A stimulus without measures or geometry, fewer than two geometries, no decided vote, a
        cover without which no vote is left.

    Notes
    -----
    Ties and repeats are left out: a tie is no choice, a repeat no independent one.
    """
    data = _choices(ballots, measures, question)
    geometries = tuple(sorted(set(data.geometry.ravel())))
    if len(geometries) < 2:
        raise InputError.single("geometries", got=len(geometries), expected="two or more covers")
    links, likelihood = {}, {}
    for name in MEASURES:
        better, worse = data.values[name]
        links[name] = _fit(better, worse)
        likelihood[name] = _left_out(better, worse, data.geometry, geometries)
    judge = np.concatenate([data.judge[(data.geometry == g).any(axis=1)] for g in geometries])
    gain = likelihood["vwi"] - likelihood["log_ratio"]
    return Calibration(
        links=MappingProxyType(links),
        held_out=MappingProxyType({name: float(p.mean()) for name, p in likelihood.items()}),
        advantage=(float(gain.mean()), *_interval(gain, judge, seed)),
        geometries=geometries,
        votes=len(gain),
    )


def calibrate_by_key(
    ballots: Ballots, key: Mapping[str, Mapping[str, Any]], *, seed: int = 0
) -> Calibration:
    """Calibrate with covers and measures of the organiser's key, which the page does not hold.

    Parameters
    ----------
    key : code name of a picture -> its geometry and measures

    Raises
    ------
    InputError
        A picture without them in the key; and see :func:`calibrate`.
    """
    questionnaire = ballots.questionnaire
    names = ("geometry", *MEASURES)
    problems = [
        Problem(key=f"key {s.name}", got=f"no {name}", expected="cover and scores of every picture")
        for s in questionnaire.stimuli
        for name in names
        if name not in key.get(s.name, {})
    ]
    if problems:
        raise InputError(problems)
    stimuli = tuple(replace(s, geometry=key[s.name]["geometry"]) for s in questionnaire.stimuli)
    complete = replace(ballots, questionnaire=replace(questionnaire, stimuli=stimuli))
    measures = {s.name: Measures(**{name: key[s.name][name] for name in MEASURES}) for s in stimuli}
    # VWI says whether a wrinkle is seen; a jury may have been asked how wrinkled alone.
    question = SEEN if SEEN in questionnaire.questions else WRINKLES
    return calibrate(complete, measures, question=question, seed=seed)


@dataclass(frozen=True, slots=True, kw_only=True)
class _Choices:
    """Decided votes: ``values[measure]`` = (chosen, other), ``geometry`` (n, 2), ``judge`` (n,)."""

    values: dict[str, tuple[FloatArray, FloatArray]]
    geometry: np.ndarray
    judge: np.ndarray


def _choices(ballots: Ballots, measures: Mapping[str, Measures], question: str) -> _Choices:
    stimuli = {s.name: s for s in ballots.questionnaire.stimuli}
    problems = [
        Problem(key=f"stimulus {name}", got="no measures", expected="VWI and its cross-checks")
        for name in stimuli
        if name not in measures
    ]
    problems += [
        Problem(key=f"stimulus {s.name}", got="no geometry", expected="the cover it shows")
        for s in stimuli.values()
        if not s.geometry
    ]
    votes = [
        v
        for v in ballots.votes
        if v.question == question and v.kind == "pair" and v.chosen is not None
    ]
    if not votes:
        problems.append(Problem(key="votes", got=f"none on {question!r}", expected="at least one"))
    if problems:
        raise InputError(problems)
    pairs = [(v.chosen or "", v.right if v.chosen == v.left else v.left) for v in votes]
    # Asked for a preference, people are expected to choose the less visible wrinkles.
    pairs = pairs if question != PREFERENCE else [pair[::-1] for pair in pairs]
    values = {}
    for name in MEASURES:
        x = np.array([[getattr(measures[stimulus], name) for stimulus in pair] for pair in pairs])
        values[name] = (x[:, 0], x[:, 1])
    return _Choices(
        values=values,
        geometry=np.array([[stimuli[name].geometry for name in pair] for pair in pairs]),
        judge=np.array([v.judge for v in votes]),
    )


def _fit(better: FloatArray, worse: FloatArray) -> Link:
    """Maximum likelihood over ln gain and ln exponent, on values scaled to 1."""
    scale = max(float(better.max()), float(worse.max()))
    if not scale > 0:
        raise InputError.single("measures", got="0 for every stimulus", expected="values above 0")
    better, worse = better / scale, worse / scale

    def loss(x: FloatArray) -> float:
        link = Link(gain=float(np.exp(x[0])), exponent=float(np.exp(x[1])))
        return -float(link.log_likelihood(better, worse).mean())

    # Bounds keep a separable set of votes finite: gain e^6, exponents 0.05 to 4.
    bounds = [(-7.0, 6.0), (np.log(0.05), np.log(4.0))]
    fits = [minimize(loss, [0.0, start], method="L-BFGS-B", bounds=bounds) for start in (-1.0, 0.0)]
    best = min(fits, key=lambda result: result.fun)
    exponent = float(np.exp(best.x[1]))
    return Link(gain=float(np.exp(best.x[0])) / scale**exponent, exponent=exponent)


def _left_out(
    better: FloatArray, worse: FloatArray, geometry: np.ndarray, geometries: tuple[str, ...]
) -> FloatArray:
    """Log-likelihood of every vote that shows a cover, by the link fitted without that cover."""
    likelihood = []
    for left_out in geometries:
        shown = (geometry == left_out).any(axis=1)
        if shown.all():
            raise InputError.single(
                "votes", got=f"none without {left_out!r}", expected="pairs of other covers"
            )
        link = _fit(better[~shown], worse[~shown])
        likelihood.append(link.log_likelihood(better[shown], worse[shown]))
    return np.concatenate(likelihood)


def _interval(gain: FloatArray, judge: np.ndarray, seed: int) -> tuple[float, float]:
    """Ends of the 95 % interval of the mean over resampled judges."""
    names, index = np.unique(judge, return_inverse=True)
    total = np.bincount(index, weights=gain)
    count = np.bincount(index)
    drawn = np.random.default_rng(seed).multinomial(
        len(names), np.full(len(names), 1 / len(names)), size=_RESAMPLES
    )
    low, high = np.quantile((drawn @ total) / (drawn @ count), [0.025, 0.975])
    return float(low), float(high)
