"""Recovered curvature on exact surfaces, its error estimate, the smooth design shape."""

import numpy as np
import pytest

from seatlook import wrinkle
from seatlook.errors import InputError
from seatlook.model import Anchor, Points
from support.meshes import KINDS
from support.wrinkle_samples import SIZE, shaped, wave

WAVE = 0.06
H = WAVE / 12


def curvature(solution):
    return wrinkle.curvature_tensor(
        solution.strain_top, solution.strain_bottom, solution.cover.thickness
    )


def recovered(solution):
    cover = solution.cover
    return wrinkle.recover(cover.rest, cover.faces, curvature(solution))


def away(rest, rows=2, h=H, size=SIZE):
    return (np.minimum(rest, size - rest) > rows * h).all(axis=1)


@pytest.mark.parametrize("kind", KINDS)
def test_sine_at_twelve_elements(kind):
    """The rms error over the peak stays below 1.5 % (3 % on slivers)."""
    amplitude, k = 0.0005, 2 * np.pi / WAVE
    solution = shaped(wave(amplitude, WAVE), h=H, kind=kind)
    rest = solution.cover.rest
    exact = amplitude * k**2 * np.sin(k * rest[:, 0])
    error = (recovered(solution)[:, 0, 0] - exact)[away(rest)]
    bound = 0.03 if kind == "sliver" else 0.015
    assert np.sqrt((error**2).mean()) < bound * amplitude * k**2


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("sign", [1, -1])
def test_cylinder_is_within_half_a_percent_with_its_sign(kind, sign):
    r = 0.05

    def roll(X):
        a = X[:, 0] / r
        return np.column_stack([r * np.sin(a), X[:, 1], sign * r * (np.cos(a) - 1)])

    solution = shaped(roll, h=H, kind=kind)
    cover = solution.cover
    # Near the outline the element meets the free edge's zero moment, which no cylinder has.
    K = curvature(solution)[away(cover.rest[cover.faces].mean(axis=1), rows=4)]
    assert K[:, 0, 0] == pytest.approx(np.full(len(K), sign / r), rel=0.005)
    assert np.abs(K[:, 1, 1]).max() < 0.005 / r


def test_convergence_of_recovered_curvature():
    errors = []
    for n in (12, 24):
        h, k = WAVE / n, 2 * np.pi / WAVE
        solution = shaped(wave(0.0002, WAVE), h=h, kind="right")
        rest = solution.cover.rest
        exact = 0.0002 * k**2 * np.sin(k * rest[:, 0])
        error = (recovered(solution)[:, 0, 0] - exact)[away(rest, h=h)]
        errors.append(np.sqrt((error**2).mean()) / (0.0002 * k**2))
    assert np.log2(errors[0] / errors[1]) > 1.9
    assert errors[1] < 0.005


def test_saddle_and_stretched_fold_have_the_right_signs():
    saddle = shaped(lambda X: np.column_stack([X, 4 * (X[:, 0] - 0.06) ** 2
                                               - 4 * (X[:, 1] - 0.06) ** 2]))  # fmt: skip
    K = recovered(saddle)[away(saddle.cover.rest)]
    assert (K[:, 0, 0] < -5).all()
    assert (K[:, 1, 1] > 5).all()
    for sign in (1, -1):  # developable fold with 2 % membrane stretch along it
        fold = shaped(lambda X, s=sign: np.column_stack([
            X[:, 0], 1.02 * X[:, 1], s * 0.0004 * np.sin(2 * np.pi * X[:, 0] / WAVE)]))  # fmt: skip
        indices = wrinkle.wrinkle_indices(
            *wrinkle.surface_strains(fold), fold.cover.thickness, 20.0, "tensor"
        )
        p = fold.cover.rest[fold.cover.faces].mean(axis=1)
        valley = (p[:, 0] % WAVE > WAVE / 2) == (sign > 0)
        inside = away(p) & (np.abs(p[:, 0] % (WAVE / 2) - WAVE / 4) < WAVE / 8)
        assert (indices.c[inside & valley] < 0).all()
        assert (indices.c[inside & ~valley] > 0).all()


@pytest.mark.parametrize("kind", KINDS)
def test_linear_fields_are_kept_to_the_outline(kind):
    """Also where the faces around a vertex lie on one side of it."""
    cover = shaped(wave(0.0, WAVE), kind=kind).cover
    plane = np.array([3.0, -2.0])
    field = cover.rest[cover.faces].mean(axis=1) @ plane + 1.0
    back = wrinkle.recover(cover.rest, cover.faces, field)
    np.testing.assert_allclose(back, cover.rest @ plane + 1.0, rtol=1e-9)


def test_constants_and_tensors_are_kept():
    solution = shaped(wave(0.0, WAVE))
    cover = solution.cover
    value = np.broadcast_to([[1.0, 2.0], [2.0, -3.0]], (len(cover.faces), 2, 2))
    back = wrinkle.recover(cover.rest, cover.faces, value)
    np.testing.assert_allclose(back, np.broadcast_to(value[0], back.shape), rtol=1e-12)


@pytest.mark.parametrize("kind", KINDS)
def test_error_estimate_follows_the_true_error(kind):
    """On the safe side, at most three quarters too large, and falling with the mesh."""
    k, amplitude = 2 * np.pi / WAVE, 0.0005
    estimates = []
    for n in (8, 16):
        h = WAVE / n
        solution = shaped(wave(amplitude, WAVE), h=h, kind=kind)
        cover = solution.cover
        field = curvature(solution)[:, 0, 0]
        p = cover.rest[cover.faces].mean(axis=1)
        inside = away(p, h=h)
        true = (field - amplitude * k**2 * np.sin(k * p[:, 0]))[inside]
        guess = wrinkle.recovery_error(cover.rest, cover.faces, field)[inside]
        ratio = np.sqrt((guess**2).mean() / (true**2).mean())
        assert 1.0 < ratio < 1.75
        estimates.append(np.sqrt((guess**2).mean()))
    assert estimates[1] < 0.6 * estimates[0]


@pytest.mark.parametrize(("wavelength", "kept"), [(0.015, 1 / 82), (0.045, 0.5), (0.09, 16 / 17)])
def test_low_pass_has_the_transfer_it_says(wavelength, kept):
    solution = shaped(wave(0.0005, wavelength), h=0.0025, size=0.18, kind="right")
    cover = solution.cover
    smooth = wrinkle.low_passed(cover, solution.positions)
    middle = (np.abs(cover.rest - 0.09) < 0.045).all(axis=1)
    z, before = smooth[middle, 2], solution.positions[middle, 2]
    assert (z @ before) / (before @ before) == pytest.approx(kept, abs=0.02)


@pytest.mark.parametrize(("along", "kept"), [(0.015, 16 / 17), (0.060, 1 / 17)])
def test_low_pass_by_direction(along, kept):
    """A wave of 30 mm along x goes by the length along x alone."""
    solution = shaped(wave(0.0005, 0.030), h=0.0025, size=0.18, kind="right")
    cover = solution.cover
    length = np.tile(np.diag([along, 0.01]), (len(cover.faces), 1, 1))
    smooth = wrinkle.low_passed(cover, solution.positions, wavelength=length)
    middle = (np.abs(cover.rest - 0.09) < 0.045).all(axis=1)
    z, before = smooth[middle, 2], solution.positions[middle, 2]
    assert (z @ before) / (before @ before) == pytest.approx(kept, abs=0.02)


def test_the_same_length_in_all_directions_is_that_of_one_number():
    solution = shaped(wave(0.0005, 0.020), h=0.0025)
    length = np.tile(0.03 * np.eye(2), (len(solution.cover.faces), 1, 1))
    np.testing.assert_allclose(
        wrinkle.low_passed(solution.cover, solution.positions, wavelength=length),
        wrinkle.low_passed(solution.cover, solution.positions, wavelength=0.03),
        atol=1e-12,
    )
    with pytest.raises(InputError, match=r"wavelength: got -0\.03, expected above 0"):
        wrinkle.low_passed(solution.cover, solution.positions, wavelength=-length)


def test_a_part_of_the_low_pass_is_that_of_the_whole():
    """At one and a half wavelengths from what is held the difference is 1 in 700 of a wave."""
    solution = shaped(wave(0.0005, 0.02), h=0.0025, size=0.24, kind="right")
    cover = solution.cover
    near = np.linalg.norm(cover.rest - 0.12, axis=1)
    whole = wrinkle.low_passed(cover, solution.positions)
    part = wrinkle.low_passed(cover, solution.positions, within=near < 0.0675)
    off = np.abs(part - whole).max(axis=1)
    assert off[near < 1e-3].max() < 0.0005 / 700
    assert off[near > 0.0675].max() > 2e-4
    assert (part[near > 0.0675] == solution.positions[near > 0.0675]).all()


def test_hooked_lines_and_outlines_are_held():
    plain = shaped(wave(0.0005, 0.015), h=0.0025)
    line = np.flatnonzero(np.abs(plain.cover.rest[:, 0] - 0.06) < 0.001)
    points = Points(
        vertices=np.column_stack([line, line]), weights=np.tile([1.0, 0.0], (len(line), 1))
    )
    hook = Anchor(name="h", kind="hook", points=points, target=plain.positions[line],
                  length=np.ones(len(line)), stage="end")  # fmt: skip
    solution = shaped(wave(0.0005, 0.015), h=0.0025, anchors=(hook,))
    smooth = wrinkle.low_passed(solution.cover, solution.positions)
    rim = (np.minimum(plain.cover.rest, SIZE - plain.cover.rest) < 1e-9).any(axis=1)
    rim[line] = True
    assert (smooth[rim] == solution.positions[rim]).all()
    assert np.abs(smooth - solution.positions)[~rim].max() > 2e-4
    with pytest.raises(InputError, match="wavelength: got 0, expected above 0"):
        wrinkle.low_passed(solution.cover, solution.positions, wavelength=0)
