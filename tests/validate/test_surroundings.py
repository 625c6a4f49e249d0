"""The demo on a floor: its front is lit from below, its shadow is dark, nothing is cut off."""

from __future__ import annotations

import numpy as np
import pytest

import seatlook
from seatlook.io.material import read_material
from seatlook.model import Rig, framed_view, sun
from seatlook.pbr.light.rig import LUMINANCE
from seatlook.pbr.shading.studio import Studio
from seatlook.seats import write_demo

pytestmark = [pytest.mark.validate, pytest.mark.render]
# That of a clear day [cd/m2].
SKY = 4000.0
# From where the camera looks [deg]; with the sun beyond the seat the shadow falls towards it.
AZIMUTH = 35


@pytest.fixture(scope="module")
def studio(tmp_path_factory):
    folder = tmp_path_factory.mktemp("demo")
    write_demo(folder)
    return Studio(seatlook.open(folder / "scene.toml").solution, surroundings="sweep")


@pytest.mark.parametrize("name", ["black-leather", "bright-leather"])
def test_front_shadow_and_highlights(studio, name):
    """Sun at 70 degrees from twelve sides, 1280 x 720, standard, with grain, floor albedo 0.4."""
    surface, cover = studio.surface, studio.solution.cover
    camera = framed_view("front_34", cover.foam.vertices)
    ids, look = studio.faces(camera, 1), read_material(name).appearance
    panel = np.where(ids >= 0, surface.mesh.panel[ids], -1)
    front, top = (panel == cover.panel_names.index(part) for part in ("FRONT", "INSERT"))
    floor = panel == len(cover.panel_names) + 1
    ratios, shadows, cut = [], [], []
    for azimuth in range(0, 360, 30):
        light = sun(elevation_deg=70, azimuth_deg=azimuth)
        rig = Rig(name="sun", lights=(light,), ambient=SKY)
        image = studio.render(look, rig=rig, camera=camera)
        seen = image.radiance @ LUMINANCE
        ratios.append(seen[front].mean() / seen[top].mean())
        if np.cos(np.radians(azimuth - AZIMUTH)) < 0:
            shadows.append(seen[floor].min() / np.median(seen[floor]))
        cut.append((image.to_srgb() == 255).any(axis=2).mean())
    print(
        f"\n  {name}: front over top {min(ratios):.2f} to {max(ratios):.2f}, "
        f"darkest floor {max(shadows):.2f}, cut off {max(cut):.2%}",
        end="",
    )
    assert min(ratios) >= 0.25
    assert max(shadows) <= 0.3
    assert max(cut) <= 0.01
