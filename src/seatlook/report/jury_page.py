"""The panel page: paired comparisons in a browser, offline, without names or scores."""

from __future__ import annotations

import json
from pathlib import Path

from markupsafe import Markup

from seatlook import files
from seatlook.errors import InputError
from seatlook.jury.plan import SECONDS_PER_TRIAL
from seatlook.jury.questionnaire import Panel, panel_document
from seatlook.report.page.write import content_policy, environment

_TEMPLATES = Path(__file__).parent / "templates"


def write_panel_page(
    panel: Panel, folder: Path, *, judges: int, seed: int, size: tuple[int, int]
) -> Path:
    """Write ``folder/index.html`` and return its path.

    Parameters
    ----------
    panel : its pictures lie in ``folder`` already; names of stimuli stand in the page's source, so
        give codes that say nothing
    judges : sessions to choose from
    size : (width, height) of every picture in pixels

    Raises
    ------
    InputError
        A picture is not in ``folder``; no judge.
    """
    shown = [*panel.stimuli, *(s for c in panel.catches for s in (c.wrinkled, c.smooth))]
    missing = [s.picture for s in shown if not (folder / s.picture).is_file()]
    if missing:
        raise InputError.single(
            "panel page",
            got=f"no file {', '.join(missing)}",
            expected="every picture written before the page",
            file=folder,
        )
    if judges < 1:
        raise InputError.single("judges", got=judges, expected="1 or more")
    style = (_TEMPLATES / "panel.css").read_text(encoding="utf-8")
    script = (_TEMPLATES / "panel.js").read_text(encoding="utf-8")
    document = panel_document(panel, judges=judges, seed=seed)
    trials = len(document["sessions"][0]["trials"])
    text = (
        environment()
        .get_template("panel.html.j2")
        .render(
            title=panel.title,
            ties=panel.ties,
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
