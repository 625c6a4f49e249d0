"""A turn round a seat: same light on a turned seat, all of it in every picture."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from seatlook.model import Rig, bulb, named_view, sun
from seatlook.model.light.lamps import rectangle
from seatlook.model.light.turning import about_z, round_the_seat, turned_camera, turned_rig

AXIS = np.array([0.12, -0.3, 0.2])


def rig() -> Rig:
    lights = (
        sun(elevation_deg=23.0, azimuth_deg=71.0),
        bulb(position_mm=(400.0, -250.0, 900.0)),
        rectangle(position_mm=(-700.0, 100.0, 800.0), size_mm=(500.0, 90.0)),
    )
    return Rig(name="all", lights=lights)


@pytest.mark.parametrize("angle", [17.0, 90.0, -133.0])
def test_lamps_stand_to_the_turned_axis_as_before(angle):
    rotation, before, after = about_z(angle), rig(), turned_rig(rig(), angle, AXIS)
    level = AXIS * [1.0, 1.0, 0.0]
    for old, new in zip(before.lights, after.lights, strict=True):
        origin = level if old.near else np.zeros(3)
        np.testing.assert_allclose(new.vector - origin, rotation @ (old.vector - origin))
        np.testing.assert_allclose(new.sides, old.sides @ rotation.T, atol=1e-12)
        assert (new.intensity, new.size) == (old.intensity, old.size)
    full = turned_rig(turned_rig(before, angle, AXIS), 360.0 - angle, AXIS)
    for old, new in zip(before.lights, full.lights, strict=True):
        np.testing.assert_allclose(new.vector, old.vector, atol=1e-12)


def test_panorama_goes_with_the_lamps():
    sky = np.ones((4, 12, 3))
    sky[1, 2] = 50.0
    after = turned_rig(Rig(name="sky", lights=(), panorama=sky), 90.0, AXIS)
    assert after.panorama is not None
    assert after.panorama[1, :, 0].argmax() == 5


@pytest.mark.parametrize("name", ["front_34", "top", "driver_door"])
@pytest.mark.parametrize("size", [(640, 360), (300, 500)])
def test_every_picture_of_a_turn_holds_all_of_a_long_seat(name, size):
    points = AXIS + np.random.default_rng(3).uniform(-1, 1, (200, 3)) * [0.9, 0.2, 0.35]
    ring = round_the_seat(named_view(name, target=points[0], size=size), points, 7)
    away = [np.linalg.norm(one.position - one.target) for one in ring]
    np.testing.assert_allclose(away, away[0])
    most = 0.0
    for one in ring:
        pixels, depth = one.pixels(points)
        assert (depth > 0).all()
        assert (pixels > 0).all()
        assert (pixels < size).all()
        most = max(most, float((np.abs(2 * pixels / size - 1)).max()))
    assert most > 0.85  # no farther than needed


def test_a_turned_camera_sees_a_turned_place_where_it_was():
    camera = replace(named_view("front_34", target=AXIS), up=np.array([0.0, 0.0, 1.0]))
    place = AXIS + np.array([0.1, 0.05, -0.2])
    there = AXIS + about_z(58.0) @ (place - AXIS)
    assert turned_camera(camera, 58.0).pixel(there) == pytest.approx(camera.pixel(place))
