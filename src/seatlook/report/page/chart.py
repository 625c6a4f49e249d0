"""Geometry of the page's small charts; the template draws it, so every text is escaped once."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from seatlook.model.table import number

WIDTH, HEIGHT = 320.0, 150.0  # drawing area of one chart in SVG units


@dataclass(frozen=True, slots=True, kw_only=True)
class Tick:
    """A mark on an axis: its place in SVG units, and its label."""

    at: float
    label: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Chart:
    """One curve: polylines "x,y x,y ..." and the marks of both axes.

    A value that the axis cannot show (nan, or 0 on a logarithmic one) breaks the line.
    """

    name: str
    x_name: str
    lines: tuple[str, ...]
    x_ticks: tuple[Tick, ...]
    y_ticks: tuple[Tick, ...]
    first: float
    last: float


def history_charts(history: Mapping[str, Sequence[float]]) -> tuple[Chart, ...]:
    """One chart for each column that changes, over "time" if given, else over the step number."""
    time = history.get("time")
    charts = []
    for name, values in history.items():
        known = [v for v in values if math.isfinite(v)]
        if name != "time" and known and min(known) < max(known):
            x = list(time) if time is not None else [float(k) for k in range(len(values))]
            charts.append(_chart(name, x, values, "time [s]" if time is not None else "step"))
    return tuple(charts)


def _chart(name: str, x: Sequence[float], y: Sequence[float], x_name: str) -> Chart:
    known = [v for v in y if math.isfinite(v)]
    positive = [v for v in known if v > 0]
    logarithmic = min(known) >= 0 and bool(positive) and max(known) > 100 * min(positive)
    shown = [math.log10(v) if v > 0 else math.nan for v in y] if logarithmic else list(y)
    y_range = _span([v for v in shown if math.isfinite(v)])
    x_range = _span(x)
    if logarithmic:
        y_range = math.floor(y_range[0]), math.ceil(y_range[1])
        every = max(1, round((y_range[1] - y_range[0]) / 5))
        marks = [float(e) for e in range(int(y_range[0]), int(y_range[1]) + 1, every)]
        labels = [f"1e{int(e)}".replace("-", "−") for e in marks]
    else:
        marks = [y_range[0], (y_range[0] + y_range[1]) / 2, y_range[1]]
        labels = [number(v) for v in marks]
    across = [_place(v, x_range, WIDTH) for v in x]
    down = [HEIGHT - _place(v, y_range, HEIGHT) for v in shown]
    return Chart(
        name=name,
        x_name=x_name,
        lines=_polylines(across, down),
        x_ticks=tuple(
            Tick(at=_place(v, x_range, WIDTH), label=number(v))
            for v in (x_range[0], sum(x_range) / 2, x_range[1])
        ),
        y_ticks=tuple(
            Tick(at=HEIGHT - _place(v, y_range, HEIGHT), label=label)
            for v, label in zip(marks, labels, strict=True)
        ),
        first=known[0],
        last=known[-1],
    )


def _span(values: Sequence[float]) -> tuple[float, float]:
    low, high = min(values), max(values)
    return (low, high) if low < high else (low - 0.5, high + 0.5)


def _place(value: float, span: tuple[float, float], length: float) -> float:
    return length * (value - span[0]) / (span[1] - span[0])


def _polylines(across: Sequence[float], down: Sequence[float]) -> tuple[str, ...]:
    runs: list[list[str]] = [[]]
    for u, v in zip(across, down, strict=True):
        if math.isfinite(v):
            runs[-1].append(f"{u:.1f},{v:.1f}")
        elif runs[-1]:
            runs.append([])
    return tuple(" ".join(run) for run in runs if run)
