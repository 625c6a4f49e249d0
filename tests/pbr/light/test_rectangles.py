"""Strips, rectangles and tunnels: their light, their highlights, their shadows, energy."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from seatlook.errors import InputError
from seatlook.model import (
    Appearance,
    Camera,
    Light,
    Rig,
    rectangle,
    strip,
    tunnel,
    two_sided_rectangle,
)
from seatlook.pbr import ev100, lux_at_seat
from seatlook.pbr.light.rig import illuminance, patched
from seatlook.pbr.quality import TIERS
from seatlook.pbr.reflectance import brdf
from seatlook.pbr.shading.studio import Studio
from support.reference.lit_sheets import above, flat, sheet
from support.reference.rectangle_points import direct

pytestmark = pytest.mark.render
PLAIN = replace(TIERS["T2"], bounces=0)
LEATHER = Appearance(albedo=np.full(3, 0.05), roughness=0.4, coat=0.3, coat_roughness=0.3)
LOOKS = {
    "leather": LEATHER,
    "polished": replace(LEATHER, coat=1.0, coat_roughness=0.12),
    "metal": Appearance(albedo=np.full(3, 0.8), roughness=0.3, metalness=1.0),
    "stretched": Appearance(albedo=np.full(3, 0.2), roughness=0.5, anisotropy=0.6),
    "nap": Appearance(albedo=np.full(3, 0.1), roughness=0.9, sheen=np.full(3, 0.4)),
}
STRIP = strip(position_mm=(100, 200, 600), along=(1.0, 0.3, 0.0))
PANEL = rectangle(position_mm=(-200, 300, 500), size_mm=(500, 400))


@pytest.fixture(scope="module")
def card():
    return Studio(sheet(flat, steps=8))


def oblique(size=(48, 32), fov=14.0):
    return Camera(
        name="oblique",
        position=np.array([0.0, -0.6, 0.5]),
        target=np.zeros(3),
        vertical_fov_deg=fov,
        size=size,
    )


def points_of(light, count):
    """Points (n, 3) of a rectangle and their area each."""
    a, b = light.sides
    x, y = ((2 * np.arange(n) + 1) / n - 1 for n in count)
    each = 4 * np.linalg.norm(a) * np.linalg.norm(b) / (count[0] * count[1])
    return (light.vector + x[:, None, None] * a + y[:, None] * b).reshape(-1, 3), each


def integral(look, light, camera, p, count=(600, 60)):
    """Radiance (3,) of a card at ``p`` by the array BRDF over very many points of a rectangle."""
    q, area = points_of(light, count)
    d = q - p
    far = np.linalg.norm(d, axis=1)
    l = d / far[:, None]
    m = np.cross(*light.sides)
    ahead = np.maximum(0.0, -(l @ m) / np.linalg.norm(m))
    v = camera.position - p
    v = np.broadcast_to(v / np.linalg.norm(v), l.shape)
    up = l[:, 2] > 1e-6
    luminance = light.intensity / (4 * np.prod(np.linalg.norm(light.sides, axis=1)))
    weight = luminance * area * (ahead * l[:, 2] / far**2)[up]
    return light.colour * (brdf.evaluate(look, v[up], l[up]) * weight[:, None]).sum(axis=0)


@pytest.mark.parametrize("light", [STRIP, PANEL], ids=["strip", "panel"])
@pytest.mark.parametrize("name", LOOKS)
def test_a_card_is_lit_like_by_very_many_points(card, light, name):
    """The array BRDF over 36,000 points, at places all over the picture."""
    look, camera = LOOKS[name], oblique()
    rig = Rig(name="one", lights=(light,), ev100=8.0)
    got = card.render(look, rig=rig, camera=camera, quality=PLAIN).radiance
    places = np.array([[x, y, 0.0] for x in (-0.06, 0.0, 0.05) for y in (-0.05, 0.0, 0.06)])
    pixels, _ = camera.pixels(places)
    truth = []
    for x, y in np.floor(pixels) + 0.5:
        # Back to the card through the middle of the pixel.
        near = places[np.argmin(np.linalg.norm(pixels - [x, y], axis=1))]
        for _ in range(3):
            (at,), _ = camera.pixels(near[None])
            step = np.array(
                [(camera.pixels((near + e)[None])[0][0] - at) / 1e-5 for e in 1e-5 * np.eye(3)[:2]]
            )
            near = near + np.append(np.linalg.solve(step.T, [x, y] - at), 0.0)
        truth.append(integral(look, light, camera, near))
    x, y = np.floor(pixels).astype(int).T
    error = np.abs(got[y, x] - truth) / np.max(truth)
    assert error.max() < 0.03
    assert error.mean() < 0.012


def test_a_long_lamp_leaves_one_highlight_on_gloss(card):
    """Along the mirror image of a strip the light neither rises nor falls in steps."""
    look = Appearance(albedo=np.zeros(3), roughness=0.12)
    light = strip(position_mm=(0, 500, 450), size_mm=(1500, 60))
    rig = Rig(name="s", lights=(light,), ev100=8.0)
    got = card.render(look, rig=rig, camera=oblique((160, 90), 8.0), quality=PLAIN).radiance
    line = got[np.argmax(got[:, 80, 1]), :, 1].astype(float)
    assert line.min() > 0.6 * line.max()
    bend = np.abs(np.diff(line, 2)) / line.max()
    assert bend.max() < 0.01


@pytest.mark.parametrize("side", [0.4, 4.0])
def test_white_things_in_a_lit_box_give_back_what_they_get(card, side):
    """Six rectangles around the card, all of one luminance: a white furnace by lamps."""
    walls = []
    for axis in np.vstack([np.eye(3), -np.eye(3)]):
        beside = np.roll(axis, 1)
        walls.append(
            rectangle(
                lumen=np.pi * side**2, position_mm=tuple(500 * side * axis), target_mm=(0, 0, 0),
                along=tuple(beside), size_mm=(1000 * side, 1000 * side), name=str(axis),
            )
        )  # fmt: skip
    lights = tuple(replace(wall, colour=np.ones(3)) for wall in walls)
    rig = Rig(name="box", lights=lights, ev100=1.0)
    for look in (
        Appearance(albedo=np.ones(3), roughness=0.9, f0=0.0),
        Appearance(albedo=np.ones(3), roughness=0.4, f0=0.04, coat=1.0, coat_roughness=0.3),
        Appearance(albedo=np.ones(3), roughness=0.5, metalness=1.0),
    ):
        camera = above(distance=0.19, size=(8, 6), fov=8.0)
        got = card.render(look, rig=rig, camera=camera, quality=PLAIN).radiance
        assert got.min() >= 0.98
        assert got.max() <= 1.01


def test_lumens_go_where_they_should():
    """Through a sphere around it goes the flux of a lamp, forward or to both sides."""
    y, phi = np.meshgrid(2 * (np.arange(40) + 0.5) / 40 - 1, 2 * np.pi * np.arange(40) / 40)
    level = np.sqrt(1 - y**2)
    ways = np.stack([level * np.cos(phi), level * np.sin(phi), y], -1).reshape(-1, 3)
    for both in (False, True):
        make = two_sided_rectangle if both else strip
        light = make(lumen=1000, position_mm=(0, 0, 0), target_mm=(0, 0, -500), size_mm=(900, 90))
        lux = np.array([illuminance(light, 20 * way, -way) for way in ways])
        assert 4 * np.pi * 20**2 * lux.mean() == pytest.approx(1000, rel=0.01)
        assert (lux[ways[:, 2] > 0.05] > 0).all() == both


def test_lux_and_exposure_of_a_strip():
    """Twice as many lumens are one stop; four patches of it are as bright as the whole."""
    one, two = (
        Rig(name="s", lights=(strip(lumen=n, position_mm=(0, 0, 900)),)) for n in (1000, 2000)
    )
    assert ev100(two) - ev100(one) == pytest.approx(1.0)
    assert lux_at_seat(patched(one))["total"] == pytest.approx(lux_at_seat(one)["total"], rel=1e-5)
    assert lux_at_seat(Rig(name="t", lights=tunnel()))["total"] > 0
    twins = Rig(name="two", lights=one.lights * 2)
    assert lux_at_seat(twins)["total"] == pytest.approx(2 * lux_at_seat(one)["total"])


def test_a_relief_that_is_flat_reflects_like_none(card):
    """Samples of a relief take another way through the same integral; black, without strokes."""
    camera, black = oblique(fov=8.0), replace(LEATHER, albedo=np.zeros(3))
    flat_grain = replace(black, texture="leather", texture_scale=1e-3, texture_depth=1e-9)
    for light in (STRIP, PANEL):
        rig = Rig(name="one", lights=(light,), ev100=8.0)
        plain, grain = (
            card.render(look, rig=rig, camera=camera, quality=PLAIN).radiance
            for look in (black, flat_grain)
        )
        assert np.abs(grain - plain).max() / plain.max() < 0.03


def test_shadows_of_a_strip_in_a_trench():
    """Radiance beside a wall and in a trench, against a ray to each of 1,024 points per pixel."""

    def height(x, y):
        return 0.03 * (np.abs(x + 0.04) < 0.01) - 0.03 * np.exp(-((x - 0.03) ** 2) / 0.008**2)

    studio = Studio(sheet(height, steps=120, size=0.2, element_size=0.0017))
    rig = Rig(
        name="s", lights=(strip(position_mm=(350, 0, 500), along=(0.3, 1.0, 0.0)),), ev100=8.0
    )
    camera = oblique((96, 64), 18.0)
    truth = direct(studio, LEATHER, rig=rig, camera=camera, factor=4, points=(16, 4))
    # As many samples as the truth: where the wall ends is not what is compared.
    fine = replace(TIERS["T4"], strata=0, bounces=0)
    image = studio.render(LEATHER, rig=rig, camera=camera, quality=fine)
    whole = image.cover == 1
    error = np.abs(image.radiance - truth)[whole][:, 1]
    assert error.mean() < 0.012 * truth[whole].mean()
    assert np.percentile(error, 99) < 0.1 * truth[whole].mean()
    open_ = studio.render(LEATHER, rig=rig, camera=camera, quality=replace(fine, rays=0))
    assert np.abs(open_.radiance - truth)[whole].mean() > 5 * error.mean()  # there are shadows


def test_behind_a_lamp_it_is_dark(card):
    away = strip(position_mm=(0, 0, 500), target_mm=(0, 0, 900))
    got = [
        card.render(
            LEATHER,
            rig=Rig(name="s", lights=(light,), ev100=5.0, ambient=1e-6),
            camera=above(fov=6.0),
        ).radiance.max()
        for light in (away, replace(away, two_sided=True))
    ]
    assert got[0] < 1e-5 < 1 < got[1]


@pytest.mark.parametrize(
    ("values", "key"),
    [
        ({"target_mm": (0, 0, 900)}, "target_mm"),
        ({"along": (0, 0, 1)}, "along"),
        ({"along": (0, 0, 0)}, "along"),
        ({"size_mm": (0, 5)}, "size_mm"),
        ({"size_mm": (9, float("nan"))}, "size_mm"),
        ({"size_mm": (9, -5)}, "size_mm"),
        ({"lumen": 0}, "intensity"),
        ({"temperature_k": 900}, "temperature_k"),
    ],
)
def test_lamps_that_cannot_be(values, key):
    with pytest.raises(InputError, match=key):
        strip(**{"position_mm": (0, 0, 900), **values})


def test_sides_of_a_light_that_is_no_rectangle():
    for sides in (np.eye(3)[:2] * [[1], [2]], [[1, 0, 0], [1, 1, 0]], [[1, 0, 0], [0, 0, 0]]):
        with pytest.raises(InputError, match="sides"):
            Light(name="x", intensity=1, vector=np.zeros(3), near=True, sides=np.array(sides))
    with pytest.raises(InputError, match="sides"):
        Light(name="x", intensity=1, vector=np.ones(3), near=False, sides=np.eye(3)[:2])
