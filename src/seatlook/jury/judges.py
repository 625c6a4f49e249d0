"""What the votes show about the judges, and who is left out of the second fit."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from seatlook.jury.consistency import FEWEST_TO_SCREEN, coin_consistence, consistence
from seatlook.jury.votes import Ballots, Vote
from seatlook.model import FloatArray


@dataclass(frozen=True, slots=True, kw_only=True)
class Rule:
    """When a judge is left out: too many catch pairs wrong, or one wrong and no consistence.

    Parameters
    ----------
    wrong_share : float   share of wrong catch pairs from which a judge is left out
    coin_share : float    zeta counts as none if this share of coin flippers reach no more
    """

    wrong_share: float = 0.5
    coin_share: float = 0.95


RULE = Rule()


@dataclass(frozen=True, slots=True, kw_only=True)
class JudgeRecord:
    """Figures of one judge under one question.

    Parameters
    ----------
    votes : comparisons that enter the fit
    zeta : consistence, None where not every pair was judged
    catches, catches_right : catch pairs answered, and rightly (they stand under "wrinkles")
    repeats, repeats_same : pairs shown again, and answered alike
    left_share : share of left among decided votes, repeats included
    seconds : median time of an answer, None where the page gave none
    excluded : reason, empty for a judge who stays
    """

    judge: str
    votes: int
    zeta: float | None
    catches: int
    catches_right: int
    repeats: int
    repeats_same: int
    left_share: float
    seconds: float | None
    excluded: str


def judge_records(ballots: Ballots, question: str, *, rule: Rule = RULE) -> tuple[JudgeRecord, ...]:
    """Summarise every judge with at least one vote under ``question``."""
    records = []
    for judge in ballots.judges:
        own = [v for v in ballots.votes if v.judge == judge]
        answers = [v for v in own if v.question == question]
        if any(v.kind == "pair" for v in answers):
            records.append(
                _record(judge, answers, [v for v in own if v.kind == "catch"], ballots, rule)
            )
    return tuple(records)


def tables(
    votes: Iterable[Vote], names: tuple[str, ...], judges: tuple[str, ...]
) -> tuple[FloatArray, FloatArray]:
    """Count first showings: wins and ties, each (judges, n, n)."""
    place = {name: k for k, name in enumerate(names)}
    wins = np.zeros((len(judges), len(names), len(names)))
    ties = np.zeros_like(wins)
    for vote in votes:
        if vote.kind != "pair" or vote.judge not in judges:
            continue
        k, i, j = judges.index(vote.judge), place[vote.left], place[vote.right]
        if vote.chosen is None:
            ties[k, i, j] += 1
            ties[k, j, i] += 1
        elif vote.chosen == vote.left:
            wins[k, i, j] += 1
        else:
            wins[k, j, i] += 1
    return wins, ties


def _record(
    judge: str, answers: list[Vote], catches: list[Vote], ballots: Ballots, rule: Rule
) -> JudgeRecord:
    names = ballots.questionnaire.names
    wins, ties = tables(answers, names, (judge,))
    complete = np.array_equal(wins + wins.transpose(0, 2, 1) + ties, 1 - np.eye(len(names))[None])
    zeta = float(consistence(wins + ties / 2)[0]) if complete else None
    wrinkled = {c.wrinkled.name for c in ballots.questionnaire.catches}
    right = sum(v.chosen in wrinkled for v in catches)
    repeats = [v for v in answers if v.kind == "repeat"]
    first = {frozenset((v.left, v.right)): v.chosen for v in answers if v.kind == "pair"}
    decided = [v for v in answers if v.chosen is not None and v.kind != "catch"]
    seconds = [v.seconds for v in answers if v.seconds is not None]
    return JudgeRecord(
        judge=judge,
        votes=sum(v.kind == "pair" for v in answers),
        zeta=zeta,
        catches=len(catches),
        catches_right=right,
        repeats=len(repeats),
        repeats_same=sum(first[frozenset((v.left, v.right))] == v.chosen for v in repeats),
        left_share=sum(v.chosen == v.left for v in decided) / len(decided) if decided else 0.5,
        seconds=float(np.median(seconds)) if seconds else None,
        excluded=_reason(len(catches), len(catches) - right, zeta, len(names), rule),
    )


def _reason(catches: int, wrong: int, zeta: float | None, stimuli: int, rule: Rule) -> str:
    """Catch pairs decide first; zeta only beside them, and only where a coin would be seen."""
    if not wrong:
        return ""
    if wrong >= rule.wrong_share * catches:
        return f"{wrong} of {catches} catch pairs wrong"
    if zeta is None or stimuli < FEWEST_TO_SCREEN:
        return ""
    coin = coin_consistence(stimuli, rule.coin_share)
    if zeta > coin:
        return ""
    return f"{wrong} of {catches} catch pairs wrong and zeta {zeta:.2f}, a coin reaches {coin:.2f}"
