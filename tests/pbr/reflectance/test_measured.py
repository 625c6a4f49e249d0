"""Measured maps: decoded, laid in millimetres, filtered without losing the slopes' variance."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from seatlook.errors import InputError
from seatlook.model import Appearance, Rig, TextureMaps, sun
from seatlook.model.colour import srgb_decode
from seatlook.pbr.kernels.measured import measured
from seatlook.pbr.reflectance.measured import load_maps, mean_albedo
from seatlook.pbr.shading.look import pack_materials
from seatlook.pbr.shading.studio import Studio
from support.reference.lit_sheets import above, flat, sheet

FINE = 1e-6
RIG = Rig(name="sun", lights=(replace(sun(elevation_deg=90, azimuth_deg=0), colour=np.ones(3)),))


def texture(width=0.1, height=0.1, **maps):
    pixels = {k: np.asarray(v, dtype=np.uint8) for k, v in maps.items()}
    return TextureMaps(folder="made", width=width, height=height, **pixels)


def at(maps, u, v, width=FINE, **change):
    """What the kernel gives at a pattern point, for a sample of a width [m]."""
    change = {"albedo": np.ones(3), "roughness": 1.0, "metalness": 1.0, **change}
    (material,) = pack_materials([Appearance(maps=maps, **change)])
    return measured(load_maps((maps,)), material, u, v, width)


def bumps(n=64, steep=0.3):
    """Normals of waves along u, eight to the tile, and the slopes that 8 bits leave of them."""
    slope = steep * np.sin(2 * np.pi * 8 * (np.arange(n) + 0.5) / n)
    normal = np.stack([-slope, 0 * slope, np.ones(n)], axis=-1)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    pixels = np.rint(255 * (normal + 1) / 2)
    x, _, z = 2 * pixels.T / 255 - 1
    return pixels[None].repeat(n, axis=0), -x / z


def test_colour_is_decoded_and_divided_by_its_mean():
    quarters = np.zeros((2, 2, 3))
    quarters[0, 0] = 255, 188, 0
    maps = texture(albedo=quarters)
    mean = mean_albedo(maps)
    assert mean == pytest.approx([0.25, float(srgb_decode(188 / 255)) / 4, 1e-4])
    # First row at the top, so the upper left quarter is at large v.
    colour = at(maps, 0.025, 0.075)[0]
    assert np.array(colour) * mean == pytest.approx([1, float(srgb_decode(188 / 255)), 0], abs=1e-6)
    assert at(maps, 0.025, 0.025)[0][0] == pytest.approx(0, abs=1e-6)


def test_roughness_and_metalness_are_linear_and_multiply_the_material():
    maps = texture(roughness=np.full((4, 4), 128), metalness=np.full((4, 4), 51))
    _, roughness, metal, *_ = at(maps, 0.01, 0.01, roughness=0.8, metalness=0.5)
    assert roughness == pytest.approx(0.8 * 128 / 255, rel=1e-5)
    assert metal == pytest.approx(0.1, rel=1e-6)


def test_slopes_are_those_of_the_normals():
    normal, slope = bumps()
    maps = texture(normal=normal)
    for column in (3, 17, 40):
        su, sv = at(maps, 0.1 * (column + 0.5) / 64, 0.03)[3:]
        assert su == pytest.approx(slope[column], abs=5e-4)
        # 128 of 255 is not quite upright; only its mean over the picture is taken off.
        assert sv == pytest.approx(0, abs=2e-4)


def test_y_of_a_normal_is_up_in_the_picture():
    normal, slope = bumps()
    turned = np.rot90(normal)[..., [1, 0, 2]]
    for row in (3, 17, 40):
        # Rows run down, v runs up.
        sv = at(texture(normal=turned), 0.03, 0.1 * (row + 0.5) / 64)[4]
        assert sv == pytest.approx(slope[row], abs=5e-4)


def test_far_away_the_relief_is_roughness():
    normal, slope = bumps()
    maps = texture(normal=normal)
    _, roughness, _, su, sv = at(maps, 0.01, 0.02, width=1.0, roughness=0.4)
    assert max(abs(su), abs(sv)) < 1e-4
    variance = 0.5 * np.var(slope)
    assert roughness == pytest.approx((0.4**4 + 2 * variance) ** 0.25, rel=2e-3)


def test_contrast_falls_smoothly_with_distance():
    noise = np.random.default_rng(2).integers(0, 255, (128, 128, 3))
    maps = texture(albedo=noise)
    u = np.linspace(0, 0.1, 200)
    spread = [
        np.std([at(maps, x, 0.013, width)[0][1] for x in u])
        for width in (5e-4, 1e-3, 2e-3, 4e-3, 8e-3, 1.6e-2, 3.2e-2, 6.4e-2)
    ]
    assert spread == sorted(spread, reverse=True)
    assert spread[-1] < 0.05 * spread[0]


def test_tiles_repeat_and_need_not_be_square():
    noise = np.random.default_rng(3).integers(0, 255, (10, 30, 3))
    maps = texture(width=0.3, height=0.1, albedo=noise)
    point = at(maps, 0.123, 0.045)
    assert at(maps, 0.123 + 0.6, 0.045 - 0.3)[0] == pytest.approx(point[0], rel=1e-5)
    whole = np.mean(
        [
            at(maps, u, v)[0]
            for u in 0.3 * (np.arange(60) + 0.5) / 60
            for v in np.arange(0, 0.1, 0.005)
        ],
        axis=0,
    )
    assert whole == pytest.approx(np.ones(3), abs=0.02)


def test_maps_of_different_sizes_lie_over_each_other():
    colour = np.zeros((8, 8, 3))
    colour[:, :4] = 255
    rough = np.full((2, 2), 50)
    rough[:, 0] = 200
    maps = texture(albedo=colour, roughness=rough)
    for u in (0.025, 0.075):
        tint, roughness, *_ = at(maps, u, 0.05)
        assert (tint[0] > 1) == (roughness > 0.5)


def test_sets_are_packed_beside_each_other():
    a = texture(roughness=np.full((8, 8), 100))
    b = texture(width=0.2, roughness=np.full((2, 4), 200))
    looks = [Appearance(albedo=np.ones(3), roughness=1.0, maps=m) for m in (b, a, b)]
    packed, materials = load_maps((b, a)), pack_materials(looks)
    assert materials["maps"].tolist() == [0, 1, 0]
    got = [measured(packed, m, 0.01, 0.01, w)[1] for m in materials for w in (FINE, 1.0)]
    assert got == pytest.approx([200 / 255] * 2 + [100 / 255] * 2 + [200 / 255] * 2, rel=1e-5)


def test_pixels_of_another_kind():
    with pytest.raises(InputError, match=r"TextureMaps.normal: got uint8 \(4, 4\), expected"):
        texture(normal=np.full((4, 4), 128))
    with pytest.raises(InputError, match="TextureMaps: got no map, expected at least one"):
        texture()


def stripes():
    """Black and white across u, each 20 mm wide."""
    board = np.zeros((8, 8, 3))
    board[:, 4:] = 255
    return texture(width=0.04, height=0.04, albedo=board)


@pytest.mark.render
def test_pattern_is_laid_in_millimetres_and_follows_the_stretch():
    """A sheet pulled to 1.5 times its width shows the stripes 1.5 times as wide."""
    rest = sheet(flat, size=0.4, steps=8)
    pulled = rest.positions * np.array([1.5, 1.0, 1.0])
    look = Appearance(albedo=np.ones(3), f0=0.0, roughness=1.0, maps=stripes())
    for solution, period in ((rest, 0.04), (replace(rest, positions=pulled), 0.06)):
        camera = above(size=(240, 16), fov=1.0)
        width = 240 / 16 * 2 * np.tan(np.radians(0.5))
        picture = Studio(solution).render(look, rig=RIG, camera=camera, quality="T1")
        row = picture.radiance[8, :, 1].astype(float)
        power = np.abs(np.fft.rfft(row - row.mean(), n=8 * len(row)))
        assert power.argmax() / 8 == pytest.approx(width / period, rel=0.06)


@pytest.mark.render
def test_pattern_lies_along_the_grain_of_the_panel():
    """Cut across the cloth, the stripes run across as well."""
    solution = sheet(flat, size=0.4, steps=8)
    rest = solution.cover.rest[:, ::-1] * [1.0, -1.0]
    turned = replace(solution, cover=replace(solution.cover, rest=rest))
    look = Appearance(albedo=np.ones(3), f0=0.0, roughness=1.0, maps=stripes())
    for one, axis in ((solution, 0), (turned, 1)):
        camera = above(size=(40, 40), fov=8.0)
        seen = Studio(one).render(look, rig=RIG, camera=camera, quality="T1").radiance[..., 1]
        along, across = seen.mean(axis=axis).std(), seen.mean(axis=1 - axis).std()
        assert along > 10 * across


@pytest.mark.render
def test_far_away_a_picture_has_the_mean_of_the_map_and_no_sparkle():
    noise = np.random.default_rng(5).integers(0, 255, (256, 256, 3))
    maps = texture(width=0.005, height=0.005, albedo=noise, normal=bumps(256, 1.0)[0])
    plain = Appearance(albedo=mean_albedo(maps), f0=0.0, roughness=1.0)
    studio = Studio(sheet(flat, size=0.2, steps=8))
    camera = above(size=(24, 24), fov=4.0)
    look = Appearance(albedo=np.ones(3), f0=0.0, roughness=1.0, maps=maps)
    got = studio.render(look, rig=RIG, camera=camera).radiance
    wanted = studio.render(plain, rig=RIG, camera=camera).radiance
    assert got.mean(axis=(0, 1)) == pytest.approx(wanted.mean(axis=(0, 1)), rel=0.02)
    assert got.std(axis=(0, 1)).max() < 0.03 * got.mean()


@pytest.mark.render
def test_every_panel_has_its_own_maps():
    maps = [texture(albedo=np.full((2, 2, 3), code)) for code in (255, 0)]
    looks = {
        f"panel{k}": Appearance(albedo=np.ones(3), f0=0.0, roughness=1.0, maps=m)
        for k, m in enumerate(maps)
    }
    studio = Studio(sheet(flat, panels=2, steps=8))
    row = studio.render(looks, rig=RIG, camera=above(size=(32, 8), fov=1.5)).radiance[4, :, 1]
    assert row[4] == pytest.approx(RIG.lights[0].intensity / np.pi, rel=0.02)
    assert row[28] < 0.01 * row[4]


@pytest.mark.render
def test_metal_of_a_map_is_metal():
    """Half of the sheet is a rough mirror: as bright as a material with the number."""
    metal = np.zeros((8, 8))
    metal[:, :4] = 255
    studio = Studio(sheet(flat, size=0.2, steps=8))
    camera = above(size=(32, 8), fov=1.5)
    gold = {"albedo": np.array([1.0, 0.7, 0.3]), "roughness": 0.5}
    mixed = Appearance(metalness=1.0, maps=texture(width=0.2, height=0.2, metalness=metal), **gold)
    row = studio.render(mixed, rig=RIG, camera=camera).radiance[4]
    # The tile begins in the middle of the picture.
    for k, metalness in ((8, 0.0), (24, 1.0)):
        whole = Appearance(metalness=metalness, **gold)
        wanted = studio.render(whole, rig=RIG, camera=camera).radiance[4, k]
        assert row[k] == pytest.approx(wanted, rel=2e-3)
