import numpy as np
import pytest

from seatlook.errors import InputError
from seatlook.solver.foam.distance import distance_field
from seatlook.solver.kernels import distance as kernel
from support.covers import cylinder, sphere, volume
from support.scenes import block


def directions(n, seed=0):
    p = np.random.default_rng(seed).normal(size=(n, 3))
    return p / np.linalg.norm(p, axis=1)[:, None]


def nearest_on_triangle(p, a, b, c):
    """Twin: the smallest of the plane's foot (if inside) and of the three edges."""
    best = np.inf
    for u, v in ((a, b), (b, c), (c, a)):
        t = np.clip((p - u) @ (v - u) / ((v - u) @ (v - u)), 0, 1)
        best = min(best, np.sum((p - u - t * (v - u)) ** 2))
    s, t = np.linalg.lstsq(np.stack([b - a, c - a], 1), p - a, rcond=None)[0]
    if s >= 0 and t >= 0 and s + t <= 1:
        best = min(best, np.sum((p - a - s * (b - a) - t * (c - a)) ** 2))
    return best


def test_point_to_triangle_equals_its_twin():
    rng = np.random.default_rng(1)
    for _ in range(300):
        p, a, b, c = rng.normal(size=(4, 3))
        assert kernel.triangle_distance2(p, a, b, c) == pytest.approx(
            nearest_on_triangle(p, a, b, c), rel=1e-9, abs=1e-12
        )


def test_sphere():
    vertices, faces = sphere(0.1, 5)
    assert volume(vertices, faces) == pytest.approx(4 / 3 * np.pi * 1e-3, rel=5e-3)
    field = distance_field(vertices, faces, spacing=0.005)
    way = directions(4000)
    r = np.random.default_rng(2).uniform(0.091, 0.109, len(way))
    phi, gradient = field.at(way * r[:, None])
    error = phi - (r - 0.1)
    # The facets themselves lie up to 0.1 mm inside.
    assert np.sqrt(np.mean(error**2)) < 0.06e-3
    assert np.abs(error).max() < 0.2e-3
    cosine = np.einsum("ij,ij->i", way, gradient) / np.linalg.norm(gradient, axis=1)
    assert np.degrees(np.arccos(cosine.min())) < 6
    deep = np.random.default_rng(2).uniform(0.07, 0.091, len(way))
    phi, _ = field.at(way * deep[:, None])
    assert np.abs(phi - (deep - 0.1)).max() < 0.6e-3


def rounded(p, half, r):
    q = np.abs(p) - (half - r)
    return np.linalg.norm(np.maximum(q, 0), axis=1) + np.minimum(q.max(axis=1), 0) - r


def test_rounded_box_away_from_facets():
    """The distance of a block from 10 mm outside is that of a rounded box."""
    half = np.array([0.08, 0.06, 0.04])
    field = distance_field(*block(-half, half), spacing=0.004, margin=0.03)
    p = np.random.default_rng(3).uniform(-1, 1, (20000, 3)) * (half + 0.025)
    exact = rounded(p, half + 0.01, 0.01) + 0.01
    p = p[(exact > 0.008) & (exact < 0.022)]
    phi, _ = field.at(p)
    error = phi - (rounded(p, half + 0.01, 0.01) + 0.01)
    assert np.sqrt(np.mean(error**2)) < 0.02e-3
    assert np.abs(error).max() < 0.2e-3


def test_flat_face_is_exact_far_from_edges():
    field = distance_field(*block((-0.1, -0.1, -0.08), (0.1, 0.1, 0.0)))
    p = np.array([[0.01, 0.02, 0.013], [0.0, 0.0, -0.02], [-0.03, 0.01, 0.0]])
    phi, gradient = field.at(p)
    np.testing.assert_allclose(phi, p[:, 2], atol=5e-6)
    # The kink midway through the block rings on, by 0.27 for every 4 mm.
    np.testing.assert_allclose(gradient, np.tile([0, 0, 1.0], (3, 1)), atol=2e-3)


def test_gradient_and_hessian_are_derivatives():
    field = distance_field(*cylinder(0.05, 0.1, 48))
    p = directions(40, seed=4) * 0.055
    h = 1e-6
    for x in p:
        phi, *gradient = kernel.distance(field.coefficients, field.grid, *x)
        assert np.isfinite(phi)
        xx, yy, zz, xy, xz, yz = kernel.distance_hessian(field.coefficients, field.grid, *x)
        H = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        for d in range(3):
            step = np.zeros(3)
            step[d] = h
            up = kernel.distance(field.coefficients, field.grid, *(x + step))
            down = kernel.distance(field.coefficients, field.grid, *(x - step))
            assert (up[0] - down[0]) / (2 * h) == pytest.approx(gradient[d], abs=1e-6)
            np.testing.assert_allclose(
                (np.array(up[1:]) - down[1:]) / (2 * h), H[d], atol=1e-3 * np.abs(H).max()
            )


def test_outside_the_grid_is_far():
    field = distance_field(*sphere(0.05, 2))
    phi, gradient = field.at(np.array([[1.0, 0.0, 0.0]]))
    assert phi[0] == np.inf
    assert not gradient.any()


def test_open_surface_is_refused():
    vertices, faces = sphere(0.05, 3)
    with pytest.raises(InputError, match=r"foam: got a surface that leaves .* lines open"):
        distance_field(vertices, faces[(vertices[faces] < 1e-9).any(axis=(1, 2))])


def test_surface_inside_out_is_refused():
    vertices, faces = sphere(0.05, 3)
    with pytest.raises(InputError, match="got normals pointing inward, expected outward normals"):
        distance_field(vertices, faces[:, ::-1])


def test_foam_in_millimetres_is_refused():
    vertices, faces = sphere(50.0, 2)
    with pytest.raises(InputError, match="is it in the right unit"):
        distance_field(vertices, faces)


def test_a_field_is_kept_under_the_content_of_its_surface():
    v, f = sphere(0.05, 2)
    first = distance_field(v, f, spacing=0.01)
    assert distance_field(v.copy(), f.copy(), spacing=0.01) is first
    moved = distance_field(v * 1.001, f, spacing=0.01)
    assert moved is not first
    assert distance_field(v, f, spacing=0.012) is not first
    assert distance_field(v * 1.001, f, spacing=0.01) is moved
    # Two are kept in memory: the first comes back from disk, equal.
    again = distance_field(v, f, spacing=0.01)
    assert again is not first
    assert again.coefficients.tobytes() == first.coefficients.tobytes()
