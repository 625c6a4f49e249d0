"""Relief maps: slopes of a height, tiled, and filtered without losing their variance."""

from __future__ import annotations

import numpy as np
import pytest

from seatlook.model import Appearance, TextureMaps
from seatlook.pbr.kernels.grain import bilinear, grain, prefetch_bilinear
from seatlook.pbr.kernels.measured import measured
from seatlook.pbr.reflectance.measured import load_maps
from seatlook.pbr.reflectance.relief import MAPS, baked, load_textures, texture_index
from seatlook.pbr.shading.look import pack_materials


def look(name, **change):
    change = {"texture_scale": 0.001, "texture_depth": 1e-4, "roughness": 0.4, **change}
    return pack_materials([Appearance(albedo=np.ones(3), texture=name, **change)])[0]


@pytest.fixture(scope="module")
def textures():
    return load_textures(*MAPS.values())


@pytest.mark.parametrize("name", MAPS)
def test_slopes_close_around_the_tile(textures, name):
    """A periodic height has no mean slope, and the coarsest level holds all the variance."""
    which = MAPS[name]
    fine = textures.texels[which][: textures.start[1]].astype(float)
    coarse = textures.texels[which][textures.start[-1]].astype(float)
    assert np.abs(fine[:, :2].mean(axis=0)).max() < 1e-4
    variance = 0.5 * (fine[:, :2] ** 2).sum(axis=1).mean()
    assert coarse[2] == pytest.approx(variance, rel=1e-3)
    assert 0.5 < fine[:, 3].min() <= fine[:, 3].max() <= 1.0


@pytest.mark.parametrize("name", MAPS)
def test_far_away_the_relief_is_roughness(textures, name):
    material = look(name)
    su, sv, roughness, share = grain(textures, material, material["roughness"], 0.01, 0.02, 1.0)
    steep = 0.1
    variance = steep**2 * textures.texels[MAPS[name]][textures.start[-1], 2]
    assert max(abs(su), abs(sv)) < 1e-3
    assert roughness == pytest.approx(min(1.0, (0.4**4 + 2 * variance) ** 0.25), rel=1e-5)
    assert 0.5 < share <= 1
    assert roughness > 0.4


def test_weave_finer_than_the_samples_is_roughness(textures):
    """Regular yarns about as wide as a sample would beat with the pixels: rings on the cover."""
    material, points = look("weave"), np.random.default_rng(0).random((500, 2)) * 0.5

    def steepness(width):
        return np.std([grain(textures, material, 0.4, u, w, width)[0] for u, w in points])

    assert steepness(0.8e-3) < 1e-6
    assert steepness(0.25e-3) > 0.5 * steepness(1e-5)


@pytest.mark.parametrize("name", MAPS)
def test_no_slope_as_long_as_a_wrinkle(textures, name):
    """Relief that tilts over 8 mm and more would be seen as wrinkles under raking light."""
    material = look(name)
    points = np.random.default_rng(0).random((500, 2)) * 0.5
    # Texels are half a sample wide: these are means over 8 mm.
    slopes = np.array(
        [grain(textures, material, material["roughness"], u, w, 0.016)[:2] for u, w in points]
    )
    assert np.abs(slopes).max() < 5e-3


def test_near_the_relief_is_slope(textures):
    material = look("leather")
    values = np.array(
        [
            grain(textures, material, material["roughness"], u, 0.02, 1e-6)[:3]
            for u in np.linspace(0, 0.06, 4000)
        ]
    )
    assert np.abs(values[:, 0]).max() > 0.1
    assert np.allclose(values[:, 2], 0.4, atol=1e-6)


def test_slope_grows_with_depth_and_repeats_with_the_tile(textures):
    shallow, deep = look("leather"), look("leather", texture_depth=2e-4)
    a, b = (grain(textures, m, m["roughness"], 0.0123, 0.0456, 1e-5) for m in (shallow, deep))
    assert b[0] == pytest.approx(2 * a[0], rel=1e-6)
    tile = textures.cells * 0.001
    c = grain(textures, shallow, shallow["roughness"], 0.0123 + 3 * tile, 0.0456 - tile, 1e-5)
    assert c == pytest.approx(a, rel=1e-6, abs=1e-7)


def test_contrast_falls_smoothly_with_distance(textures):
    material = look("leather")
    u = np.linspace(0, 0.064, 300)
    spread = [
        np.std([grain(textures, material, material["roughness"], x, 0.01, width)[0] for x in u])
        for width in (1e-4, 2e-4, 4e-4, 8e-4, 1.6e-3, 3.2e-3)
    ]
    assert spread == sorted(spread, reverse=True)
    assert spread[-1] < 0.1 * spread[0]


@pytest.mark.parametrize("name", MAPS)
def test_baked_grain_is_the_grain(textures, name):
    """Slopes, colour and roughness of the maps at the pixels' middles, to 8 bits."""
    a = Appearance(
        albedo=np.full(3, 0.5), texture=name, texture_scale=0.001, texture_depth=2e-4, roughness=0.5
    )
    b = baked(a)
    assert (b.texture, b.maps.width) == ("none", pytest.approx(0.064))
    packed = load_maps((b.maps,))
    grained, mapped = pack_materials([a])[0], pack_materials([b])[0]
    pixel = 0.064 / 512
    apart = []
    for i, j in np.random.default_rng(0).integers(0, 512, (200, 2)):
        u, v = (i + 0.5) * pixel, (j + 0.5) * pixel
        su, sv, _, share = grain(textures, grained, 0.5, u, v, 2 * pixel)
        colour, _, _, mu, mv = measured(packed, mapped, u, v, 1e-6)
        seen = colour[0] * mapped["albedo"][0]
        if name == "suede":
            # Without the marks of the hand.
            assert 0.925 * seen < share * 0.5 < 1.005 * seen
        else:
            assert seen == pytest.approx(share * 0.5, rel=0.02)
        apart.append((su - mu, sv - mv))
    assert np.abs(apart).max() < 0.03
    assert b.roughness > 0.5


def test_baking_leaves_measured_maps_alone():
    maps = TextureMaps(folder="m", width=1.0, height=1.0, roughness=np.ones((1, 1), dtype=np.uint8))
    a = Appearance(albedo=np.ones(3), texture="leather", texture_depth=1e-4, maps=maps)
    assert baked(a) is a


def test_no_depth_is_no_texture():
    assert texture_index(Appearance(albedo=np.ones(3), texture="leather")) == -1
    assert texture_index(Appearance(albedo=np.ones(3), texture_depth=1e-4)) == -1


def test_reading_ahead_changes_nothing_wherever_it_looks(textures):
    texels = textures.texels[MAPS["suede"]]
    before = bilinear(texels, textures, 0, 0.3, 0.7)
    for u, v in ((0.0, 0.0), (-3.2, 1e6), (0.999999, 0.999999)):
        for level in (0, len(textures.start) - 1):
            prefetch_bilinear(texels, textures, level, u, v)
    assert bilinear(texels, textures, 0, 0.3, 0.7) == before
