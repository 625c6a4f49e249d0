import numpy as np
import pytest

from seatlook import mesh
from seatlook.flattening.face_map import stretches
from seatlook.flattening.newton import _Matrix
from seatlook.flattening.relax import HeldEdges, flatten_patch
from seatlook.flattening.start import conformal_map
from support.rolls import rolled, sheet


def dome(points, radius):
    x, y = (points - points.mean(axis=0)).T
    return np.column_stack([x, y, np.sqrt(radius**2 - x**2 - y**2)])


def lengths(x, pairs):
    return np.linalg.norm(x[pairs[:, 1]] - x[pairs[:, 0]], axis=1)


@pytest.mark.parametrize("turn", [0.5, 2.0, 4.0])
def test_a_rolled_sheet_comes_back_flat(turn):
    """Within the chord error of the mesh, h^2 / (24 R^2), over most of a full turn too."""
    flat, faces = sheet()
    radius = 0.12 / turn
    back = flatten_patch(rolled(flat, radius), faces)
    far = np.random.default_rng(0).integers(0, len(flat), (200, 2))
    far = far[far[:, 0] != far[:, 1]]
    assert np.abs(lengths(back, far) / lengths(flat, far) - 1).max() < 4e-4 * max(turn, 1) ** 2
    assert (mesh.face_vectors(back, faces)[:, 2] > 0).all()


def test_developable_lengths_are_exact_to_1e_4():
    flat, faces = sheet()
    back = flatten_patch(rolled(flat, 0.12), faces)
    far = np.array([[i, j] for i in range(0, 60, 7) for j in range(80, 100, 5)])
    assert np.abs(lengths(back, far) / lengths(flat, far) - 1).max() < 1e-4


def test_a_flat_sheet_stays_what_it_is_in_any_pose():
    flat, faces = sheet()
    q, _ = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))
    space = np.column_stack([flat, np.zeros(len(flat))]) @ (q * np.linalg.det(q)).T + 0.3
    back = flatten_patch(space, faces)
    pairs = mesh.edges(faces)
    assert np.abs(lengths(back, pairs) / lengths(flat, pairs) - 1).max() < 1e-9
    assert np.abs(stretches(space, faces, back) - 1).max() < 1e-8


def test_dome_strain_has_the_known_size():
    """Shallow cap of curvature K, radius a: e_r = K (a^2 - r^2)/16, e_hoop = K (a^2 - 3 r^2)/16."""
    angle = np.linspace(0, 2 * np.pi, 90, endpoint=False)
    points, faces = mesh.triangulate(0.05 * np.column_stack([np.cos(angle), np.sin(angle)]), 0.0035)
    space = dome(points, 0.2)
    strain = stretches(space, faces, flatten_patch(space, faces)) - 1
    bound = (0.05 / 0.2) ** 2 / 16
    middle = np.linalg.norm(points[faces].mean(axis=1), axis=1) < 0.005
    assert strain[middle].mean() == pytest.approx(bound, rel=0.15)
    assert strain.min() == pytest.approx(-2 * bound, rel=0.2)


def test_conformal_map_keeps_angles_of_a_rolled_sheet():
    flat, faces = sheet()
    mapped = conformal_map(rolled(flat, 0.1), faces)
    error = mesh.angles(mapped, faces) - mesh.angles(flat, faces)
    assert np.abs(error).max() < 2e-3


def test_held_edges_get_their_length():
    flat, faces = sheet()
    space = dome(flat, 0.25)
    loop = mesh.boundary_loops(faces)[0]
    pairs = np.column_stack([loop, np.roll(loop, -1)])
    expected = 1.01 * lengths(space, pairs)
    back = flatten_patch(space, faces, HeldEdges(vertices=pairs, length=expected))
    assert np.abs(lengths(back, pairs) / expected - 1).max() < 2e-4


def test_start_does_not_change_the_result():
    flat, faces = sheet(h=0.008)
    space = dome(flat, 0.2)
    a = flatten_patch(space, faces)
    b = flatten_patch(space, faces, start=1.1 * flat)
    pairs = mesh.edges(faces)
    assert np.allclose(lengths(a, pairs), lengths(b, pairs), rtol=1e-7)


def test_a_closed_dome_is_flattened_with_great_strain():
    """Most of a sphere: no face is turned over, and none is crushed to nothing."""
    angle = np.linspace(0, 2 * np.pi, 40, endpoint=False)
    points, faces = mesh.triangulate(np.column_stack([np.cos(angle), np.sin(angle)]), 0.15)
    r = np.linalg.norm(points, axis=1) * 0.97 * np.pi
    direction = points / np.maximum(np.linalg.norm(points, axis=1), 1e-12)[:, None]
    ball = 0.1 * np.column_stack([np.sin(r)[:, None] * direction, np.cos(r)])
    flat = flatten_patch(ball, faces)
    assert (mesh.face_vectors(flat, faces)[:, 2] > 0).all()
    strain = stretches(ball, faces, flat) - 1
    assert 0.5 < strain.max() < 8


def test_steps_go_down_where_the_curvature_is_not_positive():
    """Newton's own step leads to a saddle there; so little is left out that the step is long."""
    faces = np.array([[0, 1, 2]])
    matrix = _Matrix(3, faces, [])
    rng = np.random.default_rng(0)
    root = rng.normal(size=(6, 6))
    above, weak = root @ root.T, rng.normal(size=6)
    weak /= np.linalg.norm(weak)
    limit = 1 / (weak @ np.linalg.solve(above, weak))  # so much below 0 makes it singular
    b = rng.normal(size=(3, 2))
    for size in (0.5, 1.01, 1.3):
        below = -size * limit * np.outer(weak, weak)
        blocks = [[m.reshape(3, 2, 3, 2).swapaxes(1, 2).reshape(-1, 4)] for m in (above, below)]
        step, share = matrix.descent(*blocks, b, 0.0)
        assert (share > 0) == (size > 1)
        assert share < 1
        assert (b * step).sum() > 0
        expected = np.linalg.solve(above + (1 - share) * below, b.ravel())
        np.testing.assert_allclose(step.ravel(), expected, rtol=1e-5)
