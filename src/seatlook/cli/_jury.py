"""Commands that plan a jury, make its page, and fit its votes."""

from __future__ import annotations

import json as json_module
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import App, Parameter

from seatlook.cli._output import Json, progress, say, show_json, table
from seatlook.cli._run import Names, camera_of, load, narrowed, result_of
from seatlook.errors import InputError

if TYPE_CHECKING:
    from seatlook.jury.questionnaire import Catch, Questionnaire
    from seatlook.jury.stimuli import Shown

_HELP = """Ask people: plan a jury, make its page, fit its votes.

Example: seatlook jury plan --judges 20 --stimuli 9
"""
jury = App(name="jury", help=_HELP)

_FEW, _MANY = 8, 12
_KEY = "jury.json"


@jury.command
def plan(
    *,
    judges: Annotated[tuple[int, ...], Parameter(negative=())] = (5, 10, 20, 40),
    stimuli: Annotated[tuple[int, ...], Parameter(negative=())] = (6, 9, 12),
    spacing: float = 0.36,
    json: Json = False,
) -> None:
    """Say how exact a jury of that size will be, before anybody is asked.

    Widths are in steps: one step apart, three of four choices go one way.

    Example: seatlook jury plan --judges 20 --stimuli 9

    Parameters
    ----------
    judges
        Number of judges; may be given more than once.
    stimuli
        Number of pictures compared; may be given more than once.
    spacing
        Expected distance of neighbours in steps; 0.36 are designs hard to tell apart.
    """
    from seatlook.jury.plan import plan_jury

    rows = [asdict(plan_jury(j, m, spacing=spacing)) for m in stimuli for j in judges]
    table(tuple(rows[0]), [tuple(row.values()) for row in rows], json=json)


@jury.command
def export(
    *scenes: Annotated[Path, Parameter(help='Scene files, each with its "result.npz" beside it.')],
    out: Annotated[Path, Parameter(help="Folder to write to.")],
    texture: Names = (),
    rig: Names = (),
    view: str | None = None,
    judges: int = 20,
    seed: int = 1,
    title: str = "Seat covers",
    width_px: int = 900,
    ties: Annotated[bool, Parameter(negative=())] = False,
    json: Json = False,
) -> None:
    """Make the page on which judges compare pictures, two at a time.

    Leaves the folder "page" for the judges, which names nothing, and jury.json, which "seatlook
    jury fit" needs and which is not for them.

    Example: seatlook jury export out/demo/scene.toml --rig sun --out jury

    Parameters
    ----------
    texture
        Texture of the scenes' galleries; may be given more than once. All of them if not given.
    rig
        Rig of the scenes; may be given more than once. All of them if not given.
    view
        Camera of the scenes. The first if not given.
    judges
        Sessions to prepare; every judge takes another one.
    seed
        Of code names, order and sides.
    title
        What the judges read above the pictures.
    width_px
        Pictures are cut to this width at their own scale, so that two fit beside each other.
    ties
        Allow "equal" as an answer.
    """
    from seatlook.jury.questionnaire import questionnaire_document, trials
    from seatlook.pbr import offscreen_backend
    from seatlook.report.jury_page import write_jury_page

    offscreen_backend()
    cells, catches = _drawn(scenes, texture, rig, view, width_px, seed)
    questionnaire = _questionnaire(cells, catches, title=title, ties=ties)
    shown = [*cells, *(s for pair in catches for s in pair)]
    for one in shown:
        one.picture.save(out / "page" / _picture(one))
    height, width = shown[0].picture.radiance.shape[:2]
    page = write_jury_page(
        questionnaire, out / "page", judges=judges, seed=seed, size=(width, height)
    )
    document = {
        **questionnaire_document(questionnaire, judges=judges, seed=seed),
        "key": _key(shown),
    }
    _write_key(document, out / _KEY)
    say(f"page for the judges: {page}", f"key, not for them: {out / _KEY}")
    rows = [
        ("stimuli", len(cells)),
        ("catch_pairs", len(catches)),
        ("comparisons_per_judge", len(trials(questionnaire, seed))),
        ("sessions", judges),
        ("digest", questionnaire.digest),
    ]
    table(("what", "value"), rows, json=json)


@jury.command
def fit(
    key: Annotated[Path, Parameter(help='The "jury.json" of "seatlook jury export".')],
    votes: Annotated[tuple[Path, ...], Parameter(help="Files that the judges saved.")],
    /,
    *,
    seed: int = 0,
    json: Json = False,
) -> None:
    """Merge the judges' files and fit a strength to every picture, with its 95 % half-width.

    Results stand with all judges and without those whom the rules leave out. Malformed and
    doubled votes are named on stderr and do not count. With two covers or more the scores are
    calibrated on the votes.

    Example: seatlook jury fit jury/jury.json votes-*.json

    Parameters
    ----------
    seed
        Of the judges drawn again for the intervals.
    """
    from seatlook.jury.fit import fit_votes
    from seatlook.jury.questionnaire import read_questionnaire
    from seatlook.jury.votes import merge_votes
    from seatlook.report.sections.jury_tables import calibration_rows, fit_tables, fit_values

    document = _read_key(key)
    questionnaire = read_questionnaire(document)
    ballots = merge_votes({path: _text(path) for path in votes}, questionnaire)
    for problem in ballots.problems:
        say(str(problem))
    questions = [q for q in questionnaire.questions if any(v.question == q for v in ballots.votes)]
    if not questions:
        raise InputError.single("votes", got="none that counts", expected="at least one")
    results = {question: fit_votes(ballots, question, seed=seed) for question in questions}
    labels = {code: entry["label"] for code, entry in document["key"].items()}
    calibrated, why_not = calibration_rows(ballots, document["key"])
    if json:
        values = {q: fit_values(result, labels) for q, result in results.items()}
        show_json({"questions": values, "calibration": calibrated, "not_calibrated": why_not})
        return
    for result in results.values():
        for heads, rows in fit_tables(result, labels):
            table(heads, rows, json=False)
            table((), (), json=False)
    if calibrated:
        table(("what", "value"), list(calibrated.items()), json=False)
    say(*dict.fromkeys(note for r in results.values() for note in r.notices))
    if why_not:
        say(f"not calibrated: {why_not}")


def _drawn(
    scenes: Sequence[Path],
    textures: tuple[str, ...],
    rigs: tuple[str, ...],
    view: str | None,
    width: int,
    seed: int,
) -> tuple[list[Shown], list[tuple[Shown, Shown]]]:
    """Draw every cell of every scene, and catch pairs of the first scene that yields any."""
    from seatlook import io
    from seatlook.jury import stimuli

    if not scenes:
        raise InputError.single("scenes", got="none", expected="a scene file or more")
    cells: list[Shown] = []
    catches: list[tuple[Shown, Shown]] = []
    black = io.read_material("black-leather").appearance
    names = [path.parent.name if len(scenes) > 1 else "" for path in scenes]
    with progress() as show:
        for path, folder in zip(scenes, names, strict=True):
            scene = narrowed(load(path), textures, rigs)
            solution = result_of(scene, path.with_name("result.npz"))
            jury_view = stimuli.jury_view(solution, camera_of(scene, view), width=width)
            name = f"{scene.name} ({folder})" if folder else scene.name
            show("draw", scene=name)
            cells += stimuli.shown_cells(scene, jury_view, name=name, seed=seed)
            if not catches:
                show("draw", scene=name, what="catch pairs")
                pairs = [
                    stimuli.catch_pair(jury_view, black, lights, seed=seed)
                    for lights in stimuli.catch_rigs(scene, jury_view.camera)
                ]
                catches = [pair for pair in pairs if pair is not None]
    if not catches:
        say("no catch pair: raised by 32 mm these wrinkles would still be missed; judges cannot be")
        say("screened")
    return cells, catches


def _questionnaire(
    cells: list[Shown], catches: list[tuple[Shown, Shown]], *, title: str, ties: bool
) -> Questionnaire:
    """Make the questionnaire; say so if it is too long or too short to screen judges."""
    from seatlook.jury.questionnaire import Catch, Questionnaire, Stimulus

    if not _FEW <= len(cells) <= _MANY:
        say(f"{len(cells)} pictures; {_FEW} to {_MANY} screen judges without tiring them")

    def stimulus(one: Shown) -> Stimulus:
        # A judge who reads the source must not learn which cover is which.
        return Stimulus(name=one.code, picture=_picture(one), geometry="")

    pairs: tuple[Catch, ...] = tuple(
        Catch(wrinkled=stimulus(wrinkled), smooth=stimulus(smooth)) for wrinkled, smooth in catches
    )
    return Questionnaire(
        title=title, stimuli=tuple(stimulus(one) for one in cells), catches=pairs, ties=ties
    )


def _key(shown: list[Shown]) -> dict[str, dict[str, Any]]:
    """What the judges do not see, by code."""
    return {
        one.code: {
            "label": one.label,
            "geometry": one.geometry,
            "texture": one.texture,
            "rig": one.rig,
            **(asdict(one.measures) if one.measures else {}),
        }
        for one in shown
    }


def _picture(one: Shown) -> str:
    return f"images/{one.code}.png"


def _write_key(document: dict[str, Any], path: Path) -> None:
    from seatlook import files

    files.write_text(path, json_module.dumps(document, indent=1) + "\n")


def _read_key(path: Path) -> dict[str, Any]:
    """Read jury.json; its labels must be there."""
    try:
        document = json_module.loads(_text(path))
    except json_module.JSONDecodeError as error:
        raise InputError.single(
            "file", got=error.msg, expected="JSON", file=path, line=error.lineno
        ) from error
    if not isinstance(document, dict) or not isinstance(document.get("key"), dict):
        raise InputError.single(
            "key", got="none", expected='the "jury.json" of "seatlook jury export"', file=path
        )
    return document


def _text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        raise InputError.single("file", got="bytes", expected="UTF-8 text", file=path) from error
