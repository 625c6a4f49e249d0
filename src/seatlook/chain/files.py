"""What the chain leaves in a folder, under which name, and when a result in it is taken again."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path

from seatlook import io
from seatlook.assembly.digest import content_digest
from seatlook.chain.assess import Assessment
from seatlook.files import file_names
from seatlook.model import Scene, Solution
from seatlook.results.deviation import SeamLine
from seatlook.results.gap import ZoneGap
from seatlook.solver import SETTINGS
from seatlook.wrinkle import DistortionRow, Section, Wrinkle, ZoneRow, advice_on

RESULT, ZONES = "result.npz", "zones.csv"
SHAPE, SEAM_LINES = "shape.csv", "seam-lines.csv"
WORST, SECTIONS, DISTORTION = "worst.csv", "sections.csv", "distortion.csv"
EXCESS, ADVICE = "seam-excess.csv", "advice.csv"

Row = Mapping[str, object]


def reusable(solution: Solution, scene: Scene, *, settings: str = SETTINGS) -> bool:
    """Whether a result may stand for solving a scene: converged, and of all that goes in.

    A result from before the verdict looked where the cover is has no figure of it: it is not taken.

    The digest is of the whole scene with every file it names, seed and element size among it;
    ``settings`` is of the solver, its revision among it.
    """
    return (
        solution.status == "converged"
        and (solution.cover.foam is None or "untouched" in solution.figures)
        and solution.settings == settings
        and of_scene(solution, scene)
    )


def of_scene(solution: Solution, scene: Scene) -> bool:
    """Whether a result was solved for a scene as it now is."""
    return solution.cover.scene_digest == content_digest(scene)


def earlier_result(scene: Scene, path: Path, *, settings: str = SETTINGS) -> Solution | None:
    """Return the result in a file if it may stand for solving the scene."""
    if not path.exists():
        return None
    solution: Solution = io.read_result(path)
    return solution if reusable(solution, scene, settings=settings) else None


def picture_paths(scene: Scene) -> dict[tuple[str, str], str]:
    """Return (texture, rig) -> path of the picture, relative to the folder of a run.

    No two are alike, whatever the names are.
    """
    textures, rigs = file_names(scene.textures), file_names(rig.name for rig in scene.rigs)
    return {
        (texture, rig): f"images/{rigs[rig]}/{textures[texture]}.png"
        for rig in rigs
        for texture in textures
    }


def write_zones(zones: Sequence[ZoneRow], path: Path) -> None:
    """Write the zone table as CSV, one row per zone; empty where a companion is not known."""
    rows = [row.values() for row in zones]
    heads = tuple(dict.fromkeys(head for row in rows for head in row))
    io.write_table(path, heads, [tuple(row.get(head) for head in heads) for row in rows])


def write_shape(assessment: Assessment, out: Path) -> tuple[str, ...]:
    """Write the deviation from the design by zone, and its seams; return the files' names."""
    _write(gap_rows(assessment.zone_deviations), out / SHAPE, heads=("zone",))
    _write(seam_line_rows(assessment.seam_lines), out / SEAM_LINES, heads=("seam",))
    return SHAPE, SEAM_LINES


def write_findings(
    assessment: Assessment, out: Path, *, distortion: bool = True
) -> tuple[str, ...]:
    """Write wrinkles, seams, advice, sections and the distortion; return the files' names."""
    _write(wrinkle_rows(assessment), out / WORST, heads=("rank",))
    _write(stretch_rows(assessment), out / EXCESS, heads=("seam",))
    _write(advice_rows(assessment), out / ADVICE, heads=("action",))
    io.write_table(
        out / SECTIONS,
        ("rank", "along_mm", "height_mm", "intended_mm"),
        [
            point
            for rank, cut in enumerate(assessment.sections, 1)
            for point in _section_points(rank, cut)
        ],
    )
    if not distortion:
        return WORST, EXCESS, ADVICE, SECTIONS
    _write(
        [asdict(row) for row in assessment.distortion_rows],
        out / DISTORTION,
        heads=DistortionRow.__slots__,
    )
    return WORST, EXCESS, ADVICE, SECTIONS, DISTORTION


def gap_rows(zones: Sequence[ZoneGap]) -> list[dict[str, object]]:
    """Zones and their distances, in mm and cm2."""
    return [
        {
            "zone": z.zone,
            "area_cm2": 1e4 * z.area,
            "measured_percent": 100 * z.measured,
            **{f"{n}_mm": 1e3 * getattr(z, n) for n in ("mean", "rms", "p95", "lowest", "highest")},
        }
        for z in zones
    ]


def seam_line_rows(seams: Sequence[SeamLine]) -> list[dict[str, object]]:
    """Seams and how far they lie from the design's, in mm."""
    return [
        {
            "seam": s.seam,
            "length_mm": 1e3 * s.length,
            "mean_mm": None if s.mean is None else 1e3 * s.mean,
            "largest_mm": None if s.largest is None else 1e3 * s.largest,
        }
        for s in seams
    ]


def wrinkle_rows(assessment: Assessment) -> list[dict[str, object]]:
    """Return the worst wrinkles as key -> value, units in the keys, the advice on each last."""
    return [
        _wrinkle_row(rank, w)
        | {
            "criterion": assessment.criteria.words(),
            "advice": advice_on(w, rank, assessment.advice),
        }
        for rank, w in enumerate(assessment.wrinkles, 1)
    ]


def _wrinkle_row(rank: int, w: Wrinkle) -> dict[str, object]:
    x, y, z = (1e3 * w.position).tolist()
    u, v = (1e3 * w.uv).tolist()
    return {
        "rank": rank,
        "kind": w.kind,
        "panel": w.panel,
        "zone": w.zone,
        "cause": w.cause,
        "stretch_share": w.stretch_share,
        "length_mm": 1e3 * w.length,
        "width_mm": 1e3 * w.width,
        "depth_mm": 1e3 * w.depth,
        "excess_mm": 1e3 * w.excess,
        "waves_mm": 1e3 * w.waves,
        "scatter_mm": 1e3 * w.scatter,
        "w2_max": w.w2_max,
        "w2_area_cm2": 1e4 * w.w2_area,
        "x_mm": x,
        "y_mm": y,
        "z_mm": z,
        "u_mm": u,
        "v_mm": v,
        "near": f"{w.near_kind} {w.near}".strip() or None,
        "distance_mm": 1e3 * w.distance if w.near_kind else None,
        "resolved": w.resolved,
    }


def stretch_rows(assessment: Assessment) -> list[dict[str, object]]:
    """Return what every seam has too much, from notch to notch, in the order of the seams."""
    return [
        {
            "seam": s.seam,
            "from": s.begin,
            "to": s.end,
            "longer": s.long_panel,
            "shorter": s.short_panel,
            "length_mm": 1e3 * s.length,
            "excess_mm": 1e3 * s.excess,
            "scatter_mm": 1e3 * s.scatter,
            "excess_percent": 100 * s.share,
            "compression_mm": 1e3 * s.compression,
            "tension_mm": 1e3 * s.tension,
            "waves_mm": 1e3 * s.waves,
            "resolved": s.resolved,
        }
        for s in assessment.stretches
    ]


def advice_rows(assessment: Assessment) -> list[dict[str, object]]:
    """Return what to change, the largest first."""
    return [
        {
            "action": a.action,
            "panel": a.panel,
            "seam": a.seam or None,
            "place": a.place,
            "amount_mm": 1e3 * a.amount,
            "scatter_mm": 1e3 * a.scatter,
            "confidence": a.confidence,
            "wrinkles": " ".join(map(str, a.wrinkles)) or None,
            "advice": a.sentence,
        }
        for a in assessment.advice
    ]


def _section_points(rank: int, cut: Section) -> list[tuple[object, ...]]:
    if cut.intended is None:
        return []
    return [
        (rank, 1e3 * s, 1e3 * z, 1e3 * intended)
        for s, z, intended in zip(cut.along, cut.height, cut.intended, strict=True)
    ]


def _write(rows: Sequence[Row], path: Path, *, heads: Sequence[str] = ("zone",)) -> None:
    """Write rows of one shape; only ``heads`` where there is none."""
    io.write_table(path, tuple(rows[0]) if rows else heads, [tuple(r.values()) for r in rows])
