"""Points that gather light share it with those beside them."""

import numpy as np
import pytest

from seatlook.pbr.shading.sharing import neighbours


def strip(around, n=41):
    """Points in a row, 7 mm apart, on an even surface."""
    points = np.column_stack([0.007 * np.arange(n), np.zeros(n), np.zeros(n)])
    pairs = np.column_stack([np.arange(n - 1), np.arange(1, n)])
    return neighbours(points, np.tile([0.0, 0.0, 1.0], (n, 1)), pairs, np.full(n, around))


def test_a_single_point_does_not_glow():
    values = np.ones((41, 1))
    values[20] = 100.0
    assert strip(np.inf).trimmed(values).max() == 1.0


def test_what_is_even_or_rises_evenly_stays():
    even, slope = np.full((41, 3), 7.0), np.linspace(0, 1, 41)[:, None]
    beside = strip(1.0)
    np.testing.assert_allclose(beside.shared(beside.trimmed(even), times=9), even)
    np.testing.assert_allclose(beside.shared(slope, times=5)[8:-8], slope[8:-8], atol=1e-12)


def test_noise_gets_less_where_all_see_the_same():
    values = np.random.default_rng(0).normal(size=(41, 1))
    assert strip(np.inf).shared(values, times=24)[8:-8].std() < 0.3 * values.std()


@pytest.mark.parametrize("around", [0.003, 0.007])
def test_points_close_to_what_surrounds_them_keep_their_own(around):
    values = np.random.default_rng(0).normal(size=(41, 1))
    np.testing.assert_allclose(strip(around).shared(values, times=24), values)


def test_no_trust_across_a_bend():
    points = np.array([[0.0, 0.0, 0.0], [0.007, 0.0, 0.0]])
    normals = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]])
    got = neighbours(points, normals, np.array([[0, 1]]), np.full(2, np.inf))
    assert got.trust.max() == 0.0
