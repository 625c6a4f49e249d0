"""A strip of 1.5 x 0.1 m at 0.8 m against 1,024 points per pixel, direct light, by FLIP."""

from __future__ import annotations

from dataclasses import replace

import pytest

from seatlook.model import Rig, rectangle, strip
from seatlook.pbr.quality import quality_named
from seatlook.pbr.shading.studio import Studio
from support.reference.rectangle_points import direct
from support.reference.render_error import camera, compare, look, scene

pytestmark = [pytest.mark.validate, pytest.mark.render]
pytest.importorskip("flip_evaluator")

LEATHER = look("black-leather", textured=False)
CASES = {
    "strip, plain leather": (strip(position_mm=(0, -150, 800)), replace(LEATHER, coat=0.0)),
    "strip, coated leather": (strip(position_mm=(0, -150, 800)), LEATHER),
    "panel, coated leather": (rectangle(position_mm=(200, -300, 800), size_mm=(600, 400)), LEATHER),
}


@pytest.fixture(scope="module")
def studio():
    return Studio(scene())


@pytest.mark.parametrize("case", CASES)
def test_direct_light_of_rectangles(studio, case):
    """Two halves of the reference tell its own noise; 640 x 360, object pixels, 67 per degree."""
    lamp, leather = CASES[case]
    rig = Rig(name="lamp", lights=(lamp,))
    points = (16, 2) if "strip" in case else (8, 4)
    halves = [
        direct(studio, leather, rig=rig, camera=camera(), factor=4, points=points, seed=seed)
        for seed in (0, 1)
    ]
    for name, bar in (("standard", 0.02), ("high", 0.01)):
        level = replace(quality_named(name), strata=0, bounces=0)
        image = studio.render(leather, rig=rig, camera=camera(), quality=level)
        kwargs = {"rig": rig, "cover": image.cover}
        noise = compare(*halves, **kwargs).flip / 2
        got = compare(sum(halves) / 2, image.radiance, **kwargs)
        print(f"{case}, {name}: FLIP {got.flip:.4f}, block {got.block:.4f}, noise {noise:.4f}")
        assert got.flip <= bar
        assert got.block <= 0.015
