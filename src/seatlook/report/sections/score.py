"""The score of a result as tables, sentences, maps and plain values: for page and command line."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np

from seatlook.chain.evaluation import Evaluation
from seatlook.errors import InputError
from seatlook.files import file_names
from seatlook.model import Camera, Limit
from seatlook.model.progress import Progress, silent
from seatlook.model.scene import SCORE_MEASURES
from seatlook.model.table import Table, number
from seatlook.pbr.maps.pixel_map import render_pixel_map
from seatlook.report.page.types import Check, MapView, ScoreSection, SeenPlace
from seatlook.visibility.concentration import CONCENTRATED
from seatlook.visibility.heights import Ladder
from seatlook.visibility.light_search import WorstLight
from seatlook.visibility.observer import FITTING, NULL_LIMIT, OBSERVER, TOO_LONG, VISIBLE
from seatlook.visibility.pixels import MARGIN
from seatlook.visibility.places import Place, places
from seatlook.visibility.scoring import SceneScore
from seatlook.visibility.view import ELEMENTS_PER_WAVE

_LEAST_TOP = 3.0  # of a map's range: the first value of D that counts as visible


def visibility(evaluation: Evaluation, progress: Progress | None = None) -> ScoreSection:
    """Score an evaluation for its page; what stands against a score is said instead of one.

    Limits of [accept] on a score that cannot be given are missed.
    """
    scene = evaluation.case.scene
    try:
        scored = evaluation.case.score(progress=progress or silent)
    except InputError as error:
        limits = [limit for limit in scene.limits if limit.measure in SCORE_MEASURES]
        return ScoreSection(
            refused=str(error), checks=tuple(_check(limit, "no score", False) for limit in limits)
        )
    assessment, panel = evaluation.case.assessment, evaluation.case.solution.cover.panel
    valley = assessment.values("w2") * assessment.criteria.per_face(panel)
    seen = places(scored, assessment.wrinkles, valley)
    section = score_section(scored, evaluation.folder)
    return replace(section, places=tuple(_seen(place, evaluation.camera) for place in seen))


def _seen(place: Place, camera: Camera) -> SeenPlace:
    (texture, rig), (x, y) = place.worst, camera.pixel(place.position)
    return SeenPlace(
        rank=place.rank,
        zone=place.zone,
        shows=place.shows,
        texture=texture,
        rig=rig,
        vwi=place.vwi[place.worst],
        hidden_by=place.hidden_by,
        x=round(x, 1),
        y=round(y, 1),
    )


def score_section(score: SceneScore, folder: Path) -> ScoreSection:
    """Gather the page's section; draws the map of every texture under its worst rig."""
    cells = [(texture, score.grid.worst_rig(texture)) for texture in score.grid.textures]
    return ScoreSection(
        grid=grid_table(score),
        causes=cause_table(score),
        zones=zone_table(score),
        sentences=tuple(sentences(score)),
        maps=draw_maps(score, cells, folder),
        checks=score_checks(score),
        cells=MappingProxyType({cell: s.score.vwi for cell, s in score.grid.sights.items()}),
    )


def height_text(height: float, top: float) -> str:
    """Equivalent height [mm] for a reader, or what it is above.

    Examples
    --------
    >>> height_text(0.00021, 0.001), height_text(math.inf, 0.001)
    ('0.210 mm', '> 1 mm')
    """
    return f"> {number(1e3 * top)} mm" if math.isinf(height) else f"{number(1e3 * height)} mm"


def grid_table(score: SceneScore) -> Table:
    """Textures by rigs with row and column summaries."""
    grid, vwi = score.grid, score.grid.vwi
    rows: list[tuple[str | float, ...]] = [
        (
            texture,
            *(_cell(score, texture, rig) for rig in grid.rigs),
            float(vwi[k].mean()),
            grid.worst_rig(texture),
        )
        for k, texture in enumerate(grid.textures)
    ]
    rows.append(("mean", *map(float, vwi.mean(axis=0)), float(vwi.mean()), "–"))
    worst = [grid.worst_texture(rig) for rig in grid.rigs]
    rows.append(("worst texture", *worst, "–", "–"))
    return Table(heads=("VWI, height", *grid.rigs, "mean", "worst rig"), rows=tuple(rows))


def cause_table(score: SceneScore) -> Table:
    """One row per cell: the score by cause beside its cross-checks."""
    low, high = OBSERVER.visible
    return Table(
        heads=(
            "texture",
            "rig",
            "VWI",
            "apparent contrast [%]",
            "VWI where W_stretch",
            "VWI where W_compression",
            f"D above {number(low)} [cm2]",
            f"D above {number(high)} [cm2]",
            "rms log ratio",
            "1 - SSIM",
            "in 0.1 % of the pixels [%]",
        ),
        rows=tuple(
            (
                texture,
                rig,
                sight.score.vwi,
                sight.score.apparent_contrast,
                sight.stretch,
                sight.compression,
                *(1e4 * area for area in sight.score.visible_area or (math.nan, math.nan)),
                sight.measures.log_ratio,
                sight.measures.dissimilarity,
                100 * sight.peak.share,
            )
            for (texture, rig), sight in score.grid.sights.items()
        ),
    )


def zone_table(score: SceneScore) -> Table:
    """One row per zone in view, the most visible first: each texture under its worst rig."""
    grid = score.grid

    def worst(zone: str, texture: str) -> tuple[float, str]:
        cells = [(grid.sights[texture, rig].zones.get(zone), rig) for rig in grid.rigs]
        seen = [(vwi, rig) for vwi, rig in cells if vwi is not None]
        if not seen:
            return 0.0, "–"
        vwi, rig = max(seen)
        ladder = score.ladder.zones[zone]
        return vwi, f"{number(vwi)}, {height_text(ladder.equivalent(vwi), ladder.top)} ({rig})"

    ranked = [
        (zone, {texture: worst(zone, texture) for texture in grid.textures})
        for zone in score.ladder.zones
    ]
    ranked.sort(key=lambda row: -max(vwi for vwi, _ in row[1].values()))
    return Table(
        heads=("zone", "peak to valley [mm]", "visible from", *grid.textures),
        rows=tuple(
            (
                zone,
                1e3 * score.ladder.zones[zone].height,
                visible_from(score.ladder.zones[zone]),
                *(text for _, text in cells.values()),
            )
            for zone, cells in ranked
        ),
    )


def visible_from(ladder: Ladder) -> str:
    """Yardstick of equivalent heights: from which height on the same wrinkles are visible.

    Examples
    --------
    >>> visible_from(
    ...     Ladder(height=0.001, heights=np.array([0, 0.001]), vwi=np.array([0.0, 4.0]))
    ... )
    '0.250 mm'
    """
    return height_text(ladder.equivalent(VISIBLE), ladder.top)


def sentences(score: SceneScore) -> Iterator[str]:
    """Say what follows from the tables."""
    grid, view = score.grid, score.view
    least = grid.least_visible
    if least is not None:
        yield f"Least visible texture under these lights: {least}."
    elif len(grid.textures) > 1:
        yield "No texture can be told to be the least visible: the measures disagree."
    alike: dict[str, list[str]] = {}
    for first, second, rig in grid.not_separable():
        alike.setdefault(rig, []).append(f"{first} and {second}")
    for rig, pairs in alike.items():
        yield f"Not separable under {rig}: {', '.join(pairs)}; the measures disagree."
    yield (
        f"The wrinkles in view are {number(1e3 * score.ladder.height)} mm from peak to valley "
        f"(95 % of their area). Reference: {view.mode}"
        + (f", cut-off {number(1e3 * view.cutoff)} mm." if view.mode != "design" else ".")
    )
    size = 1e3 * view.element_size
    yield (
        f"Waves shorter than {number(ELEMENTS_PER_WAVE * size)} mm are left out: a mesh of "
        f"{number(size)} mm does not carry them. So is what lies closer than "
        f"{number(1e3 * MARGIN)} mm to a seam, a hem, a silhouette or a shadow that moves."
    )
    if score.peak.places:
        yield (
            f"At most {number(100 * score.peak.share)} % of a score lie in 0.1 % of its pixels "
            f"({', '.join(score.peak.places)}); the limit is {number(100 * CONCENTRATED)} %."
        )
    yield from yardsticks(score)
    yield (
        f"A cover without wrinkles scores at most {number(score.null)}; the limit is "
        f"{number(NULL_LIMIT)}."
    )
    yield f"The model observer is fitted {OBSERVER.calibrated}, not on wrinkles."


def yardsticks(score: SceneScore) -> Iterator[str]:
    """Say what scores and equivalent heights are to be held against."""
    fitting, too_long = (f"{number(low)} to {number(high)}" for low, high in (FITTING, TOO_LONG))
    yield (
        f"From {number(VISIBLE)} on wrinkles are visible. The middle panel of the demo cushion in "
        f"black leather scores {fitting} where it fits, {too_long} beside a seam 3 % too long."
    )
    ladder = score.ladder
    if math.isinf(ladder.equivalent(VISIBLE)):
        seen = f"are not visible up to {number(1e3 * ladder.top)} mm"
    else:
        seen = f"are visible from {visible_from(ladder)} on"
    yield (
        f"On black leather, in a sun that shows them well, the wrinkles in view {seen}. "
        "That is the yardstick of equivalent heights; each zone has its own."
    )
    if len(score.grid.textures) > 1:
        yield (
            "Compare equivalent heights within one texture: across textures the model gives gloss "
            "more weight than people do."
        )


def draw_maps(
    score: SceneScore, cells: Iterable[tuple[str, str]], folder: Path
) -> tuple[MapView, ...]:
    """Draw D of cells (texture, rig) below ``folder``, all with one range."""
    top = max(_LEAST_TOP, *(sight.score.p995 for sight in score.grid.sights.values()))
    view, maps = score.view, []
    names = file_names(f"{texture}\n{rig}" for texture, rig in score.grid.sights)
    for texture, rig in cells:
        sight = score.grid.sights[texture, rig]
        picture = render_pixel_map(
            view.solution,
            np.where(sight.mask, sight.score.map, np.nan),
            camera=view.camera,
            title=f"Visibility D of wrinkles: {texture}, {rig}",
            value_range=(0.0, top),
            unit="1",
        )
        name = names[f"{texture}\n{rig}"]
        path = f"maps/visibility-{name}.png"
        picture.save(folder / path, run=view.solution.cover.scene_digest)
        maps.append(
            MapView(
                name=f"D of {texture}, {rig}",
                image=path,
                low=0.0,
                high=top,
                meaning="visibility of wrinkles in thresholds of the model observer; seams, "
                "hems, silhouettes and moving shadows are left out",
            )
        )
    return tuple(maps)


def score_values(
    score: SceneScore, searches: dict[str, dict[str, WorstLight]] | None = None
) -> dict[str, Any]:
    """Everything as plain values; an equivalent height above the ladder is null."""
    grid, view = score.grid, score.view
    return {
        "camera": view.camera.name,
        "reference": view.mode,
        "cutoff_mm": 1e3 * view.cutoff if view.mode != "design" else None,
        "calibrated": OBSERVER.calibrated,
        "null_vwi": score.null,
        "shortest_wave_mm": 1e3 * ELEMENTS_PER_WAVE * view.element_size,
        "highest_frequency_per_deg": view.highest_frequency,
        "height_mm": 1e3 * score.ladder.height,
        "ladder_mm": (1e3 * score.ladder.heights).tolist(),
        "ladder_vwi": score.ladder.vwi.tolist(),
        "visible_from_mm": {
            zone: _millimetres(ladder.equivalent(VISIBLE))
            for zone, ladder in score.ladder.zones.items()
        },
        "least_visible": grid.least_visible,
        "worst_rig": {texture: grid.worst_rig(texture) for texture in grid.textures},
        "worst_texture": {rig: grid.worst_texture(rig) for rig in grid.rigs},
        "not_separable": [list(entry) for entry in grid.not_separable()],
        "cells": [_cell_values(score, *cell) for cell in grid.sights],
        "limits": [
            {
                "zone": v.limit.zone,
                "measure": v.limit.measure,
                "value": v.value if math.isfinite(v.value) else None,
                "maximum": v.limit.maximum,
                "resolved": v.resolved,
                "kept": v.kept,
            }
            for v in score.verdicts
        ],
        "worst_light": {
            texture: {kind: _light_values(light) for kind, light in kinds.items()}
            for texture, kinds in (searches or {}).items()
        },
    }


def _cell_values(score: SceneScore, texture: str, rig: str) -> dict[str, Any]:
    sight = score.grid.sights[texture, rig]
    return {
        "texture": texture,
        "rig": rig,
        "vwi": sight.score.vwi,
        "apparent_contrast_percent": sight.score.apparent_contrast,
        "equivalent_height_mm": _millimetres(score.grid.height[texture, rig]),
        "vwi_stretch": sight.stretch,
        "vwi_compression": sight.compression,
        "log_ratio": sight.measures.log_ratio,
        "dissimilarity": sight.measures.dissimilarity,
        "share_in_top_pixels": sight.peak.share,
        "top_pixels": list(sight.peak.places),
        "zones": {
            zone: {
                "vwi": vwi,
                "apparent_contrast_percent": sight.contrasts[zone],
                "equivalent_height_mm": _millimetres(score.zone_height(zone, texture, rig)),
            }
            for zone, vwi in sight.zones.items()
        },
    }


def _light_values(light: WorstLight) -> dict[str, float]:
    return {
        "azimuth_deg": light.azimuth_deg,
        "elevation_deg": light.elevation_deg,
        "vwi": light.vwi,
        "lights_tried": len(light.tried),
    }


def _millimetres(height: float | None) -> float | None:
    return 1e3 * height if height is not None and math.isfinite(height) else None


def _cell(score: SceneScore, texture: str, rig: str) -> str:
    height = height_text(score.grid.height[texture, rig], score.ladder.top)
    return f"{number(score.grid.sights[texture, rig].score.vwi)}, {height}"


def score_checks(score: SceneScore) -> tuple[Check, ...]:
    """Limits of [accept] on the score, and what was found."""
    return tuple(_check(v.limit, number(v.value) + v.note, v.kept) for v in score.verdicts)


def _check(limit: Limit, value: str, kept: bool) -> Check:
    return Check(
        name=f"{limit.zone}: {limit.measure}", value=value, limit=number(limit.maximum), kept=kept
    )
