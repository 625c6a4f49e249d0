import dataclasses
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from seatlook.solver.foam.contact import (
    FoamContact,
    foam_wavelength,
    plane_strain_modulus,
    wave_stiffness,
)
from seatlook.solver.foam.distance import distance_field
from support.covers import cylinder, flat_foam
from support.scenes import fabric, foam_material
from support.taylor import slopes

LEVEL = distance_field(*(lambda f: (f.vertices, f.faces))(flat_foam()))
ROUND = distance_field(*cylinder(0.05, 0.2, 96))


def on_level(x, *, stiffness=1e6, area=1e-4, half=1e-3):
    n = len(x)
    return FoamContact(LEVEL, np.full(n, half), np.full(n, stiffness), np.full(n, area))


def around_cylinder(n, seed=0):
    rng = np.random.default_rng(seed)
    angle, r = rng.uniform(0, 2 * np.pi, n), rng.uniform(0.044, 0.052, n)
    y = rng.uniform(-0.05, 0.05, n)
    return np.column_stack([r * np.cos(angle), y, r * np.sin(angle)])


def test_wavelength_of_leather_on_foam():
    """12 B = Ef t^3: leather 1.2 mm, 20 MPa (plane strain) on 20 kPa foam: 52 mm."""
    leather = fabric(bending_warp=20e6 * 1.2e-3**3 / 12, bending_weft=1.0)
    foam = foam_material()
    modulus = plane_strain_modulus(foam)
    expected = 2 * math.pi * 1.2e-3 * (20e6 / (3 * modulus)) ** (1 / 3)
    assert foam_wavelength(leather, foam) == pytest.approx(expected, rel=1e-12)
    soft = dataclasses.replace(foam, young=20e3, poisson=0.0)
    assert foam_wavelength(leather, soft) == pytest.approx(52e-3, rel=0.01)


def test_wavelength_minimises_the_critical_load():
    """N(k) = B k^2 + E*/(2 k) is least at k = 2 pi / lambda; there the foam gives pi E*/lambda."""
    cloth, foam = fabric(), foam_material()
    k = 2 * math.pi / foam_wavelength(cloth, foam)
    load = lambda k: 8e-4 * k**2 + plane_strain_modulus(foam) / (2 * k)  # noqa: E731
    assert load(k) < min(load(0.99 * k), load(1.01 * k))
    assert wave_stiffness(cloth, foam) == pytest.approx(plane_strain_modulus(foam) * k / 2)


def test_point_pressed_into_level_foam():
    x = np.array([[0.0, 0.0, -0.002], [0.02, 0.0, 0.0005], [0.01, 0.03, 0.0011], [0.0, 0.0, 0.5]])
    contact, g = on_level(x), np.zeros((4, 3))
    energy = contact.value(x, g)
    # Depths 3 mm and 0.5 mm under half a thickness of 1 mm, 100 N/m each.
    assert energy == pytest.approx(0.5 * 100 * (3e-3**2 + 0.5e-3**2), rel=1e-4)
    np.testing.assert_allclose(g[:, 2], [-0.3, -0.05, 0, 0], rtol=1e-3)
    contact.update(x)
    np.testing.assert_allclose(contact.force, [0.3, 0.05, 0, 0], rtol=1e-3)
    np.testing.assert_allclose(contact.depth, [3e-3, 0.5e-3, 0, 0], rtol=1e-3)
    np.testing.assert_allclose(contact.pressure()[0], 3000.0, rtol=1e-3)
    np.testing.assert_allclose(contact.normal[0], [0, 0, 1], atol=1e-6)
    # The block is 100 mm thick.
    assert contact.foam_thickness(x)[0] == pytest.approx(0.1, rel=0.01)
    np.testing.assert_allclose(contact.stiffness().diagonal(), [100, 100, 0, 0])


def test_kernel_equals_numpy():
    x = around_cylinder(200)
    contact = FoamContact(ROUND, np.full(200, 1e-3), np.linspace(1e5, 1e6, 200), np.full(200, 1e-4))
    phi, n = ROUND.at(x)
    depth = np.maximum(1e-3 - phi, 0)
    k = np.linspace(1e5, 1e6, 200) * 1e-4
    g = np.zeros_like(x)
    assert contact.value(x, g) == pytest.approx(0.5 * np.sum(k * depth**2), rel=1e-12)
    np.testing.assert_allclose(g, -(k * depth)[:, None] * n, atol=1e-14)


@given(seed=st.integers(0, 1000), stiffness=st.floats(4, 8))
@settings(max_examples=10, deadline=None)
def test_taylor(seed, stiffness):
    x = around_cylinder(50, seed)
    phi, _ = ROUND.at(x)
    # Away from the moment of first touch, where the force has a corner.
    x = x[np.abs(1e-3 - phi) > 5e-4]
    n = len(x)
    contact = FoamContact(ROUND, np.full(n, 1e-3), np.full(n, 10**stiffness), np.full(n, 1e-4))
    first, second = slopes(contact, x, seed=seed)
    assert first == pytest.approx(2, abs=0.1)
    assert second == pytest.approx(2, abs=0.1)


def test_definite_hessian_is():
    x = around_cylinder(60)
    contact = FoamContact(ROUND, np.full(60, 1e-3), np.full(60, 1e6), np.full(60, 1e-4))
    full = contact.hessian(x).toarray()
    np.testing.assert_allclose(full, full.T, atol=1e-9)
    assert np.linalg.eigvalsh(contact.hessian(x, definite=True).toarray()).min() > -1e-9


def test_a_shape_seen_before_answers_as_one_seen_first():
    """Vertices move one by one, or only the foam settles: earlier distances must not stay."""
    n = 60
    rng = np.random.default_rng(4)
    state = np.zeros((n + n // 3, 3))
    state[:n] = around_cylinder(n)
    state[:5, 2] += 0.5  # out of reach
    state[5:10] *= 1.03  # too far at first
    args = ROUND, np.full(n, 1e-3), np.full(n, 1e6), np.full(n, 1e-4)
    old = FoamContact(*args)
    old.value(state, np.zeros_like(state))
    for _ in range(6):
        moved = rng.random(n) < 0.3
        state[:n][moved] += rng.normal(scale=1e-3, size=(int(moved.sum()), 3))
        state[n:] = rng.normal(scale=3e-3, size=(n // 3, 3))
        new, one, two = FoamContact(*args), np.zeros_like(state), np.zeros_like(state)
        assert old.value(state, one) == new.value(state, two)
        np.testing.assert_array_equal(one, two)
        old.update(state)
        new.update(state)
        np.testing.assert_array_equal(old.force, new.force)
        np.testing.assert_array_equal(old.blocks(state), new.blocks(state))
