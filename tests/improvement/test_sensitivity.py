"""One adjoint against central differences of full solves, each in exact balance."""

import numpy as np
import pytest

from seatlook.improvement.sensitivity import sensitivities

MM = 1e-3


@pytest.fixture(scope="module")
def found(balance, slippery_changes, candidates, objective):
    return sensitivities(balance, slippery_changes, objective, candidates)


def difference(balance, changes, objective, direction, step):
    ends = []
    for sign in (1.0, -1.0):
        other = balance.changed(changes.cover({c: sign * step * v for c, v in direction.items()}))
        assert other.polish(1e-8) < 1e-7
        ends.append(objective.parts(other.process.sheet, other.x).total)
    return (ends[0] - ends[1]) / (2.0 * step)


def test_the_balance_is_stable_so_that_slopes_mean_something(found):
    assert found.downhill == 0


@pytest.mark.parametrize("kinds", [("offset", "length"), ("hook",)])
def test_slopes_are_those_of_solves(found, balance, slippery_changes, candidates, objective, kinds):
    rng = np.random.default_rng(len(kinds))
    direction = {c: float(rng.standard_normal()) * MM for c in candidates if c.kind in kinds}
    slope = sum(found.slope[c] * v for c, v in direction.items())
    assert difference(balance, slippery_changes, objective, direction, 3e-3) == pytest.approx(
        slope, rel=0.01
    )


def test_raised_foam_lifts_the_cover(found, balance, slippery_changes, candidates, objective):
    foam = [c for c in candidates if c.kind == "foam"]
    lift = np.sum([slippery_changes.lift(c) for c in foam], axis=0)
    assert np.allclose(lift, 1.0)
    slope = sum(found.slope[c] for c in foam)
    ends = []
    for sign in (1.0, -1.0):
        other = balance.changed(lift=sign * 3e-6 * lift)
        other.polish(1e-8)
        rise = sign * 3e-6 * objective.rise(other.x, lift)
        ends.append(objective.parts(other.process.sheet, other.x).total + rise)
    assert (ends[0] - ends[1]) / 6e-6 == pytest.approx(slope, rel=0.02)


@pytest.mark.validate
def test_thirty_random_directions(found, balance, slippery_changes, candidates, objective):
    """Median 1 %, worst 5 %."""
    rng = np.random.default_rng(7)
    cut = [c for c in candidates if c.kind in ("offset", "length", "hook")]
    errors = []
    for _ in range(30):
        direction = {c: float(rng.standard_normal()) * MM for c in cut}
        slope = sum(found.slope[c] * v for c, v in direction.items())
        errors.append(
            abs(difference(balance, slippery_changes, objective, direction, 3e-3) / slope - 1.0)
        )
    assert np.median(errors) <= 0.01
    assert max(errors) <= 0.05
