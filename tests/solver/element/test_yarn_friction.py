import dataclasses

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from seatlook.errors import InputError
from seatlook.model import Hysteresis
from seatlook.solver import Sheet, SheetSettings, Support, solve_sheet
from seatlook.solver.element.elastic import ElasticSheet
from seatlook.solver.kernels import yarn_friction as kernels
from support import fabrics, meshes
from support.taylor import slopes

LOOP = Hysteresis(width=12.0, growth=40.0, strain=0.01)


def rubbing(hysteresis=LOOP, **change):
    return dataclasses.replace(
        fabrics.isotropic(1000.0), shear_hysteresis=hysteresis, **change
    )  # shear 500 N/m


def square(fabric, kind="uns"):
    X, T = meshes.rectangle(kind, 1.0, 0.8, 0.2)
    return X, ElasticSheet(X, T, np.zeros(len(T)), [fabric]).membrane


def sheared(X, shear):
    """Positions at which every triangle has the shear 2 E12, and its yarns their length."""
    half = 0.5 * np.arcsin(shear)
    F = np.array([[np.cos(half), np.sin(half)], [np.sin(half), np.cos(half)]])
    return np.pad(X @ F.T, ((0, 0), (0, 1)))


def run(membrane, X, path):
    """Shear stress at every point of a path, which is taken into the history."""
    out = []
    for shear in path:
        x = sheared(X, shear)
        S = membrane.stress(x)[:, 2]
        np.testing.assert_allclose(S, S[0], rtol=1e-9, atol=1e-9)
        membrane.wear(x)
        out.append(S[0])
    return np.array(out)


def test_a_loop_by_hand():
    X, membrane = square(rubbing(Hysteresis(width=12.0, strain=0.01)))
    out = run(membrane, X, [0.005, 0.01, 0.1, 0.09, 0.08, 0.0, -0.1, 0.0])
    # 500 e, and friction of 6 N/m that takes 0.01 to build up and 0.02 to turn round.
    expected = [2.5 + 3.0, 5.0 + 6.0, 50.0 + 6.0, 45.0, 40.0 - 6.0, -6.0, -56.0, 6.0]
    np.testing.assert_allclose(out, expected, rtol=1e-9, atol=1e-9)


def test_the_width_is_the_one_given_at_both_angles_of_kes():
    X, membrane = square(rubbing())
    at = np.array([0.0087, 0.0875])
    out = run(membrane, X, [0.0, at[0], at[1], 0.14, at[1], at[0], -0.14, at[0], at[1]])
    width = out[[7, 8]] - out[[5, 4]]
    np.testing.assert_allclose(width, [LOOP.width_at(e) for e in at], rtol=1e-9)


def test_the_work_of_a_loop_is_its_area():
    X, membrane = square(rubbing(Hysteresis(width=12.0, strain=0.01)))
    path = np.concatenate([np.linspace(0, 0.1, 400), np.linspace(0.1, -0.1, 800),
                           np.linspace(-0.1, 0.1, 800)])  # fmt: skip
    out = run(membrane, X, path)
    loop = slice(400, None)
    area = -np.trapezoid(out[loop], path[loop])
    # A parallelogram: the width over the shears less what it takes to turn round.
    assert area == pytest.approx(-12.0 * (0.2 - 0.02), rel=0.01)


strain = st.floats(-0.3, 0.3)


@settings(deadline=None, max_examples=60)
@given(strain, strain, st.floats(1.0, 50.0), st.floats(0.0, 0.9), st.floats(0.002, 0.05))
def test_energy_is_the_integral_of_the_stress(e, rest, limit, share, strain):
    spring = limit / strain
    constants = (rest, limit, share * spring, spring)
    h = 1e-6
    before, after = (kernels.rub(e + d, *constants)[0] for d in (-h, h))
    _, stress, _ = kernels.rub(e, *constants)
    assert (after - before) / (2 * h) == pytest.approx(stress, rel=1e-5, abs=limit * 1e-3)
    assert abs(stress) <= (limit + share * spring * abs(e)) * (1 + 1e-9)


@pytest.mark.parametrize("kind", ["uns", "sliver"])
def test_history_changes_neither_energy_nor_forces_where_it_is_taken(kind):
    X, membrane = square(rubbing(), kind)
    rng = np.random.default_rng(2)
    for _ in range(3):
        x = sheared(X, 0.1) + 0.01 * rng.standard_normal((len(X), 3))
        before, after = np.zeros_like(x), np.zeros_like(x)
        value = membrane.value(x, before)
        membrane.wear(x)
        assert membrane.value(x, after) == pytest.approx(value, rel=1e-12)
        np.testing.assert_allclose(after, before, atol=1e-10 * abs(before).max())


def test_energy_gradient_and_hessian_pass_the_taylor_test():
    fabric = dataclasses.replace(
        fabrics.woven(), shear_hysteresis=Hysteresis(width=3.0, growth=9.0, strain=0.02)
    )
    X, membrane = square(fabric)
    rng = np.random.default_rng(0)
    membrane.wear(sheared(X, 0.1) + 0.01 * rng.standard_normal((len(X), 3)))
    x = sheared(X, 0.09) + 0.004 * rng.standard_normal((len(X), 3))
    moved = np.abs(membrane.strain(x)[:, 2] - membrane.peaks[:, 2])
    assert 0.05 < (moved > 0.02).mean() < 0.95  # some slip, some do not
    first, second = slopes(membrane, x, size=2e-5)
    assert first == pytest.approx(2.0, abs=0.1)
    assert second == pytest.approx(2.0, abs=0.1)


def test_a_rest_state_has_no_forces_and_turns_freely():
    X, membrane = square(rubbing())
    turned = np.pad(X, ((0, 0), (0, 1))) @ fabrics.rotation(np.random.default_rng(1)).T
    for x in (np.pad(X, ((0, 0), (0, 1))), turned):
        gradient = np.zeros_like(x)
        assert membrane.value(x, gradient) == pytest.approx(0.0, abs=1e-12)
        np.testing.assert_allclose(gradient, 0.0, atol=1e-9)


def test_fabric_without_friction_keeps_nothing():
    X, membrane = square(fabrics.woven())
    membrane.wear(sheared(X, 0.05))
    assert membrane.peaks is None


def test_a_sheared_sheet_comes_back_lower_also_over_a_restart():
    X, T = meshes.rectangle("uns", 1.0, 1.0, 0.25)
    rim = ((X < 1e-9) | (X > 1 - 1e-9)).any(axis=1)
    fixed = np.stack([rim, rim, np.ones_like(rim)], axis=1)
    fabric, state, out = rubbing(Hysteresis(width=12.0, strain=0.01)), None, []
    for shear in (0.05, 0.1, 0.05):
        state = solve_sheet(
            Sheet(X, T, fabric), start=state, strict=True,
            support=Support(fixed=fixed, prescribed=sheared(X, shear)),
            settings=SheetSettings(tolerance=1e-8),
        )  # fmt: skip
        out.append(float(state.sheet.membrane.stress(state.positions)[:, 2].mean()))
    assert state.peaks.shape == (len(T), 3)
    np.testing.assert_allclose(out, [31.0, 56.0, 19.0], rtol=1e-6)


@pytest.mark.parametrize(
    ("hysteresis", "message"),
    [
        ({"width": 0.0}, "Hysteresis.width: got 0.0, expected a number above 0"),
        ({"width": 1.0, "growth": 200.0}, "Hysteresis.growth: got 200 N/m over a strain of 0.01"),
        ({"width": 20.0, "growth": 1200.0}, "shear_hysteresis: got a growth of 1200 N/m, expected"),
    ],
)
def test_friction_that_cannot_be_is_refused(hysteresis, message):
    with pytest.raises(InputError, match=message):
        rubbing(Hysteresis(**hysteresis))
