"""White furnace through ``render``: a card under 4,096 suns that fill the sky."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from seatlook.model import Appearance, Camera, Light, Rig
from seatlook.pbr.quality import TIERS
from seatlook.pbr.shading.studio import Studio
from support.reference.lit_sheets import flat, sheet

pytestmark = pytest.mark.render
SUNS = 4096
WHITE = np.ones(3)
LAYERS = {
    "matt": {"f0": 0.0, "roughness": 1.0},
    "base": {"roughness": 0.5},
    "coat": {"roughness": 0.5, "coat": 1.0, "coat_roughness": 0.4},
    "nap": {"roughness": 0.9, "sheen": WHITE, "sheen_roughness": 0.6},
    "nap and coat": {"roughness": 0.9, "sheen": WHITE, "sheen_roughness": 0.6, "coat": 1.0},
    "stretched": {"roughness": 0.7, "anisotropy": 0.4},
    "stretched much": {"roughness": 0.7, "anisotropy": 0.8},
}
# What the quadrature adds: suns are discs of 1.3 degrees.
QUADRATURE = 0.002


@pytest.fixture(scope="module")
def card():
    return Studio(sheet(flat, steps=4))


@pytest.fixture(scope="module")
def sky():
    """Suns of equal solid angle over the half-space, together a sky of 1 cd/m2."""
    k = np.arange(SUNS) + 0.5
    up, phi = k / SUNS, np.pi * (3 - np.sqrt(5)) * k
    level = np.sqrt(1 - up**2)
    each = 2 * np.pi / SUNS
    size = 2 * np.arccos(1 - each / (2 * np.pi))
    lights = tuple(
        Light(name="sun", intensity=each, vector=vector, near=False, size=size)
        for vector in np.stack([level * np.cos(phi), level * np.sin(phi), up], axis=-1)
    )
    return Rig(name="sky", lights=lights, ev100=1.0)


@pytest.mark.parametrize("metalness", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("layer", LAYERS)
def test_a_white_card_gives_back_what_it_gets(card, sky, layer, metalness):
    look = Appearance(albedo=WHITE, metalness=metalness, **LAYERS[layer])
    for elevation in (15.0, 40.0, 85.0):
        turn, rise = 0.6, np.radians(elevation)
        toward = [np.cos(rise) * np.cos(turn), np.cos(rise) * np.sin(turn), np.sin(rise)]
        camera = Camera(
            name="c", position=np.array(toward), target=np.zeros(3), vertical_fov_deg=1.0,
            size=(2, 2),
        )  # fmt: skip
        level = replace(TIERS["T2"], rays=0)
        got = card.render(look, rig=sky, camera=camera, quality=level).radiance
        print(layer, metalness, elevation, got.min(), got.max())
        assert got.min() >= 0.98
        assert got.max() <= 1 + QUADRATURE
