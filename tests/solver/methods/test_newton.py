import numpy as np
import pytest
from scipy.sparse import csc_array

from seatlook.solver.element.elastic import ElasticSheet
from seatlook.solver.element.loads import DeadLoad, Pressure
from seatlook.solver.methods.newton import Potential, factorise, line_search, newton
from support import fabrics, meshes


def strip(kind="right", length=1.0, width=0.1, h=0.05, stretch=1e4, bend=1e-2):
    X, T = meshes.rectangle(kind, length, width, h)
    fabric = fabrics.isotropic(stretch, bend)
    return X, T, ElasticSheet(X, T, np.zeros(len(T)), [fabric])


def shortened(X, sheet, strain):
    """Strip held at both short ends, closer together than its length."""
    ends = (X[:, 0] < 1e-9) | (X[:, 0] > X[:, 0].max() - 1e-9)
    free = np.repeat(~ends[:, None], 3, axis=1)
    x = np.pad(X * [1 - strain, 1.0], ((0, 0), (0, 1)))
    return x, Potential(sheet.energies, (), free)


def test_negative_pivots_count_negative_eigenvalues():
    rng = np.random.default_rng(0)
    A = rng.standard_normal((12, 12))
    A = A + A.T
    assert factorise(csc_array(A))[1] == (np.linalg.eigvalsh(A) < 0).sum()


def test_flat_sheet_past_its_buckling_load_is_reported_unstable():
    X, _, sheet = strip()
    x, potential = shortened(X, sheet, 0.01)
    flat = newton(potential, x, tolerance=1e-8)
    assert flat.residual <= 1e-8
    assert flat.downhill > 0
    assert not flat.stable
    assert abs(flat.x[:, 2]).max() == 0.0


def test_kick_leaves_the_flat_state_for_the_euler_arch():
    X, _, sheet = strip()
    x, potential = shortened(X, sheet, 0.01)
    arch = newton(potential, x, tolerance=1e-8, kick=1e-3)
    assert arch.kicks >= 1
    assert arch.stable
    # Hinged ends: z = a sin(pi x / L) with (pi a / 2 L)^2 = shortening, less what is compressed.
    critical = np.pi**2 * 1e-2 / 1e4
    amplitude = 2 / np.pi * np.sqrt(0.01 - critical)
    assert abs(arch.x[:, 2]).max() == pytest.approx(amplitude, rel=0.02)


def test_potential_never_rises():
    X, _, sheet = strip("uns")
    x, potential = shortened(X, sheet, 0.03)
    rng = np.random.default_rng(1)
    x[:, 2] += np.where(potential.free[:, 2], 1e-3 * rng.standard_normal(len(x)), 0.0)
    result = newton(potential, x, tolerance=1e-6)
    assert result.residual <= 1e-6
    assert len(result.energy) > 5
    assert (np.diff(result.energy) <= 1e-11 * abs(result.energy[0])).all()


def test_short_budget_is_not_called_converged():
    X, _, sheet = strip()
    x, potential = shortened(X, sheet, 0.03)
    x[:, 2] = 0.05 * np.sin(np.pi * X[:, 0])
    result = newton(potential, x, max_iterations=1)
    assert result.iterations == 1
    assert result.residual > 1e-6
    assert not result.stable


def test_same_input_gives_the_same_bits():
    X, _, sheet = strip("uns")
    x, potential = shortened(X, sheet, 0.01)
    runs = [newton(potential, x, kick=1e-3).x for _ in range(2)]
    assert (runs[0] == runs[1]).all()


@pytest.mark.parametrize("load", ["pressure", "dead"])
def test_loads_pass_the_taylor_test(load):
    X, T, _ = strip("uns")
    rng = np.random.default_rng(2)
    x, d = rng.standard_normal((len(X), 3)), rng.standard_normal((len(X), 3))
    term = Pressure(T, 3.0) if load == "pressure" else DeadLoad(rng.standard_normal(x.shape))
    gradient = np.zeros_like(x)
    start = term.value(x, gradient)
    e = 1e-4
    up, down = (term.value(x + s * e * d, np.zeros_like(x)) for s in (1, -1))
    assert (up - down) / (2 * e) == pytest.approx((gradient * d).sum(), rel=1e-6)
    assert start == pytest.approx(0.5 * (up + down), rel=1e-3)
    ahead, behind = np.zeros_like(x), np.zeros_like(x)
    term.value(x + e * d, ahead)
    term.value(x - e * d, behind)
    H = term.hessian(x)
    np.testing.assert_allclose(H @ d.ravel(), ((ahead - behind) / (2 * e)).ravel(), atol=1e-7)
    assert term.stiffness() is None
    assert term.hessian(x, definite=True).nnz == 0


def test_pressure_on_inner_vertices_is_pressure_times_their_area():
    X, T, sheet = strip()
    gradient = np.zeros((len(X), 3))
    Pressure(T, 5.0).value(np.pad(X, ((0, 0), (0, 1)), constant_values=0.7), gradient)
    inner = np.setdiff1d(np.arange(len(X)), sheet.edges.ends[sheet.edges.free])
    expected = 5.0 * sheet.mass[inner] / 0.3
    np.testing.assert_allclose(-gradient[inner, 2], expected, rtol=1e-12)
    np.testing.assert_allclose(gradient[inner, :2], 0.0, atol=1e-15)


class Curved:
    """1 + c z^2 / 2, so high that what it changes drowns in the rounding of the sum."""

    def __init__(self, curvature):
        self.curvature = curvature

    def value(self, x):
        return 1.0 + 2.0**-52 * (x[0, 2] != 1e-9), self.curvature * x * [0.0, 0.0, 1.0]

    def rounding(self, x):
        return 2.0**-51


@pytest.mark.parametrize(("curvature", "ends"), [(-1e-3, 1.1e-8), (1e-3, -2.5e-10)])
def test_line_search_knows_ridge_and_valley_within_rounding(curvature, ends):
    """A ridge is left by the whole step; in a valley the step ends near the bottom."""
    x = np.array([[0.0, 0.0, 1e-9]])
    step = np.array([[0.0, 0.0, -np.sign(curvature) * 1e-8]])
    potential = Curved(curvature)
    point = line_search(potential, (x, *potential.value(x)), step, np.inf)
    assert point is not None
    assert point[0][0, 2] == pytest.approx(ends)
