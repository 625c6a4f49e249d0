"""The first sentences of a page: does it wrinkle, where, why, and is it visible."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from seatlook.chain.assess import Assessment
from seatlook.model.table import number
from seatlook.model.zones import FREE_EDGE
from seatlook.report.page.types import Check

_MOSTLY = 0.6  # share of W2 from which one cause is named alone


def wrinkled(assessment: Assessment) -> Iterator[str]:
    """Where W2 is above 1, and why; free edges, which are clamped or trimmed, do not count."""
    inner = [row for row in assessment.zones if row.zone != FREE_EDGE]
    if not inner:
        return
    share = assessment.share_above_one
    if share == 0:
        worst = max(inner, key=lambda row: row["w2_p95"])
        yield (
            "W2 is nowhere above 1: no valley is as sharp as the threshold. Highest: "
            f"{worst.zone}, where 95 % of the area is below {number(worst['w2_p95'])}."
        )
        return
    worst = max(inner, key=lambda row: row["w2_area_share"] * row.area)
    yield (
        f"W2 is above 1 on {number(100 * share)} % of the cover, most in {worst.zone}: "
        f"{number(100 * worst['w2_area_share'])} % of it, {_cause(worst.stretch_share)}."
    )


def _cause(stretch_share: float) -> str:
    if stretch_share >= _MOSTLY:
        return "by stretch one way"
    if stretch_share <= 1 - _MOSTLY:
        return "by excess fabric"
    return "by stretch and excess fabric equally"


def seen(cells: Mapping[tuple[str, str], float]) -> Iterator[str]:
    """Which cell (texture, rig) shows the wrinkles most, and which texture hides them best."""
    if not cells:
        return
    texture, rig = max(cells, key=lambda cell: cells[cell])
    yield f"Most visible: {texture} under {rig}, VWI {number(cells[texture, rig])}."
    worst: dict[str, float] = {}
    for (name, _), value in cells.items():
        worst[name] = max(value, worst.get(name, value))
    if len(worst) > 1:
        least = min(worst, key=lambda name: worst[name])
        yield f"Least visible: {least}, VWI {number(worst[least])} under its worst light."


def missed(checks: Sequence[Check]) -> Iterator[str]:
    """Limits of [accept] that are missed."""
    names = [f"{c.name} is {c.value}, the limit is {c.limit}" for c in checks if not c.kept]
    if names:
        yield f"Missed: {'; '.join(names)}."
