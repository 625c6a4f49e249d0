"""The reference: pixels stay, outlines stay, waves go by wavelength."""

from dataclasses import replace

import numpy as np
import pytest

from seatlook.errors import InputError
from seatlook.model import Foam, FoamMaterial
from seatlook.visibility.reference import smooth_reference, waves
from support.reference.lit_sheets import above, flat, sheet
from support.seen.covers import DEEP, block, oblique, ridge, wave


def on_pixels(solution, camera):
    """Where the vertices appear, (n, 2), as tangents of the view."""
    forward = camera.target - camera.position
    forward = forward / np.linalg.norm(forward)
    right = np.cross(forward, camera.up)
    right = right / np.linalg.norm(right)
    ray = solution.positions - camera.position
    depth = ray @ forward
    return np.stack([ray @ right, ray @ np.cross(right, forward)], axis=1) / depth[:, None]


def inside(solution, margin):
    rest = solution.cover.rest
    return (np.abs(rest) < np.abs(rest).max(axis=0) - margin).all(axis=1)


@pytest.mark.parametrize("camera", [above(), oblique()], ids=["above", "oblique"])
def test_vertices_move_along_their_rays_only(camera):
    solution = sheet(wave(0.04), steps=40)
    smooth = smooth_reference(solution, camera)
    np.testing.assert_allclose(on_pixels(smooth, camera), on_pixels(solution, camera), atol=1e-12)
    assert np.abs(smooth.positions - solution.positions).max() > 0.5 * DEEP


def test_outlines_stay():
    solution = sheet(wave(0.04), steps=40, panels=2)
    smooth = smooth_reference(solution, oblique())
    rest = solution.cover.rest
    rim = (np.abs(np.abs(rest) - 0.1) < 1e-9).any(axis=1) | (np.abs(rest[:, 0]) < 1e-9)
    np.testing.assert_array_equal(smooth.positions[rim], solution.positions[rim])


@pytest.mark.parametrize(("length", "left"), [(0.2, 1 / 17), (0.1, 0.5), (0.05, 16 / 17)])
def test_what_is_taken_out_follows_the_wavelength(length, left):
    """A filter of the fourth power: half at the cut-off, 1/17 at twice, 16/17 at half of it."""
    solution = sheet(wave(length), size=0.8, steps=80)
    result = waves(solution, cutoff=0.1)
    middle = inside(solution, 0.2)
    truth = wave(length)(*solution.cover.rest.T)
    gain = result[middle] @ truth[middle] / (truth[middle] @ truth[middle])
    assert gain == pytest.approx(left, abs=0.02)


def test_a_bend_along_an_outline_stays_and_waves_square_to_it_go():
    """Of a panel 100 mm wide: the bend across it is its shape, waves along it are wrinkles."""
    strip = sheet(flat, size=0.4, steps=80, panels=4)
    rest = strip.cover.rest
    middle = (np.abs(rest[:, 0] - 0.05) < 0.03) & (np.abs(rest[:, 1]) < 0.1)

    def left(height):
        """Share of a height that counts as wrinkle."""
        lifted = np.column_stack([rest, height])
        found = waves(replace(strip, positions=lifted))[middle]
        return found @ height[middle] / (height[middle] @ height[middle])

    bend = 1e-3 * np.sin(np.pi * rest[:, 0] / 0.1)
    assert left(bend) < 0.1
    for length in (0.03, 0.06):
        assert left(bend * np.cos(2 * np.pi * rest[:, 1] / length)) > 0.85


def on_foam_of(top, height, foam_material, **options):
    """A sheet ``height`` above a foam with a lid of that form."""
    solution = sheet(lambda x, y: top(x, y) + height(x, y), **options)
    vertices, faces = block(top)
    foam = Foam(vertices=vertices, faces=faces, material=foam_material)
    return replace(solution, cover=replace(solution.cover, foam=foam))


@pytest.fixture(scope="module")
def foam_material() -> FoamMaterial:
    from support.scenes import foam_material as make

    return make()


def test_the_design_stays_and_wrinkles_on_it_go(foam_material):
    solution = on_foam_of(ridge, wave(0.04), foam_material, size=0.28, steps=68)
    smooth = smooth_reference(solution, above())
    middle = inside(solution, 0.08)  # as far from the outline as waves are long
    rest = solution.cover.rest[middle]
    left = smooth.positions[middle, 2] - ridge(*rest.T)
    before = solution.positions[middle, 2] - ridge(*rest.T)
    assert left.std() < 0.15 * before.std()
    # Without the foam the ridge itself is taken for a wrinkle.
    bare = replace(solution, cover=replace(solution.cover, foam=None))
    flattened = smooth_reference(bare, above()).positions[middle, 2] - ridge(*rest.T)
    assert flattened.std() > 3 * left.std()


def test_a_cover_that_lies_on_its_foam_has_no_waves_but_the_facets(foam_material):
    solution = on_foam_of(ridge, flat, foam_material, steps=48)
    # Facets of 5 mm on a ridge of curvature 10 DEEP 2 / 25 mm^2 stand off by h^2 kappa / 8.
    facet = 0.005**2 / 8 * 10 * DEEP * 2 / 0.025**2
    assert np.abs(waves(solution)[inside(solution, 0.02)]).max() < facet


def test_refuses_what_makes_no_reference():
    solution = sheet(flat, steps=8)
    with pytest.raises(InputError, match=r"cutoff: got 0\.0, expected a wavelength above 0 m"):
        smooth_reference(solution, above(), cutoff=0.0)
    on_cover = replace(above(), position=solution.positions[5])
    with pytest.raises(InputError, match=r"camera.position: got on the cover"):
        smooth_reference(solution, on_cover)
