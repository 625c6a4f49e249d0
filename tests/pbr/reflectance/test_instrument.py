"""What instruments measure on materials, on their pictures, and what was typed."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from seatlook.errors import InputError
from seatlook.io.material import list_materials, read_material
from seatlook.model import Appearance, Camera, Rig, booth, direction, sun
from seatlook.model.colour import delta_e_2000, lab_from_linear, linear_from_lab, srgb_decode
from seatlook.pbr.light.rig import white_card
from seatlook.pbr.quality import TIERS
from seatlook.pbr.reflectance.instrument import (
    GEOMETRIES,
    appearance_of,
    gloss,
    lab,
    measuring,
    reflectance,
    resolved,
)
from seatlook.pbr.shading.studio import Studio
from support.reference.furnace import reflected
from support.reference.lit_sheets import above, flat, sheet

QUICK = replace(TIERS["T2"], rays=0)
# Lightness, a, b: all in the gamut of sRGB, and within what a coated leather can show.
COLOURS = [
    (20, 0, 0), (35, 0, 0), (50, 0, 0), (65, 0, 0), (80, 0, 0), (90, 0, 0),
    (25, 20, 10), (30, -15, 5), (30, 10, -25), (40, 40, 20), (40, -25, 15), (40, 15, -40),
    (50, 40, 25), (50, -35, 30), (50, 20, -45), (60, 30, 50), (60, -40, 35), (60, 10, -30),
    (70, 20, 60), (70, -30, 20), (70, 0, -25), (80, 5, 60), (85, -20, 10), (45, 60, 30),
]  # fmt: skip
LOOKS = {
    "leather": Appearance(albedo=np.ones(3), roughness=0.45, coat=0.3, coat_roughness=0.3),
    "nap": Appearance(albedo=np.ones(3), roughness=0.9, f0=0.02, sheen=np.full(3, 0.05)),
}


@pytest.fixture(scope="module")
def card():
    return Studio(sheet(flat, steps=8))


def shown(card, look, *, rig, elevation=45.0, size=(8, 6)):
    """Picture of the card, lying, reviewed: a white card is white."""
    camera = Camera(
        name="c", position=0.6 * direction(90.0, elevation), target=np.zeros(3),
        up=np.array([0.0, 1.0, 0.0]), vertical_fov_deg=4.0, size=size,
    )  # fmt: skip
    return replace(card.render(look, rig=rig, camera=camera, quality=QUICK), review=True)


def read_off(image):
    """L*a*b* of the mean of what the picture shows."""
    return lab_from_linear(srgb_decode(image.to_srgb() / 255).mean(axis=(0, 1)))


OVERHEAD = Rig(
    name="booth", lights=(booth(illuminant="D65", elevation_deg=90, angular_diameter_deg=2.0),)
)


@pytest.mark.render
@pytest.mark.parametrize("name", LOOKS)
def test_a_facing_card_shows_the_lab_that_was_typed(card, name):
    """Lit from above and seen from 45 degrees: by reciprocity what 45/0 measures."""
    worst = 0.0
    for colour in COLOURS:
        wanted = np.array(colour, dtype=float)
        look = replace(LOOKS[name], albedo=linear_from_lab(wanted).clip(0, 1), measured="45/0")
        got = read_off(shown(card, look, rig=OVERHEAD))
        worst = max(worst, float(delta_e_2000(got, wanted)))
    assert worst <= 1.0


@pytest.mark.render
@pytest.mark.parametrize("name", list_materials())
def test_pictures_of_presets_measure_what_is_printed(card, name):
    """The mean over a card with its relief, strokes and threads, against the instrument."""
    look = read_material(name).appearance
    light = sun(elevation_deg=45.0, azimuth_deg=30.0, angular_diameter_deg=0.5)
    rig = Rig(name="s", lights=(replace(light, colour=np.ones(3)),))
    image = card.render(look, rig=rig, camera=above(fov=9.0, size=(200, 150)), quality=TIERS["T2"])
    seen = image.radiance.astype(float).mean(axis=(0, 1)) * np.pi
    seen /= light.intensity * np.sin(np.pi / 4)
    assert delta_e_2000(lab_from_linear(seen), lab(look, "45/0")) <= 1.0


@pytest.mark.parametrize("geometry", GEOMETRIES)
def test_the_material_measures_what_was_typed_by_any_geometry(geometry):
    wanted = linear_from_lab(np.array([45.0, 25.0, 15.0]))
    for look in (
        *LOOKS.values(),
        replace(read_material("black-leather").appearance, albedo=np.ones(3)),
        Appearance(albedo=np.ones(3), metalness=0.5, roughness=0.5),
    ):
        if geometry != "d/8 SCI" and look.metalness:
            continue
        solved = measuring(look, wanted, geometry)
        assert delta_e_2000(lab(solved, geometry), lab_from_linear(wanted)) < 0.05


def test_a_colour_that_the_surface_cannot_have():
    """Coat and lobe alone reflect 7 %: nothing darker is measured with the specular included."""
    shiny = Appearance(albedo=np.zeros(3), coat=1.0, coat_roughness=0.1)
    with pytest.raises(InputError, match=r"albedo.*L\* 20.0, expected what this surface can show"):
        measuring(shiny, linear_from_lab(np.array([20.0, 0, 0])), "d/8 SCI")
    measuring(shiny, linear_from_lab(np.array([20.0, 0, 0])), "45/0")
    with pytest.raises(InputError, match="geometry"):
        reflectance(shiny, "0/45")


def test_sphere_with_the_specular_included_is_the_furnace():
    look = Appearance(
        albedo=np.array([0.1, 0.2, 0.3]), roughness=0.35, coat=0.6, coat_roughness=0.2
    )
    theta = np.radians(8.0)
    v = np.array([np.sin(theta), 0.0, np.cos(theta)])
    whole = reflectance(look, "d/8 SCI")
    np.testing.assert_allclose(whole, reflected(look, v), rtol=3e-3)
    without = reflectance(look, "d/8 SCE")
    assert (without < whole - 0.003).all()
    assert (without > reflectance(look, "45/0") - 0.02).all()


@pytest.mark.parametrize(
    ("angle", "high", "wide", "glass_reflects"), [(20, 1.8, 3.6, 0.0491), (60, 4.4, 11.7, 0.1001)]
)
def test_gloss_is_the_share_of_mirrored_rays_that_meet_the_aperture(
    angle, high, wide, glass_reflects
):
    """Half-vectors of a polished lobe by chance, mirrored and counted; Schlick over Fresnel."""
    f0, alpha, theta = (0.567 / 2.567) ** 2, 0.1**2, np.radians(angle)
    glass = Appearance(albedo=np.zeros(3), f0=f0, roughness=0.1)
    rng = np.random.default_rng(3)
    u, phi = rng.uniform(size=400_000), rng.uniform(0, 2 * np.pi, size=400_000)
    slope = alpha * np.sqrt(u / (1 - u))
    h = np.stack([slope * np.cos(phi), slope * np.sin(phi), np.ones(len(u))], axis=-1)
    h /= np.linalg.norm(h, axis=1, keepdims=True)
    v = np.array([-np.sin(theta), 0.0, np.cos(theta)])
    l = 2 * (h @ v)[:, None] * h - v
    seen = np.minimum(1.0, np.maximum(0.0, h @ v) / np.cos(theta))  # of those that face the eye
    # The image of the source is 0.75 by 2.5 degrees.
    up = np.degrees(np.arctan2(l[:, 0], l[:, 2])) - angle + rng.uniform(-0.375, 0.375, len(u))
    across = np.degrees(np.arcsin(l[:, 1])) + rng.uniform(-1.25, 1.25, len(u))
    inside = (np.abs(up) < high / 2) & (np.abs(across) < wide / 2)
    schlick = f0 + (1 - f0) * (1 - np.cos(theta)) ** 5
    expected = 100 * (inside * seen).mean() * schlick / glass_reflects
    assert gloss(glass, angle) == pytest.approx(expected, rel=0.06)


@pytest.mark.parametrize("angle", [20, 60, 85])
def test_gloss_falls_with_roughness(angle):
    glass = Appearance(albedo=np.zeros(3), f0=(0.567 / 2.567) ** 2, roughness=0.08)
    assert 60 < gloss(glass, angle) < 107
    steps = [gloss(replace(glass, roughness=r), angle) for r in (0.08, 0.15, 0.3, 0.5, 0.8)]
    assert (np.diff(steps) < 0).all()


@pytest.mark.parametrize("units", [0.8, 2.0, 5.0, 20.0, 60.0])
@pytest.mark.parametrize("colour", [(20.0, 0.0, 0.0), (60.0, 20.0, 30.0)])
def test_gloss_and_colour_that_were_entered_are_met(colour, units):
    look = appearance_of(np.array(colour), units)
    assert abs(gloss(look) - units) <= 0.2
    assert delta_e_2000(lab(look), np.array(colour)) <= 0.1
    typed = Appearance(albedo=linear_from_lab(np.array(colour)), measured="45/0", gloss_60=units)
    again = resolved(typed)
    assert abs(gloss(again) - units) <= 0.2
    assert delta_e_2000(lab(again), np.array(colour)) <= 0.1


@pytest.mark.parametrize("units", [0.05, 95.0])
def test_gloss_that_no_roughness_has(units):
    with pytest.raises(InputError, match=f"gloss_60: got {units:g} GU"):
        appearance_of(np.array([50.0, 0.0, 0.0]), units)


@pytest.mark.render
def test_illuminants_are_adapted_to_by_choice(card):
    """Grey under A is grey to an eye that has adapted, and the colour of the lamp to one not."""
    rig = Rig(name="A", lights=(booth(illuminant="A", angular_diameter_deg=2.0),))
    grey = Appearance(albedo=np.full(3, 0.3), f0=0.0)
    image = shown(card, grey, rig=rig)
    adapted, bare = (read_off(replace(image, adaptation=d)) for d in (1.0, 0.0))
    assert np.abs(adapted[1:]).max() < 1.0
    assert bare[2] > 25
    half = read_off(replace(image, adaptation=0.5))
    assert adapted[2] < half[2] < bare[2]
    with pytest.raises(InputError, match="adaptation"):
        replace(image, adaptation=1.5).to_srgb()
    with pytest.raises(InputError, match="card"):
        replace(image, card=None).to_srgb()


def test_a_white_card_faces_the_light():
    """Two lamps: the card turns between them; under a sky alone it lies."""
    low = sun(elevation_deg=30, azimuth_deg=0, illuminance_lux=1000)
    one = white_card(Rig(name="one", lights=(low,)))
    assert np.pi * one @ [0.2126, 0.7152, 0.0722] == pytest.approx(1000, rel=1e-4)
    sky = white_card(Rig(name="sky", lights=(), ambient=500.0))
    assert sky @ [0.2126, 0.7152, 0.0722] == pytest.approx(500)


# Sharma, Wu and Dalal 2005, rows of their table.
@pytest.mark.parametrize(
    ("first", "second", "expected"),
    [
        ((50, 2.6772, -79.7751), (50, 0, -82.7485), 2.0425),
        ((50, -1.3802, -84.2814), (50, 0, -82.7485), 1.0000),
        ((50, 0, 0), (50, -1, 2), 2.3669),
        ((50, 2.4900, -0.0010), (50, -2.4900, 0.0009), 7.1792),
        ((50, 2.4900, -0.0010), (50, -2.4900, 0.0011), 7.2195),
        ((50, 2.5, 0), (73, 25, -18), 27.1492),
        ((60.2574, -34.0099, 36.2677), (60.4626, -34.1751, 39.4387), 1.2644),
        ((22.7233, 20.0904, -46.6940), (23.0331, 14.9730, -42.5619), 2.0373),
        ((2.0776, 0.0795, -1.1350), (0.9033, -0.0636, -0.5514), 0.9082),
    ],
)
def test_colour_differences_of_the_published_table(first, second, expected):
    got = delta_e_2000(np.array(first, dtype=float), np.array(second, dtype=float))
    assert got == pytest.approx(expected, abs=5e-5)
