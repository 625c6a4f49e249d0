"""A cover in balance answers small changes by its true stiffness."""

from dataclasses import replace

import numpy as np
import pytest

from seatlook import io
from seatlook.assembly import assemble
from seatlook.errors import InputError
from seatlook.solver import solve
from seatlook.solver.balance import Balance


@pytest.fixture(scope="module")
def solved(demo_scene):
    return solve(assemble(io.load_scene(demo_scene)))


@pytest.fixture(scope="module")
def balance(solved):
    return Balance(solved)


def test_newton_comes_far_below_the_residual_of_a_solve(solved):
    balance = Balance(solved)
    before = balance.residual(balance.process.forces())
    assert balance.polish(1e-8) < 1e-8 < before
    assert balance.downhill == 0
    assert np.linalg.norm(balance.x - solved.positions, axis=1).max() < 1e-4


def test_the_stiffness_is_that_of_the_forces(balance):
    rng = np.random.default_rng(0)
    way = 1e-3 * rng.standard_normal(balance.process.state.shape)
    count = len(balance.x)
    way[count:].reshape(-1)[count:] = 0.0  # places of the state that stand for nothing
    product = balance.product(way)
    exact = (balance.process.stiffness() @ way.ravel()).reshape(way.shape)
    exact[count:].reshape(-1)[count:] = 0.0
    assert np.linalg.norm(product - exact) < 0.01 * np.linalg.norm(exact)


def test_solve_is_the_inverse_of_product(balance):
    rng = np.random.default_rng(1)
    right = np.zeros_like(balance.process.state)
    right[: len(balance.x)] = rng.standard_normal(balance.x.shape)
    left = balance.product(balance.solve(right)) - right
    assert np.linalg.norm(left) < 1e-5 * np.linalg.norm(right)


def test_a_changed_cover_is_out_of_balance_by_its_change(balance, solved):
    same = balance.changed()
    assert np.allclose(same.process.forces(), balance.process.forces(), atol=1e-12)
    wider = balance.changed(replace(solved.cover, rest=1.001 * solved.cover.rest))
    more = wider.process.forces() - balance.process.forces()
    assert np.linalg.norm(more) > 10.0 * np.linalg.norm(balance.process.forces())
    assert np.array_equal(wider.process.state, balance.process.state)


def test_another_mesh_or_a_cover_in_the_making_is_refused(solved, demo_scene):
    other = assemble(io.load_scene(demo_scene), element_size=0.03)
    with pytest.raises(InputError, match="another mesh"):
        Balance(solved, other)
    with pytest.raises(InputError, match="at rest"):
        Balance(replace(solved, stage="sew"))
