"""Curvature from shape: exact surfaces, sign for both orientations, every kind of mesh."""

import numpy as np
import pytest

from seatlook.wrinkle.jet import vertex_curvature
from support.meshes import KINDS, rectangle

WAVE = 0.06
H = WAVE / 12


def inside(X, size, rows=2):
    return (np.minimum(X, size - X) > rows * H).all(axis=1)


@pytest.mark.parametrize("kind", KINDS)
def test_cylinder(kind):
    X, T = rectangle(kind, 0.1, 0.1, H)
    r = 0.05
    x = np.column_stack([r * np.sin(X[:, 0] / r), X[:, 1], r * np.cos(X[:, 0] / r)])
    values = np.linalg.eigvalsh(vertex_curvature(x, T))
    assert values[:, 2] == pytest.approx(np.full(len(X), 1 / r), rel=0.012)
    assert np.abs(values[inside(X, 0.1)][:, 0]).max() < 0.01 / r


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("flip", [1, -1])
def test_sine_at_twelve_elements_for_both_orientations(kind, flip):
    X, T = rectangle(kind, 3 * WAVE, 3 * WAVE, H)
    k, a = 2 * np.pi / WAVE, 0.0005
    x = np.column_stack([X, a * np.sin(k * X[:, 0])])
    K = vertex_curvature(x, T[:, ::flip])
    error = K[:, 0, 0] - flip * a * k**2 * np.sin(k * X[:, 0])
    rms = np.sqrt((error[inside(X, 3 * WAVE)] ** 2).mean())
    assert rms < 0.05 * a * k**2


def test_saddle_has_both_signs():
    X, T = rectangle("uns", 0.1, 0.1, H)
    u = X - 0.05
    K = vertex_curvature(np.column_stack([X, 5 * (u[:, 0] ** 2 - u[:, 1] ** 2)]), T)
    middle = np.linalg.norm(u, axis=1) < 0.01
    assert K[middle][:, 0, 0] == pytest.approx(np.full(middle.sum(), -10.0), rel=0.02)
    assert K[middle][:, 1, 1] == pytest.approx(np.full(middle.sum(), 10.0), rel=0.02)


def test_convergence_is_of_second_order():
    errors = []
    for n in (1, 2, 4):
        X, T = rectangle("right", WAVE, WAVE, H / n)
        k, a = 2 * np.pi / WAVE, 0.0005
        K = vertex_curvature(np.column_stack([X, a * np.sin(k * X[:, 0])]), T)
        keep = inside(X, WAVE)
        slope = a * k * np.cos(k * X[:, 0])
        # Curvature of the graph, along a tangent that is tilted by the slope.
        exact = a * k**2 * np.sin(k * X[:, 0]) / (1 + slope**2) ** 2.5
        error = (K[:, 0, 0] - exact)[keep]
        errors.append(np.sqrt((error**2).mean()) / (a * k**2))
    rates = np.log2(np.array(errors[:-1]) / errors[1:])
    assert rates == pytest.approx([2.0, 2.0], abs=0.15)
    assert errors[-1] < 0.005


def test_a_lone_triangle_has_no_curvature_to_tell():
    K = vertex_curvature(np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2]]))
    assert (K == 0).all()
