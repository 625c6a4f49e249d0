import numpy as np
import pytest

from seatlook.mesh import nearest_places
from seatlook.model import Wire

TURN = np.linspace(0.0, 2 * np.pi, 241)
RING = 0.1 * np.column_stack([np.cos(TURN), np.sin(TURN), np.zeros_like(TURN)])
RING[-1] = RING[0]
STRAIGHT = np.array([[0.0, 0.0, 0.0], [0.3, 0.4, 0.0]])
FREE = (-np.inf, np.inf)


def wire(curve, place, stops=FREE):
    return Wire(curve=curve, place=place, stops=np.tile(stops, (len(place), 1)))


@pytest.mark.parametrize("away", [0.0, 1e-4, 5e-3])
@pytest.mark.parametrize("curve", [RING[:121], STRAIGHT], ids=["bent", "straight"])
def test_places_are_the_nearest_ones(curve, away):
    rng = np.random.default_rng(0)
    place = np.linspace(0.05, 0.25, 9)
    way = rng.normal(size=(9, 3))
    points = np.column_stack([np.interp(place, np.r_[0, np.cumsum(np.linalg.norm(
        np.diff(curve, axis=0), axis=1))], column) for column in curve.T])  # fmt: skip
    points = points + away * way / np.linalg.norm(way, axis=1)[:, None]
    got = wire(curve, place + 0.01 * rng.uniform(-1, 1, 9)).nearest(points)
    # The direction turns evenly where the polyline has corners of 1.5 degrees.
    np.testing.assert_allclose(got, nearest_places(curve, points)[1], atol=1e-9 + 0.03 * away)


def test_places_do_not_go_past_a_stop():
    place = np.array([0.1, 0.2, 0.3])
    points = place[:, None] * [0.6, 0.8, 0.0] + [0.06, 0.08, 0.0]
    np.testing.assert_allclose(
        wire(STRAIGHT, place, (0.0, 0.25)).nearest(points), [0.2, 0.25, 0.25]
    )


def test_a_closed_wire_goes_on_over_its_seam():
    length = 240 * 0.2 * np.sin(np.pi / 240)
    angle = np.deg2rad([-6.0, 6.0])
    points = 0.1 * np.column_stack([np.cos(angle), np.sin(angle), [0.0, 0.0]])
    got = wire(RING, np.array([0.005, length - 0.005])).nearest(points)
    np.testing.assert_allclose(got, length * np.array([-1 / 60, 1 + 1 / 60]), atol=1e-6)
