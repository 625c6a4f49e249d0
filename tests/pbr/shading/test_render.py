"""Whole pictures: radiometry by hand, shadows, energy, repeatability, bad input."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from PIL import Image as Pillow

from seatlook.errors import InputError, RenderError
from seatlook.model import Appearance, Camera, Light, Rig, bulb, named_view, sun
from seatlook.pbr import Image, render
from seatlook.pbr.shading.studio import Studio
from support.reference.lit_sheets import GREY, above, flat, sheet

pytestmark = pytest.mark.render
OVERHEAD = Rig(
    name="noon", lights=(replace(sun(elevation_deg=90, azimuth_deg=0), colour=np.ones(3)),)
)


def white_bulb(**where):
    return replace(bulb(**where), colour=np.ones(3))


@pytest.fixture(scope="module")
def card():
    return Studio(sheet(flat, steps=8))


def middle(image):
    h, w, _ = image.radiance.shape
    return image.radiance[h // 2 - 1 : h // 2 + 1, w // 2 - 1 : w // 2 + 1].mean(axis=(0, 1))


def test_facing_lambert_card_is_e_over_pi(card):
    image = card.render(GREY, rig=OVERHEAD, camera=above(fov=5))
    assert image.radiance == pytest.approx(0.5 * 97_000 / np.pi, rel=1e-3)
    assert image.radiance.dtype == np.float32
    assert image.cover.min() == 1.0


def test_tilted_sun_follows_the_cosine(card):
    rig = Rig(
        name="low",
        lights=(replace(OVERHEAD.lights[0], vector=sun(elevation_deg=30, azimuth_deg=77).vector),),
    )
    image = card.render(GREY, rig=rig, camera=above(fov=5))
    assert image.radiance == pytest.approx(0.5 * 97_000 * 0.5 / np.pi, rel=1e-3)


def test_inverse_square_and_linear_in_power(card):
    def seen(lumen, height_mm):
        rig = Rig(
            name="b", lights=(white_bulb(lumen=lumen, position_mm=(0, 0, height_mm)),), ev100=5.0
        )
        return middle(card.render(GREY, rig=rig, camera=above(size=(65, 49), fov=5)))[0]

    assert seen(800, 500) == pytest.approx(0.5 * 800 / (4 * np.pi) / 0.25 / np.pi, rel=1e-3)
    assert seen(800, 500) / seen(800, 1000) == pytest.approx(4, rel=1e-3)
    assert seen(2400, 500) / seen(800, 500) == pytest.approx(3, rel=1e-3)


@pytest.mark.parametrize(
    "appearance",
    [
        Appearance(albedo=np.ones(3), roughness=0.4),
        Appearance(albedo=np.ones(3), metalness=1.0, roughness=0.6),
        Appearance(albedo=np.ones(3), roughness=0.9, sheen=np.ones(3)),
        Appearance(albedo=np.ones(3), roughness=0.5, coat=1.0),
    ],
    ids=["dielectric", "metal", "sheen", "coat"],
)
def test_white_dome_under_a_constant_sky_vanishes(appearance):
    """A convex white body in a white furnace looks like the furnace, to the loss allowed."""
    dome = sheet(lambda x, y: -4 * (x**2 + y**2), steps=20)
    rig = Rig(name="sky", lights=(), ambient=1000.0)
    image = render(dome, appearance, rig=rig, camera=above(size=(48, 48), fov=16))
    inside = image.radiance[image.cover == 1.0] / 1000
    assert inside.max() <= 1.005
    assert inside.min() >= 0.95


def test_a_wall_throws_its_shadow_where_geometry_says():
    """A step of 20 mm, its edge at x = -2 mm, lit at 45 degrees darkens the floor to 18 mm."""

    def step(x, y):
        return np.where(x < 0, 0.02, 0.0)

    solution = sheet(step, steps=100, size=0.2, element_size=0.001)
    rig = Rig(
        name="low", lights=(replace(sun(elevation_deg=45, azimuth_deg=270), colour=np.ones(3)),)
    )
    image = render(solution, GREY, rig=rig, camera=above(size=(200, 20), fov=1.1))
    profile = image.radiance[10, :, 0]
    x = (np.arange(200) + 0.5 - 100) / 200 * 2 * np.tan(np.radians(1.1) / 2) * 10
    lit = 0.5 * 97_000 * np.sqrt(0.5) / np.pi
    assert profile[(x > 0.002) & (x < 0.0175)].max() < 0.2 * lit
    assert profile[(x > 0.0185)].min() > 0.99 * lit


def test_a_large_bulb_softens_the_same_edge():
    def step(x, y):
        return np.where(x < 0, 0.02, 0.0)

    studio = Studio(sheet(step, steps=100, element_size=0.001))
    camera = above(size=(200, 20), fov=1.1)

    def width(radius):
        light = white_bulb(position_mm=(-500, 0, 500), radius_mm=radius)
        rig = Rig(name="bulb", lights=(light,), ev100=6.0)
        profile = studio.render(GREY, rig=rig, camera=camera).radiance[:, :, 0].mean(axis=0)
        share = profile[110:] / profile[-1]
        return int(((share > 0.3) & (share < 0.9)).sum())

    assert width(60) > 2 * max(1, width(5))


def test_valley_gets_bounced_light_and_keeps_the_energy_bound():
    """The bounce brightens a trench that the sun does not reach, by less than the light it got."""
    valley = sheet(lambda x, y: 0.02 * np.cos(63 * x), steps=60, element_size=0.0011)
    rig = Rig(
        name="side", lights=(replace(sun(elevation_deg=35, azimuth_deg=90), colour=np.ones(3)),)
    )
    camera = above(size=(120, 20), fov=3)
    white = Appearance(albedo=np.full(3, 0.8), f0=0.0)
    hard = render(valley, white, rig=rig, camera=camera, quality="draft").radiance
    full = render(valley, white, rig=rig, camera=camera).radiance
    dark = hard[..., 0] == 0
    assert dark.mean() > 0.1
    assert full[dark].min() > 0
    assert full.max() < 97_000 / np.pi


def test_materials_per_panel_and_by_name():
    solution = sheet(flat, panels=2, steps=8)
    dark, bright = (Appearance(albedo=np.full(3, a), f0=0.0) for a in (0.1, 0.8))
    camera = above(fov=5)
    image = render(solution, {"panel1": dark}, rig=OVERHEAD, camera=camera)
    assert image.radiance[:, -4:].mean() / image.radiance[:, :4].mean() == pytest.approx(0.2, 1e-3)
    image = render(solution, bright, rig=OVERHEAD, camera=camera)
    assert image.radiance == pytest.approx(0.8 * 97_000 / np.pi, rel=1e-3)
    with pytest.raises(InputError, match=r"panel 'panel3', expected one of .*did you mean"):
        render(solution, {"panel3": dark}, rig=OVERHEAD, camera=camera)


def test_exposure_does_not_depend_on_what_is_drawn(card):
    other = Studio(sheet(lambda x, y: 0.03 * np.cos(30 * x), steps=8))
    images = [
        studio.render(a, rig=OVERHEAD, camera=camera)
        for studio in (card, other)
        for a in (GREY, Appearance(albedo=np.full(3, 0.02), roughness=0.4))
        for camera in (above(), named_view("front_34", target=np.zeros(3), size=(32, 18)))
    ]
    assert len({image.ev100 for image in images}) == 1


def test_a_shape_drawn_from_the_studio_of_another_has_its_own_bytes():
    flat_one = sheet(flat, steps=20, panels=2)
    bent = sheet(lambda x, y: 0.004 * np.sin(60 * x), steps=20, panels=2)
    moved = replace(flat_one, positions=bent.positions)
    shared = Studio(moved, like=Studio(flat_one))
    options = {"rig": OVERHEAD, "camera": above(size=(96, 96)), "quality": "standard"}
    own = Studio(moved).render(GREY, **options)
    assert np.array_equal(shared.render(GREY, **options).radiance, own.radiance)
    assert shared.surface.mesh.uv is shared._like.surface.mesh.uv


def test_no_studio_of_another_cover_is_shared():
    with pytest.raises(InputError, match="the same in another shape"):
        Studio(sheet(flat, steps=8), like=Studio(sheet(flat, steps=8)))


def test_same_bytes_twice_and_from_a_new_studio():
    solution = sheet(lambda x, y: 0.01 * np.sin(60 * x), steps=20)
    look = Appearance(albedo=np.full(3, 0.3), texture="leather", texture_depth=1e-4)
    rig = Rig(
        name="r",
        lights=(sun(elevation_deg=40, azimuth_deg=30), bulb(position_mm=(100, 0, 300))),
        ambient=50.0,
    )
    camera = named_view("front_34", target=np.zeros(3), size=(64, 36), distance=0.3)
    first = render(solution, look, rig=rig, camera=camera).to_png()
    assert render(solution, look, rig=rig, camera=camera).to_png() == first
    assert Studio(solution).render(look, rig=rig, camera=camera).to_png() == first


@pytest.mark.parametrize("size", [(1, 1), (3, 40), (50, 2)])
def test_tiny_and_narrow_pictures(card, size):
    image = card.render(GREY, rig=OVERHEAD, camera=above(size=size, fov=5))
    assert image.radiance.shape == (size[1], size[0], 3)
    assert middle(image)[0] > 0


def test_roughness_widens_the_highlight_and_metalness_fills_it():
    """A dome under one sun: width of the highlight, and its share of the reflected light."""
    dome = Studio(
        sheet(lambda x, y: np.sqrt(0.15**2 - x**2 - y**2) - 0.15, steps=40, element_size=0.0011)
    )
    camera = above(size=(96, 96), fov=11)

    def measure(roughness, metalness):
        look = Appearance(albedo=np.full(3, 0.6), roughness=roughness, metalness=metalness)
        image = dome.render(look, rig=OVERHEAD, camera=camera)
        y = np.where(image.cover == 1.0, image.radiance[..., 1], 0.0)
        peak = y > 0.5 * y.max()
        return peak.sum(), y[36:60, 36:60].sum() / y.sum()

    widths = [measure(r, 1.0)[0] for r in (0.2, 0.35, 0.5, 0.8)]
    assert widths == sorted(widths)
    assert widths[-1] > 4 * widths[0]
    shares = [measure(0.35, m)[1] for m in (0.0, 0.5, 1.0)]
    assert shares == sorted(shares)
    assert shares[-1] > 2 * shares[0]


def test_nothing_in_the_picture_is_an_error(card):
    away = Camera(
        name="away",
        position=np.array([0.0, 0.0, 1.0]),
        target=np.array([0.0, 0.0, 2.0]),
        up=np.array([0.0, 1.0, 0.0]),
        size=(8, 8),
    )
    with pytest.raises(RenderError, match="camera away: nothing is in the picture"):
        card.render(GREY, rig=OVERHEAD, camera=away)


def test_lit_and_black_is_an_error(card):
    black = Appearance(albedo=np.zeros(3), f0=0.0)
    with pytest.raises(RenderError, match="black though a light reaches it"):
        card.render(black, rig=OVERHEAD, camera=above(size=(8, 8), fov=5))


def test_dark_because_the_light_is_behind_is_no_error(card):
    behind = Light(name="floor", intensity=1e4, vector=np.array([0.0, 0.0, -1.0]), near=False)
    image = card.render(GREY, rig=Rig(name="b", lights=(behind,), ev100=10.0), camera=above(fov=5))
    assert image.radiance.max() == 0


def test_shading_of_another_cover_is_refused():
    """Its normals would be read beyond their end."""
    with pytest.raises(InputError, match="another shape of the same cover"):
        Studio(sheet(flat, steps=8), shading=sheet(flat, steps=4))
    bent = sheet(lambda x, y: 0.1 * x**2, steps=8)
    shaded = Studio(sheet(flat, steps=8), shading=bent).surface.mesh.normals
    assert (shaded == Studio(bent).surface.mesh.normals).all()


def test_unknown_quality(card):
    with pytest.raises(InputError, match=r"quality: got 'hihg', .*did you mean 'high'"):
        card.render(GREY, rig=OVERHEAD, camera=above(), quality="hihg")


def test_saving_a_picture(card, tmp_path):
    image = card.render(GREY, rig=OVERHEAD, camera=above(size=(8, 6)))
    image.save(tmp_path / "a.png")
    image.save(tmp_path / "a.npy")
    assert (tmp_path / "a.png").read_bytes() == image.to_png() == image._repr_png_()
    with Pillow.open(tmp_path / "a.png") as picture:
        assert picture.info["srgb"] == 0
    assert (np.load(tmp_path / "a.npy") == image.radiance).all()
    with pytest.raises(
        InputError, match=r"image file: got a\.jpg, expected a \.png, \.npy or \.exr"
    ):
        image.save(tmp_path / "a.jpg")
    assert isinstance(image, Image)
