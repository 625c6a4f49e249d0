"""What a score must do, on the real renderer and a solved demo cover with one seam spoiled."""

from dataclasses import replace

import numpy as np
import pytest

from seatlook import io
from seatlook.assembly import assemble
from seatlook.cli._demo import write_demo
from seatlook.model import Appearance, Rig, named_view, sun
from seatlook.sensory.cross_check import log_ratio
from seatlook.sensory.vwi import score
from seatlook.solver import solve
from seatlook.study.amplitude import amplitude_ladder, reference_rig
from seatlook.study.light_search import sun_rig
from seatlook.study.view import View, luminance

pytestmark = [pytest.mark.validate, pytest.mark.render]
LAMBERT = Appearance(albedo=np.full(3, 0.2), f0=0.0, roughness=1.0)


@pytest.fixture(scope="module")
def solution(tmp_path_factory):
    """Solve the demo in plain leather, one sewing line 4 % longer than its partner."""
    folder = tmp_path_factory.mktemp("eased")
    write_demo(
        folder,
        ease={"INSERT-BOLSTER_L": 0.04},
        starve={},
        tension=0.005,
        material="black-leather",
        insert="black-leather",
        element_size_mm=7.0,
        seed=0,
    )
    return solve(assemble(io.load_scene(folder / "scene.toml")))


@pytest.fixture(scope="module")
def view(solution):
    target = solution.positions.mean(axis=0)
    return View(solution, named_view("front_34", target=target, size=(1280, 720)))


@pytest.fixture(scope="module")
def looks():
    black, bright, suede = (
        io.read_material(name).appearance for name in ("black-leather", "bright-leather", "suede")
    )
    rough = replace(bright, roughness=0.85, texture="none", coat=0.0)
    return {"black": black, "bright": bright, "bright rough": rough, "suede": suede}


@pytest.fixture(scope="module")
def highlight(view):
    """Sun at 70 deg that puts its highlight on the cover."""
    return reference_rig(view.camera)


def pair(view, appearance, rig):
    return tuple(luminance(picture) for picture in view._draw(appearance, rig))


def vwi(view, test, reference, mask=None, share=1.0):
    mask = view.region.mask if mask is None else mask
    ppd = share * view.camera.pixels_per_degree
    return score(test, reference, pixels_per_degree=ppd, mask=mask).vwi


def test_equal_pictures_score_exactly_zero(view, looks, highlight):
    test, _ = pair(view, looks["suede"], highlight)
    assert vwi(view, test, test) == 0


def test_a_highlight_shows_dark_and_glossy_first(view, looks, highlight, record_property):
    found = {name: view.vwi(appearance, highlight) for name, appearance in looks.items()}
    record_property("vwi", found)
    assert found["black"] > 1.1 * found["bright"] > 1.21 * found["bright rough"]
    assert found["bright rough"] > 1.1 * found["suede"]


def test_raking_light_is_reported(view, looks, record_property):
    """No order is claimed at 20 degrees."""
    rig = sun_rig()(215.0, 20.0)
    ratio = view.vwi(looks["black"], rig) / view.vwi(looks["bright rough"], rig)
    record_property("black_over_bright_rough_at_20_deg", ratio)
    assert np.isfinite(ratio)


def test_a_texture_in_both_pictures_hides(view, looks, highlight):
    plain = replace(looks["suede"], texture="none")
    assert view.vwi(looks["suede"], highlight) < 0.9 * view.vwi(plain, highlight)


def test_albedo_cancels_without_interreflection(solution, view):
    draft = View(solution, view.camera, quality="draft")
    # Sky light has no shade in a draft, so only the sun is left to divide by the albedo.
    rig = Rig(name="sun", lights=(sun(elevation_deg=40, azimuth_deg=215),), ambient=100.0)
    mask = draft.region.mask
    ratios = [
        log_ratio(*pair(draft, replace(LAMBERT, albedo=np.full(3, a)), rig), mask=mask)
        for a in (0.05, 0.2, 0.8)
    ]
    np.testing.assert_allclose(ratios, ratios[1], rtol=0.01)


def test_daylight_does_not_matter_and_dusk_lowers(view, looks, highlight, record_property):
    """Less than on narrow creases, which lose 30 %: these waves are wide and stay seen."""
    for name, appearance in looks.items():
        test, reference = pair(view, appearance, highlight)
        assert np.median(reference[view.region.mask]) > 200
        day = vwi(view, test, reference)
        assert vwi(view, 10 * test, 10 * reference) == pytest.approx(day, rel=0.05)
        dusk = vwi(view, 1e-3 * test, 1e-3 * reference) / day
        record_property(f"dusk_over_day_{name}", dusk)
        assert dusk < 0.9


def test_half_the_pixels_at_half_the_pixels_per_degree(view, looks, highlight, record_property):
    def halved(picture):
        h, w = picture.shape
        return picture.reshape(h // 2, 2, w // 2, 2).mean(axis=(1, 3))

    mask = halved(view.region.mask.astype(float)) == 1.0
    whole = np.repeat(np.repeat(mask, 2, axis=0), 2, axis=1)
    for name, appearance in looks.items():
        test, reference = pair(view, appearance, highlight)
        half = vwi(view, halved(test), halved(reference), mask, 0.5)
        share = half / vwi(view, test, reference, whole)
        record_property(f"half_over_full_{name}", share)
        assert share == pytest.approx(1, abs=0.05)


def test_a_texture_shifted_by_one_pixel_is_caught(view, looks, highlight):
    null = view._null
    test, reference = pair(null, looks["suede"], highlight)
    assert vwi(null, test, reference) < 0.1
    assert vwi(null, test, np.roll(reference, 1, axis=1)) > 0.1


def test_grows_with_the_amplitude_nearly_linearly(view, looks):
    found = amplitude_ladder(view, replace(looks["black"], texture="none"))
    assert (np.diff(found.vwi) > 0).all()
    assert np.corrcoef(found.heights, found.vwi)[0, 1] ** 2 > 0.99
