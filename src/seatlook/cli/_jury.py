"""Commands that plan a jury, make its page, and fit its votes."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Annotated

from cyclopts import App, Parameter

from seatlook.cli._options import Names, solved_seat
from seatlook.cli._output import Json, progress, say, show_json, table

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
    ask: Names = (),
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
    ask
        Question: seen ("In which one can you see a wrinkle more easily?"), wrinkles ("Which one
        looks more wrinkled?") or preference ("Which one would you rather have?"); may be given more
        than once. The first two if not given.
    title
        What the judges read above the pictures.
    width_px
        Pictures are cut to this width at their own scale, so that two fit beside each other.
    ties
        Allow "equal" as an answer.
    """
    from seatlook.pbr import offscreen_backend
    from seatlook.report.jury_export import export_jury

    offscreen_backend()
    with progress() as show:
        result = export_jury(
            [solved_seat(path) for path in scenes], out, textures=texture, rigs=rig, camera=view,
            width=width_px, judges=judges, seed=seed, questions=ask, title=title, ties=ties,
            progress=show,
        )  # fmt: skip
    say(*result.notices)
    say(f"page for the judges: {result.page}", f"key, not for them: {result.key}")
    rows = [
        ("stimuli", len(result.stimuli.cells)),
        ("catch_pairs", len(result.stimuli.catches)),
        ("comparisons_per_judge", result.comparisons),
        ("sessions", judges),
        ("digest", result.questionnaire.digest),
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
    from seatlook.report.jury_fit import fit_jury
    from seatlook.report.sections.jury_tables import calibration_rows, fit_tables, fit_values

    answer = fit_jury(key, votes, seed=seed)
    say(*map(str, answer.ballots.problems))
    figures = calibration_rows(answer.calibration) if answer.calibration else {}
    if json:
        questions = {q: fit_values(result, answer.labels) for q, result in answer.results.items()}
        reason = answer.not_calibrated
        show_json({"questions": questions, "calibration": figures, "not_calibrated": reason})
        return
    for result in answer.results.values():
        for heads, rows in fit_tables(result, answer.labels):
            table(heads, rows, json=False)
            table((), (), json=False)
    if figures:
        table(("what", "value"), list(figures.items()), json=False)
    say(*answer.notices)
    if answer.not_calibrated:
        say(f"not calibrated: {answer.not_calibrated}")
