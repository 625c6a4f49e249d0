"""From seats to what a jury looks at: pictures, a page, and the key of the organiser."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TypedDict, Unpack

from seatlook.chain.case import Case
from seatlook.comparison.compare import Variant, case_of
from seatlook.jury.questionnaire import SEEN, WRINKLES, Questionnaire, trials
from seatlook.jury.stimuli import Stimuli, draw_stimuli, jury_view
from seatlook.model import Camera, Scene
from seatlook.model.progress import Progress, silent
from seatlook.report.jury_page import KEY, PAGE, write_jury
from seatlook.visibility.view import View


class JuryChoices(TypedDict, total=False):
    """What a jury compares, and how it is asked.

    ``textures``, ``rigs``: names of the scenes' own, all of them if empty; ``camera``: name of a
    camera of the scenes, the first if None; ``width`` [px]: pictures are cut to it at their own
    scale; ``judges``: sessions to prepare; ``seed``: of code names, order and sides; ``title``:
    what the judges read above the pictures; ``questions``: "seen" (in which one can you see a
    wrinkle more easily), "wrinkles" (which one looks more wrinkled), "preference" (which one would
    you rather have), the first two if not given; ``ties``: allow "equal" as an answer.
    """

    textures: Sequence[str]
    rigs: Sequence[str]
    camera: str | Camera | None
    width: int
    judges: int
    seed: int
    title: str
    questions: Sequence[str]
    ties: bool
    progress: Progress


@dataclass(frozen=True, slots=True, kw_only=True)
class JuryExport:
    """What was left for a jury.

    Parameters
    ----------
    page : ``index.html`` for the judges, which names nothing
    key : ``jury.json``, which :func:`fit_jury` needs and the judges must not see
    comparisons : pairs that a judge compares
    """

    page: Path
    key: Path
    stimuli: Stimuli
    questionnaire: Questionnaire
    comparisons: int

    @property
    def notices(self) -> tuple[str, ...]:
        """What makes the answers less certain."""
        return tuple(self.stimuli.notices)


def export_jury(
    scenes: Sequence[Variant], out: Path | str, **choices: Unpack[JuryChoices]
) -> JuryExport:
    """Draw every texture under every rig of some seats, and write the page for the judges.

    Parameters
    ----------
    scenes : seats, scenes or their files; one without a solution is solved

    Raises
    ------
    InputError
        No scene; a texture, rig or camera that a scene does not have; no judge.
    SolverError, RenderError

    Examples
    --------
    >>> seats = [seatlook.open(f, result=r) for f, r in files]       # doctest: +SKIP
    >>> export_jury(seats, "jury", rigs=["sun"], judges=20).page     # doctest: +SKIP
    PosixPath('jury/page/index.html')
    """
    folder, seed = Path(out), choices.get("seed", 1)
    cases = [case_of(one) for one in scenes]
    stimuli = draw_stimuli(
        _covers(cases, choices), seed=seed, progress=choices.get("progress", silent)
    )
    questionnaire = write_jury(
        stimuli,
        folder,
        title=choices.get("title", "Seat covers"),
        judges=choices.get("judges", 20),
        seed=seed,
        questions=tuple(choices.get("questions") or (SEEN, WRINKLES)),
        ties=choices.get("ties", False),
    )
    return JuryExport(
        page=folder / PAGE / "index.html",
        key=folder / KEY,
        stimuli=stimuli,
        questionnaire=questionnaire,
        comparisons=len(trials(questionnaire, seed)),
    )


def _covers(cases: Sequence[Case], choices: JuryChoices) -> Iterator[tuple[str, Scene, View]]:
    """One case after the other; scenes of one name differ by their folder."""
    width = choices.get("width", 900)
    for case in cases:
        scene = case.narrowed(choices.get("textures", ()), choices.get("rigs", ()))
        folder = scene.path.parent.name if scene.path else ""
        name = f"{scene.name} ({folder})" if len(cases) > 1 and folder else scene.name
        camera = case.camera(choices.get("camera"))
        yield name, scene, jury_view(case.solution, camera, width=width)
