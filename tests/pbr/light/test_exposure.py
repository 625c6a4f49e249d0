"""Exposure values, transfer function and dither."""

from __future__ import annotations

import numpy as np
import pytest

from seatlook.errors import InputError
from seatlook.model import Rig, bulb, sun
from seatlook.model.colour import srgb_encode
from seatlook.pbr.light.exposure import TONE_CURVES, ev100, saturation_luminance, to_display
from seatlook.pbr.light.rig import SEAT, illuminance, lux_at_seat, white_of

SUN = Rig(name="sun", lights=(sun(elevation_deg=30, azimuth_deg=200),))


def test_sun_overhead_is_ev_15():
    overhead = Rig(name="noon", lights=(sun(elevation_deg=90, azimuth_deg=0),))
    assert ev100(overhead) == pytest.approx(np.log2(97_000 / 2.5))
    assert round(ev100(overhead)) == 15


def test_lux_on_the_card_per_light():
    rig = Rig(
        name="both",
        lights=(sun(elevation_deg=30, azimuth_deg=0), bulb(position_mm=(0, 300, 500))),
        ambient=100.0,
    )
    lux = lux_at_seat(rig)
    assert lux["sun"] == pytest.approx(48_500)
    # 63.66 cd at 0.5 m, tilted by 3-4-5: 63.66 / 0.25 * 0.8
    assert lux["bulb"] == pytest.approx(800 / (4 * np.pi) / 0.25 * 0.8)
    assert lux["sky"] == pytest.approx(314.159, abs=1e-3)
    assert lux["total"] == pytest.approx(sum(v for k, v in lux.items() if k != "total"))


def test_inverse_square_and_linearity():
    near, far = (bulb(position_mm=(0, 0, 100 + d)) for d in (400, 800))
    assert illuminance(near) / illuminance(far) == pytest.approx(4, rel=1e-12)
    bright = bulb(lumen=2400, position_mm=(0, 0, 500))
    assert illuminance(bright) / illuminance(near) == pytest.approx(3, rel=1e-12)


def test_a_light_below_the_card_gives_nothing_and_is_no_exposure():
    below = Rig(name="floor", lights=(bulb(position_mm=(0, 0, -300)),))
    assert illuminance(below.lights[0]) == 0
    with pytest.raises(InputError, match="rig floor: got 0 lux on the grey card"):
        ev100(below)


def test_given_exposure_wins():
    assert ev100(Rig(name="set", lights=SUN.lights, ev100=9.5)) == 9.5


def test_grey_card_is_exposed_right():
    """An 18 % card in the rig's light shows at 12 % of white, a half stop under sRGB mid grey."""
    lux = lux_at_seat(SUN)["total"]
    share = 0.18 * lux / np.pi / saturation_luminance(ev100(SUN))
    assert share == pytest.approx(0.18 * 2.5 / (1.2 * np.pi))
    assert round(255 * float(srgb_encode(np.array(share)))) == 97


@pytest.mark.parametrize(
    ("linear", "code"), [(0, 0), (0.002, 6.589), (0.0031308, 10.314), (0.18, 117.6458), (1, 255)]
)
def test_srgb_codes(linear, code):
    assert 255 * float(srgb_encode(np.array(linear))) == pytest.approx(code, abs=2e-3)


def test_srgb_has_no_step_where_its_pieces_meet():
    below, above = srgb_encode(np.array([0.0031308 - 1e-9, 0.0031308 + 1e-9]))
    assert abs(above - below) < 1e-6


def test_dither_keeps_the_mean_and_the_ends():
    ev = 0.0
    ramp = np.linspace(0, 0.02, 64)[:, None, None] * saturation_luminance(ev)
    image = np.broadcast_to(ramp, (64, 512, 3)).astype(np.float32)
    shown = to_display(image, ev).astype(float)
    exact = 255 * srgb_encode(ramp[:, 0, 0] / saturation_luminance(ev))
    assert np.abs(shown.mean(axis=(1, 2)) - exact).max() < 0.06
    assert (shown[0] == 0).all()
    white = np.full((8, 8, 3), 2 * saturation_luminance(ev), np.float32)
    assert (to_display(white, ev) == 255).all()


def test_rig_white_is_shown_neutral():
    warm = Rig(name="lamp", lights=(bulb(position_mm=(0, 0, 900), temperature_k=2700),))
    white = white_of(warm)
    assert white[0] > 1.5 > 1 > white[2]
    card = np.broadcast_to(white * 10, (4, 4, 3)).astype(np.float32)
    shown = to_display(card, 5.0, white=white).astype(int)
    assert np.ptp(shown, axis=2).max() == 0


@pytest.mark.parametrize("name", TONE_CURVES)
def test_tone_curves_rise_and_stay_in_range(name):
    x = np.repeat(np.linspace(0, 20, 2000)[:, None], 3, axis=1)
    y = TONE_CURVES[name](x)
    assert y.min() >= 0
    assert y.max() <= 1
    assert (np.diff(y[:, 0]) >= -1e-12).all()


def test_unknown_tone_curve():
    with pytest.raises(InputError, match=r"tone: got 'clmp', .*did you mean 'clamp'"):
        to_display(np.zeros((1, 1, 3), np.float32), 0.0, tone="clmp")


def test_the_seat_is_above_the_origin():
    assert SEAT == (0.0, 0.0, 0.1)
