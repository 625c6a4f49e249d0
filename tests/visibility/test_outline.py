"""How far a place is from its panel's outline, and which waves are wrinkles there."""

import numpy as np
import pytest

from seatlook.mesh.kinematics import principal_values
from seatlook.visibility.outline import cutoffs, outline_distance
from support.reference.lit_sheets import flat, sheet

SIDE = 0.4


@pytest.fixture(scope="module")
def cover():
    return sheet(flat, size=SIDE, steps=40).cover


def test_distance_is_that_to_the_nearest_side(cover):
    expected = (SIDE / 2 - np.abs(cover.rest)).min(axis=1)
    np.testing.assert_allclose(outline_distance(cover), expected, atol=1e-12)


def test_panels_over_each_other_in_the_flat_keep_their_own_outlines():
    """The seam in the middle counts for both panels, however they lie."""
    both = sheet(flat, size=SIDE, steps=40, panels=2).cover
    left = both.rest[:, 0] < -1e-9
    to_seam = np.abs(both.rest[left, 0])
    expected = np.minimum((SIDE / 2 - np.abs(both.rest[left])).min(axis=1), to_seam)
    np.testing.assert_allclose(outline_distance(both)[left], expected, atol=1e-12)


@pytest.mark.parametrize(
    ("place", "along_x", "along_y"),
    [
        ((0.0, 0.0), 0.1, 0.1),  # far from all sides: the same in all directions
        ((0.165, 0.0), 0.035, 0.1),  # beside one: shorter across, whole along
        ((0.165, 0.145), 0.035, 0.055),  # in a corner: what both sides leave
    ],
)
def test_a_wave_is_no_longer_than_the_way_to_the_outline(cover, place, along_x, along_y):
    centre = cover.rest[cover.faces].mean(axis=1)
    near = np.linalg.norm(centre - place, axis=1) < 0.012
    tensor = cutoffs(cover, 0.1)[near].mean(axis=0)
    assert tensor[0, 0] == pytest.approx(along_x, abs=0.01)
    assert tensor[1, 1] == pytest.approx(along_y, abs=0.01)


def test_no_length_is_above_the_cutoff_or_below_an_element(cover):
    major, minor = principal_values(cutoffs(cover, 0.1))
    assert major.max() <= 0.1 + 1e-12
    assert minor.min() >= cover.element_size - 1e-12
