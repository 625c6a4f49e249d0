"""Maps and tables of a result without its scene, and of two results side by side."""

from __future__ import annotations

from dataclasses import asdict, replace
from pathlib import Path

from seatlook import pbr
from seatlook.chain.assess import Assessment, assess
from seatlook.chain.draw import Canvas, draw_distortion, draw_maps, round_end
from seatlook.chain.files import ZONES, write_findings, write_zones
from seatlook.chain.framing import fitted_view
from seatlook.model import Camera, Criteria, CurvatureMode, Solution, StrainMeasure, criteria_of
from seatlook.model.criteria import threshold_of_radius
from seatlook.model.progress import Progress
from seatlook.results.difference import difference, zone_differences


def other_criteria(
    criteria: Criteria,
    solution: Solution,
    *,
    curvature: CurvatureMode | None = None,
    threshold: float | None = None,
    bending_radius: float | None = None,
    strain_measure: StrainMeasure | None = None,
) -> Criteria:
    """Criteria with some of them changed; what is None stays.

    Parameters
    ----------
    criteria : of the result, or of its scene
    curvature : of another mode than those: thresholds are the materials' own in that mode
    threshold : float [1/m], for all panels
    bending_radius : float [m], the same as the radius of the first wrinkle
    """
    mode = curvature or criteria.curvature
    if bending_radius is not None:
        threshold = float(threshold_of_radius(bending_radius, mode))
    if threshold is not None:
        changed = Criteria(curvature=mode, thresholds=(threshold,))
    elif mode == criteria.curvature:
        changed = criteria
    else:
        changed = criteria_of(solution.cover.materials, mode)
    return replace(changed, strain_measure=strain_measure or criteria.strain_measure)


def draw_result(
    assessment: Assessment, out: Path, *, camera: Camera | None = None, progress: Progress
) -> None:
    """Write maps and the tables of zones, wrinkles, seams, advice, sections and distortion.

    Parameters
    ----------
    camera : None fits one to the cover

    Raises
    ------
    NoOffscreenContext, RenderError
    """
    pbr.offscreen_backend()
    canvas = _canvas(assessment.solution, camera, out)
    draw_maps(assessment, canvas, progress)
    draw_distortion(assessment, canvas, progress)
    write_zones(assessment.zones, out / ZONES)
    write_findings(assessment, out)


def draw_difference(
    assessment: Assessment,
    other: Assessment,
    out: Path,
    *,
    camera: Camera | None = None,
    progress: Progress,
) -> None:
    """Draw W2 of both in one range and from one camera, and how much more the first has.

    Leaves ``maps/w2_this.png``, ``w2_other.png``, ``w2_difference.png``.
    """
    pbr.offscreen_backend()
    canvas = _canvas(assessment.solution, camera, out)
    top = max(assessment.top, other.top)
    for name, one in (("this", assessment), ("other", other)):
        progress("map", name=f"w2 of {name}")
        drawn = replace(canvas, solution=one.solution)
        path = f"maps/w2_{name}.png"
        drawn.draw(path, one.indices.w2, f"W2 of {name}", unit="1", ends=(0.0, top))
    more = difference(assessment.solution, assessment.indices.w2, other.solution, other.indices.w2)
    end = round_end(more)
    title = "W2 of this minus W2 of other"
    canvas.draw("maps/w2_difference.png", more, title, unit="1", ends=(-end, end))


def compared_zones(assessment: Assessment, other: Assessment) -> list[dict[str, str | float]]:
    """Return mean W2 of every common zone of both, and how much more the first has."""
    rows = zone_differences(
        assessment.solution, assessment.indices.w2, other.solution, other.indices.w2
    )
    return [asdict(row) | {"difference": row.difference} for row in rows]


def assess_other(solution: Solution, criteria: Criteria) -> Assessment:
    """Assess a second result by the criteria of the first, its thresholds by its own materials."""
    if len(criteria.thresholds) == 1 or len(solution.cover.panel_names) == len(criteria.thresholds):
        return assess(solution, criteria)
    own = criteria_of(
        solution.cover.materials, criteria.curvature, strain_measure=criteria.strain_measure
    )
    return assess(solution, own)


def _canvas(solution: Solution, camera: Camera | None, out: Path) -> Canvas:
    run = solution.cover.scene_digest
    return Canvas(solution=solution, camera=camera or fitted_view(solution), out=out, run=run)
