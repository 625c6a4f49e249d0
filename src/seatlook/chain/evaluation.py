"""Everything that is drawn and written of one case, into one folder."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType

from seatlook import pbr
from seatlook.chain.case import Case
from seatlook.chain.draw import (
    Canvas,
    Drawn,
    draw_distance,
    draw_distortion,
    draw_maps,
    draw_pictures,
)
from seatlook.chain.files import RESULT, ZONES, write_findings, write_shape, write_zones
from seatlook.model import Camera, Verdict
from seatlook.model.progress import Progress, silent

# Patterns of all that a run leaves, and its page.
LEFT = (
    "index.html", "result.npz", "zones.csv", "shape.csv", "seam-lines.csv", "worst.csv",
    "seam-excess.csv", "advice.csv", "sections.csv", "distortion.csv",
    "images/**/*.png", "maps/**/*.png",
)  # fmt: skip
GAP = "from the drawn foam to the cover: below 0 the foam is pressed in"
DEVIATION = "distance from the design surface: above 0 outside, below 0 inside"


@dataclass(frozen=True, slots=True, kw_only=True)
class Evaluation:
    """What was drawn and written; paths are relative to ``folder``.

    Parameters
    ----------
    pictures : (texture, rig) -> path
    maps, distances, distortion : maps of indices, of distances in mm, of the texture
    files : tables and the result
    verdicts : of the limits of [accept] on figures of zones
    """

    case: Case
    folder: Path
    camera: Camera
    pictures: MappingProxyType[tuple[str, str], str]
    maps: tuple[Drawn, ...]
    distances: tuple[Drawn, ...]
    distortion: tuple[Drawn, ...]
    files: tuple[str, ...]
    verdicts: tuple[Verdict, ...]

    @property
    def accepted(self) -> bool:
        """Whether every limit on the figures of zones is kept."""
        return all(verdict.kept for verdict in self.verdicts)


def evaluate_case(
    case: Case, out: Path, *, resume: bool = False, progress: Progress = silent
) -> Evaluation:
    """Solve a case, assess it, and leave result, tables, pictures and maps in a folder.

    Parameters
    ----------
    resume : take ``out/result.npz`` instead of solving, see ``chain.files.reusable``

    Raises
    ------
    NoOffscreenContext
        Before anything is solved, if nothing could be drawn afterwards.
    InputError
        Before the solve as well: what ``Case.check`` finds.
    SolverError, RenderError
    """
    pbr.offscreen_backend()
    if not (resume and case.reuse(out / RESULT)):
        case.check()
        case.solve(out / RESULT, progress=progress)
    solution = case.solution
    assessment = case.assessment
    verdicts = assessment.verdicts(case.scene)
    write_zones(assessment.zones, out / ZONES)
    design = () if case.scene.design is None else write_shape(assessment, out)
    canvas = Canvas(
        solution=solution, camera=case.camera(None), out=out, run=solution.cover.scene_digest
    )
    return Evaluation(
        case=case,
        folder=out,
        camera=canvas.camera,
        pictures=draw_pictures(case.scene, canvas, progress),
        maps=draw_maps(assessment, canvas, progress),
        distances=_distances(case, canvas),
        distortion=draw_distortion(assessment, canvas, progress),
        files=(RESULT, ZONES, *design, *write_findings(assessment, out)),
        verdicts=verdicts,
    )


def _distances(case: Case, canvas: Canvas) -> tuple[Drawn, ...]:
    gap = draw_distance("gap", case.assessment.gap, canvas, GAP)
    if case.scene.design is None:
        return (gap,)
    return gap, draw_distance("deviation", case.assessment.deviation, canvas, DEVIATION)
