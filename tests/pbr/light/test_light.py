"""Lights with a size, skies as pictures, booths, holes and tiers."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from seatlook.errors import InputError
from seatlook.model import Appearance, Rig, booth, bulb, sun
from seatlook.pbr import ev100, lux_at_seat
from seatlook.pbr.kernels.light import above_horizon, panorama_towards
from seatlook.pbr.light.panorama import directions, irradiance_on, levels_of, shrunk, solid_angles
from seatlook.pbr.light.rig import disc_points, white_of
from seatlook.pbr.quality import TIERS, quality_within
from seatlook.pbr.reflectance import brdf
from seatlook.pbr.shading.studio import Studio
from support.reference.lit_sheets import GREY, above, flat, sheet

UP = np.array([0.0, 0.0, 1.0])


@pytest.fixture(scope="module")
def card():
    return Studio(sheet(flat, steps=8))


@pytest.mark.parametrize("factor", [2, 3, 4])
def test_points_of_the_disc_keep_its_variance(factor):
    points = disc_points(factor)
    assert points.mean(axis=0) == pytest.approx(0, abs=1e-12)
    assert points.var(axis=0) + 0.25 / factor**2 == pytest.approx(0.25)


def test_samples_to_one_side_of_a_pixel_do_not_look_to_one_side_of_the_light():
    place = disc_points(4) * 0 + np.stack(np.meshgrid(np.arange(4), np.arange(4)), -1).reshape(
        -1, 2
    )
    place = (place - 1.5) / 4
    assert np.abs(place.T @ disc_points(4) / 16).max() < 0.005


@pytest.mark.render
@pytest.mark.parametrize("tier", ["T2", "T4"])
def test_parts_of_a_large_bulb_light_a_card_like_the_whole(card, tier):
    """30 mm at 0.2 m: their mean cosine is 1 % below that of the middle."""
    light = replace(bulb(position_mm=(0, 0, 200), radius_mm=30), colour=np.ones(3))
    camera = above(size=(80, 80), fov=1.0)
    look = Appearance(albedo=np.full(3, 0.5), f0=0.0, roughness=1.0)
    got = card.render(look, rig=Rig(name="b", lights=(light,)), camera=camera, quality=tier)
    expected = 0.5 / np.pi * light.intensity / 0.2**2
    assert got.radiance[38:42, 38:42, 1].mean() == pytest.approx(expected, rel=1e-3)


@pytest.mark.render
def test_a_rounded_surface_throws_no_shadow_on_itself():
    """Under a bulb that sets behind a crown the terminator is the cosine's alone."""
    crown = Studio(sheet(lambda x, y: 0.1 - 2.5 * x * x, size=0.2, steps=24))
    rig = Rig(name="b", lights=(bulb(position_mm=(-400, 0, 120), radius_mm=30),))
    kwargs = {"rig": rig, "camera": above(size=(96, 72), fov=10.0)}
    look = Appearance(albedo=np.full(3, 0.5), f0=0.0, roughness=1.0)
    bare = crown.render(look, quality=replace(TIERS["T2"], rays=0), **kwargs).radiance
    got = crown.render(look, quality="T2", **kwargs).radiance
    assert (bare[:, -8:].mean(axis=2) < 0.05 * bare.max()).any()  # it does set
    assert np.abs(got - bare).max() < 0.002 * bare.max()


def test_half_set_disc_has_the_integral_of_the_cosine():
    """Mean of the positive part over a disc at the horizon: 2 / (3 pi) of its radius."""
    assert above_horizon(0.0, 0.0, 0.1) == pytest.approx(0.1 * 2 / (3 * np.pi), rel=0.03)
    assert above_horizon(0.3, 0.3, 0.1) == 0.3
    assert above_horizon(-0.3, -0.3, 0.1) == 0.0


@pytest.mark.render
def test_highlight_of_a_large_bulb_is_the_integral_over_its_disc(card):
    """Mirror direction of a glossy card: the picture against 4000 points of the bulb."""
    look = Appearance(albedo=np.full(3, 0.05), roughness=0.35)
    light = replace(bulb(position_mm=(0, 300, 300), radius_mm=30), colour=np.ones(3))
    eye = np.array([0.0, -0.7, 0.7])
    camera = replace(above(size=(8, 8), fov=1.0), position=eye, up=UP)
    got = card.render(look, rig=Rig(name="b", lights=(light,)), camera=camera, quality="T2")
    k = np.arange(4000)
    r, phi = light.size * np.sqrt((k + 0.5) / 4000), 2.399963 * k
    middle = light.vector / np.linalg.norm(light.vector)
    side = np.cross(UP, middle) / np.linalg.norm(np.cross(UP, middle))
    to = light.vector + np.outer(r * np.cos(phi), side)
    to += np.outer(r * np.sin(phi), np.cross(middle, side))
    l = to / np.linalg.norm(to, axis=1, keepdims=True)
    v = np.tile(eye / np.linalg.norm(eye), (4000, 1))
    one = brdf.evaluate(look, v, l)[:, 1] * l[:, 2] * light.intensity / (light.vector**2).sum()
    point = brdf.evaluate(look, v[0], middle)[1] * middle[2] * light.intensity / 0.18
    assert point > 1.1 * one.mean()
    assert got.radiance[4, 4, 1] == pytest.approx(one.mean(), rel=0.02)


def test_booth_lights():
    a, tl84 = (booth(illuminant=name) for name in ("A", "TL84"))
    assert a.colour[0] > tl84.colour[0] > 1 > tl84.colour[2] > a.colour[2]
    assert lux_at_seat(Rig(name="b", lights=(a,)))["booth"] == 1500
    with pytest.raises(InputError, match=r"booth.illuminant: got 'F2', expected one of D65, A"):
        booth(illuminant="F2")


def test_panorama_gives_the_light_of_the_same_even_sky():
    even = np.full((16, 32, 3), 200.0)
    assert irradiance_on(even, UP) == pytest.approx(200 * np.pi, rel=5e-3)
    assert solid_angles(16, 32).sum() * 32 == pytest.approx(4 * np.pi)
    rig = Rig(name="sky", lights=(), panorama=even)
    assert ev100(rig) == pytest.approx(ev100(Rig(name="sky", lights=(), ambient=200.0)), abs=0.01)
    assert white_of(rig) == pytest.approx(np.ones(3))


def test_shrinking_and_rough_levels_keep_the_light():
    sky = np.random.default_rng(0).random((90, 150, 3)) + 2 * (np.arange(90) < 30)[:, None, None]
    small = shrunk(sky)
    assert small.shape == (32, 64, 3)
    for picture in (small, levels_of(sky)[3]):
        total = (picture * solid_angles(32, 64)[..., None]).sum(axis=(0, 1))
        exact = (sky * solid_angles(90, 150)[..., None]).sum(axis=(0, 1))
        assert total == pytest.approx(exact, rel=0.02)
    assert np.ptp(levels_of(sky)[-1]) < 0.6 * np.ptp(levels_of(sky)[0])


def test_panorama_is_found_where_it_was_drawn():
    sky = np.zeros((32, 64, 3))
    sky[8, 20] = (1.0, 2.0, 3.0)
    levels = levels_of(sky)
    seen = panorama_towards(levels, 0.0, tuple(directions(32, 64)[8, 20]))
    assert seen == pytest.approx((1.0, 2.0, 3.0))


@pytest.mark.render
def test_card_under_a_panorama(card):
    """An even picture is the even sky; one bright in the east reflects there only."""
    even = Rig(name="even", lights=(), panorama=np.full((8, 16, 3), 500.0))
    look = Appearance(albedo=np.full(3, 0.2), roughness=0.5)
    camera = above(size=(8, 8), fov=5)
    flat_sky = card.render(look, rig=Rig(name="a", lights=(), ambient=500.0), camera=camera)
    assert card.render(look, rig=even, camera=camera).radiance == pytest.approx(
        flat_sky.radiance, rel=0.01
    )
    sky = np.zeros((16, 32, 3))
    sky[:8, 16:] = 1000.0  # azimuth above 180: -x
    east = Rig(name="east", lights=(), panorama=sky)
    mirror = Appearance(albedo=np.ones(3), metalness=1.0, roughness=0.1)
    views = [
        replace(above(size=(8, 8), fov=1.0), position=np.array([x, 0.0, 0.7])) for x in (0.7, -0.7)
    ]
    bright, dark = (card.render(mirror, rig=east, camera=v).radiance.mean() for v in views)
    assert bright > 900
    assert dark < 50


@pytest.mark.render
def test_window_in_a_dark_room_leaves_no_patches(card):
    """A source of 0.03 sr gives every point of a card the same, its irradiance over pi."""
    sky = np.full((32, 64, 3), 10.0)
    sky[8:11, 20:24] = 20_000.0
    rig = Rig(name="window", lights=(), panorama=sky)
    picture = card.render(GREY, rig=rig, camera=above(size=(40, 40), fov=6.0)).radiance[..., 1]
    expected = 0.5 * irradiance_on(sky, UP)[1] / np.pi
    assert picture.mean() == pytest.approx(expected, rel=0.02)
    assert picture.std() < 0.005 * picture.mean()


def test_bad_panoramas():
    with pytest.raises(InputError, match="one of them"):
        Rig(name="x", lights=(), ambient=1.0, panorama=np.ones((8, 16, 3)))
    with pytest.raises(InputError, match="none below 0"):
        Rig(name="x", lights=(), panorama=-np.ones((8, 16, 3)))


@pytest.mark.render
def test_holes_take_their_share_of_the_light_near_and_far(card):
    rig = Rig(name="s", lights=(replace(sun(elevation_deg=90, azimuth_deg=0), colour=np.ones(3)),))
    punched = replace(GREY, perforation_pitch=0.006, perforation_diameter=0.002)
    share = 1 - np.pi / 4 * 0.002**2 / (0.006**2 * np.sqrt(0.75))
    for size in ((200, 200), (6, 6)):
        camera = above(size=size, fov=5)
        whole, holes = (card.render(a, rig=rig, camera=camera).radiance for a in (GREY, punched))
        assert (holes / whole).mean() == pytest.approx(share, rel=0.02)
        if size[0] == 200:
            assert (holes / whole).min() < 0.05
    with pytest.raises(InputError, match="perforation_diameter"):
        replace(GREY, perforation_pitch=0.006, perforation_diameter=0.006)


@pytest.mark.render
def test_target_error_picks_the_cheapest_tier(card):
    errors = [tier.error for tier in TIERS.values()]
    assert errors == sorted(errors, reverse=True)
    assert quality_within(1.0) is TIERS["T0"]
    assert quality_within(min(errors)).error == min(errors)
    rig = Rig(name="b", lights=(bulb(position_mm=(0, 0, 400)),))
    named = card.render(GREY, rig=rig, camera=above(), quality="T0").radiance
    assert (card.render(GREY, rig=rig, camera=above(), target_error=1.0).radiance == named).all()
    with pytest.raises(InputError, match=r"target_error: got 0\.0, expected at least"):
        quality_within(0.0)
