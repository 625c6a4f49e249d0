"""When a search is given up for another method, and that it may be at any time."""

import sys

import numpy as np
import pytest

from seatlook.model import Stage
from seatlook.solver import SolverSettings, solve
from seatlook.solver.process.pace import too_slow
from support.covers import cover, flat_foam, sheet


def test_nothing_is_said_of_few_rounds():
    assert not too_slow([1.0] * 7, 1e-3, 1.0)
    assert too_slow([1.0] * 8, 1e-3, 1e9)


@pytest.mark.parametrize("factor", [0.3, 0.5, 0.9, 0.99])
def test_a_steady_fall_is_followed_to_where_it_arrives(factor):
    residuals = [factor**k for k in range(12)]
    needed = np.log(1e-3 / residuals[-1]) / np.log(factor)
    if residuals[-1] <= 1e-3:
        assert not too_slow(residuals, 1e-3, 0.0)
    else:
        assert not too_slow(residuals, 1e-3, 1.01 * needed)
        assert too_slow(residuals, 1e-3, 0.99 * needed)


def test_single_rounds_may_rise_and_a_stall_counts_as_one():
    rng = np.random.default_rng(0)
    falling = 0.5 ** np.arange(16) * rng.uniform(0.5, 2.0, 16) * 100.0
    assert not too_slow(falling.tolist(), 1e-3, 12.0)
    assert too_slow([3.3e-3 * (1.0 + 0.1 * (-1) ** k) for k in range(16)], 1e-3, 24.0)
    assert not too_slow([3.3e-3] * 8 + [0.9e-3], 1e-3, 24.0)


def hanging():
    """A sheet that reaches beyond its foam by 40 mm."""
    panel = sheet(0.12, 0.08, 0.02, z=0.0006, at=(0.07, -0.04))
    return cover([panel], foam=flat_foam(), stages=[Stage(name="drop", start=0.0, end=0.2)], h=0.02)


def test_a_change_of_method_on_the_way_finds_the_same_rest(monkeypatch):
    straight = solve(hanging(), strict=True)
    assert straight.positions[:, 2].min() < -5e-4
    assert straight.figures["changes_of_method"] == 0
    by_one = solve(hanging(), settings=SolverSettings(method="lbfgs"), strict=True)
    assert straight.positions.tobytes() == by_one.positions.tobytes()
    module = sys.modules[solve.__module__]
    monkeypatch.setattr(module, "_REST_ITERATIONS", 20)
    monkeypatch.setattr(module, "too_slow", lambda residuals, goal, rounds: True)
    changed = solve(hanging(), strict=True)
    assert changed.figures["changes_of_method"] >= 1
    # Either rests within the residual that counts as converged: .12 mm apart at the tip, of 5.3 mm.
    np.testing.assert_allclose(changed.positions, straight.positions, atol=2e-4)
