"""Flat outlines in one plane: what they share, and how they are moved apart."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from seatlook.mesh.overlap import lifts, shared_area

OBLIQUE = Rotation.from_rotvec([0.4, -1.1, 0.7])
AWAY = np.array([1.0, 2.0, -3.0])
L_SHAPE = np.array([[0, 0], [0.3, 0], [0.3, 0.1], [0.1, 0.1], [0.1, 0.4], [0, 0.4]])


def laid(flat: np.ndarray, u: float = 0.0, v: float = 0.0, w: float = 0.0) -> np.ndarray:
    """An outline in an oblique plane, moved within it and along its normal."""
    sheet = np.column_stack([flat, np.zeros(len(flat))]) + np.array([u, v, w])
    return OBLIQUE.apply(sheet) + AWAY


@pytest.mark.parametrize(
    ("u", "v", "w", "shared"),
    [
        (0.0, 0.0, 0.0, 0.06),
        (0.15, 0.0, 0.0, 0.015),  # of both feet
        (0.12, 0.12, 0.0, 0.0),  # within the angle of the L
        (0.15, 0.0, 0.0009, 0.015),
        (0.15, 0.0, 0.0011, 0.0),  # above each other
        (0.2995, 0.0, 0.0, 0.0),  # less than a hundredth
    ],
)
def test_what_two_outlines_share(u, v, w, shared):
    assert shared_area(laid(L_SHAPE), laid(L_SHAPE, u, v, w)) == pytest.approx(shared, abs=1e-9)
    assert shared_area(laid(L_SHAPE, u, v, w), laid(L_SHAPE)) == pytest.approx(shared, abs=1e-9)


def test_crossing_planes_share_nothing():
    upright = np.column_stack([L_SHAPE[:, 0], np.zeros(6), L_SHAPE[:, 1]])
    assert shared_area(laid(L_SHAPE), OBLIQUE.apply(upright) + AWAY) == 0.0


@given(st.lists(st.tuples(st.floats(-0.3, 0.3), st.floats(-0.3, 0.3)), max_size=6))
def test_lifted_outlines_do_not_cover_each_other(places):
    outlines = [laid(L_SHAPE, *place) for place in places]
    ways = lifts(outlines)
    moved = [outline + way for outline, way in zip(outlines, ways, strict=True)]
    assert all(shared_area(a, b) == 0.0 for a, b in combinations(moved, 2))
    assert np.abs(ways @ OBLIQUE.apply(np.eye(3)[:2]).T).max(initial=0.0) < 1e-12
    if len(places):
        assert not ways[0].any()
