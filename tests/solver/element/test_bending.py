import math

import numpy as np
import pytest

from seatlook.solver.element.bending import JUMP, Bending
from seatlook.solver.element.curvature import recover_curvature
from seatlook.solver.element.edgeslope import areas, edges_of, slope_rows
from seatlook.solver.element.elastic import ElasticSheet
from support import fabrics, meshes, naive
from support.reference.morley import MorleySheet
from support.reference.waves import lateral_load, sine_curvature_error, winkler_load


def sheet(kind="uns", fabric=None, h=0.1, **clamp):
    X, T = meshes.rectangle(kind, 1.0, 0.8, h)
    return X, ElasticSheet(X, T, np.zeros(len(T)), [fabric or fabrics.woven()], **clamp)


def gradient(energy, x):
    out = np.zeros_like(x)
    energy.value(x, out)
    return out


def bowl(X):
    """Quadratic surface with curvature (-0.3, 0.2; 0.1 off the diagonal)."""
    x, y = X.T
    return np.column_stack([X, 0.15 * x**2 - 0.1 * x * y - 0.1 * y**2])


@pytest.mark.parametrize("kind", meshes.KINDS)
def test_curvature_of_a_quadratic_is_exact_inside(kind):
    X, s = sheet(kind)
    flat_limit = bowl(X) * [1.0, 1.0, 1e-6]
    kappa = s.curvatures(flat_limit) / 1e-6
    rim = s.edges.free[s.edges.of_face].any(axis=1)
    expected = [[-0.3, 0.1], [0.1, 0.2]]
    np.testing.assert_allclose(kappa[~rim], np.tile(expected, ((~rim).sum(), 1, 1)), atol=1e-8)


def test_crown_is_positive_and_its_top_longer():
    X, s = sheet(fabric=fabrics.isotropic(poisson=0.0))
    radius = 2.0
    angle = X[:, 0] / radius
    x = np.column_stack([radius * np.sin(angle), X[:, 1], radius * np.cos(angle)])
    top, mid, bottom = s.strains(x)
    inside = ~s.edges.free[s.edges.of_face].any(axis=1)
    np.testing.assert_allclose(s.curvatures(x)[inside, 0, 0], 1 / radius, rtol=0.02)
    between = s.thickness[:, None, None] * s.recovered_curvatures(x)
    np.testing.assert_allclose(top - bottom, between, atol=1e-15)
    assert (top - bottom)[:, 0, 0].min() > 0.0
    np.testing.assert_allclose(top + bottom, 2 * mid, atol=1e-15)


@pytest.mark.parametrize("h", [0.1, 0.05, 0.03])
def test_energy_of_an_almost_flat_sheet_is_not_lost_in_rounding(h):
    """Terms of either sign that sum to a billionth of their size; summed one by one .1 eps."""
    X, s = sheet(h=h)
    x = np.column_stack([X, 5e-5 * np.sin(12 * X[:, 0])])
    start, column, value = s.bending._pairs
    row = np.repeat(np.arange(len(X)), np.diff(start))
    terms = -0.5 * value * ((x[column] - x[row]) ** 2).sum(axis=1)
    exact, size = math.fsum(terms), np.abs(terms).sum()
    assert abs(exact) < 1e-7 * size
    energy = s.bending.value(x, np.zeros_like(x))
    assert abs(energy - exact) < 0.03 * np.finfo(float).eps * size


@pytest.mark.parametrize("kind", ["uns", "sliver"])
def test_kernels_equal_their_twins(kind):
    X, T = meshes.rectangle(kind, 1.0, 0.8, 0.15)
    edges, area = edges_of(X, T), areas(X, T)
    rows = slope_rows(X, T, edges)
    rng = np.random.default_rng(4)
    stiffness = np.einsum("tij,tkj->tik", *2 * (rng.standard_normal((len(T), 3, 3)),))
    # With every rim sewn no rotation is released.
    rim = np.flatnonzero(edges.free)
    curvature = recover_curvature(len(X), edges, rows, area, stiffness, None, rim)
    dense = naive.curvature_rows(X, edges, rows, area)
    x = bowl(X) + 0.01 * rng.standard_normal((len(X), 3))
    np.testing.assert_allclose(curvature.at(x), dense @ x, atol=1e-9)
    values = rng.standard_normal((len(T), 3, 3))
    back = np.einsum("tcn,tci->ni", dense, values)
    np.testing.assert_allclose(curvature.back(values), back, atol=1e-9)
    K = Bending(edges, curvature, area, stiffness).stiffness().toarray()
    twin = naive.bending_matrix(dense, edges, area, stiffness, JUMP)
    np.testing.assert_allclose(K, twin, atol=1e-11 * abs(twin).max())


@pytest.mark.parametrize("kind", meshes.KINDS)
def test_constant_moment_is_in_balance_inside(kind):
    X, s = sheet(kind, h=0.08)
    force = gradient(s.bending, bowl(X))
    inside = ((X > 0.25) & (X < [0.75, 0.55])).all(axis=1)
    assert inside.sum() > 5
    assert abs(force[inside]).max() < 1e-9 * abs(force).max()


@pytest.mark.parametrize("kind", meshes.KINDS)
def test_only_rigid_motion_is_free(kind):
    _, s = sheet(kind, fabrics.isotropic(bend=1.0, poisson=0.3), h=0.2)
    values = np.linalg.eigvalsh(s.bending.stiffness().toarray())
    assert abs(values[:3]).max() < 1e-9 * values[-1]
    # The softest mode of a free plate this size is a saddle: no spurious mode below it.
    assert values[3] > 1e-4 * values[-1]


def test_sparse_morley_equals_its_dense_twin():
    X, T = meshes.rectangle("uns", 1.0, 0.5, 0.2)
    fabric = fabrics.isotropic(poisson=0.3)
    reference = MorleySheet(X, T, fabric)
    stiffness = np.tile(fabric.bending_matrix, (len(T), 1, 1))
    K, n = reference.bending.stiffness().toarray(), len(X)
    condensed = K[:n, :n] - K[:n, n:] @ np.linalg.solve(K[n:, n:], K[n:, :n])
    twin = naive.morley_matrix(X, reference.edges, reference.area, stiffness)
    np.testing.assert_allclose(condensed, twin, atol=1e-12 * abs(twin).max())
    # A cylinder w = x^2 / 2: bending and tension exact.
    slope = 0.5 * X[reference.edges.ends, 0].sum(axis=1) * reference.edges.normal[:, 0]
    w = np.concatenate([0.5 * X[:, 0] ** 2, slope])
    assert 0.5 * w @ K @ w == pytest.approx(0.5 * 0.5 * fabric.bending_warp)
    assert w @ reference.stress_stiffness(np.diag([1.0, 0.0])) @ w == pytest.approx(0.5 / 3)


@pytest.mark.parametrize("kind", meshes.KINDS)
def test_nothing_is_softer_than_morleys_plate(kind):
    # Recovered turns of the edges cannot beat the best ones: no mode can be spurious.
    X, T = meshes.rectangle(kind, 1.0, 0.8, 0.2)
    fabric = fabrics.isotropic(bend=1.0, poisson=0.3)
    s = ElasticSheet(X, T, np.zeros(len(T)), [fabric])
    stiffness = np.tile(fabric.bending_matrix, (len(T), 1, 1))
    morley = naive.morley_matrix(X, s.edges, s.area, stiffness)
    lowest = np.linalg.eigvalsh(s.bending.stiffness().toarray() - morley)[0]
    assert lowest > -1e-9 * np.linalg.eigvalsh(morley)[-1]


def test_energy_gradient_and_hessian_agree():
    X, s = sheet("sliver")
    rng = np.random.default_rng(0)
    x, d = bowl(X) + 0.01 * rng.standard_normal((len(X), 3)), rng.standard_normal((len(X), 3))
    value, twin_gradient = naive.quadratic(s.bending.stiffness().toarray(), x)
    assert s.bending.value(x, np.zeros_like(x)) == pytest.approx(value, rel=1e-9)
    np.testing.assert_allclose(gradient(s.bending, x), twin_gradient, atol=1e-11)
    H = s.bending.hessian(x)
    change = gradient(s.bending, x + d) - gradient(s.bending, x)
    np.testing.assert_allclose(H @ d.ravel(), change.ravel(), atol=1e-10)


def test_rigid_motion_costs_nothing():
    X, s = sheet()
    rng = np.random.default_rng(2)
    x = np.pad(X, ((0, 0), (0, 1))) @ fabrics.rotation(rng).T + rng.standard_normal(3)
    assert abs(s.bending.value(x, np.zeros_like(x))) < 1e-10
    assert abs(gradient(s.bending, x)).max() < 1e-10
    np.testing.assert_allclose(s.curvatures(x), 0.0, atol=1e-9)


def test_clamp_holds_the_slope():
    X, T = meshes.rectangle("uns", 1.0, 0.2, 0.1)
    clamped = X[:, 0] < 1e-9
    s = ElasticSheet(X, T, np.zeros(len(T)), [fabrics.isotropic(bend=1.0)], clamped=clamped)
    flat = np.pad(X, ((0, 0), (0, 1)))
    assert abs(s.bending.value(flat, np.zeros_like(flat))) < 1e-20
    # Turning the sheet about its clamped edge now bends it.
    tilted = np.column_stack([X, 0.1 * X[:, 0]])
    assert s.bending.value(tilted, np.zeros_like(flat)) > 1e-3
    rng = np.random.default_rng(3)
    d, e = rng.standard_normal(flat.shape), 1e-6
    rise = s.bending.value(tilted + e * d, np.zeros_like(flat))
    fall = s.bending.value(tilted - e * d, np.zeros_like(flat))
    assert (rise - fall) / (2 * e) == pytest.approx((gradient(s.bending, tilted) * d).sum())


@pytest.mark.parametrize("kind", ["uns", "right", "sliver"])
def test_buckling_load_on_a_soft_bed(kind):
    assert abs(winkler_load(kind, 8)) < 0.025
    assert abs(winkler_load(kind, 12)) < 0.015


@pytest.mark.parametrize("kind", meshes.KINDS)
def test_lateral_buckling_of_a_narrow_strip(kind):
    # Timoshenko's 12.85 is the limit of no width; the rest is the width.
    assert lateral_load(kind, 0.02, 4) == pytest.approx(12.85, rel=0.03)


@pytest.mark.parametrize(
    ("kind", "raw", "recovered"),
    [("uns", 0.15, 0.05), ("right", 0.15, 0.065), ("sliver", 0.16, 0.075), ("alt", 0.165, 0.065)],
)
def test_curvature_of_a_sine_sheet(kind, raw, recovered):
    coarse, fine = (sine_curvature_error(kind, n) for n in (8, 16))
    assert coarse[0] < raw
    assert fine[0] < 0.08
    assert coarse[1] < recovered
    assert fine[1] < 0.025
