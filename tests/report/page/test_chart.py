"""Numbers for readers, and curves that lie where their values are."""

from __future__ import annotations

import math

import pytest

from seatlook.model.table import number
from seatlook.report.page.chart import HEIGHT, WIDTH, history_charts


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0"),
        (3, "3"),
        (-0.5, "−0.500"),
        (999.6, "1000"),
        (0.00123, "0.00123"),
        (1234.5, "1234"),
        (2.5e7, "2.50e7"),
        (math.nan, "–"),
        (math.inf, "∞"),
        ("kept", "kept"),
        ("a-b", "a-b"),
    ],
)
def test_numbers(value, text):
    assert number(value) == text


def points(line: str) -> list[tuple[float, float]]:
    return [tuple(map(float, pair.split(","))) for pair in line.split()]


def test_a_decay_over_decades_is_a_straight_line_on_a_logarithmic_axis():
    (chart,) = history_charts({"residual": [1.0, 0.1, 0.01, 0.001]})
    (line,) = chart.lines
    assert points(line) == [
        (pytest.approx(WIDTH * k / 3, abs=0.06), pytest.approx(HEIGHT * k / 3, abs=0.06))
        for k in range(4)
    ]
    assert [t.label for t in chart.y_ticks] == ["1e−3", "1e−2", "1e−1", "1e0"]
    assert (chart.first, chart.last) == (1.0, 0.001)
    assert chart.x_name == "step"


def test_a_linear_column_uses_the_time_axis_and_its_ends():
    (chart,) = history_charts({"time": [0.0, 1.0, 4.0], "energy": [2.0, 3.0, 6.0]})
    assert points(chart.lines[0]) == [(0.0, HEIGHT), (WIDTH / 4, 112.5), (WIDTH, 0.0)]
    assert [t.label for t in chart.x_ticks] == ["0", "2", "4"]
    assert [t.label for t in chart.y_ticks] == ["2", "4", "6"]
    assert chart.x_name == "time [s]"


def test_what_an_axis_cannot_show_breaks_the_line():
    (chart,) = history_charts({"gap": [1.0, 0.0, 1e-4, math.nan, 1e-5, 1e-6]})
    assert [len(points(line)) for line in chart.lines] == [1, 1, 2]


@pytest.mark.parametrize("values", [[], [1.0], [2.0, 2.0], [math.nan, math.nan]])
def test_a_column_that_never_changes_gets_no_chart(values):
    assert history_charts({"gap": values}) == ()
