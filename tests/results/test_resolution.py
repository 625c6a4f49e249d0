"""Whether a result is resolved: one rule, from the mesh and the folds, before and after a solve."""

import dataclasses

import numpy as np
import pytest

from seatlook.results.resolution import (
    PER_WAVE,
    SHARPEST,
    expected_waves,
    largest_size,
    resolution,
)
from seatlook.solver import foam_wavelength
from support.covers import cover, flat_foam, sheet
from support.io_samples import as_placed

H = 0.01


def strip(*, h=H, foam=None, panels=1):
    return cover(
        [sheet(0.16, 0.08, h, kind="right", at=(0.2 * k, 0.0)) for k in range(panels)],
        foam=foam,
        h=h,
    )


def folded(angle_deg, *, foam=None):
    """A strip folded along the line x = 0.08 by an angle."""
    solution = as_placed(strip(foam=foam))
    x = solution.positions.copy()
    out, angle = np.maximum(x[:, 0] - 0.08, 0.0), np.radians(angle_deg)
    x[:, 0] += out * (np.cos(angle) - 1.0)
    x[:, 2] += out * np.sin(angle)
    return dataclasses.replace(solution, positions=x)


@pytest.mark.parametrize("angle", [-170.0, -46.0, -44.0, -5.0, 0.0, 20.0, 44.0, 46.0, 90.0, 179.0])
def test_a_fold_of_any_angle_is_measured_and_the_sharp_ones_are_named(angle):
    found = resolution(folded(angle))
    assert found.largest_fold == pytest.approx(abs(angle), abs=1e-6)
    assert found.resolved == (abs(angle) <= SHARPEST)
    assert found.status == ("resolved" if found.resolved else "converged, not resolved")
    assert found.unresolved.any() == (not found.resolved)
    if not found.resolved:
        assert f"by {abs(angle):.0f} in zone all (panel panel 0, pattern u, v = 80," in found.reason
        fold = found.folds[0]
        assert fold.uv[0] == pytest.approx(0.08)
        assert fold.position[[0, 2]] == pytest.approx([0.08, 0.0], abs=1e-12)
        rows = folded(angle).cover.faces[found.unresolved]
        on_line = np.isclose(folded(angle).cover.rest[rows][..., 0], 0.08).sum(axis=1)
        assert (on_line == 2).all()


def test_a_fold_counts_from_the_shape_at_the_start_and_not_from_the_plane():
    """Parts of other programs may begin bent; what moves as a whole is not folded."""
    bent = folded(80.0)
    begun = dataclasses.replace(bent.cover, positions=bent.positions)
    found = resolution(dataclasses.replace(bent, cover=begun))
    assert found.largest_fold == pytest.approx(0.0, abs=1e-6)
    straight = dataclasses.replace(bent, cover=begun, positions=strip().positions)
    assert resolution(straight).largest_fold == pytest.approx(80.0)


def test_two_panels_that_meet_at_an_angle_are_not_folded():
    c = strip(panels=2)
    x = c.positions.copy()
    second = np.unique(c.faces[c.panel == 1])
    x[second] = x[second][:, [2, 1, 0]]
    assert resolution(dataclasses.replace(as_placed(c), positions=x)).resolved


@pytest.mark.parametrize("per_wave", [3.0, 7.8, 7.9, PER_WAVE, 8.1, 20.0])
def test_eight_elements_to_a_wave_resolve_it_and_fewer_do_not(per_wave):
    solution = as_placed(strip(foam=flat_foam()))
    wave = foam_wavelength(solution.cover.materials[0].fabric, solution.cover.foam.material)
    # Triangles of equal sides would have this size; those of a right grid have its area.
    scale = wave / per_wave / expected_waves(solution.cover)[0].element_size
    rest = scale * solution.cover.rest
    mesh = dataclasses.replace(solution.cover, rest=rest)
    own = expected_waves(mesh)[0]
    assert own.wavelength == wave
    assert own.per_wave == pytest.approx(per_wave)
    # A mesh may miss the size it was asked for by 2 %.
    assert own.resolved == (per_wave > 0.98 * PER_WAVE)
    assert own.error == pytest.approx(3.9 / own.per_wave**2)
    found = resolution(as_placed(mesh))
    assert found.resolved == own.resolved
    assert found.unresolved.all() == (not own.resolved)
    if not own.resolved:
        assert own.sentence in found.reason
        assert f"--element-size-mm {largest_size(wave):g} resolves them" in own.sentence
        assert largest_size(wave) * 1e-3 <= wave / PER_WAVE


def test_only_the_panels_with_large_elements_are_not_resolved():
    wave = expected_waves(strip(foam=flat_foam()))[0].wavelength
    fine, coarse = wave / 10, wave / 4
    c = cover(
        [sheet(0.16, 0.08, fine), sheet(0.16, 0.08, coarse, at=(0.2, 0.0))],
        foam=flat_foam(),
        h=fine,
    )
    found = resolution(as_placed(c))
    assert found.waves[0].panels == ("panel 1",)
    assert found.waves[0].element_size == pytest.approx(coarse, rel=0.05)
    np.testing.assert_array_equal(found.unresolved, c.panel == 1)
    assert "cloth in panel 1: " in found.reason


def test_what_is_not_at_rest_is_not_converged_whatever_its_mesh():
    stuck = dataclasses.replace(folded(90.0), status="not converged", reason="too hard")
    found = resolution(stuck)
    assert (found.status, found.reason) == ("not converged", "too hard")
    assert found.sentence == "not converged: too hard"
    assert found.coarseness


def test_a_measured_error_above_the_tolerance_is_a_reason_as_well():
    good = resolution(folded(10.0))
    assert good.sentence == "resolved"
    assert good.measured(0.04, 0.05).resolved
    bad = good.measured(0.06, 0.05)
    assert bad.status == "converged, not resolved"
    assert bad.reason == "zone means of W2 err by 6 %, asked for 5 %"
