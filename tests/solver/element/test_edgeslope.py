import numpy as np
import pytest

from seatlook.errors import InputError, InvertedElementError
from seatlook.solver.element.edgeslope import areas, edges_of, slope_rows
from seatlook.solver.kernels.edgeslope import RIDGE
from support import meshes, naive


def quadratic(X):
    x, y = X.T
    value = 1 + 2 * x - y + 3 * x**2 - x * y + 0.5 * y**2
    return value, np.stack([2 + 6 * x - y, -1 - x + y], axis=1)


def recovered(rows, values):
    return np.add.reduceat(rows.weights * values[rows.nodes], rows.start[:-1])


def test_two_triangles_have_one_inner_edge():
    X = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    T = np.array([[0, 1, 2], [0, 2, 3]])
    edges = edges_of(X, T)
    assert len(edges.ends) == 5
    assert edges.free.sum() == 4
    (inner,) = np.flatnonzero(~edges.free)
    assert set(edges.ends[inner]) == {0, 2}
    assert edges.length[inner] == pytest.approx(np.sqrt(2))
    # Out of the first face: 0-1-2 lies below the diagonal, so its conormal points up left.
    assert edges.faces[inner].tolist() == [0, 1]
    np.testing.assert_allclose(edges.normal[inner], [-np.sqrt(0.5), np.sqrt(0.5)])
    assert sorted(edges.sign.ravel()) == [-1, 1, 1, 1, 1, 1]


@pytest.mark.parametrize("kind", meshes.KINDS)
def test_slope_is_exact_for_quadratics(kind):
    X, T = meshes.rectangle(kind, 1.0, 0.7, 0.1)
    edges = edges_of(X, T)
    values, _ = quadratic(X)
    _, gradient = quadratic(X[edges.ends].mean(axis=1))
    expected = (gradient * edges.normal).sum(axis=1)
    np.testing.assert_allclose(recovered(slope_rows(X, T, edges), values), expected, atol=1e-11)


@pytest.mark.parametrize("kind", ["uns", "sliver"])
def test_rows_equal_the_plain_least_squares_fit(kind):
    X, T = meshes.rectangle(kind, 1.0, 1.0, 0.2)
    edges = edges_of(X, T)
    rows = slope_rows(X, T, edges)
    values = np.cos(3 * X[:, 0] - 2 * X[:, 1])
    twin = naive.conormal_slopes(X, edges.ends, rows.start, rows.nodes, values, RIDGE)
    inside = np.diff(rows.start) >= 8
    np.testing.assert_allclose(recovered(rows, values)[inside], twin[inside], atol=1e-12)


def test_error_of_a_wave_falls_with_the_square_of_h():
    errors = []
    for h in (0.1, 0.05, 0.025):
        X, T = meshes.rectangle("uns", 1.0, 1.0, h)
        edges = edges_of(X, T)
        mid = X[edges.ends].mean(axis=1)
        slope = 3 * np.cos(3 * mid[:, 0]) * edges.normal[:, 0]
        result = recovered(slope_rows(X, T, edges), np.sin(3 * X[:, 0]))
        errors.append(np.sqrt(((result - slope) ** 2).mean()))
    rate = np.polyfit(np.log([0.1, 0.05, 0.025]), np.log(errors), 1)[0]
    assert rate > 1.9
    # (q h)^2 / 24 of the slope inside, more where the fit is one-sided at the rim.
    assert errors[-1] < 2e-3


def test_strip_of_one_element_still_reproduces_planes():
    X, T = meshes.rectangle("right", 1.0, 0.1, 0.1)
    edges = edges_of(X, T)
    result = recovered(slope_rows(X, T, edges), 2 * X[:, 0] - 3 * X[:, 1])
    np.testing.assert_allclose(result, edges.normal @ [2.0, -3.0], atol=1e-12)


def test_single_triangle():
    X = np.array([[0.0, 0.0], [1.0, 0.0], [0.3, 0.8]])
    edges = edges_of(X, np.array([[0, 1, 2]]))
    result = recovered(slope_rows(X, np.array([[0, 1, 2]]), edges), X @ [1.0, 2.0])
    np.testing.assert_allclose(result, edges.normal @ [1.0, 2.0], atol=1e-12)


def test_edge_with_three_faces_is_refused():
    X = np.array([[0.0, 0.0], [1.0, 0.0], [0.5, 1.0], [0.5, 2.0], [0.5, -1.0]])
    with pytest.raises(
        InputError, match=r"1 edges with over two faces.*expected an oriented sheet"
    ):
        edges_of(X, np.array([[0, 1, 2], [0, 1, 3], [1, 0, 4]]))


def test_faces_that_run_against_each_other_are_refused():
    X = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    with pytest.raises(InputError, match="1 with faces that run the same way"):
        edges_of(X, np.array([[0, 1, 2], [0, 3, 2]]))


@pytest.mark.parametrize("corner", [[0.5, 0.0], [0.5, -0.1]])
def test_flat_and_turned_triangles_are_refused(corner):
    X = np.array([[0.0, 0.0], [1.0, 0.0], corner])
    with pytest.raises(InvertedElementError, match="1 triangles are turned over"):
        areas(X, np.array([[0, 1, 2]]))
