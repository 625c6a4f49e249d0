"""From an evaluation to what its page shows."""

from __future__ import annotations

import platform
from collections.abc import Iterator, Mapping
from dataclasses import replace
from importlib.metadata import version
from pathlib import Path
from types import MappingProxyType

from seatlook._version import __version__
from seatlook.assembly.ease import SeamEase, seam_ease
from seatlook.chain.case import Case
from seatlook.chain.evaluation import Evaluation
from seatlook.model import Scene
from seatlook.model.table import Table, number
from seatlook.model.zones import FREE_EDGE
from seatlook.pbr import offscreen_backend
from seatlook.report.page.data import PageData
from seatlook.report.page.types import Check, CloseUp, ScoreSection
from seatlook.report.page.write import write_page
from seatlook.report.sections.design import design_section, distance_table
from seatlook.report.sections.in_short import WORDS, first_lines, place_words
from seatlook.report.sections.making import making_section
from seatlook.report.sections.maps import map_view
from seatlook.report.sections.parameters import parameter_tables, parameter_toml
from seatlook.report.sections.rigs import rig_head
from seatlook.report.sections.words import light_words, look_words
from seatlook.report.sections.wrinkles import wrinkle_section
from seatlook.report.viewer.section import viewer_section
from seatlook.results.conditions import conditions
from seatlook.wrinkle import INDICES

# column of the history -> its name on the page, factor to the unit in it
_CHARTED: Mapping[str, tuple[str, float]] = {
    "residual": ("out-of-balance force over mean elastic force", 1.0),
    "seam_gap": ("largest seam gap [mm]", 1e3),
    "elastic": ("elastic energy [J]", 1.0),
    "kinetic": ("kinetic energy [J]", 1.0),
}


def write_report(
    evaluation: Evaluation, *, score: ScoreSection | None = None, single_file: bool = False
) -> Path:
    """Write the gallery page of an evaluation into its folder and return its path."""
    data = page_data(evaluation)
    data = replace(
        data,
        score=score,
        summary=page_answer(evaluation, score),
        close_up=_close_up(evaluation, score),
        viewer=viewer_section(evaluation.case, evaluation.camera, evaluation.folder),
    )
    return write_page(data, evaluation.folder, single_file=single_file)


def page_answer(evaluation: Evaluation, score: ScoreSection | None) -> tuple[str, ...]:
    """The sentences that the page begins with, and the command line ends with."""
    checks = (*_limits(evaluation), *(score.checks if score else ()))
    return first_lines(evaluation.case.assessment, score, checks)


def _close_up(evaluation: Evaluation, score: ScoreSection | None) -> CloseUp:
    """The place that shows most, in the look and light in which it does; else a whole picture."""
    cells = score.cells if score else {}
    texture, rig = max(cells or evaluation.pictures, key=lambda cell: cells.get(cell, 0.0))
    at, where = None, "the seat"
    place = next((p for p in (score and score.places) or () if p.shows), None)
    if place:
        texture, rig, at = place.texture, place.rig, (place.x, place.y)
        where = place_words(evaluation.case.assessment, place)
    caption = f"{look_words(texture)} under {light_words(rig)}: {where}"
    return CloseUp(image=evaluation.pictures[texture, rig], caption=caption, at=at)


def page_data(evaluation: Evaluation) -> PageData:
    """Gather what the page shows."""
    scene, solution = evaluation.case.scene, evaluation.case.solution
    wrinkles = wrinkle_section(evaluation)
    return PageData(
        title=scene.name,
        camera=evaluation.camera.name,
        size=evaluation.camera.size,
        pixels_per_degree=evaluation.camera.pixels_per_degree,
        textures=tuple(scene.textures),
        rigs=tuple(rig_head(rig) for rig in scene.rigs),
        pictures=evaluation.pictures,
        maps=tuple(map(map_view, (*evaluation.maps, *evaluation.distances))),
        zones=_zones(evaluation),
        parameters=parameter_tables(scene),
        toml=parameter_toml(scene),
        spots=wrinkles.spots,
        provenance=MappingProxyType(dict(_provenance(evaluation))),
        status=evaluation.case.resolution.status,
        verdict=WORDS[evaluation.case.resolution.status],
        again=_again(scene, evaluation.folder),
        seams=seam_table(scene),
        shape=_shape(evaluation),
        wrinkles=wrinkles,
        making=making_section(solution, evaluation.folder),
        design=design_section(evaluation),
        checks=(*_conditions(evaluation.case), *_limits(evaluation)),
        warnings=tuple(_warnings(evaluation)),
        history=MappingProxyType(
            {
                name: tuple((factor * solution.history[column]).tolist())
                for column, (name, factor) in _CHARTED.items()
            }
        ),
        files=evaluation.files,
    )


def _again(scene: Scene, folder: Path) -> str:
    """The command that makes the page as one file; without a file of the scene there is none."""
    if scene.path is None:
        return ""
    out = folder.resolve().name
    return f"seatlook evaluate {scene.path.name} --out {out} --resume --single-file"


def _zones(evaluation: Evaluation) -> Table:
    """Zones, worst first, without the free edges, which are clamped or trimmed."""
    columns = [column for index in INDICES.values() for column in index.columns]
    return Table(
        heads=(
            "zone",
            "area [cm2]",
            *(head for _, head, _ in columns),
            "stretch [% of W2]",
            "W2 mean ± mesh",
            "± seeds",
            "resolved",
            "h [mm]",
            "W2 by",
        ),
        rows=tuple(
            (
                row.zone,
                1e4 * row.area,
                *(factor * row[figure] for figure, _, factor in columns),
                100 * row.stretch_share,
                row.w2_mesh_error,
                row.w2_scatter,
                "yes" if row.resolved else "no",
                1e3 * row.element_size,
                row.criterion,
            )
            for row in sorted(evaluation.case.assessment.zones, key=lambda row: -row["w2_p95"])
            if row.zone != FREE_EDGE
        ),
    )


def _shape(evaluation: Evaluation) -> Table:
    """Gap of the zones, the farthest from the foam first, and faces through each other."""
    table = distance_table(evaluation.case.assessment.zone_gaps)
    figures = evaluation.case.solution.figures
    none = 0.0 if "intersecting_pairs" in figures else None
    return Table(
        heads=(*table.heads, "intersecting pairs"),
        rows=tuple(
            (*row, figures.get(f"zone/{row[0]}/intersecting_pairs", none)) for row in table.rows
        ),
    )


def seam_table(scene: Scene) -> Table:
    """Seams, the one with the largest ease first."""
    eases = [seam_ease(scene.pattern, seam) for seam in scene.pattern.seams]
    return Table(
        heads=(
            "seam",
            "near side [mm]",
            "far side [mm]",
            "ease [mm]",
            "ease [%]",
            "largest between notches [%]",
            "notches",
        ),
        rows=tuple(
            (
                ease.name,
                1e3 * ease.length_a,
                1e3 * ease.length_b,
                1e3 * ease.ease,
                100 * ease.share,
                100 * ease.extreme,
                _matching(ease),
            )
            for ease in sorted(eases, key=lambda ease: -abs(ease.share))
        ),
    )


def _matching(ease: SeamEase) -> str:
    """Say how many notches meet, or that they do not."""
    near, far = len(ease.notches_a), len(ease.notches_b)
    return f"{near} matched" if ease.matched else f"{near} and {far}: not matched"


def _conditions(case: Case) -> Iterator[Check]:
    for condition in conditions(case.solution, case.resolution):
        unit = f" {condition.unit}" if condition.unit else ""
        yield Check(
            name=condition.meaning,
            value=f"{number(condition.value)}{unit}",
            limit=f"{number(condition.limit)}{unit}",
            kept=condition.kept,
        )


def _limits(evaluation: Evaluation) -> Iterator[Check]:
    for verdict in evaluation.verdicts:
        yield Check(
            name=f"{verdict.limit.zone}: {verdict.limit.measure}",
            value=number(verdict.value) + verdict.note,
            limit=number(verdict.limit.maximum),
            kept=verdict.kept,
        )


def _warnings(evaluation: Evaluation) -> Iterator[str]:
    found = evaluation.case.resolution
    if found.balance:
        yield f"The solution is not converged: {found.balance}."
    for sentence in found.coarseness:
        yield f"The solution is not resolved: {sentence}."


def _provenance(evaluation: Evaluation) -> Iterator[tuple[str, str]]:
    scene, solution = evaluation.case.scene, evaluation.case.solution
    cover = solution.cover
    yield "seatlook", __version__
    yield "solved with", solution.version
    for package in ("numpy", "scipy", "numba", "vtk"):
        yield package, version(package)
    yield "python", platform.python_version()
    yield "drawn with", offscreen_backend().window
    yield "scene", scene.path.name if scene.path else scene.name
    yield "run (sha256 of all that went in)", cover.scene_digest
    yield "solver settings", solution.settings
    yield "seed", str(cover.seed)
    yield "vertices, triangles", f"{len(cover.rest)}, {len(cover.faces)}"
    yield "element size h", f"{number(1e3 * cover.element_size)} mm"
    for wave in evaluation.case.resolution.waves:
        yield (
            f"wavelength lambda of {wave.material}",
            f"{number(1e3 * wave.wavelength)} mm, lambda / h = {number(wave.per_wave)}, "
            f"estimated error of W2 on it {number(100 * wave.error)} %",
        )
    yield "status", evaluation.case.resolution.sentence
    yield "solver steps", number(solution.figures["steps"])
    yield "solver iterations", number(solution.figures["iterations"])
    yield "solver CPU time", f"{number(solution.figures['cpu_seconds'])} s"
