"""The methods agree, and each says when it does not work."""

import numpy as np
import pytest

from seatlook import model
from seatlook.errors import InputError
from seatlook.solver import (
    Explicit,
    Load,
    Sheet,
    SheetError,
    SheetSettings,
    SolverSettings,
    Support,
    UnstableStepError,
    solve,
    solve_sheet,
)
from seatlook.solver.methods.explicit import DampedDynamics, Motion, least_mass, stable_step
from seatlook.solver.process.process import Process
from support import fabrics, meshes
from support.covers import cover, flat_foam, sheet
from support.reference.elastica import hanging_tip

METHODS = ("newton", "lbfgs", "explicit")


def strip(method, *, gamma=1.0, slenderness=0.02, edges=10, strict=False, **options):
    """Hanging strip of length 1 and how far its tip is from the elastica's."""
    X, T = meshes.rectangle("uns", 1.0, 0.2, 1.0 / edges)
    fabric = fabrics.isotropic(12.0 / slenderness**2, 1.0, density=1.0, thickness=slenderness)
    solved = solve_sheet(
        Sheet(X, T, fabric),
        support=Support(clamped=X[:, 0] < 1e-9),
        load=Load(gravity=(0, 0, -gamma)),
        settings=SheetSettings(method=method, **options),
        strict=strict,
    )
    tip = solved.positions[X[:, 0] > 1 - 1e-9].mean(axis=0)
    x, z = hanging_tip(gamma, slenderness)
    return solved, np.hypot(tip[0] - x, tip[2] - z)


@pytest.mark.parametrize("method", METHODS)
def test_every_method_finds_the_elastica(method):
    solved, error = strip(method, tolerance=1e-4, strict=True)
    assert solved.residual <= 1e-4
    assert error < 1e-3


@pytest.mark.parametrize("method", METHODS)
def test_every_method_leaves_the_flat_state(method):
    """Pushed together by 1 %, ends hinged: z = a sin(pi x / L), less what is compressed."""
    X, T = meshes.rectangle("right", 1.0, 0.1, 0.1)
    fabric = fabrics.isotropic(1e4, 1e-2)
    ends = (X[:, 0] < 1e-9) | (X[:, 0] > 1 - 1e-9)
    flat = np.pad(X * [0.99, 1.0], ((0, 0), (0, 1)))
    solved = solve_sheet(
        Sheet(X, T, fabric),
        start=flat,
        support=Support(fixed=ends),
        settings=SheetSettings(method=method),
        strict=True,
    )
    assert solved.kicks >= 1
    amplitude = 2 / np.pi * np.sqrt(0.01 - np.pi**2 * 1e-2 / 1e4)
    assert abs(solved.positions[:, 2]).max() == pytest.approx(amplitude, rel=0.03)


@pytest.mark.parametrize("method", METHODS)
def test_too_few_iterations_are_raised_with_the_last_state(method):
    with pytest.raises(SheetError, match=r"residual .* above") as caught:
        strip(method, gamma=10.0, max_iterations=2, strict=True)
    assert np.isfinite(caught.value.solution.positions).all()


@pytest.mark.parametrize("method", METHODS)
def test_same_input_same_bits(method):
    first, second = (strip(method, tolerance=1e-2)[0] for _ in range(2))
    assert first.positions.tobytes() == second.positions.tobytes()


def test_unknown_method_is_refused():
    with pytest.raises(InputError, match="method: got 'xpbd', expected 'lbfgs', 'newton'"):
        strip("xpbd")


def test_mass_is_scaled_for_a_given_step_only():
    with pytest.raises(InputError, match="time_step: got nothing"):
        Explicit(scale_mass=True)
    with pytest.raises(InputError, match="time_step: got -1"):
        Explicit(time_step=-1.0)


def test_least_mass_makes_any_step_stable():
    X, T = meshes.rectangle("sliver", 1.0, 0.3, 0.1)
    process = Process(cover([(X, T, np.pad(X, ((0, 0), (0, 1))))], h=0.1))
    hessian = process._static.hessian(process.state, definite=True)
    assert stable_step(hessian, least_mass(hessian, 1e-3)) >= 1e-3


def oscillator(dt, steps=2000, **options):
    """A mass on a spring, omega = 2, for which steps up to 1 s are stable."""

    def gradient(x, out):
        np.multiply(x, 4.0, out=out)
        return 2.0 * float((x * x).sum())

    motion = Motion(np.array([[1.0, 0.0, 0.0]]), np.zeros((1, 3)), np.ones((1, 3)))
    motion.advance(gradient, dt=dt, steps=steps, **options)
    return motion.x, motion.v


def test_central_differences_up_to_their_limit_and_no_further():
    oscillator(0.99)
    with pytest.raises(UnstableStepError, match=r"energy grew without bound in steps of 1.01 s"):
        oscillator(1.01)


def test_damping_brings_the_oscillator_to_rest():
    x, v = oscillator(0.1, damping=2.0)
    assert max(abs(x).max(), abs(v).max()) < 1e-6


def test_explicit_sheet_above_its_time_step_is_raised_with_the_limit():
    with pytest.raises(SheetError, match=r"the mesh allows .* s: shorten time_step or scale"):
        strip(Explicit(time_step=1.0))


def laid(**change):
    X, T, x = sheet(0.12, 0.12, 0.04, z=0.002, at=(-0.06, -0.06))
    drop = model.Stage(name="drop", start=0.0, end=0.1)
    return cover([(X, T, x)], foam=flat_foam(), stages=[drop], h=0.04, **change)


def test_hessian_of_the_state_is_the_derivative_of_its_gradient():
    process = Process(laid())
    process.x[:, 2] = -0.001 + 0.0002 * np.sin(60.0 * process.x[:, 0])
    process.begin(rest=True)
    process.lag()
    rng = np.random.default_rng(0)
    way = 1e-7 * rng.standard_normal(process.state.shape)
    way.ravel()[4 * len(process.x) :] = 0.0
    ahead, behind = np.zeros_like(way), np.zeros_like(way)
    process._static.value(process.state + way, ahead)
    process._static.value(process.state - way, behind)
    process._static.value(process.state, np.zeros_like(way))
    product = process._static.hessian(process.state) @ way.ravel()
    measured = 0.5 * (ahead - behind).ravel()
    assert np.abs(product - measured).max() < 1e-4 * np.abs(measured).max()


def test_cover_comes_to_the_same_rest_by_every_method():
    implicit = solve(laid(), strict=True)
    for method in ("newton", Explicit(time_step=2e-4, scale_mass=True)):
        other = solve(laid(), settings=SolverSettings(method=method), strict=True)
        np.testing.assert_allclose(other.positions[:, 2], implicit.positions[:, 2], atol=2e-5)


def test_cover_above_the_explicit_time_step_is_raised():
    with pytest.raises(UnstableStepError, match="the mesh allows"):
        solve(laid(), settings=SolverSettings(method=Explicit(time_step=5e-3)))


def test_damped_dynamics_refuse_to_add_mass_that_was_given():
    mass = np.full((3, 3), 1.0)
    fixed = DampedDynamics((3, 3), Explicit(time_step=0.1), mass)
    assert fixed._masses(None, np.zeros((3, 3))) is mass
