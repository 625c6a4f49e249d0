"""Which pixels are scored: 20 mm from seams, hems, silhouettes and moving shadows, at any scale."""

from dataclasses import replace

import numpy as np
import pytest

from seatlook.model import Rig, sun
from seatlook.pbr import Studio
from seatlook.visibility.pixels import MARGIN, moving_shadows, region
from support.reference.lit_sheets import above, flat, sheet
from support.seen.covers import zoned

pytestmark = pytest.mark.render
LOW = Rig(name="low", lights=(sun(elevation_deg=30, azimuth_deg=90),), ambient=100.0)


def places(solution, result):
    """Centres (k, 2) [m] of the faces that are scored."""
    face = np.unique(result.face[result.mask])
    return solution.cover.rest[solution.cover.faces[face]].mean(axis=1)


@pytest.mark.parametrize(("size", "distance"), [((160, 160), 1.0), ((480, 480), 1.0),
                                                ((320, 320), 2.5)])  # fmt: skip
def test_the_margin_is_one_of_the_cover(size, distance):
    """As wide in mm in a small picture and a large one, from near and from far."""
    solution = sheet(flat, steps=80)
    camera = above(distance=distance, size=size, fov=2 * np.degrees(np.arctan(0.11 / distance)))
    result = region(Studio(solution), camera)
    reach = np.abs(places(solution, result)).max()
    pixel = 0.22 / size[0]
    assert reach == pytest.approx(0.1 - MARGIN, abs=0.0025 + 2 * pixel)
    assert result.pixel == pytest.approx(pixel, rel=0.01)


def test_a_seam_counts_as_an_outline():
    solution = sheet(flat, steps=80, panels=2)
    result = region(Studio(solution), above(size=(320, 320), fov=12.6))
    assert np.abs(places(solution, result)[:, 0]).min() == pytest.approx(MARGIN, abs=0.004)


def test_beside_a_step_in_depth_nothing_is_scored():
    """A plateau with steep walls: its rim is a silhouette though no face of it is grazing."""
    step = sheet(lambda x, y: np.where(np.abs(x) < 0.03, 0.06, 0.0), size=0.3, steps=120)
    camera = above(size=(300, 300), fov=17.0)
    result = region(Studio(step), camera)
    off = np.abs(np.abs(places(step, result)[:, 0]) - 0.03)
    assert off.min() > 0.75 * MARGIN
    assert (np.abs(places(step, result)[:, 0]) < 0.03).any()


def hump(height):
    """A wall across the sheet, which throws a shadow; the light comes from +x."""
    return lambda x, y: height * np.exp(-(((x - 0.05) / 0.012) ** 2))


def test_only_shadows_that_both_have_can_move():
    camera = above(size=(200, 200), fov=17.0)
    low, high, none = (
        Studio(zoned(sheet(hump(h), size=0.3, steps=90))) for h in (0.03, 0.034, 0.0)
    )
    side = region(low, camera).side

    def left_out(test, reference):
        return moving_shadows(test, reference, LOW, camera, "draft", side)

    assert not left_out(low, low).any()
    assert left_out(high, low).any()
    # The shadow of a wrinkle that the reference does not have is what is to be seen.
    assert not left_out(low, none).any()
    whole = region(low, camera)
    rest = whole.without(left_out(high, low))
    assert rest.mask.sum() < whole.mask.sum()
    assert (rest.zone[~rest.mask] == -1).all()
    brighter = replace(LOW, lights=())
    assert not moving_shadows(high, low, brighter, camera, "draft", side).any()
