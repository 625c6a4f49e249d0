"""The page's part on wrinkles: the worst five, sections across them, distortion of the texture."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from seatlook.chain.assess import Assessment
from seatlook.chain.draw import DISTORTION_MAPS
from seatlook.chain.evaluation import Evaluation
from seatlook.chain.framing import Mark, marks
from seatlook.model import Camera
from seatlook.model.table import Table, number
from seatlook.model.zones import FREE_EDGE
from seatlook.report.page.chart import HEIGHT, WIDTH, Tick
from seatlook.report.page.types import MapView, Profile, Spot, WrinkleSection
from seatlook.report.sections.maps import map_view
from seatlook.wrinkle import Section, Wrinkle, advice_on


def wrinkle_section(evaluation: Evaluation) -> WrinkleSection:
    """Gather the section of an evaluation."""
    return section_of(
        evaluation.case.assessment,
        evaluation.camera,
        maps=tuple(map(map_view, evaluation.distortion)),
        files=evaluation.files,
    )


def section_of(
    assessment: Assessment,
    camera: Camera,
    *,
    maps: tuple[MapView, ...] = (),
    files: tuple[str, ...] = (),
    count: int | None = None,
    distortion: bool = True,
) -> WrinkleSection:
    """Put the worst wrinkles in tables and charts; ``maps`` and ``files`` are there already.

    Parameters
    ----------
    count : of the worst wrinkles; None for all that the assessment lists
    """
    wrinkles, sections = assessment.wrinkles[:count], assessment.sections[:count]
    found = marks(assessment.solution, [w.position for w in wrinkles], camera)
    return WrinkleSection(
        worst=_worst(assessment, wrinkles, [_view_words(camera, mark) for mark in found]),
        profiles=tuple(
            profile(f"Wrinkle {rank}, {w.panel}", cut)
            for rank, (w, cut) in enumerate(zip(wrinkles, sections, strict=True), 1)
        ),
        distortion=_distortion(assessment) if distortion else None,
        maps=maps,
        files=files,
        spots=tuple(_spots(camera, found)),
    )


def _spots(camera: Camera, found: Sequence[Mark]) -> Iterator[Spot]:
    """Pixels of the worst wrinkles, of those that this camera sees."""
    for rank, mark in enumerate(found, 1):
        if mark.camera is camera:
            yield Spot(label=f"wrinkle {rank}", x=round(mark.x, 1), y=round(mark.y, 1))


def _view_words(camera: Camera, mark: Mark) -> str:
    """In which view a wrinkle is seen."""
    if mark.camera is None:
        return "hidden in every view"
    return "this view" if mark.camera is camera else f"hidden here; see {mark.camera.name}"


def profile(name: str, cut: Section) -> Profile:
    """Scale a section to the chart's area; its length fills the width."""
    along, height = 1e3 * cut.along, 1e3 * cut.height
    meant = height if cut.intended is None else 1e3 * cut.intended
    low, high = min(height.min(), meant.min()), max(height.max(), meant.max())
    span = max(high - low, 1e-3)
    left, width = along[0], along[-1] - along[0]
    # Near an end of the section the 0 would lie on that end's number.
    middle = (0.0,) if min(-along[0], along[-1]) > width / 8 else ()

    def line(z: np.ndarray) -> str:
        x = WIDTH * (along - left) / width
        y = HEIGHT * (high - z) / span
        return " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(x, y, strict=True))

    return Profile(
        name=name,
        cover=line(height),
        intended=line(meant),
        x_ticks=tuple(
            Tick(at=WIDTH * (v - left) / width, label=number(round(float(v), 1)))
            for v in (along[0], *middle, along[-1])
        ),
        y_ticks=tuple(
            Tick(at=HEIGHT * (high - v) / span, label=f"{v:.2f}".replace("-", "−"))
            for v in (high, 0.5 * (low + high), low)
        ),
        exaggeration=float((HEIGHT / span) / (WIDTH / width)),
    )


def _worst(assessment: Assessment, wrinkles: Sequence[Wrinkle], views: Sequence[str]) -> Table:
    return Table(
        heads=(
            "", "kind", "panel", "length [mm]", "width [mm]", "depth [mm]", "excess [mm]",
            "W2 at most", "cause", "stretch [% of W2]", "nearest", "away [mm]",
            "pattern u, v [mm]", "seen in", "advice",
        ),
        rows=tuple(
            (
                str(k), w.kind, w.panel, 1e3 * w.length, 1e3 * w.width, 1e3 * w.depth,
                f"{number(1e3 * w.excess)} ± {number(1e3 * w.scatter)}", w.w2_max, w.cause,
                100 * w.stretch_share, f"{w.near_kind} {w.near}", 1e3 * w.distance,
                ", ".join(f"{1e3 * v:.0f}" for v in w.uv), view,
                advice_on(w, k, assessment.advice),
            )
            for k, (w, view) in enumerate(zip(wrinkles, views, strict=True), 1)
        ),
    )  # fmt: skip


def _distortion(assessment: Assessment) -> Table:
    """One row per zone: mean, and from the 5th to the 95th percentile, without free edges."""
    zones: dict[str, list[str | float]] = {}
    for row in assessment.distortion_rows:
        _, _, factor, _ = DISTORTION_MAPS[row.measure]
        low, high = factor * row.p05, factor * row.p95
        zones.setdefault(row.zone, []).extend(
            (factor * row.mean, f"{low:.2f} to {high:.2f}".replace("-", "−").replace(" ", "\u00a0"))
        )
    heads = ["zone"]
    for label, unit, _, _ in DISTORTION_MAPS.values():
        heads += [f"{label.lower()} [{unit}]", "5 to 95 %"]
    return Table(
        heads=tuple(heads),
        rows=tuple(
            (zone, *cells, *[None] * (len(heads) - 1 - len(cells)))
            for zone, cells in zones.items()
            if zone != FREE_EDGE
        ),
    )
