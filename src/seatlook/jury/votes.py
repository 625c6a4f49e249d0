"""Votes of a jury: one JSON file per judge, checked and merged, everything odd named.

::

    {"schema": 1, "questionnaire": "<digest>", "judge": "anna", "seed": 12,
     "votes": [{"trial": 0, "question": "wrinkles", "left": "a", "right": "b",
                "choice": "left", "seconds": 4.2}]}

``choice`` is "left", "right" or, where the questionnaire allows it, "tie". ``seconds`` may be
left out.
"""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from seatlook.errors import Problem, did_you_mean
from seatlook.io.schema import shown
from seatlook.jury.questionnaire import SCHEMA, Kind, Questionnaire, trials

_KEYS = {"trial", "question", "left", "right", "choice"}


@dataclass(frozen=True, slots=True, kw_only=True)
class Vote:
    """One answer; ``chosen`` is the name of a stimulus, or None for a tie."""

    judge: str
    trial: int
    question: str
    kind: Kind
    left: str
    right: str
    chosen: str | None
    seconds: float | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Ballots:
    """Votes that count, and everything that does not.

    Parameters
    ----------
    problems : votes and files that are malformed or contradict each other; none of them counts
    notices : what is odd but harmless: the same vote sent twice, sessions not finished
    """

    questionnaire: Questionnaire
    votes: tuple[Vote, ...]
    problems: tuple[Problem, ...]
    notices: tuple[str, ...]

    @property
    def judges(self) -> tuple[str, ...]:
        """Judges with at least one vote, in order of appearance."""
        return tuple(dict.fromkeys(vote.judge for vote in self.votes))


def merge_votes(files: Mapping[Path, str], questionnaire: Questionnaire) -> Ballots:
    """Merge the exported files of the judges.

    Parameters
    ----------
    files : path -> text of the file

    Notes
    -----
    A vote sent twice counts once. Two different answers of a judge to one trial count neither
    time. A judge's name with two seeds is two people: the second file is not used.
    """
    problems: list[Problem] = []
    notices: list[str] = []
    answers: dict[tuple[str, int], Vote | None] = {}
    seeds: dict[str, int] = {}
    for path, text in files.items():
        document = _document(text, questionnaire, path, problems)
        if document is None:
            continue
        judge = document["judge"]
        if seeds.setdefault(judge, document["seed"]) != document["seed"]:
            got = f"{document['seed']} for judge {judge!r}"
            expected = f"{seeds[judge]}, as in this judge's earlier file"
            problems.append(Problem(key="seed", got=got, expected=expected, file=path))
            continue
        _collect(answers, document, questionnaire, path, problems, notices)
    votes = _with_repeats([vote for vote in answers.values() if vote is not None], problems)
    whole = len(trials(questionnaire, 0))
    for judge, count in Counter(vote.judge for vote in votes).items():
        if count < whole:
            notices.append(f"judge {judge!r} answered {count} of {whole} trials")
    return Ballots(
        questionnaire=questionnaire, votes=votes, problems=tuple(problems), notices=tuple(notices)
    )


def _collect(
    answers: dict[tuple[str, int], Vote | None],
    document: dict[str, Any],
    questionnaire: Questionnaire,
    path: Path,
    problems: list[Problem],
    notices: list[str],
) -> None:
    """Add one file's votes to the answers; one that is contradicted becomes None."""
    judge, repeated = document["judge"], 0
    for number, vote in _votes(document, questionnaire, path, problems):
        key = (judge, vote.trial)
        if key not in answers:
            answers[key] = vote
        elif _same(answers[key], vote):
            repeated += 1
        else:
            answers[key] = None
            got = f"a second answer of judge {judge!r} to trial {vote.trial}"
            expected = "one answer; neither counts"
            place = f"votes[{number}]"
            problems.append(Problem(key=place, got=got, expected=expected, file=path))
    if repeated:
        notices.append(f"{path}: {repeated} votes of judge {judge!r} sent twice count once")


def _document(
    text: str, questionnaire: Questionnaire, path: Path, problems: list[Problem]
) -> dict[str, Any] | None:
    """Return the file's content if its head is sound."""
    try:
        document = json.loads(text)
    except json.JSONDecodeError as error:
        problems.append(
            Problem(key="file", got=error.msg, expected="JSON", file=path, line=error.lineno)
        )
        return None
    # Numbers of more digits than Python reads, lists in lists in lists.
    except (ValueError, RecursionError) as error:
        problems.append(Problem(key="file", got=shown(str(error)), expected="JSON", file=path))
        return None
    types = {"schema": int, "questionnaire": str, "judge": str, "seed": int, "votes": list}
    if not isinstance(document, dict):
        problems.append(_type("file", document, "an object", path))
        return None
    wrong = [
        _type(key, document.get(key), kind.__name__, path)
        for key, kind in types.items()
        if type(document.get(key)) is not kind
    ]
    for key, value in (("schema", SCHEMA), ("questionnaire", questionnaire.digest)):
        if not wrong and document[key] != value:
            wrong.append(
                Problem(key=key, got=shown(document[key]), expected=repr(value), file=path)
            )
    if not wrong and not document["judge"].strip():
        wrong.append(Problem(key="judge", got="an empty name", expected="a name", file=path))
    problems += wrong
    return None if wrong else document


def _votes(
    document: dict[str, Any], questionnaire: Questionnaire, path: Path, problems: list[Problem]
) -> Iterator[tuple[int, Vote]]:
    """Yield the sound votes of a file with their place in it."""
    for number, entry in enumerate(document["votes"]):
        wrong = list(_vote_problems(entry, questionnaire, f"votes[{number}]", path))
        if wrong:
            problems += wrong
            continue
        sides = {"left": entry["left"], "right": entry["right"], "tie": None}
        is_catch = any(
            {c.wrinkled.name, c.smooth.name} <= set(sides.values()) for c in questionnaire.catches
        )
        yield (
            number,
            Vote(
                judge=document["judge"],
                trial=entry["trial"],
                question=entry["question"],
                kind="catch" if is_catch else "pair",
                left=entry["left"],
                right=entry["right"],
                chosen=sides[entry["choice"]],
                seconds=entry.get("seconds"),
            ),
        )


def _vote_problems(
    entry: Any, questionnaire: Questionnaire, key: str, path: Path
) -> Iterator[Problem]:
    if not isinstance(entry, dict) or not set(entry) >= _KEYS:
        expected = f"an object with {', '.join(sorted(_KEYS))}"
        got = f"keys {', '.join(sorted(entry))[:200]}" if isinstance(entry, dict) else shown(entry)
        yield Problem(key=key, got=got, expected=expected, file=path)
        return
    if type(entry["trial"]) is not int or entry["trial"] < 0:
        yield _type(f"{key}.trial", entry["trial"], "a number from 0 up", path)
    seconds = entry.get("seconds")
    if seconds is not None and not (type(seconds) in (int, float) and 0 <= seconds < 1e6):
        yield _type(f"{key}.seconds", seconds, "seconds from 0 up", path)
    choices = ("left", "right", "tie") if questionnaire.ties else ("left", "right")
    for name, allowed in (("question", questionnaire.questions), ("choice", choices)):
        if entry[name] not in allowed:
            yield _type(f"{key}.{name}", entry[name], f"one of {', '.join(allowed)}", path)
    yield from _pair_problems(entry, questionnaire, key, path)


def _pair_problems(
    entry: dict[str, Any], questionnaire: Questionnaire, key: str, path: Path
) -> Iterator[Problem]:
    """Both sides must be stimuli that are compared: two ranked ones, or a catch pair."""
    catches = [{c.wrinkled.name, c.smooth.name} for c in questionnaire.catches]
    known = [*questionnaire.names, *(name for pair in catches for name in sorted(pair))]
    unknown = False
    for side in ("left", "right"):
        if entry[side] not in known:
            unknown = True
            yield Problem(
                key=f"{key}.{side}",
                got=shown(entry[side]),
                expected="a stimulus of the questionnaire",
                file=path,
                hint=did_you_mean(str(entry[side]), known),
            )
    if unknown:
        return
    pair = {entry["left"], entry["right"]}
    ranked = len(pair) == 2 and pair <= set(questionnaire.names)
    if not ranked and not (pair in catches and entry["question"] == questionnaire.screening):
        yield Problem(
            key=key,
            got=f"{entry['left']!r} beside {entry['right']!r} under {shown(entry['question'])}",
            expected=f"two ranked stimuli, or a catch pair under {shown(questionnaire.screening)}",
            file=path,
        )


def _with_repeats(votes: list[Vote], problems: list[Problem]) -> tuple[Vote, ...]:
    """Mark the second showing of a pair; a third, or one with the same sides, does not count."""
    shown: dict[tuple[str, str, frozenset[str]], list[Vote]] = {}
    counted = []
    for vote in sorted(votes, key=lambda v: v.trial):
        key = (vote.judge, vote.question, frozenset((vote.left, vote.right)))
        before = shown.setdefault(key, [])
        if not before:
            counted.append(vote)
        elif len(before) == 1 and before[0].left == vote.right and vote.kind == "pair":
            counted.append(replace(vote, kind="repeat"))
        else:
            problems.append(
                Problem(
                    key=f"judge {vote.judge!r}, trial {vote.trial}",
                    got=f"{vote.left!r} beside {vote.right!r} once more",
                    expected="each pair once, and at most once more with sides exchanged",
                )
            )
        before.append(vote)
    order = {judge: k for k, judge in enumerate(dict.fromkeys(v.judge for v in votes))}
    return tuple(sorted(counted, key=lambda v: (order[v.judge], v.trial)))


def _same(first: Vote | None, second: Vote) -> bool:
    """Whether two votes give one answer; the time taken may differ by rounding."""
    if first is None:
        return False
    names = ("question", "left", "right", "chosen")
    return all(getattr(first, name) == getattr(second, name) for name in names)


def _type(key: str, got: Any, expected: str, path: Path) -> Problem:
    return Problem(key=key, got=shown(got), expected=expected, file=path)
