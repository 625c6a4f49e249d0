"""What a wrinkle map says in words, figures and pictures: worst wrinkles, sections, distortion."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np

from seatlook import io, pbr
from seatlook.model import Camera, FloatArray, Solution, WrinkleMap
from seatlook.model.progress import Progress
from seatlook.wrinkle import (
    DESIGN_WAVELENGTH,
    DISTORTIONS,
    Distortion,
    DistortionRow,
    Section,
    Wrinkle,
    beside_sections,
    distortion,
    distortion_table,
    low_passed,
    section_across,
    worst_wrinkles,
)

if TYPE_CHECKING:
    from seatlook.pbr import Picture

CHECKER = 0.010  # [m] side of the squares
_STEPS = (1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0)  # ends of ranges, so that covers share them
_SHOWN = 0.99  # share of the faces whose value lies inside the range

# name -> unit, factor to it, meaning
DISTORTION_MAPS: Mapping[str, tuple[str, float, str]] = MappingProxyType(
    {
        "stretch_along": ("%", 100.0, "stretch of the texture along the warp"),
        "stretch_across": ("%", 100.0, "stretch of the texture across the warp"),
        "shear_deg": ("deg", 1.0, "how far warp and weft are from a right angle"),
        "grain_drift_deg": ("deg", 1.0, "turn of the grain against its panel's mean direction"),
    }
)
NET = "valleys that the design does not ask for: a trench or bolster root is no wrinkle"


@dataclass(frozen=True, slots=True, kw_only=True)
class Findings:
    """What was found on one cover.

    Parameters
    ----------
    worst : the five worst wrinkles, the worst first
    sections : the height profile across each of them, the intended shape beside it
    distortion, distortion_rows : of the texture, per face and per zone
    """

    worst: tuple[Wrinkle, ...]
    sections: tuple[Section, ...]
    distortion: Distortion
    distortion_rows: tuple[DistortionRow, ...]


def find(solution: Solution, indices: WrinkleMap, *, count: int = 5) -> Findings:
    """Rank the worst wrinkles, cut across them, and measure the distortion of the texture."""
    worst = worst_wrinkles(solution, indices, count=count)
    # The low pass is the dearest step, and nobody looks at its shape but beside a section.
    beside = beside_sections(solution.cover, worst, 1.5 * DESIGN_WAVELENGTH)
    design = low_passed(solution.cover, solution.positions, within=beside)
    found = distortion(solution)
    return Findings(
        worst=worst,
        sections=tuple(section_across(solution, w, design=design) for w in worst),
        distortion=found,
        distortion_rows=distortion_table(solution, found),
    )


def write_findings(findings: Findings, out: Path, *, distortion: bool = True) -> tuple[str, ...]:
    """Write ``worst.csv``, ``sections.csv`` and ``distortion.csv``; return their names."""
    rows = [worst_row(k, w) for k, w in enumerate(findings.worst, 1)]
    heads = tuple(rows[0]) if rows else ("rank",)
    io.write_table(out / "worst.csv", heads, [tuple(row.values()) for row in rows])
    io.write_table(
        out / "sections.csv",
        ("rank", "along_mm", "height_mm", "intended_mm"),
        [
            (k, 1e3 * s, 1e3 * z, 1e3 * meant)
            for k, cut in enumerate(findings.sections, 1)
            if cut.intended is not None
            for s, z, meant in zip(cut.along, cut.height, cut.intended, strict=True)
        ],
    )
    if not distortion:
        return "worst.csv", "sections.csv"
    io.write_table(
        out / "distortion.csv",
        ("zone", "measure", "mean", "p05", "p95"),
        [tuple(asdict(row).values()) for row in findings.distortion_rows],
    )
    return "worst.csv", "sections.csv", "distortion.csv"


def worst_row(rank: int, w: Wrinkle) -> dict[str, str | int | float | None]:
    """Return one wrinkle as key -> value, units in the keys."""
    x, y, z = (1e3 * w.position).tolist()
    u, v = (1e3 * w.uv).tolist()
    return {
        "rank": rank,
        "panel": w.panel,
        "zone": w.zone,
        "cause": w.cause,
        "stretch_share": w.stretch_share,
        "length_mm": 1e3 * w.length,
        "width_mm": 1e3 * w.width,
        "depth_mm": 1e3 * w.depth,
        "w2_max": w.w2_max,
        "w2_area_cm2": 1e4 * w.w2_area,
        "x_mm": x,
        "y_mm": y,
        "z_mm": z,
        "u_mm": u,
        "v_mm": v,
        "near": f"{w.near_kind} {w.near}".strip() or None,
        "distance_mm": 1e3 * w.distance if np.isfinite(w.distance) else None,
        "ease_percent": 100 * w.ease if w.near_kind == "seam" else None,
        "advice": w.advice,
    }


def draw_findings(
    findings: Findings,
    solution: Solution,
    camera: Camera,
    out: Path,
    say: Progress | None = None,
) -> MappingProxyType[str, tuple[str, Picture]]:
    """Draw the maps of distortion and a checker; return name -> (path below ``out``, picture)."""
    pictures = {}
    for name, (unit, factor, meaning) in DISTORTION_MAPS.items():
        if say is not None:
            say("map", name=name)
        values = factor * DISTORTIONS[name](findings.distortion)
        end = round_end(values)
        picture = pbr.render_map(
            solution, values, camera=camera, title=meaning, unit=unit, value_range=(-end, end)
        )
        pictures[name] = (f"maps/{name.removesuffix('_deg')}.png", picture)
    pictures["checker"] = (
        "maps/checker.png",
        pbr.render_checker(solution, camera=camera, size=CHECKER),
    )
    for path, picture in pictures.values():
        picture.save(out / path)
    return MappingProxyType(pictures)


def draw_net(
    net: FloatArray, solution: Solution, camera: Camera, out: Path, *, top: float
) -> tuple[str, Picture]:
    """Draw ``w2_net`` (m,) from 0 to ``top``, the range of W2 beside it."""
    picture = pbr.render_map(
        solution, net, camera=camera, title=f"W2 net: {NET}", unit="1", value_range=(0.0, top)
    )
    path = "maps/w2_net.png"
    picture.save(out / path)
    return path, picture


def round_end(values: FloatArray) -> float:
    """Return the first of 1, 2, 5, 10, ... that 99 % of the values stay within, either sign.

    Examples
    --------
    >>> round_end(np.array([0.3, -4.0, np.nan]))
    5.0
    """
    known = np.abs(values[np.isfinite(values)])
    most = float(np.quantile(known, _SHOWN)) if len(known) else 0.0
    return next((step for step in _STEPS if most <= step), _STEPS[-1])
