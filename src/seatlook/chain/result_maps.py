"""Indices, tables and maps of a result without its scene, and of two results side by side."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from seatlook import pbr
from seatlook.chain.evaluation import draw_maps, write_zones
from seatlook.chain.findings import Findings, draw_findings, draw_net, round_end, write_findings
from seatlook.chain.framing import fitted_view
from seatlook.model import Camera, FloatArray, Solution, WrinkleMap
from seatlook.model.progress import Progress
from seatlook.model.scene import CurvatureMode
from seatlook.results.difference import difference, zone_differences
from seatlook.shells.strains import DEFAULT_THRESHOLD
from seatlook.wrinkle import (
    ZoneRow,
    map_top,
    surface_of,
    surface_strains,
    thresholds,
    w2_net,
    wrinkle_indices,
    zone_table,
)
from seatlook.wrinkle.equations import StrainMeasure


@dataclass(frozen=True, slots=True, kw_only=True)
class Question:
    """How to look at a result.

    Parameters
    ----------
    threshold : float [1/m]   for all materials; None takes each material's own
    default : float [1/m]     for materials without one; None takes that of the mode
    camera : None fits one to the cover
    """

    mode: CurvatureMode
    strain: StrainMeasure = "green"
    threshold: float | None = None
    default: float | None = None
    camera: Camera | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Judged:
    """A result, its indices, ``w2_net`` (m,) and its zones."""

    solution: Solution
    indices: WrinkleMap
    net: FloatArray
    zones: tuple[ZoneRow, ...]


def judge(solution: Solution, question: Question) -> Judged:
    """Evaluate the indices of a result and sum them up by zones."""
    cover, mode = solution.cover, question.mode
    if question.threshold is not None:
        limit = np.full(len(cover.faces), question.threshold)
    else:
        limit = thresholds(cover, mode, question.default or DEFAULT_THRESHOLD[mode])
    indices = wrinkle_indices(
        *surface_strains(solution),
        cover.thickness,
        limit,
        curvature=mode,
        strain_measure=question.strain,
    )
    net = w2_net(surface_of(solution, indices, limit))
    return Judged(
        solution=solution, indices=indices, net=net, zones=zone_table(solution, indices, net)
    )


def draw_result(
    judged: Judged, findings: Findings, question: Question, out: Path, *, say: Progress
) -> None:
    """Write ``maps/``, ``zones.csv``, ``worst.csv``, ``sections.csv``, ``distortion.csv``.

    Raises
    ------
    NoOffscreenContext, RenderError
    """
    pbr.offscreen_backend()
    solution = judged.solution
    camera = question.camera or fitted_view(solution)
    top = map_top(judged.indices)
    draw_maps(solution, judged.indices, camera, out, say, top=top)
    draw_net(judged.net, solution, camera, out, top=top)
    draw_findings(findings, solution, camera, out, say)
    write_zones(judged.zones, out / "zones.csv")
    write_findings(findings, out)


def draw_difference(
    judged: Judged, other: Judged, question: Question, out: Path, *, say: Progress
) -> None:
    """Draw W2 of both in one range and from one camera, and how much more the first has.

    Leaves ``maps/w2_this.png``, ``w2_other.png``, ``w2_difference.png``.
    """
    pbr.offscreen_backend()
    camera = question.camera or fitted_view(judged.solution)
    top = max(map_top(judged.indices), map_top(other.indices))
    for name, one in (("this", judged), ("other", other)):
        say("map", name=f"w2 of {name}")
        pbr.render_map(
            one.solution, one.indices.w2, camera=camera, title=f"W2 of {name}", unit="1",
            value_range=(0.0, top),
        ).save(out / f"maps/w2_{name}.png")  # fmt: skip
    more = difference(judged.solution, judged.indices.w2, other.solution, other.indices.w2)
    end = round_end(more)
    pbr.render_map(
        judged.solution, more, camera=camera, title="W2 of this minus W2 of other", unit="1",
        value_range=(-end, end),
    ).save(out / "maps/w2_difference.png")  # fmt: skip


def compared_zones(judged: Judged, other: Judged) -> list[dict[str, str | float]]:
    """Return mean W2 of every common zone of both, and how much more the first has."""
    rows = zone_differences(judged.solution, judged.indices.w2, other.solution, other.indices.w2)
    return [asdict(row) | {"difference": row.difference} for row in rows]
