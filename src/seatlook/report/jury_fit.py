"""From the files of a jury to strengths of the pictures and a calibration of the scores."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType

from seatlook.errors import InputError, Problem
from seatlook.jury.calibration import Calibration, calibrate_by_key
from seatlook.jury.fit import JuryResult, fit_votes
from seatlook.jury.votes import Ballots
from seatlook.report.jury_page import read_jury, read_votes


@dataclass(frozen=True, slots=True, kw_only=True)
class JuryFit:
    """What a jury answered.

    Parameters
    ----------
    ballots : votes that count, and the problems of those that do not
    results : question -> strengths of the pictures, with all judges and with the screened
    labels : code name of a picture -> cover, texture and rig
    calibration : how well the scores predict the votes; None where that cannot be known
    not_calibrated : why; empty where there is a calibration
    """

    ballots: Ballots
    results: Mapping[str, JuryResult]
    labels: Mapping[str, str]
    calibration: Calibration | None
    not_calibrated: str

    @property
    def notices(self) -> tuple[str, ...]:
        """What to know about the results, each once."""
        notices = [notice for result in self.results.values() for notice in result.notices]
        return tuple(dict.fromkeys(notices))


def fit_jury(key: Path | str, votes: Iterable[Path | str], *, seed: int = 0) -> JuryFit:
    """Merge the files of the judges and fit a strength to every picture, question by question.

    Parameters
    ----------
    key : the ``jury.json`` of :func:`export_jury`
    votes : files that the judges saved
    seed : of the judges drawn again for the intervals

    Raises
    ------
    InputError
        Not such a key; no vote that counts, with the problems of all files; pictures that no chain
        of comparisons links.

    Examples
    --------
    >>> fit = fit_jury("jury/jury.json", Path().glob("votes-*.json"))          # doctest: +SKIP
    >>> [fit.labels[c] for c in fit.results["wrinkles"].everyone.strengths]    # doctest: +SKIP
    """
    questionnaire, pictures = read_jury(Path(key))
    ballots = read_votes([Path(path) for path in votes], questionnaire)
    answered = {vote.question for vote in ballots.votes}
    questions = [question for question in questionnaire.questions if question in answered]
    if not questions:
        none = Problem(key="votes", got="none that counts", expected="at least one")
        raise InputError([*ballots.problems, none])
    results = {question: fit_votes(ballots, question, seed=seed) for question in questions}
    calibration, reason = None, ""
    try:
        calibration = calibrate_by_key(ballots, pictures)
    except InputError as error:
        reason = str(error)
    return JuryFit(
        ballots=ballots,
        results=MappingProxyType(results),
        labels=MappingProxyType({code: str(row["label"]) for code, row in pictures.items()}),
        calibration=calibration,
        not_calibrated=reason,
    )
