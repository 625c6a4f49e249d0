"""Scores of drawn covers: what must be zero, what must grow, and which pixels count."""

from dataclasses import replace

import numpy as np
import pytest

from seatlook.errors import InputError
from seatlook.model import Foam, Rig, WrinkleMap, named_view, sun
from seatlook.pbr import Studio
from seatlook.visibility.cross_check import more_visible
from seatlook.visibility.grid import score_grid
from seatlook.visibility.heights import Ladder, amplitude_ladder, peak_to_valley, reference_rig
from seatlook.visibility.light_search import search_light, sun_rig
from seatlook.visibility.observer import OBSERVER, VISIBLE
from seatlook.visibility.pixels import region, solver_faces
from seatlook.visibility.reference import on_foam
from seatlook.visibility.view import SAMPLING, View, at_density
from support.reference.lit_sheets import above, flat, sheet
from support.seen.covers import BLACK, COARSE, RIG, ROUGH, block, oblique, ridge, wave, zoned

pytestmark = pytest.mark.render
GRAINED = replace(BLACK, texture="leather", texture_scale=0.001, texture_depth=5e-5)


@pytest.fixture(scope="module")
def wrinkled():
    return zoned(sheet(wave(0.04, 0.2e-3), steps=48))


@pytest.fixture(scope="module")
def view(wrinkled):
    return View(wrinkled, oblique((320, 240)), sampling=COARSE)


def test_a_smooth_cover_scores_nothing():
    smooth = View(zoned(sheet(flat, steps=24)), oblique((320, 240)), sampling=COARSE)
    for looks in (BLACK, GRAINED):
        assert smooth.vwi(looks, RIG) < 1e-3


@pytest.mark.parametrize("size", [(320, 240), (640, 480), (1920, 1440)])
def test_the_size_of_the_scenes_picture_does_not_count(wrinkled, view, size):
    camera = oblique(size)
    assert at_density(camera, SAMPLING.pixels_per_degree).pixels_per_degree == pytest.approx(
        45, rel=1e-3
    )
    seen = View(wrinkled, camera, sampling=COARSE)
    assert max(abs(a - b) for a, b in zip(seen.camera.size, view.camera.size, strict=True)) <= 1
    assert seen.vwi(BLACK, RIG) == pytest.approx(view.vwi(BLACK, RIG), rel=0.02)


def test_waves_that_the_mesh_does_not_carry_are_left_out(wrinkled, view):
    """Three elements to a wave at the least; of the coarsest mesh where covers are compared."""
    wave = 3 * wrinkled.cover.element_size
    per_degree = np.radians(np.linalg.norm(view.camera.position))  # m at the middle of the sheet
    assert view.highest_frequency == pytest.approx(per_degree / wave, rel=0.05)
    whole = view.vwi(BLACK, RIG)
    for size, left in ((0.006, 1.0), (0.012, 1.0), (0.020, 0.8)):
        seen = View(wrinkled, view.camera, sampling=COARSE,
                    element_size=size)  # fmt: skip
        frequencies = [band.frequency for band in seen.sight(BLACK, RIG).score.bands]
        assert max(frequencies) <= seen.highest_frequency
        # The wave on it is 40 mm long: a mesh of 20 mm does not show it.
        assert seen.vwi(BLACK, RIG) <= left * whole * (1 + 1e-9)
    far_too_coarse = View(wrinkled, view.camera, sampling=COARSE,
                          element_size=0.040)  # fmt: skip
    with pytest.raises(InputError, match=r"frequencies up to 0\.142 cycles/deg, expected at least"):
        far_too_coarse.vwi(BLACK, RIG)


def test_wrinkles_score_and_their_texture_does_not_move(view, wrinkled):
    assert view.vwi(BLACK, RIG) > VISIBLE
    same = solver_faces(view.test_studio, view.camera) == solver_faces(
        view.reference_studio, view.camera
    )
    assert same.mean() > 0.999
    # The smooth cover against its own reference: the grain is not taken for a wrinkle, it hides.
    still = View(view.reference, view.camera, sampling=COARSE)
    assert still.vwi(GRAINED, RIG) <= still.vwi(BLACK, RIG)


@pytest.mark.xfail(strict=True, reason="0.15: what is left in the reference shows near threshold")
def test_a_smooth_cover_scores_a_tenth_of_a_wrinkled_one(view):
    still = View(view.reference, view.camera, sampling=COARSE)
    assert still.vwi(GRAINED, RIG) < 0.1 * view.vwi(GRAINED, RIG)


def test_only_interiors_count(view, wrinkled):
    names = wrinkled.cover.zone_names
    zone = view.region.zone
    assert {names[k] for k in np.unique(zone[view.region.mask])} == {
        "left interior",
        "right interior",
    }
    assert (zone[~view.region.mask] == -1).all()
    only = region(view.test_studio, view.camera, zones=("seam a-b",))
    assert not (only.mask & view.region.mask).any()
    with pytest.raises(InputError, match="zones: got 'left', expected some of left interior"):
        region(view.test_studio, view.camera, zones=("left",))


def test_area_of_the_pixels_is_that_of_the_cover():
    solution = zoned(sheet(flat, steps=24))
    for camera in (above(size=(320, 320), fov=14), oblique((400, 320))):
        result = region(Studio(solution), camera)
        shown = result.face >= 0
        assert result.area[shown].sum() == pytest.approx(0.04, rel=0.02)


def test_silhouettes_are_left_out():
    hill = zoned(sheet(lambda x, y: 0.08 * np.exp(-((x**2 + y**2) / 0.03**2)), steps=48))
    result = region(Studio(hill), named_view("front_34", target=np.zeros(3), size=(320, 180)))
    p = hill.positions[hill.cover.faces]
    normal = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
    camera = named_view("front_34", target=np.zeros(3), size=(320, 180))
    ray = camera.position - p.mean(axis=1)
    cosine = (normal * ray).sum(axis=1)
    cosine /= np.linalg.norm(normal, axis=1) * np.linalg.norm(ray, axis=1)
    assert cosine[result.face[result.mask]].min() >= 0.2


def test_a_sight_splits_by_zone_and_cause(view, wrinkled):
    m = len(wrinkled.cover.faces)
    left = (wrinkled.cover.zone == 0).astype(float)
    zero = np.zeros(m)
    indices = WrinkleMap(
        c=zero, w1=zero, w2=left, r_stretch=left, w_stretch=left, w_compression=zero
    )
    sight = view.sight(BLACK, RIG, indices=indices)
    assert sight.stretch == pytest.approx(sight.zones["left interior"])
    assert sight.compression is None
    energy = sum(vwi**OBSERVER.pooling for vwi in sight.zones.values())
    assert energy ** (1 / OBSERVER.pooling) == pytest.approx(sight.score.vwi)
    assert set(sight.contrasts) == set(sight.zones) == {"left interior", "right interior"}
    assert sight.measures.vwi == sight.score.vwi == view.vwi(BLACK, RIG)
    assert sight.score.visible_area[0] < 0.04


def test_the_score_is_nearly_linear_in_amplitude(view):
    ladder = amplitude_ladder(view, BLACK, heights=(0, 5e-5, 1e-4, 2e-4, 4e-4))
    assert ladder.vwi[0] == 0
    assert (np.diff(ladder.vwi) > 0).all()
    assert np.corrcoef(ladder.heights, ladder.vwi)[0, 1] ** 2 > 0.98
    assert ladder.height == pytest.approx(peak_to_valley(view))
    left = ladder.zones["left interior"]
    assert left.height == pytest.approx(peak_to_valley(view, "left interior"))
    np.testing.assert_allclose(left.heights / left.height, ladder.heights / ladder.height)
    energy = sum(zone.vwi**OBSERVER.pooling for zone in ladder.zones.values())
    np.testing.assert_allclose(energy ** (1 / OBSERVER.pooling), ladder.vwi)


@pytest.mark.parametrize("mode", ["normals", "design"])
def test_the_other_references_see_the_same_wrinkles(wrinkled, view, mode):
    """On a flat foam all three take the same wave out; normals leave shape and shadows alone."""
    from support.scenes import block as box
    from support.scenes import foam_material

    vertices, faces = box([-0.15, -0.15, -0.1], [0.15, 0.15, -0.0005])
    foam = Foam(vertices=vertices, faces=faces, material=foam_material())
    on_foam_solution = replace(wrinkled, cover=replace(wrinkled.cover, foam=foam))
    result = View(on_foam_solution, oblique((320, 240)), mode=mode, sampling=COARSE)
    same = solver_faces(result.test_studio, result.camera) == solver_faces(
        result.reference_studio, result.camera
    )
    assert same[result.region.mask].mean() > 0.999
    if mode == "normals":
        np.testing.assert_array_equal(
            result.reference_studio.surface.mesh.vertices, result.test_studio.surface.mesh.vertices
        )
    assert result.vwi(BLACK, RIG) == pytest.approx(view.vwi(BLACK, RIG), rel=0.15)
    assert result.null_score(BLACK, RIG) < 0.1


def test_the_equivalent_height_of_the_field_itself_is_its_height(view):
    ladder = amplitude_ladder(view, BLACK, heights=(0, 1e-4, 2e-4, 4e-4, 8e-4))
    result = ladder.equivalent(view.vwi(BLACK, reference_rig(view.camera)))
    assert result == pytest.approx(ladder.height, rel=0.05)


def test_height_is_that_of_the_wave():
    """Away from outlines, which hold the smooth shape to the wave."""
    wide = sheet(wave(0.04, 0.2e-3), size=0.6, steps=90)
    centre = wide.cover.rest[wide.cover.faces].mean(axis=1)
    zone = (np.abs(centre) > 0.15).any(axis=1).astype(int)
    wide = replace(wide, cover=replace(wide.cover, zone=zone, zone_names=("box", "free edge")))
    seen = View(wide, above(size=(160, 160), fov=36), sampling=COARSE)
    # 95 % of a cosine lie within 0.997 of its range; the filter takes 1/40 of a 40 mm wave.
    assert peak_to_valley(seen, "box") == pytest.approx(0.4e-3 * 0.975, rel=0.03)


def test_equivalent_heights_off_the_ladder():
    ladder = Ladder(
        height=1e-3, heights=np.array([0, 1e-4, 2e-4, 5e-4]), vwi=np.array([0, 4.0, 3.0, 8.0])
    )
    assert ladder.equivalent(0.0) == 0.0
    assert ladder.equivalent(2.0) == pytest.approx(0.5e-4)
    assert ladder.equivalent(6.0) == pytest.approx(3e-4)
    assert ladder.equivalent(9.0) == float("inf")


def test_light_across_is_the_worst_light_of_a_rough_cover(view):
    result = search_light(view, ROUGH, sun_rig(), coarse=24, rounds=1, keep=1)
    # The wave runs along x: light from +x or -x, low.
    assert abs(np.sin(np.radians(result.azimuth_deg))) > 0.7
    assert result.elevation_deg < 40


def test_the_null_gate(view, wrinkled):
    from support.scenes import foam_material

    vertices, faces = block(ridge)
    foam = Foam(vertices=vertices, faces=faces, material=foam_material())
    up = np.array([0.0, 0.0, 1.0])
    on_ridge = replace(
        wrinkled,
        positions=wrinkled.positions + ridge(*wrinkled.cover.rest.T)[:, None] * up,
        cover=replace(wrinkled.cover, foam=foam),
    )
    gated = View(on_ridge, oblique((320, 240)), sampling=COARSE)
    assert gated.null_score(GRAINED, RIG) < 0.1
    lain = on_foam(on_ridge)
    assert np.abs(lain.positions[:, 2] - ridge(*lain.positions[:, :2].T)).mean() < 0.6e-3
    with pytest.raises(InputError, match="foam: got none, expected the surface the cover was made"):
        view.null_score(BLACK, RIG)


def test_a_grid_names_the_worst_rig_and_the_least_visible_texture(view):
    across, along = (
        Rig(name=n, lights=(sun(elevation_deg=30, azimuth_deg=a),), ambient=600.0)
        for n, a in (("across", 90), ("along", 0))
    )
    ladder = Ladder(height=1e-4, heights=np.array([0, 1e-4]), vwi=np.array([0, 50.0]))
    grid = score_grid(view, {"black": BLACK, "rough": ROUGH}, (along, across)).on_ladder(ladder)
    assert grid.worst_texture("along") == ("black", "rough")[int(grid.vwi[:, 0].argmax())]
    assert grid.vwi.shape == (2, 2)
    assert grid.worst_rig("rough") == "across"
    lowest, other = np.array(["black", "rough"])[np.argsort(grid.vwi.max(axis=1))]
    told = more_visible(
        grid.sights[other, grid.worst_rig(other)].measures,
        grid.sights[lowest, grid.worst_rig(lowest)].measures,
    )
    assert grid.least_visible == (lowest if told == "first" else None)
    assert grid.vwi[1, 1] == view.vwi(ROUGH, across)
    assert grid.height["rough", "along"] == ladder.equivalent(grid.vwi[1, 0])
    measures = [grid.sights[name, "across"].measures for name in ("black", "rough")]
    signs = {
        np.sign(getattr(measures[0], key) - getattr(measures[1], key))
        for key in ("vwi", "log_ratio", "dissimilarity")
    }
    wanted = {(1.0,): "first", (-1.0,): "second"}.get(tuple(signs), "not separable")
    assert grid.compare("black", "rough", "across") == wanted
    with pytest.raises(InputError, match="grid: got 1 textures, rigs along, along"):
        score_grid(view, {"black": BLACK}, (along, along))
