"""A far lamp 12 degrees wide from an oblique direction: penumbra, highlight, setting, its parts."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from seatlook.model import Appearance, Light, Rig
from seatlook.model.light.lamps import direction
from seatlook.pbr.reflectance import brdf
from seatlook.pbr.shading.studio import Studio
from support.reference.lit_sheets import above, flat, grid, sheet

WIDE = np.radians(12.0)
UP = np.array([0.0, 0.0, 1.0])
MATT = Appearance(albedo=np.full(3, 0.5), f0=0.0, roughness=1.0)
LUX = 1000.0


def lamp(azimuth, elevation, size=WIDE, lux=LUX, name="lamp"):
    way = direction(azimuth, elevation)
    return Light(name=name, intensity=lux, vector=way, near=False, size=size)


def parts(light, count):
    """Unit directions (count, 3) spread evenly over the disc of a far lamp."""
    l = light.vector
    t = np.cross(l, UP) / np.linalg.norm(np.cross(l, UP))
    k = np.arange(count)
    r, phi = np.tan(0.5 * light.size) * np.sqrt((k + 0.5) / count), 2.399963 * k
    to = l + np.outer(r * np.cos(phi), t) + np.outer(r * np.sin(phi), np.cross(l, t))
    return to / np.linalg.norm(to, axis=1, keepdims=True)


def rig_of(*lights):
    return Rig(name="r", lights=lights, ev100=8.0)


@pytest.fixture(scope="module")
def card():
    return Studio(sheet(flat, steps=8))


TURN, HEIGHT, AZIMUTH, ELEVATION = np.radians(28.0), 0.02, 160.0, 52.0
EDGE = np.array([np.cos(TURN), np.sin(TURN)])


@pytest.fixture(scope="module")
def shaded():
    """A floor, and 20 mm above it a board with a straight edge askew to floor and light."""
    solution = sheet(flat, size=0.4, steps=10)
    points, faces = grid((-0.3, 0.0), (0.3, 0.3), (6, 3))
    x = np.column_stack([points @ [EDGE, [-EDGE[1], EDGE[0]]], np.full(len(points), HEIGHT)])
    cover, n, m = solution.cover, len(solution.positions), len(solution.cover.faces)
    rest = np.concatenate([cover.rest, points + 1.0])
    f = np.concatenate([cover.faces, faces + n])
    both = np.concatenate([solution.positions, x])
    strain = np.zeros((len(f), 2, 2))
    cover = replace(
        cover, rest=rest, uv=rest, positions=both, faces=f,
        panel=np.repeat([0, 1], [m, len(faces)]), panel_names=("floor", "board"),
        materials=cover.materials * 2, zone=np.zeros(len(f), dtype=int),
    )  # fmt: skip
    return Studio(
        replace(
            solution,
            cover=cover,
            positions=both,
            velocities=np.zeros_like(both),
            friction_anchor=np.full_like(both, np.nan),
            strain_top=strain,
            strain_mid=strain,
            strain_bottom=strain,
        )
    )


def unhidden(points, light):
    """Share (k,) of a lamp that floor points see beside the board, by 4000 parts of its disc."""
    to = parts(light, 4000)
    inward = np.array([-EDGE[1], EDGE[0]])
    # Where the rays pass the board's height, they lie beyond its edge or not.
    shift = HEIGHT * (to[:, :2] / to[:, 2:]) @ inward
    away = points[:, :2] @ inward
    return (away[:, None] + shift < 0.0).mean(axis=1)


@pytest.mark.render
@pytest.mark.parametrize("quality", ["T2", "T4"])
def test_penumbra_is_the_share_of_the_disc_that_is_seen(shaded, quality):
    """Row by row along the edge, from all of the lamp to nothing."""
    light = lamp(AZIMUTH, ELEVATION)
    inward = np.array([-EDGE[1], EDGE[0]])
    shift = HEIGHT * (light.vector[:2] / light.vector[2]) @ inward
    at = np.array([*(-shift * inward), 0.0]) + 0.01 * np.array([*EDGE, 0.0])
    assert shift > 0.008
    camera = replace(
        above(distance=0.06, size=(96, 64), fov=12.0, at=at), up=np.array([*inward, 0])
    )
    got = shaded.render(MATT, rig=rig_of(light), camera=camera, quality=quality).radiance[..., 1]
    rows = (np.arange(64) + 0.5 - 32) / 32 * 0.06 * np.tan(np.radians(6.0))
    points = at[:2] - rows[:, None] * inward
    share = unhidden(points, light)
    full = 0.5 / np.pi * LUX * light.vector[2]
    assert got.mean(axis=1) / full == pytest.approx(share, abs=0.02)
    assert (share[0], share[-1]) == (0.0, 1.0)
    assert ((share > 0.05) & (share < 0.95)).sum() > 20


@pytest.mark.render
@pytest.mark.parametrize("quality", ["T1", "T2", "T4"])
@pytest.mark.parametrize("off", [(0.0, 0.0), (7.0, 0.0), (0.0, 7.0), (-4.0, 5.0)])
def test_highlight_is_the_integral_over_the_disc(card, quality, off):
    """A glossy card, at the mirror direction and beside it along and across its plane."""
    look = Appearance(albedo=np.full(3, 0.05), roughness=0.3)
    light = lamp(200.0, 50.0)
    eye = direction(20.0 + off[0], 50.0 + off[1])
    camera = replace(above(size=(8, 8), fov=1.0), position=0.8 * eye, up=UP)
    got = card.render(look, rig=rig_of(light), camera=camera, quality=quality).radiance[4, 4, 1]
    l = parts(light, 4000)
    v = np.tile(eye, (4000, 1))
    exact = (brdf.evaluate(look, v, l)[:, 1] * l[:, 2]).mean() * LUX
    point = brdf.evaluate(look, eye, light.vector)[1] * light.vector[2] * LUX
    assert got == pytest.approx(exact, rel=0.1 if quality == "T1" else 0.03)
    assert abs(point / exact - 1.0) > 0.07


@pytest.mark.render
@pytest.mark.parametrize("quality", ["T1", "T2", "T4"])
@pytest.mark.parametrize("elevation", [90.0, 52.0, 20.0, 3.0, 0.0, -3.0, -7.0])
def test_card_gets_the_light_of_what_has_risen(card, quality, elevation):
    """Mean of the positive cosine over the disc; all of it as a point in its middle."""
    light = lamp(110.0, elevation)
    camera = above(size=(16, 16), fov=1.0)
    got = card.render(MATT, rig=rig_of(light), camera=camera, quality=quality).radiance[..., 1]
    cosine = parts(light, 40_000)[:, 2]
    full = light.vector[2] if elevation > 6.0 else np.maximum(cosine, 0.0).mean()
    assert got.mean() == pytest.approx(
        0.5 / np.pi * LUX * full, rel=0.002 if elevation > 6 else 0.06, abs=1e-9
    )


@pytest.mark.render
@pytest.mark.parametrize("quality", ["T2", "T4"])
def test_lamp_is_the_sum_of_its_parts(quality):
    """Grained leather on a crown: one lamp, or 91 suns that share its light and its disc."""
    crown = Studio(sheet(lambda x, y: 0.05 - 3 * (x + 0.3 * y) ** 2, size=0.12, steps=24))
    leather = Appearance(
        albedo=np.full(3, 0.05), roughness=0.35, texture="leather", texture_scale=0.0012,
        texture_depth=0.00006,
    )  # fmt: skip
    light = lamp(215.0, 48.0)
    ways = parts(light, 91)
    suns = [
        replace(light, name=f"{k}", vector=way, size=0.0, intensity=LUX / 91)
        for k, way in enumerate(ways)
    ]
    camera = replace(above(size=(96, 72), fov=9.0), position=np.array([0.1, 0.3, 0.6]), up=UP)
    one, many = (
        crown.render(leather, rig=rig_of(*lights), camera=camera, quality=quality).radiance[..., 1]
        for lights in ((light,), suns)
    )
    blocks = [p.reshape(9, 8, 12, 8).mean(axis=(1, 3)) for p in (one, many)]
    assert blocks[0] == pytest.approx(blocks[1], rel=0.015)
