import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from seatlook.solver.foam.contact import FoamContact
from seatlook.solver.foam.distance import distance_field
from seatlook.solver.foam.friction import Friction
from support.covers import flat_foam
from support.taylor import slopes

FOAM = flat_foam()
FIELD = distance_field(FOAM.vertices, FOAM.faces)


def pressed(n, *, mu=0.5, depth=2e-3, slip=2e-4):
    """Points in a row, all pressed in by ``depth`` with 0.2 N, stuck where they are."""
    x = np.column_stack([np.linspace(-0.05, 0.05, n), np.zeros(n), np.full(n, -depth)])
    contact = FoamContact(FIELD, np.zeros(n), np.full(n, 1e6), np.full(n, 1e-4))
    friction = Friction(contact, mu, slip=slip)
    contact.update(x)
    friction.update(x)
    return x, contact, friction


def force(friction, x):
    g = np.zeros_like(x)
    friction.value(x, g)
    return g


def test_force_rises_to_mu_n_and_no_further():
    x, _, friction = pressed(4)
    moved = x.copy()
    moved[:, 0] += [0.0, 1e-4, 2e-4, 5e-3]
    moved[:, 2] += 1e-3  # a normal move drags nothing along
    np.testing.assert_allclose(
        force(friction, moved), np.outer([0, 0.075, 0.1, 0.1], [1.0, 0, 0]), atol=1e-6
    )


def test_work_of_a_long_slide():
    """Energy of a slide of 5 mm: mu N (5 mm - slip / 3)."""
    x, _, friction = pressed(1)
    assert friction.value(np.add(x, [[5e-3, 0, 0]]), np.zeros((1, 3))) == pytest.approx(
        0.1 * (5e-3 - 2e-4 / 3), rel=1e-3
    )


def test_sliding_drags_the_anchor_and_rest_keeps_it():
    x, contact, friction = pressed(2)
    start = friction.anchor.copy()
    moved = np.add(x, [[1e-4, 0, 0], [3e-3, 0, 0]])
    contact.update(moved)
    friction.update(moved)
    np.testing.assert_allclose(friction.anchor[0], start[0], atol=1e-9)
    np.testing.assert_allclose(moved[1] - friction.anchor[1], [2e-4, 0, 0], atol=1e-9)
    # What acted before the update acts after it.
    np.testing.assert_allclose(force(friction, moved)[:, 0], [0.075, 0.1], rtol=1e-3)


def test_a_vertex_that_lifts_off_is_free():
    x, contact, friction = pressed(2)
    x[1, 2] = 0.01
    contact.update(x)
    friction.update(x)
    assert np.isnan(friction.anchor[1]).all()
    assert not force(friction, x + 1e-3)[1].any()
    assert np.isfinite(friction.value(x + 1e-3, np.zeros_like(x)))


@given(seed=st.integers(0, 1000), size=st.floats(-5.5, -2.5))
@settings(max_examples=15, deadline=None)
def test_taylor(seed, size):
    x, _, friction = pressed(6)
    x = x + np.random.default_rng(seed).normal(size=x.shape) * 10**size
    u = np.linalg.norm((x - friction.anchor)[:, :2], axis=1)
    if np.any(np.abs(u - friction.slip) < 0.1 * friction.slip) or np.any(u < 2e-6):
        return  # third derivative jumps there
    first, second = slopes(friction, x, seed=seed + 1, size=1e-6)
    assert first == pytest.approx(2, abs=0.1)
    assert second == pytest.approx(2, abs=0.15)


def test_hessian_is_never_indefinite():
    x, _, friction = pressed(20)
    x = x + np.random.default_rng(0).normal(size=x.shape) * 3e-4
    H = friction.hessian(x).toarray()
    np.testing.assert_allclose(H, H.T, atol=1e-9)
    assert np.linalg.eigvalsh(H).min() > -1e-9
