"""What the octaves make of patterns whose answer is known: each of these can fail."""

from dataclasses import replace

import numpy as np
import pytest

from seatlook.visibility.bands import PEAK, responses
from seatlook.visibility.kernels.pyramid import soften
from seatlook.visibility.observer import OBSERVER
from seatlook.visibility.vwi import detectability, score
from support.seen.stimuli import axes, gabor, grating, noise

GROUND = 30.0  # cd/m2


def decibel(ratio):
    return 20 * np.log10(ratio)


def seen(pattern, ppd, *, contrast=0.01, mask=0.0, observer=None):
    """D of a pattern on a mask, both contrasts about 0."""
    test, flat = (GROUND * (1 + mask + c * pattern) for c in (contrast, 0.0))
    if observer is None:
        return detectability(test, flat, ppd)
    return score(test, flat, pixels_per_degree=ppd, observer=observer).vwi


def patch(frequency=4.0, sigma=0.4, ppd=60.0, **options):
    return gabor(*axes(8 * sigma, ppd), frequency, sigma, **options)


def patterns():
    """Patterns of 2 deg at 60 pixels per degree, of many kinds."""
    x, y = axes(2.0, 60.0)
    below = np.exp(-(x**2 + y**2) / (2 * 0.3**2))
    return {
        "patch": gabor(x, y, 4.0, 0.3),
        "long patch": np.exp(-(x**2) / 0.02 - y**2 / 0.5) * np.cos(2 * np.pi * 6 * x),
        "two octaves": (grating(x, y, 2.0) + grating(x, y, 8.0)) * below / 2,
        "blob": below,
        "dot": np.exp(-(x**2 + y**2) / (2 * 0.03**2)),
        "edge": np.sign(x) * below,
        "line": (abs(x) < 1 / 60) * below,
        "noise": noise(len(x), 60.0, up_to_cycles_per_deg=30.0, seed=1) * below / 3,
        "disc": 1.0 * (np.hypot(x, y) < 0.4),
        "checks": np.sign(np.sin(4 * np.pi * x) * np.sin(4 * np.pi * y)) * below,
    }


@pytest.mark.parametrize("name", patterns())
def test_faint_patterns_are_seen_by_their_contrast_alone(name):
    """Twice the contrast is twice as far above threshold, in either polarity, whichever way up."""
    pattern = patterns()[name]
    once = seen(pattern, 60.0, contrast=1e-3)
    assert seen(pattern, 60.0, contrast=2e-3) == pytest.approx(2 * once, rel=0.01)
    assert seen(-pattern, 60.0, contrast=1e-3) == pytest.approx(once, rel=0.01)
    for turned in (pattern.T, pattern[::-1], pattern[:, ::-1]):
        assert decibel(seen(turned, 60.0, contrast=1e-3) / once) == pytest.approx(0, abs=0.5)


@pytest.mark.parametrize("name", patterns())
def test_where_a_pattern_stands_does_not_matter(name):
    pattern = np.pad(patterns()[name], 40)
    moved = np.roll(pattern, (13, -7), axis=(0, 1))
    assert decibel(seen(moved, 60.0) / seen(pattern, 60.0)) == pytest.approx(0, abs=0.5)


@pytest.mark.parametrize("frequency", [1.0, 2.0, 4.0, 8.0])
def test_the_number_of_pixels_does_not_matter(frequency):
    """Within what the place of a pattern between two octaves makes out."""
    values = [seen(patch(frequency, ppd=ppd), ppd) for ppd in (40.0, 57.0, 80.0)]
    assert decibel(max(values) / min(values)) < 1.5


@pytest.mark.parametrize("turned", [30.0, 45.0, 90.0])
def test_bars_are_seen_at_any_angle(turned):
    upright, other = (seen(patch(turned_deg=angle), 60.0) for angle in (0.0, turned))
    assert decibel(other / upright) == pytest.approx(0, abs=1.5)


def test_eight_patches_are_seen_twice_as_well_as_one():
    one = np.pad(patch(sigma=0.2), ((0, 0), (0, 7 * 96)))
    all_eight = sum(np.roll(one, 96 * k, axis=1) for k in range(8))
    assert seen(all_eight, 60.0) / seen(one, 60.0) == pytest.approx(2.0, rel=0.02)


@pytest.mark.parametrize("cycles_per_pixel", [0.03, 0.06, 0.12, PEAK, 0.3, 0.4])
def test_all_octaves_pass_the_same(cycles_per_pixel):
    """Contrast of a grating, thresholds left out: within 2 dB up to 0.4 cycles per pixel."""
    x, _ = axes(512, 1.0)
    bars = np.cos(2 * np.pi * cycles_per_pixel * x)
    keen = replace(OBSERVER, gain=1e6)
    test, flat = GROUND * (1 + 0.01 * bars), np.full(x.shape, GROUND)
    octaves = responses(test, flat, 45.0, keen)
    shown = [inner(octave.contrast).mean() for octave in octaves]
    passed = (sum(shown) / np.mean(abs(bars) ** 3)) ** (1 / 3) / 0.01
    assert decibel(passed) == pytest.approx(0, abs=2.0)


def inner(values):
    """Without an eighth at every side, which the border of the picture reaches."""
    rim = len(values) // 8
    return values[rim : len(values) - rim, rim : len(values) - rim]


@pytest.mark.parametrize("kind", ["fine bars", "bars", "noise"])
def test_a_texture_is_seen_at_the_border_as_inside(kind):
    x, y = axes(3.0, 60.0)
    pattern = {
        "fine bars": grating(x, y, 20.0),
        "bars": np.sin(2 * np.pi * 5 * x),
        "noise": noise(len(x), 60.0, up_to_cycles_per_deg=30.0, seed=3),
    }[kind]
    test, flat = GROUND * (1 + 0.02 * pattern), np.full(x.shape, GROUND)
    inside = (abs(x) < 1.0) & (abs(y) < 1.0)
    whole, middle = (
        score(test, flat, pixels_per_degree=60.0, mask=mask).vwi for mask in (None, inside)
    )
    assert whole / middle == pytest.approx((9 / 4) ** (1 / 3), rel=0.06)


def test_softening_keeps_slopes():
    x, y = axes(20, 1.0)
    np.testing.assert_allclose(soften(50 + 0.7 * x - y), 50 + 0.7 * x - y, rtol=1e-13)


def raised(mask):
    """By how many dB a mask raises the threshold of the patch."""
    return -decibel(seen(patch(), 60.0, mask=mask) / seen(patch(), 60.0))


def bars_of(frequency, contrast, turned=0.0):
    return contrast * grating(*axes(3.2, 60.0), frequency, turned_deg=turned)


def test_a_strong_pattern_raises_the_threshold_by_its_contrast():
    weak, strong = (raised(bars_of(4.0, c)) for c in (0.2, 0.4))
    assert strong - weak == pytest.approx(6.0, abs=1.0)
    assert raised(bars_of(4.0, 1e-3)) == pytest.approx(0, abs=0.3)


def test_neighbouring_octaves_hide_and_farther_ones_hardly():
    alone = replace(OBSERVER, masking_neighbours=0.0)
    for frequency in (2.0, 8.0):
        mask = bars_of(frequency, 0.2)
        hidden = seen(patch(), 60.0, mask=mask)
        assert decibel(seen(patch(), 60.0, mask=mask, observer=alone) / hidden) > 1.0
    assert raised(bars_of(0.7, 0.2)) < 0.5 * raised(bars_of(2.0, 0.2))


def apparent(frequency, contrast, luminance=100.0, ppd=32.0):
    x, y = axes(6.0, ppd)
    inside = np.hypot(x, y) < 2.0
    beyond = np.clip(np.hypot(x, y) - 2.0, 0, 1)
    bars = grating(x, y, frequency) * (0.5 + 0.5 * np.cos(np.pi * beyond))
    test, flat = luminance * (1 + contrast * bars), np.full(x.shape, luminance)
    return score(test, flat, pixels_per_degree=ppd, mask=inside).apparent_contrast


@pytest.mark.parametrize("frequency", [1.0, 2.0, 4.0, 8.0])
@pytest.mark.parametrize("luminance", [5.0, 100.0, 2000.0])
def test_a_strong_grating_looks_as_strong_as_it_is(frequency, luminance):
    assert apparent(frequency, 0.3, luminance) == pytest.approx(30.0, rel=0.12)


def test_nothing_below_its_threshold_has_contrast():
    assert apparent(4.0, 0.004) == 0
    assert 0 < apparent(4.0, 0.02) < 2.0


def test_a_larger_field_looks_as_strong_but_is_seen_from_farther_below():
    x, y = axes(8.0, 32.0)
    flat, test = np.full(x.shape, 100.0), 100 * (1 + 0.1 * grating(x, y, 3.0))
    small, large = (
        score(test, flat, pixels_per_degree=32.0, mask=(abs(x) < r) & (abs(y) < r))
        for r in (1.0, 2.0)
    )
    assert large.apparent_contrast == pytest.approx(small.apparent_contrast, rel=0.02)
    assert large.vwi / small.vwi == pytest.approx(4 ** (1 / 3), rel=0.02)
