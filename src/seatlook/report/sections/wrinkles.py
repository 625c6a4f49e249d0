"""The page's part on wrinkles: the worst five, sections across them, distortion of the texture."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from seatlook.chain.evaluation import Evaluation, surface
from seatlook.chain.findings import (
    CHECKER,
    DISTORTION_MAPS,
    NET,
    Findings,
    draw_findings,
    draw_net,
    find,
    write_findings,
)
from seatlook.model import Camera
from seatlook.model.table import Table, number
from seatlook.pbr import Picture
from seatlook.report.page.chart import HEIGHT, WIDTH, Tick
from seatlook.report.page.types import MapView, Profile, Spot, WrinkleSection
from seatlook.wrinkle import Section, map_top, w2_net

_LABELS = {
    "stretch_along": "Stretch along the grain",
    "stretch_across": "Stretch across the grain",
    "shear_deg": "Shear",
    "grain_drift_deg": "Grain drift",
}


def wrinkle_section(evaluation: Evaluation) -> WrinkleSection:
    """Find, draw and write what stands in the section, into the evaluation's folder.

    Raises
    ------
    NoOffscreenContext, RenderError
    """
    solution, out = evaluation.solution, evaluation.folder
    found = find(solution, evaluation.indices)
    maps, files = tuple(_maps(evaluation, found)), write_findings(found, out)
    return section_of(found, evaluation.camera, maps, files)


def section_of(
    found: Findings, camera: Camera, maps: tuple[MapView, ...], files: tuple[str, ...]
) -> WrinkleSection:
    """Put findings in tables and charts; ``maps`` and ``files`` lie beside the page already."""
    return WrinkleSection(
        worst=_worst(found),
        profiles=tuple(
            profile(f"Wrinkle {k}, {w.panel}", cut)
            for k, (w, cut) in enumerate(zip(found.worst, found.sections, strict=True), 1)
        ),
        distortion=_distortion(found),
        maps=maps,
        files=files,
        spots=tuple(_spots(camera, found)),
    )


def _spots(camera: Camera, found: Findings) -> Iterator[Spot]:
    """Pixels of the worst wrinkles, of those inside the picture."""
    for rank, wrinkle in enumerate(found.worst, 1):
        x, y = camera.pixel(wrinkle.position)
        if 0 <= x < camera.size[0] and 0 <= y < camera.size[1]:
            yield Spot(label=f"wrinkle {rank}", x=round(x, 1), y=round(y, 1))


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


def _worst(found: Findings) -> Table:
    return Table(
        heads=(
            "", "panel", "length [mm]", "width [mm]", "depth [mm]", "W2 largest", "cause",
            "stretch [% of W2]", "nearest", "away [mm]", "pattern u, v [mm]", "advice",
        ),
        rows=tuple(
            (
                str(k), w.panel, 1e3 * w.length, 1e3 * w.width, 1e3 * w.depth, w.w2_max, w.cause,
                100 * w.stretch_share, f"{w.near_kind} {w.near}", 1e3 * w.distance,
                ", ".join(f"{1e3 * v:.0f}" for v in w.uv), w.advice,
            )
            for k, w in enumerate(found.worst, 1)
        ),
    )  # fmt: skip


def _distortion(found: Findings) -> Table:
    """One row per zone: mean, and from the 5th to the 95th percentile, without free edges."""
    zones: dict[str, list[str | float]] = {}
    for row in found.distortion_rows:
        _, factor, _ = DISTORTION_MAPS[row.measure]
        low, high = factor * row.p05, factor * row.p95
        zones.setdefault(row.zone, []).extend(
            (factor * row.mean, f"{low:.2f} to {high:.2f}".replace("-", "−").replace(" ", "\u00a0"))
        )
    heads = ["zone"]
    for name, (unit, _, _) in DISTORTION_MAPS.items():
        heads += [f"{_LABELS[name].lower()} [{unit}]", "5 to 95 %"]
    return Table(
        heads=tuple(heads),
        rows=tuple(
            (zone, *cells, *[None] * (len(heads) - 1 - len(cells)))
            for zone, cells in zones.items()
            if zone != "free edge"
        ),
    )


def _maps(evaluation: Evaluation, found: Findings) -> Iterator[MapView]:
    solution, out, camera = evaluation.solution, evaluation.folder, evaluation.camera
    top = map_top(evaluation.indices)
    net = w2_net(surface(evaluation.scene, solution, evaluation.indices))
    path, picture = draw_net(net, solution, camera, out, top=top)
    low, high = picture.value_range
    yield MapView(name="W2 net", image=path, low=low, high=high, meaning=NET)
    yield from distortion_views(draw_findings(found, solution, camera, out))


def distortion_views(pictures: Mapping[str, tuple[str, Picture]]) -> Iterator[MapView]:
    """Name the pictures of ``draw_findings``."""
    for name, (path, picture) in pictures.items():
        low, high = picture.value_range
        if name == "checker":
            size = number(1e3 * CHECKER)
            meaning = f"squares that are {size} mm wide on the flat pattern"
            yield MapView(
                name="Checker", image=path, low=low, high=high, unit="mm", meaning=meaning
            )
        else:
            unit, _, meaning = DISTORTION_MAPS[name]
            yield MapView(
                name=_LABELS[name], image=path, low=low, high=high, unit=unit, meaning=meaning
            )
