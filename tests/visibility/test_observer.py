"""Contrast sensitivity by hand and by what is known of it, and the table against the formula."""

import csv
import dataclasses
from pathlib import Path

import numpy as np
import pytest

from seatlook.errors import InputError
from seatlook.visibility.kernels.band import sensitivity
from seatlook.visibility.observer import (
    FITTING,
    LOWEST_OCTAVE,
    NODES_PER_OCTAVE,
    OBSERVER,
    TOO_LONG,
    VISIBLE,
    Observer,
    contrast_sensitivity,
    sensitivity_table,
)

ROOT = Path(__file__).parents[2]


def test_by_hand():
    # f = 4 on 100 cd/m2: the peak lies at 1.78119 / 1.915718^0.256682 = 1.5074, 0.42385 decades
    # below f, and is 56.4947 / 1.0754726^0.144532 = 55.9042 high; the field that is summed over
    # is 157.103 / (1 + 5.69539^2) = 4.69854 deg2.
    expected = 55.9042 * 10**-0.179625 * 4 * np.sqrt(4.69854 / (1 + 4.69854))
    assert contrast_sensitivity(4.0, 100.0, area_deg2=1.0) == pytest.approx(expected, rel=1e-3)


def test_small_fields_sum_by_the_root_of_their_area_and_large_ones_not_at_all():
    small, twice = (contrast_sensitivity(4.0, 100.0, area_deg2=a) for a in (1e-4, 2e-4))
    large, more = (contrast_sensitivity(4.0, 100.0, area_deg2=a) for a in (1e4, 2e4))
    assert twice / small == pytest.approx(np.sqrt(2), rel=1e-3)
    assert more / large == pytest.approx(1.0, rel=1e-3)


@pytest.mark.parametrize("frequency", [0.5, 1.0, 2.0, 4.0, 6.0])
def test_noon_blinds_by_what_observers_lost(frequency):
    """From 200 to 7,000 cd/m2 observers lost 3.6 to 7.2 dB."""
    lamp, noon = contrast_sensitivity(frequency, np.array([200.0, 7000.0]), area_deg2=1.0)
    assert 3.0 < 20 * np.log10(lamp / noon) < 8.0


def test_dusk_blinds_the_fine_more_than_the_coarse():
    """From 20 to 0.02 cd/m2, by the square root of the light at most (de Vries and Rose)."""
    coarse, fine = (
        contrast_sensitivity(f, 20.0, area_deg2=1.0) / contrast_sensitivity(f, 0.02, area_deg2=1.0)
        for f in (0.5, 8.0)
    )
    assert 2 < coarse < fine / 4


def test_beyond_what_was_measured_it_stays():
    ends = contrast_sensitivity(2.0, np.array([1e-5, 1e-3, 1e4, 1e6]), area_deg2=1.0)
    assert ends[0] == ends[1]
    assert ends[2] == ends[3]


@pytest.mark.parametrize("frequency", [0.25, 4.0, 16.0])
def test_the_table_is_the_formula(frequency):
    table = sensitivity_table(frequency, OBSERVER)
    L = np.geomspace(1.1e-3, 1e6, 2000)
    looked_up = [sensitivity(value, table, LOWEST_OCTAVE, NODES_PER_OCTAVE) for value in L]
    formula = contrast_sensitivity(frequency, L, area_deg2=OBSERVER.area_deg2)
    miss = np.abs(np.array(looked_up) / (OBSERVER.gain * formula) - 1)
    assert miss.max() < 2e-3
    # It is straight between two nodes, also across the ends of what was measured.
    node = 2 ** (1 / NODES_PER_OCTAVE)
    ends = [(end / node < L) & (node * end > L) for end in (1e-3, 1e4)]
    assert miss[~np.any(ends, axis=0)].max() < 3e-4


def test_the_table_ends_flat():
    table = sensitivity_table(4.0, OBSERVER)
    low, high = (sensitivity(v, table, LOWEST_OCTAVE, NODES_PER_OCTAVE) for v in (1e-9, 1e12))
    assert low == pytest.approx(table[0])
    assert high == pytest.approx(table[-1])


def test_constants_say_what_they_come_from_and_are_checked():
    assert Observer.calibrated == "on detection and masking of published observers"
    with pytest.raises(InputError, match=r"gain: got 0, expected a number above 0"):
        dataclasses.replace(Observer(), gain=0)


@pytest.mark.parametrize(("state", "yardstick"), [("good", FITTING), ("spoiled", TOO_LONG)])
def test_the_yardsticks_are_what_was_measured(state, yardstick):
    with (ROOT / "docs/charts/visible_faults.csv").open(encoding="utf-8") as file:
        vwi = [
            float(row["zone_vwi"])
            for row in csv.DictReader(file)
            if (row["shape"], row["state"]) == ("cushion", state)
        ]
    assert len(vwi) == 9
    assert yardstick == tuple(float(f"{end:.2g}") for end in (min(vwi), max(vwi)))
    assert FITTING[1] < VISIBLE < TOO_LONG[0]
