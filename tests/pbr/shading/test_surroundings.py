"""What is around a seat in its picture: light from below, shadow, backdrop."""

from __future__ import annotations

import io
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image as Pillow

from seatlook.errors import InputError, RenderError
from seatlook.io.material import read_material
from seatlook.model import Appearance, Camera, Rig, bulb, sun
from seatlook.pbr.light.rig import LUMINANCE
from seatlook.pbr.shading.studio import Studio, studio
from support.reference.lit_sheets import GREY, above, sheet

pytestmark = pytest.mark.render
SKY = Rig(name="sky", lights=(), ambient=1000.0)
HIGH = Rig(name="high", lights=(sun(elevation_deg=70, azimuth_deg=180),), ambient=4000.0)


def box(x, y):
    """A block of 200 x 200 x 100 mm with walls that end 20 mm above nothing."""
    outside = np.maximum(np.abs(x), np.abs(y)) - 0.1
    return 0.1 - 0.08 * np.clip(outside / 0.01, 0.0, 1.0)


def looking(elevation, *, size=(96, 54), fov=20.0, distance=1.2):
    """Camera in front (x > 0) of the block."""
    e = np.radians(elevation)
    return Camera(
        name="front",
        position=np.array([distance * np.cos(e), 0.0, 0.05 + distance * np.sin(e)]),
        target=np.array([0.0, 0.0, 0.05]),
        vertical_fov_deg=fov,
        size=size,
    )


@pytest.fixture(scope="module")
def solution():
    # Not refined: nothing here asks for round shapes.
    return sheet(box, size=0.22, steps=44, element_size=0.0012)


@pytest.fixture(scope="module")
def swept(solution):
    return Studio(solution, surroundings="sweep")


def places(studio, camera):
    """Cosine up of the cover's face at each pixel, nan elsewhere; whether it is the floor."""
    ids, surface = studio.faces(camera, 1), studio.surface
    x = surface.mesh.vertices[surface.mesh.faces]
    n = np.cross(x[:, 1] - x[:, 0], x[:, 2] - x[:, 0])
    up = (n[:, 2] / np.linalg.norm(n, axis=1))[ids]
    floor = (ids >= surface.faces) & (ids < surface.faces + surface.ground.floor)
    return np.where((ids >= 0) & (ids < surface.faces), up, np.nan), floor


def horizon(studio, camera, image):
    """Luminance beyond the floor, and of the floor's last pixels before that, beside the seat."""
    seen, beyond = image.radiance @ LUMINANCE, studio.faces(camera, 1) < 0
    _, floor = places(studio, camera)
    last = beyond[:-1] & floor[1:]
    last[:, 30:-30] = False
    assert last.any()
    return seen[beyond], seen[1:][last]


def test_plain_is_what_it_was(solution):
    camera = looking(30)
    plain = Studio(solution, surroundings="plain").render(GREY, rig=HIGH, camera=camera)
    bare = Studio(solution).render(GREY, rig=HIGH, camera=camera)
    np.testing.assert_array_equal(plain.radiance, bare.radiance)
    assert b"surroundings" not in plain.to_png()


@pytest.mark.parametrize("name", ["black-leather", "bright-leather"])
def test_a_front_in_its_own_shadow_is_lit_from_below(swept, solution, name):
    """The bars: front over top at least .25 with the sun behind at 70 degrees, no light lost."""
    camera, look = looking(30), read_material(name).appearance
    image = swept.render(look, rig=HIGH, camera=camera)
    up, floor = places(swept, camera)
    seen = image.radiance @ LUMINANCE
    ratio = seen[np.abs(up) < 0.3].mean() / seen[up > 0.95].mean()
    bare = Studio(solution).render(look, rig=HIGH, camera=camera).radiance @ LUMINANCE
    assert ratio >= 0.25
    assert ratio > 1.3 * bare[np.abs(up) < 0.3].mean() / bare[up > 0.95].mean()
    assert seen[floor].min() <= 0.3 * np.median(seen[floor])
    assert (image.to_srgb() == 255).any(axis=2).mean() <= 0.01


@pytest.mark.parametrize("rig", [SKY, HIGH])
def test_the_open_floor_sends_what_a_grey_card_does_and_goes_on_behind(swept, rig):
    camera = looking(3, fov=40)
    image = swept.render(GREY, rig=rig, camera=camera)
    lux = sum(light.intensity * light.vector[2] for light in rig.lights) + np.pi * rig.ambient
    beyond, edge = horizon(swept, camera, image)
    np.testing.assert_allclose(beyond, 0.4 * lux / np.pi, rtol=0.01)
    np.testing.assert_allclose(edge, beyond.mean(), rtol=0.02)


def test_a_cabin_is_darker(solution, swept):
    camera = looking(30)
    dark = Studio(solution, surroundings="cabin").render(GREY, rig=HIGH, camera=camera)
    bright = swept.render(GREY, rig=HIGH, camera=camera)
    np.testing.assert_allclose(dark.radiance[0] / bright.radiance[0], 0.25, rtol=0.02)


def test_a_white_seat_in_a_furnace_gains_nothing(swept):
    image = swept.render(
        Appearance(albedo=np.ones(3), f0=0.0), rig=SKY, camera=looking(30), quality="high"
    )
    assert image.radiance.max() <= 1.005 * 1000.0


def test_transparent_shows_the_seat_alone_in_the_same_light(solution, swept):
    camera = looking(30)
    clear = Studio(solution, surroundings="transparent").render(GREY, rig=HIGH, camera=camera)
    up, _ = places(swept, camera)
    inner = (up > 0.95) & (clear.alpha == 1.0)
    swept_too = swept.render(GREY, rig=HIGH, camera=camera)
    np.testing.assert_allclose(clear.radiance[inner], swept_too.radiance[inner], rtol=1e-6)
    with Pillow.open(io.BytesIO(clear.to_png())) as file:
        assert file.mode == "RGBA"
        assert file.text["seatlook surroundings"] == "transparent"
        alpha = np.asarray(file)[..., 3]
    assert alpha[0, 0] == 0
    assert alpha[inner].min() == 255
    assert ((alpha > 0) & (alpha < 255)).any()
    # An outline has the colour of what it belongs to, not of a black backdrop.
    code = clear.to_srgb()[..., 1].astype(int)
    rim = (alpha[:-1] > 60) & (alpha[:-1] < 150) & inner[1:]
    assert rim.sum() > 5
    assert (code[:-1][rim] > 0.8 * code[1:][rim]).all()


def test_the_share_of_the_cover_knows_no_floor(solution, swept):
    camera = looking(30)
    with_floor = swept.render(GREY, rig=SKY, camera=camera).cover
    assert with_floor[0].max() == 0.0
    assert with_floor.max() == 1.0
    bare = Studio(solution).render(GREY, rig=SKY, camera=camera).cover
    assert 0.8 * bare.sum() < with_floor.sum() <= bare.sum()


def test_another_shape_of_the_cover_stands_on_the_same_floor(solution, swept):
    """Taken from the studio of the first shape, the same shape is the same picture."""
    again = Studio(replace(solution), like=swept, surroundings="sweep")
    camera = looking(30)
    np.testing.assert_allclose(
        again.render(GREY, rig=HIGH, camera=camera).radiance,
        swept.render(GREY, rig=HIGH, camera=camera).radiance,
        rtol=1e-3,
    )
    with pytest.raises(InputError, match="surroundings: got plain, expected those of like"):
        Studio(replace(solution), like=swept)


def test_studios_of_other_surroundings_are_others(solution):
    assert studio(solution, "cabin") is studio(solution, "cabin")
    assert studio(solution, "cabin") is not studio(solution)


def test_a_lamp_near_by_lights_floor_and_seat_without_an_edge_at_the_horizon(swept):
    rig = Rig(name="lamp", lights=(bulb(position_mm=(500, -300, 700)),), ambient=1.0)
    camera = looking(3, fov=40)
    image = swept.render(GREY, rig=rig, camera=camera)
    beyond, edge = horizon(swept, camera, image)
    np.testing.assert_allclose(edge, beyond.mean(), rtol=0.1)


def test_a_seat_out_of_the_picture_is_told(swept):
    away = replace(above(size=(8, 8), fov=4.0), target=np.array([5.0, 0.0, 0.0]))
    with pytest.raises(RenderError, match="nothing is in the picture"):
        swept.render(GREY, rig=SKY, camera=away)


def test_unknown_surroundings_are_named(solution):
    with pytest.raises(InputError, match=r"surroundings: got 'sweeep'.*sweep"):
        Studio(solution, surroundings="sweeep")
