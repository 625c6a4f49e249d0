"""Visibility over azimuth and elevation of the light, seen from above: where the worst light is."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import matplotlib
import numpy as np

from seatlook import files
from seatlook.model import Camera, FloatArray, direction
from seatlook.model.table import number
from seatlook.report.page.write import environment
from seatlook.visibility.light_search import LOWEST_DEG, WorstLight

RADIUS = 200.0  # of the rim, in SVG units
_STEP_DEG = 5.0
_POWER = 4.0  # of the distance, in the mean between lights tried


@dataclass(frozen=True, slots=True, kw_only=True)
class Patch:
    """Part of the sky: an SVG path, its colour and its visibility."""

    path: str
    colour: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Mark:
    """A light that was tried, where it stands on the chart."""

    x: float
    y: float
    colour: str
    label: str


def write_light_chart(worst: WorstLight, camera: Camera, path: Path, *, title: str) -> None:
    """Write the chart of a search as SVG.

    The rim is the lowest elevation searched, the middle the zenith; the occupant faces down.
    Between the lights tried the colour is a mean weighted by distance, so that the chart claims no
    value that no light had.
    """
    low, high = float(worst.tried[:, 2].min()), float(worst.tried[:, 2].max())
    eye = camera.position - camera.target
    text = (
        environment()
        .get_template("light.svg.j2")
        .render(
            title=title,
            radius=RADIUS,
            low=low,
            high=high,
            patches=_patches(worst.tried, low, high),
            marks=[_mark(a, e, vwi, low, high) for a, e, vwi in worst.tried.tolist()],
            worst=_mark(worst.azimuth_deg, worst.elevation_deg, worst.vwi, low, high),
            worst_angles=(worst.azimuth_deg, worst.elevation_deg),
            eye=place(
                float(np.degrees(np.arctan2(eye[0], -eye[1]))),
                float(np.degrees(np.arcsin(eye[2] / np.linalg.norm(eye)))),
            ),
            rings=[(e, place(0.0, e)[1]) for e in (30, 60)],
            bar=[_colour(share) for share in np.linspace(0.0, 1.0, 32)],
        )
    )
    files.write_text(path, text)


def place(azimuth_deg: float, elevation_deg: float) -> tuple[float, float]:
    """Where a direction stands on the chart, (x, y) with y downward.

    Examples
    --------
    >>> [round(v) for v in place(90.0, LOWEST_DEG)], [round(v) for v in place(0.0, 90.0)]
    ([200, 0], [0, 0])
    """
    radius = RADIUS * (90.0 - elevation_deg) / (90.0 - LOWEST_DEG)
    angle = np.radians(azimuth_deg)
    return float(radius * np.sin(angle)), float(radius * np.cos(angle))


def between(tried: FloatArray, directions: FloatArray) -> FloatArray:
    """Visibility (k,) towards unit vectors (k, 3), from the lights tried (n, 3).

    Shepard's mean: weights fall with the fourth power of the distance; on a light tried it is that
    light's value.
    """
    lights = np.array([direction(a, e) for a, e, _ in tried])
    distance = np.linalg.norm(directions[:, None] - lights, axis=2)
    weight = np.maximum(distance, 1e-6) ** -_POWER
    return np.asarray(weight @ tried[:, 2] / weight.sum(axis=1))


def _patches(tried: FloatArray, low: float, high: float) -> list[Patch]:
    azimuths = np.arange(0.0, 360.0, _STEP_DEG)
    elevations = np.arange(LOWEST_DEG, 90.0, _STEP_DEG)
    cells = [(a, e) for e in elevations for a in azimuths]
    middles = np.array([direction(a + _STEP_DEG / 2, e + _STEP_DEG / 2) for a, e in cells])
    values = between(tried, middles)
    span = max(high - low, 1e-12)
    return [
        Patch(path=_cell(a, e), colour=_colour((value - low) / span))
        for (a, e), value in zip(cells, values, strict=True)
    ]


def _cell(azimuth_deg: float, elevation_deg: float) -> str:
    """Outline of one cell of the sky; cells overlap by a little, so that no line shows."""
    reach = _STEP_DEG * 1.06
    corners = [
        place(azimuth_deg + reach * i, min(elevation_deg + reach * k, 90.0))
        for i, k in ((0, 0), (0.5, 0), (1, 0), (1, 1), (0, 1))
    ]
    return "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in corners) + "Z"


def _mark(azimuth_deg: float, elevation_deg: float, vwi: float, low: float, high: float) -> Mark:
    x, y = place(azimuth_deg, elevation_deg)
    label = (
        f"azimuth {number(round(azimuth_deg))}, elevation {number(round(elevation_deg))}: "
        f"VWI {number(vwi)}"
    )
    return Mark(x=x, y=y, colour=_colour((vwi - low) / max(high - low, 1e-12)), label=label)


def _colour(share: float) -> str:
    return str(matplotlib.colors.to_hex(matplotlib.colormaps["viridis"](float(share))))
