"""The search for the worst light against 400 lights tried one by one."""

import numpy as np
import pytest

from seatlook.visibility.light_search import bulb_rig, hemisphere, search_light, sun_rig
from seatlook.visibility.view import View
from support.reference.lit_sheets import sheet
from support.seen.covers import BLACK, COARSE, ROUGH, oblique, wave, zoned

pytestmark = [pytest.mark.validate, pytest.mark.render]


def creases(x, y):
    """Waves of 40 mm on a crown: the highlight wanders with the light."""
    return wave(0.04, 0.2e-3)(x, y) - 0.8 * (x**2 + y**2)


@pytest.fixture(scope="module")
def view():
    return View(
        zoned(sheet(creases, steps=48)),
        oblique((160, 120)),
        sampling=COARSE._replace(pixels_per_degree=8.5),
    )


@pytest.mark.parametrize("looks", [BLACK, ROUGH], ids=["black", "rough"])
@pytest.mark.parametrize("kind", ["sun", "bulb"])
def test_no_light_of_400_shows_more_than_the_one_found(view, looks, kind, record_property):
    rig_at = sun_rig() if kind == "sun" else bulb_rig(view.camera)
    best = max(view.vwi(looks, rig_at(*angles)) for angles in hemisphere(400))
    result = search_light(view, looks, rig_at)
    record_property("found_over_best_of_400", result.vwi / best)
    assert result.vwi >= 0.95 * best
    assert len(result.tried) <= 100
    assert np.isfinite(result.tried).all()
