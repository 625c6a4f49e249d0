"""Equations (1) to (6): hand-computed states, traps, and properties over random strains."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from seatlook import wrinkle
from seatlook.errors import InputError
from seatlook.mesh.kinematics import principal_values

T = 0.0012


def tensor(e11: float, e22: float, e12: float = 0.0) -> np.ndarray:
    return np.array([[[e11, e12], [e12, e22]]])


def bent(kappa: np.ndarray, mid: np.ndarray, mode: str = "paper"):
    return wrinkle.wrinkle_indices(
        mid + T / 2 * kappa, mid, mid - T / 2 * kappa, T, 20.0, curvature=mode
    )


@pytest.mark.parametrize(("mode", "share"), [("paper", 0.5), ("tensor", 1.0)])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_free_cylindrical_fold(mode, share, sign):
    """Eq. (1) as printed gives half the curvature of a fold, the tensor all of it."""
    w = bent(sign * tensor(20.0, 0.0), tensor(0.0, 0.0), mode)
    assert w.c[0] == pytest.approx(sign * 20.0 * share, rel=1e-12)
    assert w.w2[0] == pytest.approx(share if sign < 0 else 0.0, abs=1e-15)


def test_fold_under_compression_across_gives_full_curvature_in_both_modes():
    mid = tensor(-0.05, 0.0)
    for mode in ("paper", "tensor"):
        assert bent(tensor(-20.0, 0.0), mid, mode).c[0] == pytest.approx(-20.0)


def test_crown_has_w1_but_no_w2():
    w = bent(tensor(5.0, 3.0), tensor(0.01, 0.01))
    assert w.w1[0] > 0
    assert w.w2[0] == 0.0
    assert not np.signbit(w.w2[0])


def test_saddle_keeps_its_valley_in_tensor_mode():
    w = bent(tensor(20.0, -10.0), tensor(0.0, 0.0), "tensor")
    assert w.c[0] == pytest.approx(20.0)
    assert w.w2[0] == pytest.approx(0.5)


def test_tie_in_tensor_mode_is_a_valley():
    assert bent(tensor(10.0, -10.0), tensor(0.0, 0.0), "tensor").c[0] == pytest.approx(-10.0)


@pytest.mark.parametrize(
    ("major", "minor", "expected"),
    [
        (0.01, 0.01, 0.0),  # equibiaxial
        (0.01, 0.0, 1.0),  # one way, nothing across
        (0.01, -0.005, 0.5),  # one way with contraction 0.5
        (0.01, -0.01, 0.0),  # pure shear: balanced, as printed
        (0.01, -0.05, 0.8),
        (-0.01, -0.02, 0.0),  # compressed both ways
        (0.0, 0.0, 0.0),
        (0.0, -0.01, 0.0),
    ],
)
def test_stretch_ratio_of_known_states(major, minor, expected):
    assert wrinkle.stretch_ratio(tensor(major, minor))[0] == pytest.approx(expected)


finite = st.floats(-0.5, 0.5, allow_nan=False)


@given(arrays(float, (5, 3, 3), elements=finite), st.sampled_from(["paper", "tensor"]))
@settings(max_examples=200, deadline=None)
def test_causes_add_up_and_stay_in_range(numbers, mode):
    top, mid, bottom = (
        np.stack([np.stack([n[:, 0], n[:, 2]], 1), np.stack([n[:, 2], n[:, 1]], 1)], 1)
        for n in (numbers[:, i] for i in range(3))
    )
    w = wrinkle.wrinkle_indices(top, mid, bottom, T, 20.0, curvature=mode)
    total = w.w_stretch + w.w_compression
    assert (np.abs(total - w.w2) <= 2 * np.spacing(w.w2)).all()
    assert ((w.r_stretch >= 0) & (w.r_stretch <= 1)).all()
    assert (w.w2 >= 0).all()


@given(arrays(float, (4, 2, 2), elements=finite))
def test_principal_values_are_the_eigenvalues(a):
    a = a + np.swapaxes(a, 1, 2)
    major, minor = principal_values(a)
    expected = np.linalg.eigvalsh(a)
    assert np.allclose(np.stack([minor, major], 1), expected, atol=1e-12)


def test_turning_the_axes_changes_nothing():
    angle = 0.7
    q = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    kappa, mid = tensor(-12.0, 4.0, 3.0), tensor(0.02, -0.01, 0.004)
    plain, turned = bent(kappa, mid), bent(q @ kappa @ q.T, q @ mid @ q.T)
    for name in ("c", "w2", "r_stretch", "w_stretch", "w_compression"):
        assert getattr(plain, name) == pytest.approx(getattr(turned, name), rel=1e-10)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"strain_mid": np.full((1, 2, 2), np.nan)}, "strain_mid: got nan or inf"),
        ({"strain_top": np.zeros((1, 3, 3))}, r"strain_top: got shape \(1, 3, 3\)"),
        ({"thickness": 0.0}, "thickness: got 0.0, expected above 0"),
        ({"c_threshold": np.nan}, "c_threshold: got nan"),
        ({"curvature": "literal"}, "curvature: got 'literal', expected 'paper' or 'tensor'"),
    ],
)
def test_bad_input_is_named(change, message):
    zero = np.zeros((1, 2, 2))
    good = {
        "strain_top": zero,
        "strain_mid": zero,
        "strain_bottom": zero,
        "thickness": T,
        "c_threshold": 20.0,
        "curvature": "paper",
    }
    with pytest.raises(InputError, match=message):
        wrinkle.wrinkle_indices(**(good | change))


@pytest.mark.parametrize("mode", ["paper", "tensor"])
def test_a_million_random_states_add_up(mode):
    """W_stretch + W_compression = W2 within 2 ulp, 0 <= R <= 1, nothing nan or infinite."""
    a = np.random.default_rng(0).uniform(-0.5, 0.5, (3, 1_000_000, 2, 2))
    w = wrinkle.wrinkle_indices(*(0.5 * (a + np.swapaxes(a, 2, 3))), T, 20.0, curvature=mode)
    assert (np.abs(w.w_stretch + w.w_compression - w.w2) <= 2 * np.spacing(w.w2)).all()
    assert ((w.r_stretch >= 0) & (w.r_stretch <= 1)).all()
    assert all(np.isfinite(getattr(w, name)).all() for name in w.__slots__)
