"""The search on functions whose maximum is known, and what it costs."""

import numpy as np
import pytest

from seatlook.errors import InputError
from seatlook.model import direction
from seatlook.visibility.light_search import (
    LOWEST_DEG,
    bulb_rig,
    hemisphere,
    sun_rig,
    worst_direction,
)


def lobe(azimuth, elevation, width_deg):
    """A highlight: falls to 1/e at ``width_deg`` from its middle."""
    middle = direction(azimuth, elevation)

    def value(a, e):
        angle = np.degrees(np.arccos(np.clip(middle @ direction(a, e), -1, 1)))
        return float(np.exp(-((angle / width_deg) ** 2)))

    return value


@pytest.mark.parametrize("width", [15.0, 40.0])
@pytest.mark.parametrize("seed", range(4))
def test_finds_a_highlight_anywhere(width, seed):
    rng = np.random.default_rng(seed)
    azimuth, elevation = rng.uniform(0, 360), rng.uniform(15, 85)
    result = worst_direction(lobe(azimuth, elevation, width))
    assert result.vwi > 0.95
    assert len(result.tried) <= 100


def test_the_higher_of_two_wins():
    low, high = lobe(40, 20, 20), lobe(200, 60, 20)
    result = worst_direction(lambda a, e: 0.8 * low(a, e) + high(a, e))
    assert abs(result.azimuth_deg - 200) < 8
    assert abs(result.elevation_deg - 60) < 4
    assert result.vwi == result.tried[:, 2].max()


def test_no_light_is_tried_twice_or_below_the_lowest():
    seen = []
    worst_direction(lambda a, e: seen.append((a, e)) or -e)
    assert min(e for _, e in seen) >= LOWEST_DEG - 1e-9
    directions = np.array([direction(a, e) for a, e in seen])
    nearest = (directions @ directions.T - 2 * np.eye(len(seen))).max(axis=1)
    assert np.degrees(np.arccos(nearest.max())) > 0.5


def test_directions_share_the_sky_evenly():
    points = np.array([direction(a, e) for a, e in hemisphere(400)])
    assert points[:, 2].min() > np.sin(np.radians(LOWEST_DEG))
    assert points[:, 2].mean() == pytest.approx((1 + np.sin(np.radians(LOWEST_DEG))) / 2, abs=0.01)
    np.testing.assert_allclose(points[:, :2].mean(axis=0), 0, atol=0.01)


def test_rigs_stand_where_they_are_said_to():
    from support.reference.lit_sheets import above

    camera = above(at=(0.1, 0.0, 0.2))
    rig = bulb_rig(camera, distance=0.5)(90.0, 30.0)
    place = rig.lights[0].vector - camera.target
    assert np.linalg.norm(place) == pytest.approx(0.5)
    np.testing.assert_allclose(place / 0.5, direction(90.0, 30.0), atol=1e-12)
    assert rig.ambient * np.pi == pytest.approx(50.0)
    np.testing.assert_allclose(sun_rig()(10, 50).lights[0].vector, direction(10, 50))


def test_refuses_a_search_that_is_none():
    with pytest.raises(InputError, match=r"light search: got \(4, 1, 1\), expected coarse >= 8"):
        worst_direction(lambda a, e: 0.0, coarse=4, rounds=1, keep=1)
