"""Difference of two covers: same mesh, another mesh, another place, a panel that is not there."""

import dataclasses

import numpy as np
import pytest

from seatlook.chain.draw import round_end
from seatlook.errors import InputError
from seatlook.results.difference import difference, zone_differences
from support.wrinkle_samples import SIZE, shaped, wave


def field(solution, slope):
    cover = solution.cover
    return slope * (cover.rest[cover.faces].mean(axis=1)[:, 0] % 0.2) / SIZE


def test_on_the_same_mesh_it_is_exact():
    solution = shaped(wave(0.0, 0.06))
    a, b = field(solution, 3.0), field(solution, 1.0)
    assert (difference(solution, a, solution, b) == a - b).all()


@pytest.mark.parametrize("kind", ["uns", "cross"])
def test_on_another_mesh_it_is_what_lies_on_the_same_place(kind):
    one, other = shaped(wave(0.0, 0.06)), shaped(wave(0.0, 0.06), kind=kind, h=0.004)
    result = difference(one, field(one, 3.0), other, field(other, 1.0))
    # The nearest vertex is at most 0.7 h away, on a slope of 1 per 120 mm.
    np.testing.assert_allclose(result, field(one, 2.0), atol=0.7 * 0.004 / SIZE + 1e-9)


def test_a_panel_that_is_not_there_has_none():
    two, one = shaped(wave(0.0, 0.06), panels=2), shaped(wave(0.0, 0.06), kind="cross")
    result = difference(two, field(two, 1.0), one, field(one, 1.0))
    assert np.isnan(result[two.cover.panel == 1]).all()
    assert np.isfinite(result[two.cover.panel == 0]).all()


def test_a_panel_that_lies_elsewhere_on_the_pattern_is_laid_on_it():
    one, other = shaped(wave(0.0, 0.06)), shaped(wave(0.0, 0.06), kind="cross")
    moved = dataclasses.replace(other.cover, rest=other.cover.rest + np.array([0.4, 0.1]))
    result = difference(
        one, field(one, 1.0), dataclasses.replace(other, cover=moved), field(other, 1.0)
    )
    np.testing.assert_allclose(result, 0.0, atol=0.7 * 0.005 / SIZE + 1e-9)


def test_zones_are_compared_by_their_means():
    one, other = shaped(wave(0.0, 0.06), panels=2), shaped(wave(0.0, 0.06), kind="right")
    (row,) = zone_differences(one, field(one, 3.0), other, field(other, 1.0))
    assert row.zone == "P0"
    assert (row.mean, row.other) == pytest.approx((1.5, 0.5), rel=1e-6)
    assert row.difference == pytest.approx(1.0)


def test_values_of_another_cover_are_refused():
    one = shaped(wave(0.0, 0.06))
    with pytest.raises(InputError, match=r"values: got shape \(3,\), expected"):
        difference(one, np.zeros(3), one, np.zeros(len(one.cover.faces)))


def test_ranges_end_on_round_numbers():
    assert round_end(np.array([])) == 1.0
    assert round_end(np.full(5, -1.5)) == 2.0
    assert round_end(np.full(5, 1e6)) == 100.0
