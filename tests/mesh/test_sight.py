"""What is seen of a surface from a place, against a sphere and a wall of which one knows it."""

import numpy as np
import pytest

from seatlook.mesh.sight import is_seen
from support.covers import sphere


@pytest.mark.parametrize("eye", [(3.0, 0.0, 0.0), (-1.0, 2.0, 1.5), (0.3, -0.2, 4.0)])
def test_of_a_sphere_the_near_cap_is_seen(eye):
    """The horizon lies where the normal is at a right angle to the way to the eye."""
    vertices, faces = sphere(1.0, 4)
    eye = np.array(eye)
    points = np.random.default_rng(1).normal(size=(200, 3))
    points *= 1.003 / np.linalg.norm(points, axis=1, keepdims=True)
    seen = is_seen(points, eye, vertices, faces)
    facing = np.einsum("kd,kd->k", points, eye - points) / np.linalg.norm(eye - points, axis=1)
    sure = np.abs(facing) > 0.15
    assert (seen == (facing > 0))[sure].all()
    assert 20 < seen.sum() < 120


def test_from_inside_everything_is_seen_and_nothing_hides_itself():
    vertices, faces = sphere(1.0, 2)
    assert is_seen(0.9 * vertices, np.zeros(3), vertices, faces).all()
    assert not is_seen(1.1 * vertices, np.zeros(3), vertices, faces).any()
    assert is_seen(vertices + np.array([3.0, 0, 0]), np.array([9.0, 0, 0]), vertices, faces).all()
