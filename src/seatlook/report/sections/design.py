"""The finished shape against its design on the page: by zone, and where the seams lie."""

from __future__ import annotations

from seatlook.chain.evaluation import Evaluation
from seatlook.model.table import Table
from seatlook.model.zones import FREE_EDGE
from seatlook.report.page.types import DesignSection
from seatlook.results.gap import ZoneGap

DISTANCE_HEADS = (
    "zone",
    "mean [mm]",
    "rms [mm]",
    "95 % within [mm]",
    "lowest [mm]",
    "highest [mm]",
    "measured [%]",
)


def design_section(evaluation: Evaluation) -> DesignSection | None:
    """Gather the section; None where the scene names no design surface."""
    design, assessment = evaluation.case.scene.design, evaluation.case.assessment
    if design is None:
        return None
    return DesignSection(
        zones=distance_table(assessment.zone_deviations),
        seams=Table(
            heads=("seam", "length [mm]", "mean [mm]", "largest [mm]"),
            rows=tuple(
                (
                    row.seam,
                    1e3 * row.length,
                    None if row.mean is None else 1e3 * row.mean,
                    None if row.largest is None else 1e3 * row.largest,
                )
                for row in sorted(assessment.seam_lines, key=lambda row: -(row.largest or 0.0))
            ),
        ),
        visible=design.visible,
    )


def distance_table(rows: tuple[ZoneGap, ...]) -> Table:
    """Zones, the one farthest off first, without the free edges."""
    return Table(
        heads=DISTANCE_HEADS,
        rows=tuple(
            (
                row.zone,
                1e3 * row.mean,
                1e3 * row.rms,
                1e3 * row.p95,
                1e3 * row.lowest,
                1e3 * row.highest,
                100 * row.measured,
            )
            for row in sorted(rows, key=lambda row: -row.rms)
            if row.zone != FREE_EDGE
        ),
    )
