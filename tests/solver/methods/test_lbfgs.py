import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.sparse import csc_array, diags_array, identity, kron

from seatlook.errors import SolverError
from seatlook.solver.kernels import lbfgs as kernel
from seatlook.solver.methods.factor import Factor, SplitFactor
from seatlook.solver.methods.lbfgs import Lbfgs, Potential


class Quadratic:
    """x . K x / 2 - b . x, counted, with every value kept."""

    def __init__(self, matrix, load):
        self.matrix, self.load, self.values = csc_array(matrix), load, []

    def value(self, x, gradient):
        force = self.matrix @ x
        gradient += force - self.load
        self.values.append(0.5 * float(np.sum(x * force)) - float(np.sum(x * self.load)))
        return self.values[-1]

    def stiffness(self):
        return self.matrix

    def hessian(self, x, *, definite=False):
        return csc_array(kron(self.matrix, identity(3)))


class Rosenbrock:
    """The banana valley in the first two coordinates of every row."""

    def value(self, x, gradient):
        a, b = x[:, 0], x[:, 1]
        gradient[:, 0] += -2 * (1 - a) - 400 * a * (b - a * a)
        gradient[:, 1] += 200 * (b - a * a)
        gradient[:, 2] += 2 * x[:, 2]
        return float(np.sum((1 - a) ** 2 + 100 * (b - a * a) ** 2 + x[:, 2] ** 2))

    def stiffness(self):
        return None

    def hessian(self, x, *, definite=False):
        raise AssertionError("not asked for")


def chain(n, ends=1.0):
    return diags_array(
        [np.full(n, 2.0 + 1e-3 * ends), -np.ones(n - 1), -np.ones(n - 1)], offsets=[0, 1, -1]
    )


def run(energy, x, factor, *, tolerance=1e-9, iterations=500, **options):
    minimiser = Lbfgs(x.shape, **options)
    sizes = []
    descent = minimiser.minimise(
        Potential([energy]),
        x,
        factor,
        stop=lambda g: bool(sizes.append(np.abs(g).max()) or sizes[-1] < tolerance),
        iterations=iterations,
    )
    return descent, sizes


@given(n=st.integers(2, 40), seed=st.integers(0, 10_000))
@settings(max_examples=25, deadline=None)
def test_exact_matrix_solves_a_quadratic_in_one_step(n, seed):
    load = np.random.default_rng(seed).normal(size=(n, 3))
    K = csc_array(chain(n))
    x = np.zeros((n, 3))
    descent, _ = run(Quadratic(K, load), x, Factor(K), tolerance=1e-8, step_cap=1e9)
    assert descent.iterations <= 2
    np.testing.assert_allclose(K @ x, load, atol=1e-7)


def test_poor_matrix_still_solves_a_quadratic():
    n = 60
    load = np.random.default_rng(0).normal(size=(n, 3))
    K = csc_array(chain(n))
    x = np.zeros((n, 3))
    rough = Factor(csc_array(4 * identity(n)))
    descent, _ = run(Quadratic(K, load), x, rough, tolerance=1e-5, step_cap=1e9)
    assert not descent.stalled
    np.testing.assert_allclose(K @ x, load, atol=1.1e-5)


def test_finds_the_end_of_the_banana_valley():
    x = np.tile([-1.2, 1.0, 0.3], (3, 1))
    descent, _ = run(Rosenbrock(), x, Factor(csc_array(200 * identity(3))), step_cap=0.5)
    np.testing.assert_allclose(x, np.tile([1.0, 1.0, 0.0], (3, 1)), atol=1e-7)
    assert descent.value < 1e-14


def test_accepted_values_never_rise_and_no_vertex_passes_the_cap():
    class Watched(Lbfgs):
        def _remember(self, x, pairs):
            steps.append(np.linalg.norm(self._trial - x, axis=1).max())
            values.append(energy.value(self._trial, np.zeros_like(x)))
            return super()._remember(x, pairs)

    energy, steps, values = Rosenbrock(), [], []
    x = np.tile([-1.2, 1.0, 0.3], (2, 1))
    Watched(x.shape, step_cap=0.1).minimise(
        Potential([energy]), x, Factor(csc_array(identity(2))), stop=lambda g: False, iterations=80
    )
    assert max(steps) <= 0.1 * (1 + 1e-12)
    assert (np.diff(values) <= 0).all()


def test_stops_at_the_limit_of_iterations():
    x = np.tile([-1.2, 1.0, 0.3], (2, 1))
    descent, _ = run(Rosenbrock(), x, Factor(csc_array(200 * identity(2))), iterations=3)
    assert descent.iterations == 3
    assert descent.evaluations >= 4


def test_a_stall_is_reported():
    class Liar(Quadratic):
        def value(self, x, gradient):
            value = super().value(x, gradient)
            gradient *= -1.0
            return value

    K = csc_array(chain(4))
    x = np.ones((4, 3))
    descent, _ = run(Liar(K, np.zeros((4, 3))), x, Factor(K))
    assert descent.stalled
    np.testing.assert_array_equal(x, np.ones((4, 3)))


@pytest.mark.parametrize("wrong", [0.0, 3e-12])
def test_values_that_rounding_swallows_do_not_hold_up_the_search(wrong):
    """The last digits come from the slope: Armijo's rule alone takes 4507 evaluations, or stalls.

    A sum over a mesh has a few wrong digits more.
    """
    rng = np.random.default_rng(0)

    class Rounded(Quadratic):
        def value(self, x, gradient):
            return super().value(x, gradient) + wrong * rng.normal()

    x, load = np.zeros((40, 3)), np.random.default_rng(3).normal(size=(40, 3))
    guess = Factor(csc_array(4.0 * identity(40)))
    descent, sizes = run(Rounded(chain(40, ends=300.0), load), x, guess, step_cap=1e9)
    assert sizes[-1] < 1e-9
    assert not descent.stalled
    assert descent.evaluations <= 65


def test_full_matrix_is_taken_too():
    K = csc_array(kron(chain(5), np.diag([1.0, 2.0, 3.0])))
    right, out = np.random.default_rng(0).normal(size=(5, 3)), np.zeros((5, 3))
    Factor(K).solve(right, out)
    np.testing.assert_allclose(K @ out.ravel(), right.ravel(), atol=1e-12)


def test_split_matrix_treats_the_normal_by_itself():
    along, across = csc_array(chain(6)), csc_array(0.1 * chain(6, ends=5.0))
    normal = np.tile([0.0, 0.6, 0.8], (6, 1))
    normal[0] = 0.0
    held = across + diags_array(np.where(np.arange(6) == 0, 1e12, 0.0))
    right, out = np.random.default_rng(0).normal(size=(6, 3)), np.zeros((6, 3))
    SplitFactor(along, csc_array(held), normal).solve(right, out)
    project = normal[:, :, None] * normal[:, None, :]
    inside = right - np.einsum("ijk,ik->ij", project, right)
    level = np.linalg.solve(along.toarray(), inside)
    level -= np.einsum("ijk,ik->ij", project, level)
    pressing = np.linalg.solve(held.toarray(), np.einsum("ij,ij->i", normal, right))
    np.testing.assert_allclose(out, level + pressing[:, None] * normal, atol=1e-12)


def test_singular_matrix_is_an_error():
    with pytest.raises(SolverError, match="cannot be factored"):
        Factor(csc_array((4, 4)))
    with pytest.raises(SolverError, match="cannot be factored"):
        Factor(csc_array(chain(4) - 3.0 * np.eye(4)))


def test_what_only_rounding_makes_indefinite_is_lifted():
    free = chain(30) - np.diag(chain(30).sum(axis=0))
    free[3, 3] -= 1e-15
    right, out = np.zeros((30, 3)), np.zeros((30, 3))
    right[0], right[-1] = 1.0, -1.0
    Factor(csc_array(free)).solve(right, out)
    np.testing.assert_allclose(free @ out, right, atol=1e-2)


def test_matrices_of_one_pattern_share_its_order_alone():
    first, second = csc_array(chain(50)), csc_array(3.0 * chain(50, ends=7.0))
    one, two = Factor(first), Factor(second)
    assert one._cholesky._pattern is two._cholesky._pattern
    right = np.arange(50.0)
    for matrix, factor in ((first, one), (second, two)):
        np.testing.assert_allclose(matrix @ factor.column(right), right, atol=1e-10)


def test_kernels_equal_numpy():
    rng = np.random.default_rng(0)
    a, b = rng.normal(size=(2, 50, 3))
    assert kernel.dot(a, b) == pytest.approx(np.sum(a * b), rel=1e-13)
    assert kernel.largest_row(a) == pytest.approx(np.linalg.norm(a, axis=1).max(), rel=1e-14)
    out = np.empty_like(a)
    kernel.add_scaled(a, 0.3, b, out)
    np.testing.assert_allclose(out, a + 0.3 * b, rtol=1e-15)
    a[7, 1] = np.nan
    assert np.isnan(kernel.largest_row(a))


def test_two_loops_equal_the_dense_update():
    """H of the recursion against the BFGS formula, memory running over."""
    rng = np.random.default_rng(5)
    n, memory, pairs = 4, 3, 5
    A = np.eye(3 * n) * 3 + 0.2 * np.ones((3 * n, 3 * n))
    s, y = np.zeros((memory, n, 3)), np.zeros((memory, n, 3))
    rho, alpha = np.zeros(memory), np.zeros(memory)
    count = []
    for k in range(pairs):
        d = rng.normal(size=(n, 3))
        s[k % memory], y[k % memory] = d, (A @ d.ravel()).reshape(n, 3)
        rho[k % memory] = 1 / np.sum(s[k % memory] * y[k % memory])
        count.append((d.ravel(), A @ d.ravel()))
    H = np.eye(3 * n)
    for d, g in count[-memory:]:
        r = 1 / (d @ g)
        V = np.eye(3 * n) - r * np.outer(g, d)
        H = V.T @ H @ V + r * np.outer(d, d)
    q = rng.normal(size=(n, 3))
    expected = H @ q.ravel()
    kernel.first_loop(q, s, y, rho, alpha, pairs)
    kernel.second_loop(q, s, y, rho, alpha, pairs)
    np.testing.assert_allclose(q.ravel(), expected, rtol=1e-10, atol=1e-12)
