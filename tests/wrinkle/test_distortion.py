"""Distortion of the texture under deformations written down by hand."""

import numpy as np
import pytest

from seatlook.wrinkle import DISTORTIONS, distortion, distortion_table
from support.wrinkle_samples import shaped


def linear(matrix):
    return lambda X: np.column_stack([X @ np.asarray(matrix).T, np.zeros(len(X))])


def test_stretch_and_shear():
    """Warp 4 % longer, weft 3 % shorter, sheared by 5 degrees."""
    gamma = np.radians(5.0)
    warp, weft = np.array([1.04, 0.0]), 0.97 * np.array([np.sin(gamma), np.cos(gamma)])
    found = distortion(shaped(linear(np.column_stack([warp, weft]))))
    np.testing.assert_allclose(found.stretch_along, 0.04, atol=1e-12)
    np.testing.assert_allclose(found.stretch_across, -0.03, atol=1e-12)
    np.testing.assert_allclose(np.degrees(found.shear), 5.0, atol=1e-9)
    np.testing.assert_allclose(found.grain_drift, 0.0, atol=1e-12)


def test_turning_the_whole_panel_is_no_distortion():
    q = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))[0]
    found = distortion(shaped(lambda X: np.column_stack([X, 0 * X[:, :1]]) @ q.T))
    for name, field in DISTORTIONS.items():
        np.testing.assert_allclose(field(found), 0.0, atol=1e-9, err_msg=name)


def test_grain_drift_has_size_and_sign():
    """A fan: the grain turns counter-clockwise with y, by 10 degrees from rim to rim."""
    turn = np.radians(10.0)

    def fan(X):
        a = turn * (X[:, 1] / 0.12 - 0.5)
        r = 1.0 + X[:, 0]
        return np.column_stack([r * np.cos(a), r * np.sin(a), np.zeros(len(X))])

    solution = shaped(fan)
    y = solution.cover.rest[solution.cover.faces].mean(axis=1)[:, 1]
    drift = np.degrees(distortion(solution).grain_drift)
    # Half a row of elements is 0.2 degrees.
    np.testing.assert_allclose(drift, 10.0 * (y / 0.12 - 0.5), atol=0.2)


def test_a_rolled_panel_keeps_its_grain():
    def roll(X):
        a = X[:, 1] / 0.05
        return np.column_stack([X[:, 0], 0.05 * np.sin(a), 0.05 * np.cos(a)])

    # Facets of a cylinder tilt by (h / r)^2 / 24, 4e-4.
    np.testing.assert_allclose(distortion(shaped(roll)).grain_drift, 0.0, atol=4e-4)


def test_a_panel_rolled_up_along_its_grain_has_faces_without_a_direction():
    """Beyond a right angle the warp runs against the panel's mean direction."""

    def roll(X):
        a = (X[:, 0] - 0.06) / 0.03
        return np.column_stack([0.03 * np.sin(a), X[:, 1], 0.03 * np.cos(a)])

    solution = shaped(roll)
    a = (solution.cover.rest[solution.cover.faces].mean(axis=1)[:, 0] - 0.06) / 0.03
    drift = distortion(solution).grain_drift
    assert np.isnan(drift[np.abs(np.cos(a)) < 0.15]).all()
    assert np.isfinite(drift[np.abs(np.cos(a)) > 0.25]).all()
    np.testing.assert_allclose(np.cos(drift[a > 1.9]), -1.0, atol=0.01)
    # Facets are inclined by up to h / (2 r) to the surface.
    np.testing.assert_allclose(drift[np.abs(a) < 1.2], 0.0, atol=0.083)


def test_table_per_zone():
    rows = distortion_table(solution := shaped(linear(np.diag([1.02, 1.0])), panels=2),
                            distortion(solution))  # fmt: skip
    assert {(r.zone, r.measure) for r in rows} == {
        (zone, name) for zone in ("P0", "P1") for name in DISTORTIONS
    }
    row = next(r for r in rows if r.measure == "stretch_along")
    assert (row.mean, row.p05, row.p95) == pytest.approx((0.02, 0.02, 0.02))
