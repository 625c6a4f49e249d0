"""A seat in your hands: the chain of its scene, compared with others, evaluated into a page."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType

from seatlook import io
from seatlook.assembly import with_mesh
from seatlook.chain.case import Case
from seatlook.chain.evaluation import LEFT, Evaluation, evaluate_case
from seatlook.chain.film import film
from seatlook.chain.precision import Precise, solve_to
from seatlook.chain.run_folder import run_folder
from seatlook.comparison.compare import Comparison, Variant, compare, named_cases
from seatlook.comparison.visibility import VariantScores, score_variants
from seatlook.errors import InputError
from seatlook.improvement.changes import Changes
from seatlook.improvement.loop import Iteration, improve
from seatlook.improvement.proof import SEEDS, Proof, prove
from seatlook.improvement.propose import Proposals, propose
from seatlook.model import Camera, Rig, Scene
from seatlook.model.progress import Progress, silent
from seatlook.model.scene import SCORE_MEASURES
from seatlook.report.assembly_picture import draw_assembly
from seatlook.report.comparison_page import write_comparison
from seatlook.report.evaluation_page import page_answer, write_report
from seatlook.report.page.types import Check, ScoreSection
from seatlook.report.sections.score import visibility
from seatlook.report.viewer_page import ViewerPage, viewer_page
from seatlook.results.resolution import Resolution

_NO_SCENES = (".dxf", ".obj", ".stl", ".ply", ".npz")


@dataclass(frozen=True, slots=True, kw_only=True)
class Outcome:
    """What an evaluation left: the page, what was drawn, and the score if there is one."""

    page: Path
    evaluation: Evaluation
    score: ScoreSection | None

    @property
    def answer(self) -> tuple[str, ...]:
        """The sentences that the page begins with: what shows, what to do, what not to trust."""
        return page_answer(self.evaluation, self.score)

    @property
    def missed(self) -> tuple[str, ...]:
        """A sentence for every limit of [accept] that is missed."""
        figures = tuple(
            f"{v.limit.zone}: {v.limit.measure} is {v.value:.4g}{v.note}, "
            f"the limit is {v.limit.maximum:.4g}"
            for v in self.evaluation.verdicts
            if not v.kept
        )
        return (*figures, *missed(self.score.checks if self.score else ()))


@dataclass(frozen=True, slots=True, kw_only=True)
class ComparisonOutcome:
    """What a comparison left: the page, the variants, and their scores if there are any."""

    page: Path
    comparison: Comparison
    scores: VariantScores | None

    @property
    def resolutions(self) -> Mapping[str, Resolution]:
        """What is to be thought of every variant."""
        return {name: case.resolution for name, case in self.comparison.variants.items()}


def missed(checks: Iterable[Check]) -> tuple[str, ...]:
    """A sentence for every check that is missed."""
    return tuple(f"{c.name} is {c.value}, the limit is {c.limit}" for c in checks if not c.kept)


class Seat(Case):
    """A case with what needs more than one, or a page.

    Examples
    --------
    >>> seat = open("seat.toml")                                     # doctest: +SKIP
    >>> seat.resolution.status                                       # doctest: +SKIP
    'resolved'
    >>> seat.compare("eased.toml").table("w2_mean")                  # doctest: +SKIP
    >>> seat.evaluate("out/seat").page                               # doctest: +SKIP
    PosixPath('out/seat/index.html')
    """

    def compare(
        self, *others: Variant, keep: Path | str | None = None, progress: Progress = silent
    ) -> Comparison:
        """Put other seats beside this one: scenes, their files or cases.

        Raises
        ------
        InputError, SolverError, RenderError
        """
        return compare([self, *others], keep=keep, progress=progress)

    def evaluate(
        self,
        out: Path | str,
        *,
        resume: bool = False,
        score: bool = True,
        single_file: bool = False,
        force: bool = False,
        progress: Progress = silent,
    ) -> Outcome:
        """Solve, assess and draw into a folder, and write its page last.

        Parameters
        ----------
        resume : take the result in the folder if it may stand for solving the scene
        score : score how visible the wrinkles are; always where [accept] limits it
        single_file : put the images into the page
        force : overwrite files that seatlook did not write, or that were edited

        Raises
        ------
        InputError
            Before the solve: what ``check`` finds, a folder in use, files of the user's in it.
        NoOffscreenContext, SolverError, RenderError
        """
        folder = Path(out)
        writes = [name for name in LEFT if not (resume and name == "result.npz")]
        with run_folder(folder, writes=writes, page=True, force=force):
            evaluation = evaluate_case(self, folder, resume=resume, progress=progress)
            limited = any(limit.measure in SCORE_MEASURES for limit in self.scene.limits)
            section = visibility(evaluation, progress) if score or limited else None
            page = write_report(evaluation, score=section, single_file=single_file)
        return Outcome(page=page, evaluation=evaluation, score=section)

    def show(self, *, camera: str | Camera | None = None, height: int = 620) -> ViewerPage:
        """The viewer of the page in a notebook: turn the seat, light it, try looks.

        Parameters
        ----------
        height : int [pixels] of the frame

        Raises
        ------
        InputError
            No view of this name.
        NoOffscreenContext, SolverError
        """
        return viewer_page(self, self.camera(camera), height=height)

    def draw_assembly(self, path: Path | str) -> Path:
        """Draw the cover as it starts, before anything is solved, into a PNG file.

        It shows panels over foam, numbered seams with their gaps, hooks and frames, and marks
        what ``check`` refuses.

        Raises
        ------
        InputError
            The scene cannot be meshed, or the file cannot be written.
        NoOffscreenContext, RenderError
        """
        file = Path(path)
        try:
            draw_assembly(self.scene, self.cover, self.contradictions, file)
        except OSError as error:
            raise InputError.single(
                str(file), got=error.strerror or str(error), expected="a folder that can be written"
            ) from None
        return file

    def precision(self, tolerance: float, *, progress: Progress = silent) -> Precise:
        """Solve no finer than a tolerance of the zone means asks for, and measure the error.

        Raises
        ------
        InputError, SolverError
        """
        return solve_to(self.scene, tolerance, progress=progress)

    def propose(self, *, count: int = 3) -> Proposals:
        """Say which corrections of pattern, hooks and foam would help most, in millimetres.

        Parameters
        ----------
        count : of them at most; each counts on those before it being made

        Raises
        ------
        InputError
            All is frozen by [improve].
        SolverError
            The result is not converged, or its balance is unstable.
        """
        return propose(self.scene, self.assessment, count=count)

    def improve(self) -> Iterator[Iteration]:
        """Correct the pattern, hooks and foam step by step, within [improve] of the scene.

        Yields
        ------
        Iteration
            The start, every correction, and last where and why it ended.

        Raises
        ------
        InputError
            All is frozen by [improve].
        SolverError
            The result is not converged, or its balance is unstable.

        Examples
        --------
        >>> for step in seat.improve():                                  # doctest: +SKIP
        ...     print(step.number, step.value.total, step.sentence)
        >>> seat.prove(step).sentence                                    # doctest: +SKIP
        'better: 37 % of what was wrong is gone (error 0 %, scatter 4 %, 3 seeds)'
        """
        return improve(self.scene, self.assessment)

    def prove(self, step: Iteration, *, seeds: int = SEEDS, progress: Progress = silent) -> Proof:
        """Solve the seat as it is and as corrected cold, with the same seeds, and compare.

        Raises
        ------
        InputError, SolverError
        """
        corrected = Changes(self.solution, self.scene.pattern).scene(self.scene, step.made)
        return prove(self.scene, self.assessment, corrected, seeds=seeds, progress=progress)

    def timeline(
        self,
        stages: Path,
        out: Path,
        *,
        rig: str | Rig | None = None,
        camera: str | Camera | None = None,
        width: int = 480,
        seconds: float = 5.0,
    ) -> tuple[Path, Path]:
        """Draw the making from the stages that ``solve_in_stages`` left: a strip, an animation.

        Parameters
        ----------
        rig : lights of the strip; None for a preview without them, as in the animation
        """
        return film(
            self.solution,
            stages,
            out,
            camera=self.camera(camera),
            rig=None if rig is None else self.rig(rig),
            width=width,
            seconds=seconds,
        )


def open(
    scene: Path | str | Scene,
    *,
    changes: Iterable[str] = (),
    seed: int | None = None,
    element_size: float | None = None,
    tolerance: float | None = None,
    result: Path | str | None = None,
) -> Seat:
    """Open a seat.

    Parameters
    ----------
    scene : scene file, or a scene
    changes : values set over those of the file, such as ``"mesh.seed=3"``
    seed, element_size : instead of the scene's; float [m], panels' own sizes scale with it
    tolerance : relative error of zone means of W2 from which the mesh follows, instead of a size
    result : result file whose shape is taken as it is; without it the seat is solved when asked

    Raises
    ------
    InputError
        All faults of the scene and its files.
    """
    read = scene if isinstance(scene, Scene) else _read(Path(scene), changes)
    return Seat(
        with_mesh(read, element_size=element_size, tolerance=tolerance, seed=seed),
        solution=None if result is None else io.read_result(result),
    )


def _read(path: Path, changes: Iterable[str]) -> Scene:
    if path.suffix.lower() in _NO_SCENES:
        raise InputError.single(
            "scene", got=path.name, expected="a scene file (.toml)",
            hint="make one of a pattern and a foam with: seatlook init",
        )  # fmt: skip
    return io.load_scene(path, changes=changes)


def evaluate(scene: Path | str | Scene, out: Path | str, *, progress: Progress = silent) -> Outcome:
    """Evaluate a scene into a folder, see :meth:`Seat.evaluate`."""
    return open(scene).evaluate(out, progress=progress)


def compare_into(
    scenes: Sequence[Variant] | Mapping[str, Variant],
    out: Path | str,
    *,
    changes: Iterable[str] = (),
    results: Mapping[str, Path | str] = MappingProxyType({}),
    score: bool = True,
    single_file: bool = False,
    progress: Progress = silent,
) -> ComparisonOutcome:
    """Compare some scenes in a folder: results, pictures and maps, and the page last.

    Parameters
    ----------
    scenes, changes, results : see :func:`seatlook.compare`; results are kept in the folder, so
        that a second run only draws
    score : score how visible the wrinkles of every variant are
    single_file : put the images into the page

    Raises
    ------
    InputError
        Before the first solve: what ``check`` finds in any of the scenes, a folder in use.
    NoOffscreenContext, SolverError, RenderError
    """
    folder = Path(out)
    variants = named_cases(scenes, changes)
    for case in variants.values():
        case.check()
    with run_folder(folder, page=True):
        comparison = compare(variants, results=results, keep=folder, progress=progress)
        scores = score_variants(comparison, progress) if score else None
        page = write_comparison(
            comparison, folder, scores=scores, single_file=single_file, progress=progress
        )
    return ComparisonOutcome(page=page, comparison=comparison, scores=scores)
