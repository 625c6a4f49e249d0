"""Meshes whose element size varies from place to place."""

import numpy as np
import pytest

from seatlook import mesh


class Strip:
    """Fine along a line, coarser by a share of the way from it."""

    def __init__(self, finest=0.002, coarsest=0.008, growth=0.25):
        self.finest, self.coarsest, self.growth = finest, coarsest, growth

    def __call__(self, points):
        away = np.maximum(np.abs(points[:, 1] - 0.03) - 0.01, 0.0)
        return np.clip(self.finest + self.growth * away, self.finest, self.coarsest)


def meshed(size, seed=0, width=0.2, depth=0.2):
    corners = np.array([[0.0, 0.0], [width, 0.0], [width, depth], [0.0, depth], [0.0, 0.0]])
    sides = [mesh.resample(corners[k : k + 2], size)[:-1] for k in range(4)]
    return mesh.triangulate(np.concatenate(sides), size, seed=seed)


@pytest.mark.parametrize("seed", range(3))
def test_edges_are_as_long_as_asked_for_everywhere(seed):
    size = Strip()
    points, faces = meshed(size, seed)
    ends = points[mesh.edges(faces)]
    ratio = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1) / size(ends.mean(axis=1))
    wanted = size(ends.mean(axis=1))
    fine, coarse = wanted < 1.05 * size.finest, wanted > 0.95 * size.coarsest
    for part, most in ((fine, 0.04), (coarse, 0.04), (~(fine | coarse), 0.08)):
        assert part.sum() > 1000
        assert ratio[part].mean() == pytest.approx(1.0, abs=most)
    assert ratio.std() < 0.2
    smallest = np.degrees(mesh.angles(points, faces)).min(axis=1)
    assert smallest.min() > mesh.MIN_ANGLE_DEG
    assert np.quantile(smallest, 0.01) > mesh.QUANTILE_ANGLE_DEG


def test_a_graded_mesh_has_far_fewer_vertices():
    graded, fine = (len(meshed(size)[0]) for size in (Strip(), 0.002))
    assert graded < 0.5 * fine


def test_one_size_everywhere_is_the_same_however_it_is_said():
    """Steps of a rim and counts of a lattice do not depend on how the size is given."""
    one = Strip(finest=0.006, coarsest=0.006)
    np.testing.assert_allclose(meshed(one)[0], meshed(0.006)[0], atol=1e-9)


def test_places_are_as_far_apart_as_the_spacing_says():
    at = np.linspace(0.0, 1.0, 400)
    spacing = 0.01 + 0.04 * at
    places = mesh.even_places(at, spacing)
    assert places[[0, -1]] == pytest.approx([0.0, 1.0])
    middle = 0.5 * (places[1:] + places[:-1])
    np.testing.assert_allclose(np.diff(places) / np.interp(middle, at, spacing), 1.0, atol=0.03)


def test_steps_of_a_line_are_those_of_its_points():
    line = np.array([[0.0, 0.0], [0.1, 0.0], [0.1, 0.1]])
    for size in (0.013, Strip()):
        steps = mesh.resampled_steps(line, size)
        assert len(steps) == len(mesh.resample(line, size)) - 1
        assert steps.sum() == pytest.approx(0.2)
