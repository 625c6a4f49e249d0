import numpy as np
import pytest

from seatlook.identify.elastica import load_of_angle, load_of_outline, outline
from support.reference.elastica import hanging_tip

# w l^3 / B of the exact elastica, from an own boundary value problem to 1e-8.
TABLE = {
    5: 0.70113, 10: 1.42048, 15: 2.17752, 20: 2.99437, 30: 4.92094, 41.5: 8.00420,
    43: 8.51630, 45: 9.25381, 55: 14.2955, 65: 23.9522, 75: 50.5058,
}  # fmt: skip


def test_the_table_of_cantilevers():
    found = load_of_angle(np.radians(list(TABLE)))
    np.testing.assert_allclose(found, list(TABLE.values()), rtol=1e-3)
    np.testing.assert_allclose(found, list(TABLE.values()), rtol=5e-6)


def test_the_standard_is_exact_at_its_own_angle():
    assert 8.0 / load_of_angle(np.radians([41.5]))[0] == pytest.approx(1.0, abs=6e-4)


@pytest.mark.parametrize("load", [0.7, 8.0, 50.0])
def test_outline_ends_where_the_solver_of_boundary_values_ends(load):
    tip = hanging_tip(load, 0.0)
    points = outline(load)
    np.testing.assert_allclose(points[-1] * [1, -1], tip, atol=2e-6)
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    assert steps.sum() == pytest.approx(1.0, abs=2e-4)


@pytest.mark.parametrize("load", [0.8, 3.8, 12.0, 40.0])
def test_a_traced_strip_gives_its_load_back(load):
    points = 0.06 * outline(load, 26)
    found, length, misfit = load_of_outline(points)
    assert found == pytest.approx(load, rel=1e-5)
    assert length == pytest.approx(0.06, rel=1e-5)
    rough = points + 1e-4 * np.random.default_rng(0).normal(size=points.shape)
    assert load_of_outline(rough)[0] == pytest.approx(load, rel=0.03)
    assert misfit < 1e-8
