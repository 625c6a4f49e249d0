"""The measures beside the paper's, on states whose answer is known."""

import dataclasses
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from seatlook import wrinkle
from seatlook.errors import InputError
from seatlook.model import Criteria, criteria_of
from seatlook.model.criteria import threshold_of_radius
from seatlook.wrinkle import INDICES, TENSION_STATES, Surface, isotropic_membrane
from support.wrinkle_samples import shaped, wave

# major, minor, Poisson ratio, R of eq. (4), signed ratio, tension field
STATES = {
    "equal stretch": (0.02, 0.02, 0.3, 0.0, 0.0, "taut"),
    "pure shear": (0.02, -0.02, 0.3, 0.0, 1.0, "wrinkled"),
    "one way, contraction 1": (0.02, -0.02, 1.0 - 1e-9, 0.0, 1.0, "taut"),
    "one way, contraction 1/2": (0.02, -0.01, 0.5, 0.5, 0.75, "taut"),
    "one way, no contraction": (0.02, 0.0, 0.0, 1.0, 0.5, "taut"),
    "mostly compressed": (0.01, -0.05, 0.3, 0.8, 1.0, "wrinkled"),
    "noise": (1e-6, 3e-7, 0.3, 0.7, 0.0, "slack"),
    "compressed both ways": (-0.01, -0.02, 0.3, 0.0, 0.0, "slack"),
}


def table():
    """Rows of the table of edge cases in docs/reference/indices.md."""
    text = (Path(__file__).parents[2] / "docs" / "reference" / "indices.md").read_text()
    rows = text.partition("| major |")[2].splitlines()[2:]
    cells = [[c.strip() for c in r.strip("|").split("|")] for r in rows]
    return cells[: cells.index([""])]


@pytest.mark.parametrize("cells", table(), ids=lambda c: c[2])
def test_the_documented_edge_cases(cells):
    major, minor, _, paper, signed, state = cells
    strain = np.diag([float(major), float(minor)])[None]
    assert wrinkle.stretch_ratio(strain)[0] == pytest.approx(float(paper), abs=1e-6)
    assert wrinkle.signed_ratio(strain)[0] == pytest.approx(float(signed), abs=1e-9)
    found = wrinkle.tension_state(strain, isotropic_membrane(0.3))
    assert TENSION_STATES[found[0]] == state


def turned(major, minor, angle):
    q = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    return (q @ np.diag([major, minor]) @ q.T)[None]


@pytest.mark.parametrize("angle", [0.0, 0.4, 1.5])
@pytest.mark.parametrize("name", STATES)
def test_eight_states(name, angle):
    major, minor, poisson, paper, signed, state = STATES[name]
    strain = turned(major, minor, angle)
    assert wrinkle.stretch_ratio(strain)[0] == pytest.approx(paper, abs=1e-9)
    assert wrinkle.signed_ratio(strain)[0] == pytest.approx(signed, abs=1e-9)
    found = wrinkle.tension_state(strain, isotropic_membrane(poisson))
    assert TENSION_STATES[found[0]] == state


@given(st.floats(-0.1, 0.1), st.floats(-0.1, 0.1), st.floats(-0.4, 0.9), st.floats(0, 3))
def test_wrinkle_strain_of_an_isotropic_sheet(a, b, poisson, angle):
    """Minor stress over stiffness is e_minor + nu e_major, whatever the axes."""
    major, minor = max(a, b), min(a, b)
    got = wrinkle.wrinkle_strain(turned(major, minor, angle), isotropic_membrane(poisson))
    assert got[0] == pytest.approx(minor + poisson * major, abs=1e-9)


@given(arrays(float, (6, 2, 2), elements=st.floats(-0.3, 0.3)))
def test_ratio_is_in_range_and_continuous_through_zero(a):
    strain = a + np.swapaxes(a, 1, 2)
    ratio = wrinkle.signed_ratio(strain)
    assert ((ratio >= 0) & (ratio <= 1)).all()
    step = wrinkle.signed_ratio(np.stack([np.diag([0.05, e]) for e in (-1.1e-3, 0.0, 1.1e-3)]))
    assert np.abs(np.diff(step)).max() < 0.012


def test_orthotropic_sheet_wrinkles_by_stress():
    """A stiff weft carries what a soft warp's contraction asks for."""
    strain = np.diag([0.02, -0.004])[None]
    soft, stiff = (
        np.array([[5000.0, 0.3 * d, 0], [0.3 * d, d, 0], [0, 0, 800.0]]) for d in (1000.0, 9000.0)
    )
    for membrane in (soft, stiff):
        assert wrinkle.wrinkle_strain(strain, membrane)[0] == pytest.approx(0.3 * 0.02 - 0.004)


def test_threshold_of_a_bending_radius():
    """A fold at the radius is exactly a wrinkle, W2 = 1, in both modes."""
    t, r = 0.0012, 0.03
    fold = np.diag([-t / 2 / r, 0.0])[None]
    for mode in ("paper", "tensor"):
        threshold = float(threshold_of_radius(r, mode))
        w = wrinkle.wrinkle_indices(fold, 0 * fold, -fold, t, threshold, curvature=mode)
        assert w.w2[0] == pytest.approx(1.0, rel=1e-12)
    with pytest.raises(InputError, match="radius: got 0, expected above 0"):
        threshold_of_radius(0, "paper")


def test_strain_measure_changes_the_indices_and_is_checked():
    strain = np.diag([0.1, -0.05])[None]
    top, bottom = strain - np.diag([0.012, 0])[None], strain + np.diag([0.012, 0])[None]
    plain = wrinkle.wrinkle_indices(top, strain, bottom, 0.0012, 20.0)
    log = wrinkle.wrinkle_indices(top, strain, bottom, 0.0012, 20.0, strain_measure="logarithmic")
    expected = 1 - np.log(1.2) / -np.log(0.9) if np.log(1.2) < -np.log(0.9) else (
        1 - -np.log(0.9) / np.log(1.2)
    )  # fmt: skip
    assert log.r_stretch[0] == pytest.approx(expected)
    assert plain.r_stretch[0] == pytest.approx(0.5)
    with pytest.raises(InputError, match="strain_measure: got 'true', expected 'green' or"):
        wrinkle.wrinkle_indices(top, strain, bottom, 0.0012, 20.0, strain_measure="true")
    impossible = np.diag([0.1, -0.6])[None]
    with pytest.raises(InputError, match="nan or inf"):
        wrinkle.wrinkle_indices(
            impossible, impossible, impossible, 0.0012, 20.0, strain_measure="logarithmic"
        )


def indexed(solution, threshold=20.0):
    return wrinkle.wrinkle_indices(
        *wrinkle.surface_strains(solution), solution.cover.thickness, threshold, "tensor"
    )


def test_a_wrinkle_stays_in_the_net_index_and_a_wide_valley_does_not():
    """A 20 mm wave is a wrinkle, a 240 mm hollow is the shape."""
    for wavelength, height, low, high in ((0.02, 0.0003, 0.85, 1.05), (0.24, -0.02, 0.0, 0.15)):
        solution = shaped(wave(height, wavelength), h=0.002 if wavelength < 0.1 else 0.005)
        indices = indexed(solution)
        surface = Surface(solution, indices, Criteria(thresholds=(20.0,)))
        net, plain = INDICES["w2_net"].values(surface), indices.w2
        p = solution.cover.rest[solution.cover.faces].mean(axis=1)
        middle = (np.abs(p - 0.06) < 0.035).all(axis=1)
        ratio = net[middle].sum() / plain[middle].sum()
        assert low <= ratio <= high


def test_every_index_and_measure_gives_one_finite_number_per_face():
    solution = shaped(wave(0.0005, 0.04))
    surface = Surface(solution, indexed(solution), Criteria(thresholds=(20.0,)))
    for name, index in INDICES.items():
        values = index.values(surface)
        assert values.shape == (len(solution.cover.faces),), name
        assert np.isfinite(values).all(), name
    both = sum(INDICES[f"w2_net_{cause}"].values(surface) for cause in ("stretch", "compression"))
    np.testing.assert_allclose(both, INDICES["w2_net"].values(surface), rtol=1e-12)


def test_a_million_states_have_no_surprise():
    rng = np.random.default_rng(0)
    a = rng.uniform(-0.5, 0.5, (3, 1_000_000, 2, 2))
    a[:, :1000] = 0.0
    a[:, 1000:2000] *= 1e-300
    top, mid, bottom = 0.5 * (a + np.swapaxes(a, 2, 3))
    for mode in ("paper", "tensor"):
        w = wrinkle.wrinkle_indices(top, mid, bottom, 0.0012, 20.0, mode)
        for name in ("c", "w1", "w2", "r_stretch", "w_stretch", "w_compression"):
            assert np.isfinite(getattr(w, name)).all()
        assert ((w.r_stretch >= 0) & (w.r_stretch <= 1)).all()
        off = np.abs(w.w_stretch + w.w_compression - w.w2)
        assert (off <= 2 * np.spacing(w.w2)).all()


def test_each_material_brings_its_own_threshold():
    """By its curvature, by its bending radius in either mode, or not at all."""
    cover = shaped(wave(0.0, 0.06), h=0.03, panels=3).cover
    plain = cover.materials[0]
    own = (
        plain,
        dataclasses.replace(plain, c_threshold=33.0),
        dataclasses.replace(plain, first_wrinkle_radius=0.025),
    )
    cover = dataclasses.replace(cover, materials=own)
    for mode, by_radius in (("tensor", 40.0), ("paper", 20.0)):
        limits = criteria_of(cover.materials, mode, default=15.0).per_face(cover.panel)
        assert [set(limits[cover.panel == k]) for k in range(3)] == [{15.0}, {33.0}, {by_radius}]
