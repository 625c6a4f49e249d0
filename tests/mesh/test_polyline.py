"""Lengths along polylines and places on them."""

import re
from pathlib import Path

import numpy as np
import pytest

import seatlook
from seatlook import mesh

STAIRS = np.array([[0.0, 0.0], [3.0, 4.0], [3.0, 5.0], [7.0, 5.0]])


def test_lengths_of_a_line_add_up():
    np.testing.assert_array_equal(mesh.segment_lengths(STAIRS), [5.0, 1.0, 4.0])
    np.testing.assert_array_equal(mesh.arc_length(STAIRS), [0.0, 5.0, 6.0, 10.0])
    assert mesh.length(STAIRS) == 10.0


def test_lengths_in_space_agree_and_do_not_depend_on_direction():
    turn = np.linspace(0.0, 4.0 * np.pi, 4001)
    helix = np.column_stack([np.cos(turn), np.sin(turn), 0.75 * turn])
    exact = 1.25 * 4.0 * np.pi
    assert mesh.length(helix) == pytest.approx(exact, rel=1e-6)
    assert mesh.arc_length(helix)[-1] == pytest.approx(mesh.length(helix), rel=1e-13)
    assert mesh.length(helix[::-1]) == pytest.approx(mesh.length(helix), rel=1e-13)


@pytest.mark.parametrize(
    ("point", "distance", "place"),
    [((3.5, 4.5), 0.5, 5.5), ((-3.0, -4.0), 5.0, 0.0), ((9.0, 5.0), 2.0, 10.0), (STAIRS[1], 0, 5)],
)
def test_nearest_place_beside_before_and_beyond_a_line(point, distance, place):
    assert mesh.nearest_place(STAIRS, np.array(point)) == pytest.approx((distance, place))


def test_arc_length_is_defined_once():
    own = re.compile(r"norm\(\s*np\.diff\(|cumsum\((np\.)?(hypot|linalg)")
    root = Path(seatlook.__file__).parent
    places = {
        str(path.relative_to(root)): len(own.findall(path.read_text(encoding="utf-8")))
        for path in root.rglob("*.py")
    }
    assert {name: count for name, count in places.items() if count} == {"mesh/polyline.py": 1}


def test_points_at_places_are_the_corners_and_lie_between_them():
    places = np.array([0.0, 2.5, 5.0, 5.5, 10.0])
    expected = [[0, 0], [1.5, 2], [3, 4], [3, 4.5], [7, 5]]
    np.testing.assert_allclose(mesh.points_at(STAIRS, places), expected)


def test_directions_turn_evenly_from_middle_to_middle():
    middle = mesh.directions_at(STAIRS, np.array([-1.0, 0.0, 2.5, 5.5, 8.0, 10.0]))
    along = [[0.6, 0.8], [0.6, 0.8], [0.6, 0.8], [0.0, 1.0], [1.0, 0.0], [1.0, 0.0]]
    np.testing.assert_allclose(middle, along)
    between = mesh.directions_at(STAIRS, np.array([4.0]))
    np.testing.assert_allclose(between, [[0.3, 0.9] / np.hypot(0.3, 0.9)])
    fine = mesh.directions_at(STAIRS, np.linspace(0.0, 10.0, 10_001))
    assert np.abs(np.diff(fine, axis=0)).max() < 1e-3  # no jump
    np.testing.assert_allclose(np.linalg.norm(fine, axis=1), 1.0)


def test_a_closed_line_has_no_ends():
    square = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0], [0.0, 0.0]])
    assert mesh.is_closed(square)
    assert not mesh.is_closed(square[:-1])
    places = np.array([-1.0, 0.5, 7.0])
    np.testing.assert_allclose(mesh.points_at(square, places + 8.0), mesh.points_at(square, places))
    np.testing.assert_allclose(
        mesh.directions_at(square, np.array([0.0, 8.0])), np.tile([1, -1] / np.sqrt(2), (2, 1))
    )
