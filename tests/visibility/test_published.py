"""What ``gallery/observer.py`` last found of published observers, against the bars.

The published tables are not part of this project, so the misses are read and not found anew; that
they belong to the observer as it is, is held here.
"""

import csv
from pathlib import Path

import numpy as np
import pytest

from seatlook.visibility.observer import OBSERVER

TABLE = Path(__file__).parents[2] / "docs" / "charts" / "observer.csv"
CONTRASTS = ("0.51", "1", "2", "4.1", "8.1", "16", "32", "63")
NO_THRESHOLD = (
    "a little worse than plain contrast: observers saw coarse bars stronger than those at 5 "
    "cycles/deg, which no threshold makes"
)
MISSED = {"63": "0.89 dB against 0.86", "8.1": "3.49 dB against 3.37", "16": "2.9 dB against 1.8",
          "32": "2.1 dB against 1.5"}  # fmt: skip


@pytest.fixture(scope="module")
def rows():
    with TABLE.open(encoding="utf-8") as file:
        return list(csv.DictReader(file))


@pytest.fixture(scope="module")
def missed(rows):
    """Root mean square [dB] and number of the sets whose name holds all of these words."""

    def of(*words, panel):
        found = [
            float(row["miss_db"])
            for row in rows
            if row["panel"] == panel and all(word in row["set"] for word in words)
        ]
        return float(np.sqrt(np.mean(np.square(found)))), len(found)

    return of


def test_the_table_is_of_this_observer(rows):
    kept = {row["set"]: float(row["at"]) for row in rows if row["panel"] == "observer"}
    assert kept == {name: getattr(OBSERVER, name) for name in kept}
    assert len(kept) == 5


def test_sensitivity_of_observers_not_fitted(missed):
    rms, count = missed("hdr_csf", "held out", panel="detection")
    assert count == 66
    assert rms <= 5


def test_masking_of_points_not_fitted(missed):
    rms, count = missed("held out", panel="masking")
    assert count == 19
    assert rms <= 3


def test_matches_across_frequency(missed):
    rms, count = missed("frequency", panel="matches")
    assert count == 64
    assert rms <= 4


@pytest.mark.parametrize(
    "contrast",
    [
        pytest.param(c, marks=pytest.mark.xfail(strict=True, reason=f"{MISSED[c]}: {NO_THRESHOLD}"))
        if c in MISSED
        else c
        for c in CONTRASTS
    ],
)
def test_matches_no_worse_than_plain_contrast(missed, contrast):
    name = f"frequency, {contrast} %"
    rms, count = missed(name, panel="matches")
    assert count == 8
    assert rms <= missed(name, panel="plain contrast")[0]


def test_matches_across_luminance(missed):
    rms, count = missed("luminance", panel="matches")
    assert count == 21
    assert rms <= 1.6
    assert rms < missed("luminance", panel="plain contrast")[0]
