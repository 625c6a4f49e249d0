"""Bright regions of a panorama are lights: none lost, none twice, turned with it, with shadows."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from seatlook.model import Appearance, Camera, Light, Rig
from seatlook.model.light.lamps import direction, turned
from seatlook.pbr.light.panorama import directions, irradiance_on, solid_angles
from seatlook.pbr.light.rig import LUMINANCE, illuminance
from seatlook.pbr.light.windows import MOST, with_windows
from seatlook.pbr.shading.studio import Studio
from support.reference.lit_sheets import sheet

DARK = Appearance(albedo=np.full(3, 0.05), f0=0.0, roughness=1.0)


def room(windows, rows=128, even=0.0):
    """Panorama with round windows (azimuth, elevation, diameter [deg], colour) [cd/m2]."""
    picture = np.full((rows, 2 * rows, 3), even)
    for azimuth, elevation, diameter, colour in windows:
        near = directions(rows, 2 * rows) @ direction(azimuth, elevation)
        picture[near > np.cos(np.radians(diameter / 2))] = colour
    return Rig(name="room", lights=(), panorama=picture)


places = st.tuples(
    st.floats(0, 360), st.floats(10, 80), st.floats(4, 50),
    st.tuples(*[st.floats(100, 1e5)] * 3).map(np.array),
)  # fmt: skip


@settings(max_examples=40, deadline=None)
@given(st.lists(places, min_size=1, max_size=20), st.floats(0, 50))
def test_light_and_colour_of_all_directions_are_kept(windows, even):
    rig = room(windows, even=even)
    lit = with_windows(rig)
    assert len(lit.lights) <= MOST
    area = solid_angles(*rig.panorama.shape[:2])[..., None]
    d = directions(*rig.panorama.shape[:2])
    for axis in range(3):
        want = (rig.panorama * d[..., axis : axis + 1] * area).sum(axis=(0, 1))
        rest = (lit.panorama * d[..., axis : axis + 1] * area).sum(axis=(0, 1))
        lamps = sum((x.intensity * x.colour * x.vector[axis] for x in lit.lights), np.zeros(3))
        whole = (rig.panorama * area).sum(axis=(0, 1))
        # A disc stands in one place for all channels.
        assert np.abs(rest + lamps - want).max() <= 0.06 * whole.max()
        assert abs((rest + lamps - want) @ LUMINANCE) <= 2e-3 * whole @ LUMINANCE
    assert (lit.panorama <= rig.panorama * (1 + 1e-12)).all()
    assert lit.panorama.min() >= 0


def test_what_is_left_is_smooth():
    rig = room([(30, 40, 12, [1e4, 1e4, 1e4])], even=5.0)
    area = solid_angles(*rig.panorama.shape[:2])
    mean = (rig.panorama @ LUMINANCE * area).sum() / (4 * np.pi)
    assert (with_windows(rig).panorama @ LUMINANCE).max() <= 4.0 * mean * (1 + 1e-9)


def test_an_even_sky_has_no_windows():
    rig = room([], even=100.0)
    assert with_windows(rig) is rig


@pytest.mark.parametrize("azimuth", [90.0, 45.0, 201.09375, 10.0])
def test_windows_turn_with_the_panorama(azimuth):
    rig = room([(30, 40, 12, [1e4, 2e4, 1e4]), (200, 25, 30, [3e3, 2e3, 5e3])], even=5.0)
    before, after = with_windows(rig), with_windows(turned(rig, azimuth))
    assert len(before.lights) == len(after.lights)
    c, s = np.cos(np.radians(azimuth)), np.sin(np.radians(azimuth))
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    for light in before.lights:
        closest = max(after.lights, key=lambda x, way=turn @ light.vector: x.vector @ way)
        assert closest.vector @ (turn @ light.vector) > np.cos(np.radians(1.0))
        assert closest.intensity == pytest.approx(light.intensity, rel=0.05)
        assert closest.size == pytest.approx(light.size, rel=0.1, abs=0.01)


def test_lux_on_the_card_stay():
    rig = room([(30, 40, 12, [1e4, 1e4, 1e4]), (120, 60, 40, [5e3, 5e3, 5e3])], even=20.0)
    lit = with_windows(rig)
    up = np.array([0.0, 0.0, 1.0])
    got = irradiance_on(lit.panorama, up) @ LUMINANCE + sum(map(illuminance, lit.lights))
    assert got == pytest.approx(irradiance_on(rig.panorama, up) @ LUMINANCE, rel=0.01)


@pytest.mark.render
@pytest.mark.parametrize("quality", ["standard", "high"])
def test_a_window_in_a_black_room_throws_the_shadow_of_a_disc(quality):
    """A wall of 60 mm; where the window as a disc gives less than 5 %, so does the panorama."""
    size = (160, 90)
    studio = Studio(
        sheet(
            lambda x, y: 0.06 * (np.abs(0.8 * x + 0.6 * y) < 0.008),
            steps=80,
            size=0.4,
            element_size=0.005,
        )
    )
    camera = Camera(
        name="c", position=np.array([0.1, -0.5, 0.5]), target=np.zeros(3), vertical_fov_deg=25.0,
        size=size,
    )  # fmt: skip
    way, half = direction(250, 40), np.radians(6.0)
    lux = 1e4 * np.pi * np.sin(half) ** 2
    disc = Light(name="disc", intensity=lux, vector=way, near=False, size=2 * half)
    rigs = (Rig(name="disc", lights=(disc,)), room([(250, 40, 12, np.full(3, 1e4))], rows=256))
    want, got = (
        studio.render(DARK, rig=rig, camera=camera, quality=quality).radiance[..., 1]
        for rig in rigs
    )
    whole = np.percentile(want, 90)
    umbra = want < 0.05 * whole
    assert umbra.sum() > 300
    assert got[umbra].mean() <= 0.05 * whole
    assert np.percentile(got[umbra], 95) <= 0.15 * whole
    open_ = want > 0.95 * whole
    assert got[open_].mean() == pytest.approx(want[open_].mean(), rel=0.02)
