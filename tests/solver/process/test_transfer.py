import dataclasses

import numpy as np
import pytest

from seatlook import model
from seatlook.errors import InputError
from seatlook.solver import solve
from seatlook.solver.process.transfer import transfer, transfer_peaks
from support.covers import cover, flat_foam, sheet


def two(h):
    """Two panels that lie over each other in their rest coordinates."""
    return cover([sheet(0.3, 0.2, h), sheet(0.3, 0.2, h, z=1.0)], h=h)


def bent(rest):
    s, t = rest.T
    return np.column_stack([s + 0.3 * t * t, t - 0.2 * s * t, 0.1 * s * s - 0.4 * t + 0.01])


def test_quadratics_arrive_exactly_and_panels_stay_apart():
    coarse, fine = two(0.04), two(0.013)
    above = np.zeros(len(coarse.rest))
    above[coarse.faces[coarse.panel == 1]] = 5.0
    values = np.column_stack([bent(coarse.rest), above])
    result = transfer(coarse, values, fine)
    np.testing.assert_allclose(result[:, :3], bent(fine.rest), atol=1e-12)
    expected = np.zeros(len(fine.rest))
    expected[fine.faces[fine.panel == 1]] = 5.0
    np.testing.assert_allclose(result[:, 3], expected, atol=1e-12)


def test_waves_arrive_to_third_order():
    errors = []
    for h in (0.02, 0.01):
        coarse, fine = two(h), two(0.007)
        wave = [np.sin(40.0 * c.rest[:, :1] + 10.0 * c.rest[:, 1:]) for c in (coarse, fine)]
        errors.append(np.sqrt(np.mean((transfer(coarse, wave[0], fine) - wave[1]) ** 2)))
    assert errors[1] < 5e-3
    assert np.log2(errors[0] / errors[1]) > 2.5


def test_what_faces_have_gone_through_arrives_panel_by_panel():
    coarse, fine = two(0.02), two(0.013)
    centre = [c.rest[c.faces].mean(axis=1) for c in (coarse, fine)]
    peaks = np.column_stack([centre[0][:, 0], coarse.panel - 2.0])
    peaks[centre[0][:, 1] > 0.1, 0] = -np.inf
    got = transfer_peaks(coarse, peaks, fine)
    np.testing.assert_array_equal(got[:, 1], fine.panel - 2.0)
    below = centre[1][:, 1] < 0.08
    np.testing.assert_allclose(got[below, 0], centre[1][below, 0], atol=0.015)
    assert np.isneginf(got[centre[1][:, 1] > 0.12, 0]).all()


def test_other_panels_are_refused():
    one, other = two(0.04), dataclasses.replace(two(0.03), panel_names=("left", "right"))
    with pytest.raises(InputError, match="start: got a cover of the panels panel 0, panel 1"):
        transfer(one, one.rest, other)
    few = two(0.1)
    assert (few.panel == 0).sum() < 20
    with pytest.raises(InputError, match="vertices in panel panel 0, expected at least 14"):
        transfer(few, few.rest, one)


def laid(h):
    X, T, x = sheet(0.12, 0.12, h, z=0.002, at=(-0.06, -0.06))
    drop = model.Stage(name="drop", start=0.0, end=0.1)
    return cover([(X, T, x)], foam=flat_foam(), stages=[drop], h=h)


def test_a_cover_goes_on_from_a_coarser_mesh():
    coarse = solve(laid(0.02), strict=True)
    started = solve(laid(0.01), start=coarse, strict=True)
    whole = solve(laid(0.01), strict=True)
    assert set(np.unique(started.history["time"])) == {0.1}  # nothing but the rest
    np.testing.assert_allclose(started.positions[:, 2], whole.positions[:, 2], atol=2e-5)
