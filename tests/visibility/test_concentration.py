"""What share of a score a few pixels have, and where they lie."""

from dataclasses import replace

import numpy as np
import pytest

from seatlook.pbr import Studio
from seatlook.visibility.concentration import CONCENTRATED, concentration
from seatlook.visibility.pixels import region
from seatlook.visibility.view import ScoreRefusedError, View
from support.reference.lit_sheets import above, flat, sheet
from support.seen.covers import BLACK, COARSE, RIG, zoned

pytestmark = pytest.mark.render


@pytest.fixture(scope="module")
def seen():
    solution = zoned(sheet(flat, steps=40))
    return solution.cover, region(Studio(solution), above(size=(200, 200), fov=12.0))


def test_an_even_map_has_a_thousandth_in_a_thousandth(seen):
    cover, where = seen
    result = concentration(np.ones(where.mask.shape), where, cover)
    assert result.share == pytest.approx(1e-3, rel=0.05)


@pytest.mark.parametrize("share", [0.1, 0.3, 0.9])
def test_a_spot_has_its_share_and_its_place(seen, share):
    cover, where = seen
    spots = np.argwhere(where.mask & (where.zone == 0))
    y, x = spots[len(spots) // 2]
    energy = np.where(where.mask, 1.0, 0.0)
    energy[y, x] = share / (1 - share) * where.mask.sum()
    result = concentration(energy ** (1 / 3), where, cover)
    assert result.share == pytest.approx(share, abs=0.002)
    u, v = 1e3 * cover.uv[cover.faces[where.face[y, x]]].mean(axis=0)
    assert result.places[0].startswith("left interior at ")
    named = [
        float(word) for word in result.places[0].removesuffix(" mm").split(" at ")[1].split(",")
    ]
    np.testing.assert_allclose(named, (u, v), atol=5)


def test_nothing_visible_is_nowhere(seen):
    cover, where = seen
    result = concentration(np.zeros(where.mask.shape), where, cover)
    assert (result.share, result.places) == (0.0, ())


def test_a_score_of_few_pixels_is_refused():
    """A dent 6 mm wide on a smooth cover whose mesh is fine enough to carry it."""

    def dent(x, y):
        return -3e-4 * np.exp(-((x + 0.04) ** 2 + y**2) / 0.003**2)

    solution = zoned(sheet(dent, steps=100))
    solution = replace(solution, cover=replace(solution.cover, element_size=1e-3))
    view = View(solution, above(size=(240, 240), fov=12.0), sampling=COARSE)
    with pytest.raises(
        ScoreRefusedError, match=r"% of what is visible in 0\.1 % of the pixels: left"
    ):
        view.sight(BLACK, RIG)
    assert CONCENTRATED == 0.3
