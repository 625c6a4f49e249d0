"""A panel of paired comparisons: what is shown to whom, in which order, on which side."""

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
WRINKLES, PREFERENCE = "wrinkles", "preference"
QUESTIONS = MappingProxyType(
    {
        WRINKLES: "Which one shows wrinkles more?",
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
    """Two pictures nobody can mistake: ``wrinkled`` shows wrinkles more; neither is ranked."""

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
class Panel:
    """What a panel compares; the digest ties votes to it.

    Parameters
    ----------
    stimuli : three or more
    catches : pairs that screen judges, shown under the question about wrinkles
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
            Problem(key="Panel.stimuli", got=f"{count} named {name!r}", expected="one")
            for name, count in names.items()
            if count > 1
        ]
        problems += [
            Problem(key="Panel.questions", got=repr(q), expected=f"one of {', '.join(QUESTIONS)}")
            for q in self.questions
            if q not in QUESTIONS
        ]
        if len(self.stimuli) < 3:
            problems.append(
                Problem(key="Panel.stimuli", got=str(len(self.stimuli)), expected="3 or more")
            )
        if not self.questions or len(set(self.questions)) < len(self.questions):
            problems.append(
                Problem(key="Panel.questions", got=str(self.questions), expected="each one once")
            )
        if not 0 <= self.repeat_share <= 1:
            problems.append(
                Problem(key="Panel.repeat_share", got=str(self.repeat_share), expected="0 to 1")
            )
        if problems:
            raise InputError(problems)
        text = json.dumps(_content(self), sort_keys=True, ensure_ascii=True)
        object.__setattr__(self, "digest", hashlib.sha256(text.encode()).hexdigest()[:16])

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the ranked stimuli."""
        return tuple(s.name for s in self.stimuli)


def panel_document(panel: Panel, *, judges: int, seed: int) -> dict[str, Any]:
    """Everything a page needs to run the panel, as plain JSON values.

    One session per judge, drawn from ``seed``; a judge takes a session that nobody took before.
    """
    seeds = [seed + k for k in range(judges)]
    sessions = [
        {"seed": s, "trials": [[t.question, t.kind, t.left, t.right] for t in trials(panel, s)]}
        for s in seeds
    ]
    questions = {q: QUESTIONS[q] for q in panel.questions}
    return {
        "schema": SCHEMA,
        "digest": panel.digest,
        **_content(panel),
        "questions": questions,
        "sessions": sessions,
    }


def read_panel(document: Any) -> Panel:
    """Return the panel of a :func:`panel_document`.

    Raises
    ------
    InputError
        Not such a document, or its digest does not fit its content.
    """
    try:
        panel = Panel(
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
            "panel", got=f"{type(error).__name__}: {error}", expected="a panel document"
        ) from error
    if document.get("digest") != panel.digest:
        raise InputError.single("panel.digest", got=document.get("digest"), expected=panel.digest)
    return panel


def trials(panel: Panel, seed: int) -> tuple[Trial, ...]:
    """Return the session of one judge: order and sides drawn from ``seed``.

    Question by question (which comes first depends on the seed) all pairs once; a share of the
    pairs of the first half again in the second, sides exchanged; catch pairs anywhere.

    Examples
    --------
    >>> panel = Panel(title="t", stimuli=tuple(Stimulus(name=n, picture=n) for n in "abc"))
    >>> [(t.left, t.right) for t in trials(panel, 1)] == [
    ...     (t.left, t.right) for t in trials(panel, 1)]
    True
    """
    rng = random.Random(seed)
    questions = _shuffled(panel.questions, rng)
    session: list[tuple[str, Kind, str, str]] = []
    for question in questions:
        pairs = _shuffled(itertools.combinations(panel.names, 2), rng)
        # Half of the pairs are turned, so that no stimulus is bound to a side by its place.
        turned = set(_shuffled(range(len(pairs)), rng)[: len(pairs) // 2])
        sided = [(b, a) if k in turned else (a, b) for k, (a, b) in enumerate(pairs)]
        block: list[tuple[Kind, str, str]] = [("pair", *pair) for pair in sided]
        _insert_repeats(block, panel.repeat_share, rng)
        if question == WRINKLES:
            for catch in panel.catches:
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


def _content(panel: Panel) -> dict[str, Any]:
    def plain(s: Stimulus) -> dict[str, str]:
        return {"name": s.name, "picture": s.picture, "geometry": s.geometry}

    return {
        "title": panel.title,
        "stimuli": [plain(s) for s in panel.stimuli],
        "catches": [
            {"wrinkled": plain(c.wrinkled), "smooth": plain(c.smooth)} for c in panel.catches
        ],
        "questions": list(panel.questions),
        "repeat_share": panel.repeat_share,
        "ties": panel.ties,
    }
