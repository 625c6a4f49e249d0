"""The jury page: paired comparisons in a browser, offline, without names or scores; and its key."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from markupsafe import Markup

from seatlook import files
from seatlook.errors import InputError
from seatlook.files import read_text, reader
from seatlook.jury.plan import SECONDS_PER_TRIAL
from seatlook.jury.questionnaire import (
    SEEN,
    WRINKLES,
    Questionnaire,
    questionnaire_document,
    read_questionnaire,
)
from seatlook.jury.stimuli import Stimuli
from seatlook.jury.votes import Ballots, merge_votes
from seatlook.report.page.write import content_policy, environment

Key = Mapping[str, Mapping[str, Any]]
PAGE, KEY = "page", "jury.json"
_TEMPLATES = Path(__file__).parent / "templates"


def write_jury(
    stimuli: Stimuli,
    folder: Path,
    *,
    title: str,
    judges: int,
    seed: int,
    questions: tuple[str, ...] = (SEEN, WRINKLES),
    ties: bool = False,
) -> Questionnaire:
    """Write the folder "page" for the judges, and beside it the key, which is not for them.

    Parameters
    ----------
    title : what the judges read above the pictures
    judges : sessions to choose from
    seed : of order and sides
    questions : of ``seatlook.jury.questionnaire.QUESTIONS``, each over all pairs
    ties : whether "equal" may be answered

    Raises
    ------
    InputError
        See :class:`Questionnaire`; no judge.
    """
    questionnaire = stimuli.questionnaire(title=title, questions=questions, ties=ties)
    document = questionnaire_document(questionnaire, judges=judges, seed=seed)
    for one in stimuli.shown:
        one.picture.save(folder / PAGE / one.path)
    height, width = stimuli.shown[0].picture.radiance.shape[:2]
    write_jury_page(questionnaire, folder / PAGE, judges=judges, seed=seed, size=(width, height))
    key = json.dumps({**document, "key": stimuli.key}, indent=1)
    files.write_text(folder / KEY, key + "\n")
    return questionnaire


@reader("the questionnaire of a jury")
def read_jury(path: Path) -> tuple[Questionnaire, Key]:
    """Read the key that :func:`write_jury` wrote: the questionnaire, and its pictures by code.

    Raises
    ------
    InputError
        Not such a file.
    """
    try:
        document = json.loads(read_text(path))
    except json.JSONDecodeError as error:
        raise InputError.single(
            "file", got=error.msg, expected="JSON", file=path, line=error.lineno
        ) from error
    if not isinstance(document, dict) or not isinstance(document.get("key"), dict):
        raise InputError.single(
            "key", got="none", expected='the "jury.json" of "seatlook jury export"', file=path
        )
    return read_questionnaire(document), document["key"]


def read_votes(paths: Iterable[Path], questionnaire: Questionnaire) -> Ballots:
    """Read the files that the judges saved; see :func:`seatlook.jury.votes.merge_votes`."""
    return merge_votes({path: read_text(path) for path in paths}, questionnaire)


def write_jury_page(
    questionnaire: Questionnaire, folder: Path, *, judges: int, seed: int, size: tuple[int, int]
) -> Path:
    """Write ``folder/index.html`` and return its path.

    Parameters
    ----------
    questionnaire : its pictures are in ``folder`` already; names of stimuli stand in the page's
        source, so give codes that reveal nothing
    judges : sessions to choose from
    size : (width, height) of every picture in pixels

    Raises
    ------
    InputError
        A picture is not in ``folder``; no judge.
    """
    shown = [
        *questionnaire.stimuli,
        *(s for c in questionnaire.catches for s in (c.wrinkled, c.smooth)),
    ]
    missing = [s.picture for s in shown if not (folder / s.picture).is_file()]
    if missing:
        raise InputError.single(
            "jury page",
            got=f"no file {', '.join(missing)}",
            expected="every picture written before the page",
            file=folder,
        )
    style = (_TEMPLATES / "jury.css").read_text(encoding="utf-8")
    script = (_TEMPLATES / "jury.js").read_text(encoding="utf-8")
    document = questionnaire_document(questionnaire, judges=judges, seed=seed)
    trials = len(document["sessions"][0]["trials"])
    text = (
        environment()
        .get_template("jury.html.j2")
        .render(
            title=questionnaire.title,
            ties=questionnaire.ties,
            judges=judges,
            trials=trials,
            minutes=max(1, round(trials * SECONDS_PER_TRIAL / 60)),
            size=size,
            policy=content_policy(style, script),
            style=Markup(style),
            script=Markup(script),
            # Inside a script element only "<" could end it.
            document=Markup(json.dumps(document).replace("<", "\\u003c")),
        )
    )
    path = folder / "index.html"
    files.write_text(path, text)
    return path
