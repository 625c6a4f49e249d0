"""What reflections and half-spaces see: covered sky, light from other faces."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from seatlook.model import Appearance, Rig, sun
from seatlook.pbr.shading.studio import Studio
from support.reference.lit_sheets import above, sheet

pytestmark = pytest.mark.render
SKY = Rig(name="sky", lights=(), ambient=1000.0)
BLACK = Appearance(albedo=np.zeros(3), f0=0.0)
POLISHED = Appearance(albedo=np.ones(3), metalness=1.0, roughness=0.12)


def ledge(x, y):
    """50 mm high where x < 0, with its wall at x = 0."""
    return np.where(x < 0, 0.05, 0.0)


def looking(at, towards):
    at = np.array(at)
    return replace(above(size=(6, 6), fov=1.0, at=at), position=at + np.array(towards))


def test_a_mirror_shows_the_wall_beside_it_where_geometry_says():
    """Seen at 45 degrees, the floor mirrors a wall of 50 mm up to 50 mm from its foot."""
    studio = Studio(sheet(ledge, steps=40, panels=2))
    look = {"panel0": BLACK, "panel1": POLISHED}

    def seen(x):
        camera = looking((x, 0.0, 0.0), (0.2, 0.0, 0.2))
        return studio.render(look, rig=SKY, camera=camera).radiance.mean()

    assert seen(0.03) < 50
    assert seen(0.075) > 970


def test_a_wall_in_the_sun_looks_the_same_in_the_floor():
    """The floor mirrors at 30 mm what the wall sends at a height of 30 mm."""
    studio = Studio(sheet(ledge, steps=40, panels=2))
    white = Appearance(albedo=np.ones(3), f0=0.0)
    light = replace(sun(elevation_deg=30, azimuth_deg=90), colour=np.ones(3))
    rig, look = Rig(name="side", lights=(light,)), {"panel0": white, "panel1": POLISHED}
    mirrored, wall = (
        studio.render(look, rig=rig, camera=looking(at, (0.2, 0.0, 0.2))).radiance.mean()
        for at in ((0.03, 0.0, 0.0), (0.0, 0.0, 0.03))
    )
    assert wall > 0.3 * 97_000 / np.pi
    assert mirrored == pytest.approx(wall, rel=0.15)


@pytest.mark.parametrize("look", [Appearance(albedo=np.ones(3), roughness=0.5), POLISHED])
def test_a_white_gutter_in_a_furnace_loses_no_more_than_later_bounces(look):
    gutter = Studio(sheet(lambda x, y: 4 * x**2, steps=40))
    camera = above(size=(40, 40), fov=8)
    one, three = (
        gutter.render(look, rig=SKY, camera=camera, quality=q).radiance[..., 1] / 1000
        for q in ("T3", "T4")
    )
    assert one.max() <= 1.005
    assert three.max() <= 1.005
    assert one.min() > 0.85
    assert three.mean() >= one.mean() - 0.005
