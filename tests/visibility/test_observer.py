"""Contrast sensitivity against Barten's full model, and the table against the formula."""

import dataclasses

import numpy as np
import pytest

from seatlook.errors import InputError
from seatlook.visibility.kernels.band import sensitivity
from seatlook.visibility.observer import (
    LOWEST_OCTAVE,
    NODES_PER_OCTAVE,
    Observer,
    contrast_sensitivity,
    sensitivity_table,
)


def barten_1999(u, L, X0=10.0):
    """Barten's full model (Contrast Sensitivity of the Human Eye, 1999, eq. 3.26), both eyes."""
    d = 5 - 3 * np.tanh(0.4 * np.log10(L * X0**2 / 40**2))
    sigma = np.hypot(0.5, 0.08 * d) / 60
    E = np.pi * d**2 / 4 * L * (1 - (d / 9.7) ** 2 + (d / 12.4) ** 4)
    optics = np.exp(-2 * (np.pi * sigma * u) ** 2)
    photons = 1 / (0.03 * 1.2274e6 * E)
    lateral = 3e-8 / -np.expm1(-((u / 7.0) ** 2))
    spatial = 1 / X0**2 + 1 / 12.0**2 + (u / 15.0) ** 2
    return optics / 3 / np.sqrt(2 / 0.1 * spatial * (photons + lateral))


def test_the_closed_formula_follows_the_full_model():
    """The closed form is a fit; where wrinkles are seen it stays within a fifth of the model."""
    u = np.geomspace(0.5, 16, 21)
    L = np.geomspace(1, 1000, 13)[:, None]
    ratio = contrast_sensitivity(u, L) / barten_1999(u, L)
    assert ratio.min() > 0.8
    assert ratio.max() < 1.2


@pytest.mark.parametrize("luminance", [0.1, 1.0, 10.0, 100.0, 1000.0])
def test_the_peak_lies_where_the_full_model_has_it(luminance):
    u = np.geomspace(0.2, 30, 600)
    closed, full = contrast_sensitivity(u, luminance), barten_1999(u, luminance)
    assert u[closed.argmax()] == pytest.approx(u[full.argmax()], rel=0.1)


def test_by_hand():
    # f = 2, L = 10, X0 = 10: optics exp(-0.0064 * 11^0.08), summation 1 + 1.44 + 2.56,
    # noise 63 / 10^0.83 + 1 / (1 - exp(-0.08))
    expected = 5200 * np.exp(-0.0064 * 11**0.08) / np.sqrt(5 * (63 / 10**0.83 + 13.00666))
    assert contrast_sensitivity(2.0, 10.0) == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize("frequency", [0.25, 4.0, 16.0])
def test_the_table_is_the_formula(frequency):
    table = sensitivity_table(frequency, 10.0)
    L = np.geomspace(1e-3, 1e6, 2000)
    looked_up = [sensitivity(value, table, LOWEST_OCTAVE, NODES_PER_OCTAVE) for value in L]
    np.testing.assert_allclose(looked_up, contrast_sensitivity(frequency, L), rtol=3e-4)


def test_the_table_ends_flat():
    table = sensitivity_table(4.0, 10.0)
    low, high = (sensitivity(v, table, LOWEST_OCTAVE, NODES_PER_OCTAVE) for v in (1e-9, 1e12))
    assert low == pytest.approx(table[0])
    assert high == pytest.approx(table[-1])


def test_constants_are_marked_and_checked():
    assert not Observer.calibrated
    with pytest.raises(InputError, match=r"masking_root: got 0, expected a number above 0"):
        dataclasses.replace(Observer(), masking_root=0)
