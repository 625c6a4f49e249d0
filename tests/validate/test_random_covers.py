"""A handful of the covers of gallery/random_covers.py."""

import warnings

import pytest

from seatlook.errors import InputWarning
from support.random_covers import drawn, measure

pytestmark = pytest.mark.validate


@pytest.mark.parametrize("number", [1, 3, 5, 7])
def test_a_cover_drawn_at_random_comes_to_rest(number):
    draw = drawn(2026, number, 14.0)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)
        row = measure(draw)
    print(draw, row)
    assert row["status"] in ("resolved", "converged, not resolved")
    # Whatever is folded sharply is not called resolved, and what is not resolved says why.
    assert (row["status"] == "resolved") == (row["reason"] == "")
    assert row["status"] != "resolved" or row["sharp_folds"] == 0
