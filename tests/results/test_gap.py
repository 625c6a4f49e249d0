"""The gap between a cover and its foam."""

import dataclasses

import numpy as np
import pytest

from seatlook.errors import InputError
from seatlook.results.gap import gap, zone_gaps
from support.covers import cover, flat_foam, foam, sheet, sphere
from support.io_samples import as_placed


def solved(height, *, zone=None):
    """A level sheet of t = 1 mm, unsolved, whose mid surface has this height(x) over level foam."""
    X, T, x = sheet(0.16, 0.08, 0.01, at=(-0.08, -0.04))
    x[:, 2] = height(x[:, 0])
    c = cover([(X, T, x)], foam=flat_foam(), h=0.01)
    if zone is not None:
        right = (x[T].mean(axis=1)[:, 0] > 0).astype(np.int64)
        c = dataclasses.replace(c, zone=right, zone_names=("left", "right", "empty"))
    return as_placed(c)


def test_half_a_thickness_above_the_foam_is_where_it_should_be():
    gaps = gap(solved(lambda x: 0.0005 + 0 * x))
    np.testing.assert_allclose(gaps, 0.0, atol=1e-5)


@pytest.mark.parametrize("height", [0.004, -0.003])
def test_above_and_pressed_in(height):
    gaps = gap(solved(lambda x: height + 0 * x))
    np.testing.assert_allclose(gaps, height - 0.0005, atol=1e-5)


def test_coarse_faces_on_a_sphere_are_not_below_it():
    """Vertices 0.5 mm above a sphere of 60 mm; the faces' middles lie up to 2 mm inside it."""
    X, T, x = sheet(0.08, 0.08, 0.02, at=(-0.04, -0.04))
    x[:, 2] = 0.06
    x *= 0.0605 / np.linalg.norm(x, axis=1)[:, None]
    s = as_placed(cover([(X, T, x)], foam=foam(*sphere(0.06, 5)), h=0.02))
    np.testing.assert_allclose(gap(s), 0.0, atol=1e-4)


def test_zones_are_weighted_by_area():
    s = solved(lambda x: 0.0005 + np.where(x > 0, 0.1 * x, 0.0), zone=True)
    gaps = gap(s)
    left, right = zone_gaps(s, gaps)
    assert (left.zone, right.zone) == ("left", "right")
    assert left.area + right.area == pytest.approx(0.16 * 0.08)
    assert left.measured == right.measured == 1.0
    # Faces across the border have a corner on the ramp.
    assert left.rms < 3e-5
    # A ramp from 0 to 8 mm over 80 mm: mean 4 mm, rms 8 / sqrt(3) mm.
    assert right.mean == pytest.approx(0.004, rel=0.03)
    assert right.rms == pytest.approx(0.008 / np.sqrt(3), rel=0.03)
    assert right.lowest < 0.0008
    assert right.highest == pytest.approx(0.008, abs=0.0007)


def test_a_cover_without_foam_is_refused():
    s = solved(lambda x: 0 * x)
    with pytest.raises(InputError, match="foam: got nothing, expected a cover with a foam"):
        gap(dataclasses.replace(s, cover=dataclasses.replace(s.cover, foam=None)))


def test_what_is_far_from_the_foam_is_not_known():
    s = solved(lambda x: np.where(x > 0, 0.2, 0.0005), zone=True)
    gaps = gap(s)
    right = s.cover.zone == 1
    assert np.isnan(gaps[right]).all()
    (left,) = zone_gaps(s, gaps)
    assert left.zone == "left"
    assert 0.8 < left.measured < 1.0
    assert abs(np.nanmedian(gaps)) < 1e-5
