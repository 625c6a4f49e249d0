"""Light gathered by few rays against many: the demo under a low sun from twelve sides."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy import ndimage

import seatlook
from seatlook.io.material import read_material
from seatlook.model import Rig, framed_view, sun
from seatlook.pbr.quality import quality_named
from seatlook.pbr.shading.studio import Studio
from seatlook.seats import write_demo

pytestmark = [pytest.mark.validate, pytest.mark.render]
MATERIALS = ("black-leather", "bright-leather", "pvc", "suede", "woven")
HEIGHTS = (8, 11, 14, 17, 20)
# Pixels next to an edge that do not count.
EDGE = 3


@pytest.fixture(scope="module")
def studio(tmp_path_factory):
    folder = tmp_path_factory.mktemp("demo")
    write_demo(folder)
    return Studio(seatlook.open(folder / "scene.toml").solution)


@pytest.fixture(scope="module")
def camera(studio):
    return framed_view("front_34", studio.solution.cover.foam.vertices)


@pytest.fixture(scope="module")
def counted(studio, camera):
    """Pixels that show one panel, and so do those around them."""
    surface, ids = studio.surface, studio.faces(camera, 2)
    kind = np.full(ids.shape, -1)
    panel = (ids >= 0) & (ids < surface.faces)
    kind[panel] = surface.mesh.panel[ids[panel]]
    w, h = camera.size
    blocks = kind.reshape(h, 2, w, 2)
    low, high = blocks.min(axis=(1, 3)), blocks.max(axis=(1, 3))
    edge = low != high
    edge[:, 1:] |= low[:, 1:] != low[:, :-1]
    edge[1:] |= low[1:] != low[:-1]
    return ~ndimage.binary_dilation(edge, iterations=EDGE) & (low >= 0)


def shown(image):
    """Code values of sRGB without dither."""
    from seatlook.pbr.light.exposure import clamp, saturation_luminance, srgb_encode

    return 255 * srgb_encode(
        clamp(image.radiance / saturation_luminance(image.ev100) / image.white)
    )


@pytest.mark.xfail(strict=True, reason="what is mirrored still differs; see the measurements")
@pytest.mark.parametrize("name", MATERIALS)
def test_few_rays_show_what_many_do(studio, camera, counted, name):
    look = replace(read_material(name).appearance, texture="none", texture_depth=0.0)
    few = quality_named("standard")
    worst, beyond, largest = 0.0, 0.0, 0
    for side in range(12):
        light = sun(elevation_deg=HEIGHTS[side % len(HEIGHTS)], azimuth_deg=30 * side)
        rig = Rig(name="low", lights=(light,))
        a, b = (
            shown(studio.render(look, rig=rig, camera=camera, quality=level))
            for level in (few, replace(few, strata=32))
        )
        off = np.abs(a - b).max(axis=2) * counted
        labels, count = ndimage.label(off > 2)
        patch = int(np.bincount(labels.ravel())[1:].max()) if count else 0
        share = float((off > 4).sum() / counted.sum())
        print(
            f"\n  {name} {30 * side}: >4 {share:.1e}, worst {off.max():.1f}, patch {patch}", end=""
        )
        worst, beyond, largest = max(worst, off.max()), max(beyond, share), max(largest, patch)
    assert beyond <= 5e-4
    assert worst <= 10
    assert largest <= 20
