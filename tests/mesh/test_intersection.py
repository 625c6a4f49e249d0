"""Triangles that pass through each other, against cases made by hand and a plain count."""

import tracemalloc

import numpy as np
import pytest

from seatlook.mesh import intersecting_pairs, intersection
from support.meshes import rectangle

FLOOR = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]])


def pair(other, joined=None):
    """Number of intersections of the floor with one other triangle."""
    points = np.concatenate([FLOOR, np.array(other, dtype=float)])
    return len(intersecting_pairs(points, np.arange(6).reshape(2, 3), joined))


@pytest.mark.parametrize(
    ("other", "expected"),
    [
        pytest.param([[0.2, 0.2, -1], [0.3, 0.2, 1], [0.2, 0.3, 1]], 1, id="through the inside"),
        pytest.param([[-1, -1, -1], [-1, -1, 1], [1, 1, 0.1]], 1, id="through a side"),
        pytest.param([[0.2, 0.2, 0.1], [0.3, 0.2, 1], [0.2, 0.3, 1]], 0, id="above"),
        pytest.param([[2, 2, -1], [3, 2, 1], [2, 3, 1]], 0, id="beside, across its plane"),
        pytest.param([[0.8, 0.8, -1], [0.8, 0.8, 1], [2, 2, 0]], 0, id="boxes overlap only"),
        pytest.param([[0.2, 0.2, 0], [0.3, 0.2, 1], [0.2, 0.3, 1]], 0, id="a corner touches"),
        pytest.param([[0.2, 0.2, 0], [0.3, 0.2, 0], [0.2, 0.3, 1]], 0, id="a side lies on it"),
        pytest.param([[0, 0, 0], [0, 0, 1], [0, -1, 0.5]], 0, id="a corner shared"),
        pytest.param([[0.5, 0.0, -1], [0.5, 0.0, 1], [0.5, -1, 0]], 0, id="side touches side"),
        pytest.param([[0.1, 0.1, 0], [0.9, 0.3, 0], [0.1, 0.9, 0]], 1, id="one plane, overlap"),
        pytest.param([[0.1, 0.1, 0], [0.2, 0.1, 0], [0.1, 0.2, 0]], 1, id="one plane, inside"),
        pytest.param(FLOOR, 1, id="one plane, the same"),
        pytest.param([[1, 0, 0], [1, 1, 0], [0, 1, 0]], 0, id="one plane, side by side"),
        pytest.param([[2, 2, 0], [3, 2, 0], [2, 3, 0]], 0, id="one plane, apart"),
        pytest.param([[0.1, 0.1, 1e-7], [0.2, 0.1, 1e-7], [0.1, 0.2, 1e-7]], 0, id="parallel"),
    ],
)  # fmt: skip
@pytest.mark.parametrize("turn", [0, 1, 2])
def test_two_triangles(other, expected, turn):
    other = np.roll(np.array(other, dtype=float), turn, axis=0)
    assert pair(other) == expected
    assert pair(other[::-1]) == expected


def test_neighbours_count_only_away_from_what_they_share():
    fan = np.concatenate([FLOOR, [[0.3, 0.3, -0.5], [0.4, 0.3, 0.5], [-1, 0, 1], [0, -1, 1]]])
    # The side opposite the shared corner goes through the floor; it does not; a folded edge.
    for second, expected in (([0, 3, 4], 1), ([0, 5, 6], 0), ([1, 0, 4], 0)):
        result = intersecting_pairs(fan, np.array([[0, 1, 2], second]))
        assert len(result) == expected, second


def test_sewn_corners_are_one_place():
    """A gap of a micrometre turned the wrong way round makes no crossing; what lies away does."""
    beside = np.array([[1 - 1e-6, 0, -1e-7], [0, 1 - 1e-6, -1e-7], [0.9, 0.9, 0.1]])
    ends = np.array([[1, 3], [2, 4]])
    assert pair(beside) == 1
    assert pair(beside, ends) == 0
    through = np.array([[1 - 1e-6, 0, -1e-7], [0.2, 0.2, -0.5], [0.3, 0.3, 0.5]])
    assert pair(through, ends[:1]) == 1


def test_folded_sheet_finds_every_pair_a_plain_count_finds():
    """A sheet rolled up into itself: the pairs of a loop over all, each by its own segments."""
    X, faces = rectangle("uns", 0.3, 0.03, 0.012)
    radius = 0.03 + 0.02 * np.cos(X[:, 0] / 0.02)
    angle = X[:, 0] / 0.03
    points = np.column_stack([radius * np.sin(angle), X[:, 1], radius * np.cos(angle)])
    result = intersecting_pairs(points, faces)
    centre = points[faces].mean(axis=1)
    expected = [
        (i, j)
        for i in range(len(faces))
        for j in range(i + 1, len(faces))
        if np.linalg.norm(centre[i] - centre[j]) < 0.03
        and not set(faces[i]) & set(faces[j])
        and (pierces(*points[faces[[i, j]]]) or pierces(*points[faces[[j, i]]]))
    ]
    shared = np.array([len(set(faces[i]) & set(faces[j])) for i, j in result])
    assert len(expected) > 20
    assert [tuple(p) for p in result[shared == 0]] == expected


def pierces(triangle, other):
    """Whether a side of a triangle crosses another: the point of the plane, in its own axes."""
    normal = np.cross(other[1] - other[0], other[2] - other[0])
    for start, end in zip(triangle, np.roll(triangle, -1, axis=0), strict=True):
        a, b = (start - other[0]) @ normal, (end - other[0]) @ normal
        if a * b < 0:
            point = start + a / (a - b) * (end - start) - other[0]
            u, v = np.linalg.lstsq((other[1:] - other[0]).T, point, rcond=None)[0]
            if u > 0 and v > 0 and u + v < 1:
                return True
    return False


def test_no_change_when_turned_moved_and_renamed():
    rng = np.random.default_rng(0)
    faces, crossing = np.arange(6).reshape(2, 3), 0
    for _ in range(150):
        points = rng.normal(size=(6, 3))
        q, _ = np.linalg.qr(rng.normal(size=(3, 3)))
        expected = pierces(points[:3], points[3:]) or pierces(points[3:], points[:3])
        assert len(intersecting_pairs(points, faces)) == int(expected)
        moved = points @ q.T + rng.normal(size=3)
        assert len(intersecting_pairs(moved, faces[::-1])) == int(expected)
        crossing += expected
    assert 15 < crossing < 135


def test_sheets_that_nothing_crosses():
    X, faces = rectangle("uns", 0.2, 0.2, 0.01)
    flat = np.column_stack([X, np.zeros(len(X))])
    assert not len(intersecting_pairs(flat, faces))
    waved = np.column_stack([X, 0.01 * np.sin(X[:, 0] / 0.01)])
    assert not len(intersecting_pairs(waved, faces))
    assert not len(intersecting_pairs(flat, faces[:1]))
    # Two layers that lie on each other, and a millimetre apart.
    for gap, crossing in ((0.0, True), (1e-3, False)):
        both = np.concatenate([flat, flat + np.array([0.0, 0.0, gap])])
        result = intersecting_pairs(both, np.concatenate([faces, faces + len(X)]))
        assert bool(len(result)) == crossing


def needles(count, *, size, seed=0):
    """Small triangles (count, 3, 3) about a unit square in the plane, standing across it."""
    rng = np.random.default_rng(seed)
    middle = np.column_stack([rng.random((count, 2)), np.zeros(count)])
    return middle[:, None] + size * rng.standard_normal((count, 3, 3))


def test_triangles_of_all_sizes_find_the_pairs_that_each_two_alone_have():
    mixed = [needles(15, size=0.5 * 3.0**-k, seed=k) for k in range(4)]
    points = np.concatenate(mixed).reshape(-1, 3)
    faces = np.arange(len(points)).reshape(-1, 3)
    alone = [
        (i, j)
        for i in range(len(faces))
        for j in range(i + 1, len(faces))
        if len(intersecting_pairs(points, faces[[i, j]]))
    ]
    assert len(alone) > 25
    np.testing.assert_array_equal(intersecting_pairs(points, faces), alone)


def test_blocks_of_pairs_change_nothing(monkeypatch):
    points = needles(80, size=0.1).reshape(-1, 3)
    faces = np.arange(len(points)).reshape(-1, 3)
    whole = intersecting_pairs(points, faces)
    assert len(whole) > 7
    monkeypatch.setattr(intersection, "_BLOCK", 7)
    np.testing.assert_array_equal(intersecting_pairs(points, faces), whole)


def test_a_large_triangle_does_not_make_pairs_of_all_small_ones():
    floor = np.array([[[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]])
    points = np.concatenate([floor, needles(4000, size=1e-3)]).reshape(-1, 3)
    faces = np.arange(len(points)).reshape(-1, 3)
    tracemalloc.start()
    pairs = intersecting_pairs(points, faces)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert (pairs[:, 0] == 0).sum() > 1000
    # Each of the 8 million pairs would take 16 bytes.
    assert peak < 32e6
