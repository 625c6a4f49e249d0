"""Maps: the colour of a face is the colour of its value on the bar."""

from __future__ import annotations

import numpy as np
import pytest

from seatlook.errors import InputError
from seatlook.model.colour import srgb_encode
from seatlook.pbr import render_map
from seatlook.pbr.maps.face_map import COLORMAPS, colour_table
from support.reference.lit_sheets import above, flat, sheet

pytestmark = pytest.mark.render
CAMERA = above(size=(160, 120), fov=20)


@pytest.fixture(scope="module")
def solution():
    return sheet(flat, steps=8)


def left_to_right(solution):
    return solution.positions[solution.cover.faces].mean(axis=1)[:, 0]


def code(name, position):
    table = colour_table(name)
    return 255 * srgb_encode(table[round(position * (len(table) - 1))])


@pytest.mark.parametrize("name", COLORMAPS)
def test_lightness_is_even(name):
    """CIE lightness along the bar: rising by even steps, or even on both sides of the middle."""
    y = colour_table(name) @ [0.2126, 0.7152, 0.0722]
    lightness = 116 * np.where(y > 0.008856, np.cbrt(y), 7.787 * y + 16 / 116) - 16
    step = np.diff(lightness)
    if name == "diverging":
        assert (step[:120] > 0).all()
        assert (step[135:] < 0).all()
        assert abs(lightness[0] - lightness[-1]) < 6
        assert lightness[127] > 94
    else:
        assert (step > -0.05).all()


def test_constant_value_takes_its_colour(solution):
    picture = render_map(
        solution,
        np.full(len(solution.cover.faces), 0.25),
        camera=CAMERA,
        title="W2",
        value_range=(0.0, 1.0),
    )
    assert picture.value_range == (0.0, 1.0)
    assert np.abs(picture.pixels[60, 70].astype(float) - code("viridis", 0.25)).max() <= 2


def test_range_around_zero_picks_the_diverging_map(solution):
    values = left_to_right(solution)
    picture = render_map(solution, values, camera=CAMERA, title="W1", value_range=(-0.1, 0.1))
    left, right = picture.pixels[60, 66], picture.pixels[60, 93]
    assert left[2] > left[0]
    assert right[0] > right[2]


def test_default_range_ignores_the_top_percent(solution):
    values = np.ones(len(solution.cover.faces))
    values[0] = 1000.0
    picture = render_map(solution, values, camera=CAMERA, title="t")
    assert picture.value_range == (0.0, 1.0)


def test_nan_is_grey(solution):
    values = np.full(len(solution.cover.faces), np.nan)
    picture = render_map(solution, values, camera=CAMERA, title="t", value_range=(0.0, 1.0))
    r, g, b = picture.pixels[60, 70].astype(int)
    assert r == g == b


def test_bar_is_drawn_and_bytes_repeat(solution, tmp_path):
    values = left_to_right(solution)
    first = render_map(solution, values, camera=CAMERA, title="W1", unit="1", value_range=(-1, 1))
    again = render_map(solution, values, camera=CAMERA, title="W1", unit="1", value_range=(-1, 1))
    assert first.to_png() == again.to_png()
    column = first.pixels[30:90, -48].astype(int)
    assert len(np.unique(column, axis=0)) > 30
    first.save(tmp_path / "w1.png")
    with pytest.raises(InputError, match=r"picture file: got w1\.jpg"):
        first.save(tmp_path / "w1.jpg")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"values": np.zeros(3)}, r"values: got shape \(3,\), expected \(128,\)"),
        ({"value_range": (1.0, 1.0)}, r"value_range: got \(1\.0, 1\.0\), expected low < high"),
        ({"colormap": "viridiss"}, r"colormap: got 'viridiss', .*did you mean 'viridis'"),
    ],
)
def test_bad_input(solution, change, message):
    arguments = {"values": np.zeros(128), "camera": CAMERA, "title": "t", **change}
    with pytest.raises(InputError, match=message):
        render_map(solution, **arguments)
