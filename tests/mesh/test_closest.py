"""Closest places of a mesh: against brute force, the side at creases, borders between panels."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from seatlook.mesh.closest import (
    border_segments,
    closest_places,
    distance_to_segments,
    pseudonormals,
)
from support.covers import sphere
from support.scenes import block


def test_weights_give_the_closest_place_of_a_triangle():
    """Against 200,000 places spread over the triangle."""
    rng = np.random.default_rng(0)
    share = rng.dirichlet([1, 1, 1], 20_000)
    for _ in range(10):
        corner = rng.normal(size=(3, 3))
        points = rng.normal(size=(20, 3)) * 2
        result = closest_places(points, corner, np.array([[0, 1, 2]]), reach=100.0)
        brute = np.linalg.norm(points[:, None] - share @ corner, axis=2).min(axis=1)
        assert (result.distance <= brute + 1e-12).all()
        np.testing.assert_allclose(result.distance, brute, rtol=0.02, atol=0.02)
        place = result.weights @ corner
        np.testing.assert_allclose(points - place, result.offset, atol=1e-12)
        assert (result.weights >= -1e-12).all()


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 10_000), st.floats(0.01, 0.2))
def test_every_face_was_worth_trying(seed, reach):
    """The same as from all faces, on a mesh of very unequal ones."""
    rng = np.random.default_rng(seed)
    vertices = rng.normal(size=(60, 3)) * 0.05
    faces = np.array([rng.choice(60, 3, replace=False) for _ in range(90)])
    points = rng.normal(size=(40, 3)) * 0.1
    result = closest_places(points, vertices, faces, reach=reach)
    each = [closest_places(points, vertices, f[None], reach=10.0).distance for f in faces]
    exact = np.min(each, axis=0)
    np.testing.assert_allclose(result.distance, np.where(exact <= reach, exact, np.inf), rtol=1e-12)


def test_side_is_right_beside_edges_and_corners():
    """A box: points off its corners are outside though they lie behind some of its faces."""
    half = np.array([0.1, 0.06, 0.04])
    vertices, faces = block(-half, half)
    points = np.random.default_rng(1).uniform(-1.6, 1.6, (3000, 3)) * half
    result = closest_places(points, vertices, faces, reach=1.0)
    normal, on_rim = pseudonormals(vertices, faces, result)
    inside = (np.abs(points) < half).all(axis=1)
    signed = np.einsum("kd,kd->k", result.offset, normal)
    assert ((signed < 0) == inside).all()
    assert not on_rim.any()
    np.testing.assert_allclose(np.linalg.norm(normal, axis=1), 1.0)


def test_rim_of_an_open_surface_is_known():
    vertices, faces = sphere(0.1, 3)
    upper = faces[vertices[faces].mean(axis=1)[:, 2] > 0]
    points = np.array([[0.0, 0.0, 0.12], [0.15, 0.0, -0.02], [0.0, -0.11, -0.03]])
    result = closest_places(points, vertices, upper, reach=0.2)
    assert pseudonormals(vertices, upper, result)[1].tolist() == [False, True, True]


def test_segments_and_borders():
    line = np.array([[0.0, 0, 0], [1, 0, 0], [1, 0, 0], [1, 1, 0]])
    points = np.array([[0.5, 0.2, 0], [2, 2, 0], [-3, 0, 4]])
    away = distance_to_segments(points, line[:-1], line[1:])
    assert away == pytest.approx([0.2, np.sqrt(2), 5])
    faces = np.array([[0, 1, 2], [2, 1, 3], [3, 1, 4], [2, 3, 5]])
    pairs, labels = border_segments(faces, np.array([1, 0, 0, 2]))
    assert sorted(map(tuple, pairs.tolist())) == [(1, 2), (2, 3)]
    assert labels[pairs[:, 1] == 2].tolist() == [[0, 1]]
    assert labels[pairs[:, 1] == 3].tolist() == [[0, 2]]
