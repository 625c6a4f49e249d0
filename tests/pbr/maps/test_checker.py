"""The checker: squares of the wanted size, and stretched with the cover."""

import numpy as np
import pytest

from seatlook.errors import InputError
from seatlook.model import Camera
from seatlook.pbr import render_checker
from support.wrinkle_samples import SIZE, shaped

FAR = Camera(
    name="above", position=np.array([0.06, 0.06, 8.0]), target=np.array([0.06, 0.06, 0.0]),
    up=np.array([0.0, 1.0, 0.0]), vertical_fov_deg=1.3, size=(160, 160),
)  # fmt: skip


def edges(picture, axis):
    """Changes from dark to light and back, along a line through the middle of a row of squares."""
    pixels = picture.pixels.mean(axis=2)
    line = pixels[84] if axis == 0 else pixels[20:, 84]  # the title is above
    cover = (line > 40) & (np.abs(line - pixels[-1, 0]) > 8)  # a corner shows the surround
    dark = line[cover] < 128
    return int(np.count_nonzero(dark[1:] != dark[:-1]))


def flat(stretch=1.0):
    return shaped(lambda X: np.column_stack([X[:, 0] * stretch, X[:, 1], 0 * X[:, 0]]))


@pytest.mark.render
def test_squares_are_as_large_as_asked():
    """12 squares of 10 mm on 120 mm; the pattern starts at 10 mm, on a corner of the squares."""
    picture = render_checker(flat(), camera=FAR)
    assert (edges(picture, 0), edges(picture, 1)) == (11, 11)
    assert picture.value_range == (0.0, 10.0)


@pytest.mark.render
def test_squares_are_stretched_with_the_cover():
    narrow = render_checker(flat(0.5), camera=FAR)
    assert edges(narrow, 0) == 11


@pytest.mark.render
def test_stripes_run_along_the_warp():
    picture = render_checker(flat(), camera=FAR, motif="stripe", size=SIZE / 6)
    assert edges(picture, 0) == 0
    # 20 mm wide, from 10 mm: half a stripe, five whole ones, half a stripe.
    assert edges(picture, 1) == 6


def test_bad_wishes_are_named():
    with pytest.raises(InputError, match="size: got 0, expected above 0"):
        render_checker(flat(), camera=FAR, size=0)
    with pytest.raises(InputError, match="motif: got 'dots', expected 'checker' or 'stripe'"):
        render_checker(flat(), camera=FAR, motif="dots")
