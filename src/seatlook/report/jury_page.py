"""The jury page: paired comparisons in a browser, offline, without names or scores."""

from __future__ import annotations

import json
from pathlib import Path

from markupsafe import Markup

from seatlook import files
from seatlook.errors import InputError
from seatlook.jury.plan import SECONDS_PER_TRIAL
from seatlook.jury.questionnaire import Questionnaire, questionnaire_document
from seatlook.report.page.write import content_policy, environment

_TEMPLATES = Path(__file__).parent / "templates"


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
    if judges < 1:
        raise InputError.single("judges", got=judges, expected="1 or more")
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
