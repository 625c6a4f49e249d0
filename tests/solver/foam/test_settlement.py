import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.sparse import csc_array

from seatlook.solver.foam.contact import settled_part, settled_rows
from seatlook.solver.foam.foundation import Foundation
from seatlook.solver.foam.settlement import SettledFactor, kerr_layers
from seatlook.solver.methods.factor import Factor
from seatlook.solver.process.ties import Ties
from support.covers import cover, flat_foam, sheet
from support.taylor import slopes


def pressed(depth, *, h=0.02, size=0.16):
    """A level sheet held at ``depth`` below the foam's surface; foundation, state, positions."""
    X, T, x = sheet(size, size, h, z=0.0005 - depth, at=(-0.5 * size, -0.5 * size))
    c = cover([(X, T, x)], foam=flat_foam(size=0.4), h=h)
    ties = Ties(c, np.ones(len(X)))
    foundation = Foundation(c, c.foam, np.zeros(len(X), dtype=np.int64), ties.points("seam"))
    state = np.zeros((len(X) + settled_rows(len(X)), 3))
    state[: len(X)] = x
    foundation.begin(state)
    foundation.lag(state)
    return foundation, state, len(X)


@given(a=st.floats(1e-3, 0.25))
def test_layers_follow_the_half_space(a):
    upper, shear = kerr_layers(a)

    def seen(ratio):
        return 1 / (1 / upper + 1 / (a + shear * ratio**2))

    assert seen(1.0) == pytest.approx(1.0)
    assert seen(0.5) == pytest.approx(0.5)
    # Long waves see the column, in series with the springs.
    assert seen(0.0) == pytest.approx(a * upper / (a + upper))
    # Between lambda and 4 lambda never far from the half-space (or the column, if that is more).
    for ratio in (0.75, 0.35, 0.25):
        assert seen(ratio) == pytest.approx(max(ratio, a), rel=0.35)


@pytest.mark.parametrize("depth", [0.002, 0.02, 0.035])
def test_broad_pressure_follows_the_column_curve(depth):
    foundation, state, n = pressed(depth)
    strain, stress = foundation.material.strain, foundation.material.stress
    pressure = np.interp(depth / 0.1, strain, stress)
    np.testing.assert_allclose(foundation.contact.pressure(), pressure, rtol=0.01)
    np.testing.assert_allclose(foundation.settlement.pressure(state), pressure, rtol=0.01)
    np.testing.assert_allclose(settled_part(state, n) + foundation.contact.depth, depth, rtol=0.005)
    assert foundation.figures(state)["contact_compression_max"] == pytest.approx(
        depth / 0.1, rel=0.01
    )


def test_a_short_wave_meets_the_half_space():
    """Pressure of a wave of lambda on top of a uniform depth: pi E*/lambda times its height."""
    foundation, state, n = pressed(0.01, h=0.004, size=0.12)
    wave = foundation.wavelength
    x = state[:n]
    k = 2 * np.pi / wave
    level = foundation.contact.pressure().mean()
    shape = np.cos(k * x[:, 0])
    x[:, 2] += 2e-4 * shape
    foundation.begin(state)
    foundation.lag(state)
    inner = np.abs(x[:, :2]).max(axis=1) < 0.6 * wave
    answer = foundation.contact.pressure() - level
    height = -(answer[inner] @ shape[inner]) / (shape[inner] @ shape[inner])
    foam = foundation.material
    modulus = foam.young / (1 - foam.poisson**2)
    assert height == pytest.approx(2e-4 * np.pi * modulus / wave, rel=0.06)


def test_settling_is_a_minimum():
    foundation, state, n = pressed(0.01)
    gradient = np.zeros_like(state)
    foundation.contact.value(state, gradient)
    foundation.settlement.value(state, gradient)
    assert np.abs(settled_part(gradient, n)).max() < 1e-9 * foundation.contact.force.max()


@given(seed=st.integers(0, 100))
@settings(max_examples=5, deadline=None)
def test_taylor(seed):
    foundation, state, n = pressed(0.01)
    rng = np.random.default_rng(seed)
    settled_part(state, n)[:] *= rng.uniform(0.9, 1.1, n)

    class Both:
        def value(self, z, gradient):
            moved = foundation.contact.value(z, gradient)
            return moved + foundation.settlement.value(z, gradient)

        def hessian(self, z):
            return np.zeros((z.size, z.size))

    first, _ = slopes(Both(), state, seed=seed, size=1e-6)
    assert first == pytest.approx(2, abs=0.1)


def test_springs_couple_the_sheet_and_its_columns():
    """Raising the sheet and letting the column settle both lower the depth: k n, not -k n."""
    foundation, state, n = pressed(0.01)
    contact, step = foundation.contact, 1e-6
    at = int(np.argmax(contact.per_vertex))
    pulls = []
    for sign in (1.0, -1.0):
        moved = state.copy()
        moved[at] += sign * step * contact.normal[at]
        gradient = np.zeros_like(state)
        contact.value(moved, gradient)
        pulls.append(settled_part(gradient, n)[at])
    coupling = (pulls[0] - pulls[1]) / (2 * step)
    assert coupling == pytest.approx(contact.per_vertex[at], rel=1e-4)


def test_elimination_is_exact():
    """With exact blocks the preconditioner inverts the coupled matrix."""
    rng = np.random.default_rng(0)
    n = 4
    spread = rng.normal(size=(n, n))
    columns = spread @ spread.T + 10 * np.eye(n)
    link, normal = rng.uniform(1, 3, n), rng.normal(size=(n, 3))
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    B = np.zeros((n, 3 * n))
    for i in range(n):
        B[i, 3 * i : 3 * i + 3] = link[i] * normal[i]
    A = np.diag(rng.uniform(5, 9, 3 * n)) + B.T @ np.linalg.solve(columns, B)
    schur = A - B.T @ np.linalg.solve(columns, B)
    factor = SettledFactor(Factor(csc_array(schur)), Factor(csc_array(columns)), link, normal)
    right = np.zeros((n + settled_rows(n), 3))
    right[:n] = rng.normal(size=(n, 3))
    settled_part(right, n)[:] = rng.normal(size=n)
    out = np.empty_like(right)
    factor.solve(right, out)
    full = np.block([[A, B.T], [B, columns]])
    answer = np.concatenate([out[:n].ravel(), settled_part(out, n)])
    given_ = np.concatenate([right[:n].ravel(), settled_part(right, n)])
    np.testing.assert_allclose(full @ answer, given_, atol=1e-10)
