"""The drawn patch's creases in the real renderer: the bars of the drawn patch hold there."""

import numpy as np
import pytest

from seatlook.model import Appearance, Rig, sun
from seatlook.pbr import render
from seatlook.visibility.view import luminance
from seatlook.visibility.vwi import score
from support.reference.lit_sheets import above, sheet
from support.seen.field import LOOKS, PIXELS_PER_DEGREE, creases, dome

pytestmark = [pytest.mark.validate, pytest.mark.render]
SIZE, STEPS, PIXELS = 0.3, 200, 600
NAMES = ("black glossy", "bright glossy", "bright rough")


def shape(*, depth):
    def height(x, y):
        side, pitch = (STEPS + 1, STEPS + 1), SIZE / STEPS
        return (dome(side, pitch) + depth * creases(side, pitch)).ravel()

    return sheet(height, size=SIZE, steps=STEPS)


@pytest.fixture(scope="module")
def lit():
    """Pictures with and without the creases under the sun at 70 deg, across them."""
    camera = above(distance=1.03, size=(PIXELS, PIXELS), fov=PIXELS / PIXELS_PER_DEGREE)
    high = sun(elevation_deg=70, azimuth_deg=90, illuminance_lux=20_000 / np.sin(np.radians(70)))
    rig = Rig(name="sun", lights=(high,), ambient=2_000 / np.pi)
    shapes = [shape(depth=depth) for depth in (1.0, 0.0)]
    result = {}
    for name in NAMES:
        drawn = LOOKS[name]
        look = Appearance(albedo=np.full(3, drawn.albedo), roughness=drawn.roughness, f0=drawn.f0)
        result[name] = [luminance(render(s, look, rig=rig, camera=camera)) for s in shapes]
    return result


def vwi(test, reference, share=1.0):
    rim = int(20 * share)
    mask = np.zeros(test.shape, dtype=bool)
    mask[rim:-rim, rim:-rim] = True
    return score(test, reference, pixels_per_degree=share * PIXELS_PER_DEGREE, mask=mask).vwi


def test_a_highlight_shows_dark_and_glossy_first(lit, record_property):
    black, bright, rough = (vwi(*lit[name]) for name in NAMES)
    record_property("vwi", (black, bright, rough))
    assert black > 1.1 * bright > 1.21 * rough


@pytest.mark.parametrize("name", NAMES)
def test_half_the_pixels_at_half_the_pixels_per_degree(lit, name, record_property):
    halves = [p.reshape(PIXELS // 2, 2, PIXELS // 2, 2).mean(axis=(1, 3)) for p in lit[name]]
    share = vwi(*halves, share=0.5) / vwi(*lit[name])
    record_property("half_over_full", share)
    assert share == pytest.approx(1, abs=0.03)
