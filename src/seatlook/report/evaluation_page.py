"""From an evaluation to what its page shows."""

from __future__ import annotations

import platform
from collections.abc import Iterator, Mapping
from dataclasses import replace
from importlib.metadata import version
from pathlib import Path
from types import MappingProxyType

import numpy as np

from seatlook._version import __version__
from seatlook.assembly.ease import SeamEase, seam_ease
from seatlook.chain.evaluation import DISTANCES, MAPS, RESULT, Evaluation, label
from seatlook.model import Scene, Solution
from seatlook.model.table import Table, number
from seatlook.pbr import offscreen_backend, render_map
from seatlook.report.page.data import PageData
from seatlook.report.page.types import Check, MapView, ScoreSection
from seatlook.report.page.write import write_page
from seatlook.report.sections.design import FILES, design_section, distance_table
from seatlook.report.sections.in_short import missed, seen, wrinkled
from seatlook.report.sections.making import making_section
from seatlook.report.sections.parameters import parameter_tables, parameter_toml
from seatlook.report.sections.rigs import rig_head
from seatlook.report.sections.wrinkles import wrinkle_section
from seatlook.results.gap import zone_gaps
from seatlook.solver import foam_wavelength
from seatlook.solver.process import verdict
from seatlook.solver.process.process import RESIDUAL

# figure -> what it is, its limit, factor to the unit, unit
_CONDITIONS: Mapping[str, tuple[str, float, float, str]] = {
    "residual": ("out-of-balance force over mean elastic force", RESIDUAL, 1.0, ""),
    "kinetic_ratio": ("kinetic over elastic energy", verdict.KINETIC, 1.0, ""),
    "seam_gap_max": ("largest seam gap", verdict.SEAM_GAP, 1e3, " mm"),
    "hook_gap_max": ("largest distance of a hook from its wire", verdict.ANCHOR_GAP, 1e3, " mm"),
    "frame_gap_max": ("largest distance of a free edge", verdict.ANCHOR_GAP, 1e3, " mm"),
    "contact_compression_max": (
        "foam pressed, share of its thickness",
        verdict.COMPRESSION,
        1e2,
        " %",
    ),
    "contact_resultant_error": (
        "foam pressure against resultant",
        verdict.RESULTANT,
        1e2,
        " %",
    ),
    "intersecting_pairs": ("pairs of triangles that pass through each other", 0.0, 1.0, ""),
    "hem_crossing_pairs": ("triangles of a folded allowance that come through", 0.0, 1.0, ""),
}
# column of the history -> its name on the page, factor to the unit in it
_CHARTED: Mapping[str, tuple[str, float]] = {
    "residual": ("out-of-balance force over mean elastic force", 1.0),
    "seam_gap": ("largest seam gap [mm]", 1e3),
    "elastic": ("elastic energy [J]", 1.0),
    "kinetic": ("kinetic energy [J]", 1.0),
}
_CAUSES = ("w_stretch", "w_compression")  # maps that have a range of their own as well
_OWN = 0.992  # share of the faces that lie in it
_LOOSE_MESH = 8.0  # lambda / h below which the wrinkles' shape is not resolved
_FINE_MESH = 12.0  # lambda / h from which the indices are


def write_report(
    evaluation: Evaluation, *, score: ScoreSection | None = None, single_file: bool = False
) -> Path:
    """Write the gallery page of an evaluation into its folder and return its path."""
    data = page_data(evaluation)
    summary = (
        *wrinkled(evaluation.zones),
        *seen(score.cells if score else {}),
        *missed((*_limits(evaluation), *(score.checks if score else ()))),
    )
    data = replace(data, score=score, summary=summary)
    return write_page(data, evaluation.folder, single_file=single_file)


def page_data(evaluation: Evaluation) -> PageData:
    """Gather what the page shows."""
    scene, solution = evaluation.scene, evaluation.solution
    waves = {
        m.name: foam_wavelength(m.fabric, scene.foam.material) for m in solution.cover.materials
    }
    wrinkles = wrinkle_section(evaluation)
    return PageData(
        title=scene.name,
        camera=evaluation.camera.name,
        size=evaluation.camera.size,
        pixels_per_degree=evaluation.camera.pixels_per_degree,
        textures=tuple(scene.textures),
        rigs=tuple(rig_head(rig) for rig in scene.rigs),
        pictures=evaluation.pictures,
        maps=tuple(_maps(evaluation)),
        zones=_zones(evaluation),
        parameters=parameter_tables(scene),
        toml=parameter_toml(scene),
        spots=wrinkles.spots,
        provenance=MappingProxyType(dict(_provenance(evaluation, waves))),
        status=solution.status,
        seams=seam_table(scene),
        shape=_shape(evaluation),
        wrinkles=wrinkles,
        making=making_section(solution, evaluation.folder),
        design=design_section(evaluation),
        checks=(*_conditions(solution), *_limits(evaluation)),
        warnings=tuple(_warnings(evaluation, waves)),
        history=MappingProxyType(
            {
                name: tuple((factor * solution.history[column]).tolist())
                for column, (name, factor) in _CHARTED.items()
            }
        ),
        files=(RESULT, "zones.csv", *(FILES if scene.design else ()), *wrinkles.files),
    )


def _maps(evaluation: Evaluation) -> Iterator[MapView]:
    for name, (path, picture) in evaluation.maps.items():
        low, high = picture.value_range
        picture_unit, meaning = ("mm", DISTANCES[name]) if name in DISTANCES else ("1", MAPS[name])
        alone, top = _own_range(evaluation, name) if name in _CAUSES else (None, 1.0)
        yield MapView(
            name=label(name),
            image=path,
            low=low,
            high=high,
            unit=picture_unit,
            meaning=meaning,
            alone=alone,
            alone_high=top,
        )


def _own_range(evaluation: Evaluation, name: str) -> tuple[str, float]:
    """Draw a cause of W2 in the range of its own values; return path and upper end."""
    values = getattr(evaluation.indices, name)
    top = max(float(np.quantile(values, _OWN)), 1e-6)
    path = f"maps/{name}-own.png"
    render_map(
        evaluation.solution,
        values,
        camera=evaluation.camera,
        title=f"{label(name)}, range of its own",
        unit="1",
        value_range=(0.0, top),
    ).save(evaluation.folder / path)
    return path, top


def _zones(evaluation: Evaluation) -> Table:
    """Zones, worst first, without the free edges, which are clamped or trimmed and say nothing."""
    return Table(
        heads=(
            "zone",
            "area [cm2]",
            "W2 mean",
            "W2 95 %",
            "W2 above 1 [% of area]",
            "W_stretch mean",
            "W_compression mean",
            "stretch [% of W2]",
            "W2 net mean",
            "W2 net above 1 [% of area]",
            "W2 error",
            "h [mm]",
        ),
        rows=tuple(
            (
                row.zone,
                1e4 * row.area,
                row.w2_mean,
                row.w2_p95,
                100 * row.w2_area_share,
                row.w_stretch_mean,
                row.w_compression_mean,
                100 * row.stretch_share,
                row.w2_net_mean,
                None if row.w2_net_area_share is None else 100 * row.w2_net_area_share,
                row.w2_error,
                1e3 * row.element_size,
            )
            for row in sorted(evaluation.zones, key=lambda row: -row.w2_p95)
            if row.zone != "free edge"
        ),
    )


def _shape(evaluation: Evaluation) -> Table:
    """Gap of the zones to the foam, the largest first, and faces through each other."""
    found = distance_table(zone_gaps(evaluation.solution, evaluation.gap))
    figures = evaluation.solution.figures
    none = 0.0 if "intersecting_pairs" in figures else None
    return Table(
        heads=(*found.heads, "intersecting pairs"),
        rows=tuple(
            (*row, figures.get(f"zone/{row[0]}/intersecting_pairs", none)) for row in found.rows
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
            "most between notches [%]",
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


def _conditions(solution: Solution) -> Iterator[Check]:
    for name, (what, limit, factor, unit) in _CONDITIONS.items():
        if name not in solution.figures:
            continue  # a cover without foam touches none
        value = solution.figures[name]
        yield Check(
            name=what,
            value=f"{number(factor * value)}{unit}",
            limit=f"{number(factor * limit)}{unit}",
            kept=value <= limit,
        )


def _limits(evaluation: Evaluation) -> Iterator[Check]:
    for found in evaluation.verdicts:
        yield Check(
            name=f"{found.limit.zone}: {found.limit.measure}",
            value=number(found.value),
            limit=number(found.limit.maximum),
            kept=found.kept,
        )


def _warnings(evaluation: Evaluation, waves: Mapping[str, float]) -> Iterator[str]:
    solution, h = evaluation.solution, evaluation.solution.cover.element_size
    if solution.status != "converged":
        yield f"The solution is not converged: {solution.reason}."
    for name, wave in waves.items():
        if wave < _LOOSE_MESH * h:
            yield (
                f"{name}: elements of {number(1e3 * h)} mm are coarser than an eighth of its "
                f"wavelength of {number(1e3 * wave)} mm; shape and indices are not resolved."
            )
        elif wave < _FINE_MESH * h:
            yield (
                f"{name}: elements of {number(1e3 * h)} mm resolve the shape of its wrinkles "
                f"(wavelength {number(1e3 * wave)} mm), but not yet the indices, which need a "
                "twelfth."
            )


def _provenance(evaluation: Evaluation, waves: Mapping[str, float]) -> Iterator[tuple[str, str]]:
    scene, solution = evaluation.scene, evaluation.solution
    cover = solution.cover
    yield "seatlook", __version__
    yield "solved with", solution.version
    for package in ("numpy", "scipy", "numba", "vtk"):
        yield package, version(package)
    yield "python", platform.python_version()
    yield "drawn with", offscreen_backend().window
    yield "scene", scene.path.name if scene.path else scene.name
    yield "scene digest (sha256)", scene.digest
    yield "seed", str(cover.seed)
    yield "vertices, triangles", f"{len(cover.rest)}, {len(cover.faces)}"
    yield "element size h", f"{number(1e3 * cover.element_size)} mm"
    for name, wave in waves.items():
        yield (
            f"wavelength lambda of {name}",
            f"{number(1e3 * wave)} mm, lambda / h = {number(wave / cover.element_size)}",
        )
    yield "solver status", solution.status
    yield "solver steps", number(solution.figures["steps"])
    yield "solver iterations", number(solution.figures["iterations"])
    yield "solver CPU time", f"{number(solution.figures['cpu_seconds'])} s"
