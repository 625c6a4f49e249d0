"""A questionnaire of paired comparisons: what is shown to whom, in which order, on which side."""

from __future__ import annotations

import hashlib
import itertools
import json
import random
from collections import Counter
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any, Literal

from seatlook.errors import InputError, Problem

SCHEMA = 1
SEEN, WRINKLES, PREFERENCE = "seen", "wrinkles", "preference"
QUESTIONS = MappingProxyType(
    {
        SEEN: "In which one can you see a wrinkle more easily?",
        WRINKLES: "Which one looks more wrinkled?",
        PREFERENCE: "Which one would you rather have?",
    }
)
Kind = Literal["pair", "repeat", "catch"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Stimulus:
    """One picture that judges compare; ``geometry`` names the cover it shows."""

    name: str
    picture: str
    geometry: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Catch:
    """Two pictures nobody can mistake: ``wrinkled`` looks more wrinkled; neither is ranked."""

    wrinkled: Stimulus
    smooth: Stimulus


@dataclass(frozen=True, slots=True, kw_only=True)
class Trial:
    """One comparison as a judge sees it; numbers count from 0 through the whole session."""

    number: int
    question: str
    kind: Kind
    left: str
    right: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Questionnaire:
    """What a jury compares; the digest ties votes to it.

    Parameters
    ----------
    stimuli : three or more
    catches : pairs that screen judges, shown under ``screening``
    questions : asked one after the other over all pairs
    repeat_share : share of the pairs shown again with sides exchanged
    ties : whether "equal" may be answered
    """

    title: str
    stimuli: tuple[Stimulus, ...]
    catches: tuple[Catch, ...] = ()
    questions: tuple[str, ...] = (WRINKLES, PREFERENCE)
    repeat_share: float = 0.1
    ties: bool = False
    digest: str = field(init=False)

    def __post_init__(self) -> None:
        names = Counter(s.name for s in self.stimuli)
        names += Counter(s.name for c in self.catches for s in (c.wrinkled, c.smooth))
        problems = [
            Problem(key="Questionnaire.stimuli", got=f"{count} named {name!r}", expected="one")
            for name, count in names.items()
            if count > 1
        ]
        problems += [
            Problem(
                key="Questionnaire.questions",
                got=repr(q),
                expected=f"one of {', '.join(QUESTIONS)}",
            )
            for q in self.questions
            if q not in QUESTIONS
        ]
        if len(self.stimuli) < 3:
            problems.append(
                Problem(
                    key="Questionnaire.stimuli", got=str(len(self.stimuli)), expected="3 or more"
                )
            )
        if not self.questions or len(set(self.questions)) < len(self.questions):
            problems.append(
                Problem(
                    key="Questionnaire.questions", got=str(self.questions), expected="each one once"
                )
            )
        if not 0 <= self.repeat_share <= 1:
            problems.append(
                Problem(
                    key="Questionnaire.repeat_share", got=str(self.repeat_share), expected="0 to 1"
                )
            )
        if problems:
            raise InputError(problems)
        text = json.dumps(_content(self), sort_keys=True, ensure_ascii=True)
        object.__setattr__(self, "digest", hashlib.sha256(text.encode()).hexdigest()[:16])

    @property
    def screening(self) -> str | None:
        """Question under which catch pairs are shown; a preference has no right answer."""
        return next((q for q in (WRINKLES, SEEN) if q in self.questions), None)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the ranked stimuli."""
        return tuple(s.name for s in self.stimuli)


def questionnaire_document(
    questionnaire: Questionnaire, *, judges: int, seed: int
) -> dict[str, Any]:
    """Everything a page needs to ask the jury, as plain JSON values.

    One session per judge, drawn from ``seed``; a judge takes a session that nobody took before.

    Raises
    ------
    InputError
        No judge.
    """
    if judges < 1:
        raise InputError.single("judges", got=judges, expected="1 or more")
    seeds = [seed + k for k in range(judges)]
    sessions = [
        {
            "seed": s,
            "trials": [[t.question, t.kind, t.left, t.right] for t in trials(questionnaire, s)],
        }
        for s in seeds
    ]
    questions = {q: QUESTIONS[q] for q in questionnaire.questions}
    return {
        "schema": SCHEMA,
        "digest": questionnaire.digest,
        **_content(questionnaire),
        "questions": questions,
        "sessions": sessions,
    }


def read_questionnaire(document: Any) -> Questionnaire:
    """Return the questionnaire of a :func:`questionnaire_document`.

    Raises
    ------
    InputError
        Not such a document, or its digest does not fit its content.
    """
    try:
        questionnaire = Questionnaire(
            title=document["title"],
            stimuli=tuple(Stimulus(**s) for s in document["stimuli"]),
            catches=tuple(
                Catch(wrinkled=Stimulus(**c["wrinkled"]), smooth=Stimulus(**c["smooth"]))
                for c in document["catches"]
            ),
            questions=tuple(document["questions"]),
            repeat_share=document["repeat_share"],
            ties=document["ties"],
        )
    except (KeyError, TypeError) as error:
        raise InputError.single(
            "questionnaire",
            got=f"{type(error).__name__}: {error}",
            expected="a questionnaire document",
        ) from error
    if document.get("digest") != questionnaire.digest:
        raise InputError.single(
            "questionnaire.digest", got=document.get("digest"), expected=questionnaire.digest
        )
    return questionnaire


def trials(questionnaire: Questionnaire, seed: int) -> tuple[Trial, ...]:
    """Return the session of one judge: order and sides drawn from ``seed``.

    Question by question (which comes first depends on the seed) all pairs once; a share of the
    pairs of the first half again in the second, sides exchanged; catch pairs anywhere.

    Examples
    --------
    >>> stimuli = tuple(Stimulus(name=name, picture=name) for name in "abc")
    >>> questionnaire = Questionnaire(title="t", stimuli=stimuli)
    >>> trials(questionnaire, 1) == trials(questionnaire, 1)
    True
    """
    rng = random.Random(seed)
    questions = _shuffled(questionnaire.questions, rng)
    session: list[tuple[str, Kind, str, str]] = []
    for question in questions:
        pairs = _shuffled(itertools.combinations(questionnaire.names, 2), rng)
        # Half of the pairs are turned, so that no stimulus is bound to a side by its place.
        turned = set(_shuffled(range(len(pairs)), rng)[: len(pairs) // 2])
        sided = [(b, a) if k in turned else (a, b) for k, (a, b) in enumerate(pairs)]
        block: list[tuple[Kind, str, str]] = [("pair", *pair) for pair in sided]
        _insert_repeats(block, questionnaire.repeat_share, rng)
        if question == questionnaire.screening:
            for catch in questionnaire.catches:
                pair = (catch.wrinkled.name, catch.smooth.name)
                left, right = pair if rng.random() < 0.5 else pair[::-1]
                block.insert(int(rng.random() * (len(block) + 1)), ("catch", left, right))
        session += [(question, *entry) for entry in block]
    return tuple(
        Trial(number=number, question=question, kind=kind, left=left, right=right)
        for number, (question, kind, left, right) in enumerate(session)
    )


def _insert_repeats(block: list[tuple[Kind, str, str]], share: float, rng: random.Random) -> None:
    """Show pairs of the first half again in the second, with sides exchanged."""
    half = (len(block) + 1) // 2
    count = min(round(share * len(block)), half)
    for _, left, right in _shuffled(block[:half], rng)[:count]:
        place = half + 1 + int(rng.random() * (len(block) - half))
        block.insert(place, ("repeat", right, left))


def _shuffled(values: Any, rng: random.Random) -> list[Any]:
    """Shuffle by keys: of Python's generator only ``random()`` is promised to stay the same."""
    return [value for _, value in sorted(((rng.random(), v) for v in values), key=lambda kv: kv[0])]


def _content(questionnaire: Questionnaire) -> dict[str, Any]:
    def plain(s: Stimulus) -> dict[str, str]:
        return {"name": s.name, "picture": s.picture, "geometry": s.geometry}

    return {
        "title": questionnaire.title,
        "stimuli": [plain(s) for s in questionnaire.stimuli],
        "catches": [
            {"wrinkled": plain(c.wrinkled), "smooth": plain(c.smooth)}
            for c in questionnaire.catches
        ],
        "questions": list(questionnaire.questions),
        "repeat_share": questionnaire.repeat_share,
        "ties": questionnaire.ties,
    }
