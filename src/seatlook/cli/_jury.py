"""Commands that plan a jury, make its page, and fit its votes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import App, Parameter

from seatlook.cli._options import Names, solved_seat
from seatlook.cli._output import Json, progress, say, show_json, table
from seatlook.errors import InputError

if TYPE_CHECKING:
    from seatlook.model import Scene
    from seatlook.visibility.view import View

_HELP = """Ask people: plan a jury, make its page, fit its votes.

Example: seatlook jury plan --judges 20 --stimuli 9
"""
jury = App(name="jury", help=_HELP)


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
    from seatlook.jury.questionnaire import trials
    from seatlook.jury.stimuli import draw_stimuli
    from seatlook.pbr import offscreen_backend
    from seatlook.report.jury_page import KEY, PAGE, write_jury

    offscreen_backend()
    with progress() as show:
        covers = _covers(scenes, texture, rig, view, width_px)
        stimuli = draw_stimuli(covers, seed=seed, progress=show)
    say(*stimuli.notices)
    questionnaire = write_jury(stimuli, out, title=title, judges=judges, seed=seed, ties=ties)
    say(f"page for the judges: {out / PAGE / 'index.html'}", f"key, not for them: {out / KEY}")
    rows = [
        ("stimuli", len(stimuli.cells)),
        ("catch_pairs", len(stimuli.catches)),
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
    from seatlook.report.jury_page import read_jury, read_votes
    from seatlook.report.sections.jury_tables import calibration_rows, fit_tables, fit_values

    questionnaire, pictures = read_jury(key)
    ballots = read_votes(votes, questionnaire)
    for problem in ballots.problems:
        say(str(problem))
    questions = [q for q in questionnaire.questions if any(v.question == q for v in ballots.votes)]
    if not questions:
        raise InputError.single("votes", got="none that counts", expected="at least one")
    results = {question: fit_votes(ballots, question, seed=seed) for question in questions}
    labels = {code: entry["label"] for code, entry in pictures.items()}
    calibrated, why_not = calibration_rows(ballots, pictures)
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


def _covers(
    scenes: Sequence[Path],
    textures: tuple[str, ...],
    rigs: tuple[str, ...],
    view: str | None,
    width: int,
) -> Iterator[tuple[str, Scene, View]]:
    """Open one scene after the other with its result; scenes of one name differ by their folder."""
    from seatlook.jury.stimuli import jury_view

    for path in scenes:
        seat, folder = solved_seat(path), path.parent.name
        scene = seat.narrowed(textures, rigs)
        name = f"{scene.name} ({folder})" if len(scenes) > 1 and folder else scene.name
        yield name, scene, jury_view(seat.solution, seat.camera(view), width=width)
