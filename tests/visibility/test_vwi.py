"""What VWI claims of itself, on the drawn patch: each of these can fail."""

import itertools
import sys
import time
from dataclasses import replace

import numpy as np
import pytest

from seatlook.errors import InputError
from seatlook.visibility.bands import PEAK
from seatlook.visibility.cross_check import log_ratio
from seatlook.visibility.observer import OBSERVER
from seatlook.visibility.vwi import region_contrast, region_visibility, score
from support.seen.field import (
    LOOKS,
    PIXEL,
    PIXELS_PER_DEGREE,
    Look,
    Patch,
    bulb,
    creases,
    dome,
    sun,
)

SIZE = (640, 360)
# The fast tests see the patch of 512 x 288 mm from the same place with half the pixels.
STEP, PPD = 2 * PIXEL, PIXELS_PER_DEGREE / 2


@pytest.fixture(scope="module")
def smooth():
    return Patch(dome(SIZE, STEP), STEP)


@pytest.fixture(scope="module")
def wrinkled():
    return Patch(dome(SIZE, STEP) + creases(SIZE, STEP), STEP)


@pytest.fixture(scope="module")
def vwi(smooth, wrinkled):
    """Score of the creases: look, lamp -> VWI."""

    def of(look, lamp, patch=wrinkled, **options):
        look = LOOKS[look] if isinstance(look, str) else look
        test, reference = (p.draw(look, lamp, **options) for p in (patch, smooth))
        return score(test, reference, pixels_per_degree=PPD).vwi

    return of


@pytest.mark.parametrize("look", list(LOOKS))
def test_equal_pictures_score_exactly_zero(look, smooth):
    picture = smooth.draw(LOOKS[look], sun(70))
    result = score(picture, picture.copy(), pixels_per_degree=PPD, pixel_area=STEP**2)
    assert result.vwi == result.p995 == result.map.max() == 0
    assert result.visible_share == result.visible_area == (0.0, 0.0)
    assert {band.vwi for band in result.bands} == {0.0}


def test_grows_with_the_amplitude_nearly_linearly(vwi):
    amplitude = np.array([0, 0.04, 0.2, 1, 2])
    values = np.array(
        [
            vwi("black glossy", sun(70), Patch(dome(SIZE, STEP) + a * creases(SIZE, STEP), STEP))
            for a in amplitude
        ]
    )
    assert values[0] == 0
    assert (np.diff(values) > 0).all()
    assert np.corrcoef(amplitude, values)[0, 1] ** 2 > 0.99


@pytest.mark.parametrize("lamp", [sun(70), bulb(70)], ids=["sun", "bulb"])
def test_a_highlight_shows_dark_and_glossy_first(vwi, lamp):
    order = ["black glossy", "bright glossy", "bright rough", "textured suede"]
    values = [vwi(look, lamp) for look in order]
    assert all(a > 1.1 * b for a, b in itertools.pairwise(values)), values


def test_raking_light_does_not(vwi):
    ratio = vwi("black glossy", sun(20)) / vwi("bright rough", sun(20))
    assert 0.6 < ratio < 1.2


def test_albedo_cancels_without_interreflection(smooth, wrinkled):
    ratios = []
    for albedo in (0.03, 0.3, 0.9):
        look = Look(albedo=albedo, roughness=0.9, f0=0.0)
        pictures = [p.draw(look, sun(40), interreflection=False) for p in (wrinkled, smooth)]
        ratios.append(log_ratio(*pictures))
    assert max(ratios) < 1.01 * min(ratios)


def test_dusk_hides_what_is_faint_and_leaves_the_contrast_of_what_is_not(smooth, wrinkled):
    look, lamp = LOOKS["black glossy"], sun(20)
    day, dusk = (
        score(*(p.draw(look, lamp.scaled(k)) for p in (wrinkled, smooth)), pixels_per_degree=PPD)
        for k in (1.0, 1e-3)
    )
    assert dusk.vwi < 0.5 * day.vwi
    assert dusk.apparent_contrast == pytest.approx(day.apparent_contrast, rel=0.25)


@pytest.mark.parametrize("lamp", [sun(70), sun(20)], ids=["70", "20"])
def test_a_texture_in_both_pictures_hides(vwi, lamp):
    assert vwi("textured suede", lamp) < 0.8 * vwi("suede", lamp)


def test_masking_is_what_makes_the_texture_hide(smooth, wrinkled):
    pictures = [p.draw(LOOKS["textured suede"], sun(70)) for p in (wrinkled, smooth)]
    unmasked = replace(OBSERVER, masking_gain=0.0)
    seen = score(*pictures, pixels_per_degree=PPD, observer=unmasked).vwi
    assert seen > 2 * score(*pictures, pixels_per_degree=PPD).vwi


def test_light_across_shows_more_than_light_along(vwi):
    across, along = (vwi("bright rough", sun(40, azimuth)) for azimuth in (0.0, 90.0))
    assert across > 1.5 * along


def test_a_slow_ramp_is_no_wrinkle(smooth):
    picture = smooth.draw(LOOKS["bright rough"], sun(70))
    ramp = np.linspace(0.95, 1.05, SIZE[0])
    assert score(picture * ramp, picture, pixels_per_degree=PPD).vwi < 0.2


def test_a_texture_shifted_by_one_pixel_is_caught(smooth, vwi):
    """The null gate of 0.1 refuses it, and must: it outscores the wrinkle itself."""
    still, moved = (smooth.draw(LOOKS["textured suede"], sun(70), shift=k) for k in (0, 1))
    shifted = score(moved, still, pixels_per_degree=PPD).vwi
    assert shifted > 0.1
    assert shifted > vwi("textured suede", sun(70))


@pytest.mark.parametrize("look", ["black glossy", "bright rough", "textured suede"])
@pytest.mark.parametrize("elevation", [70, 20])
def test_half_the_pixels_at_half_the_pixels_per_degree(look, elevation, fine_patches):
    pictures = [p.draw(LOOKS[look], sun(elevation)) for p in fine_patches]
    boxes = [p.reshape(SIZE[1] // 2, 2, SIZE[0] // 2, 2).mean(axis=(1, 3)) for p in pictures]
    full = score(*pictures, pixels_per_degree=PIXELS_PER_DEGREE).vwi
    half = score(*boxes, pixels_per_degree=PIXELS_PER_DEGREE / 2).vwi
    assert half == pytest.approx(full, rel=0.03)


@pytest.fixture(scope="module")
def fine_patches():
    return [Patch(dome(SIZE) + creases(SIZE)), Patch(dome(SIZE))]


def test_figures_of_a_region_come_from_its_map(smooth, wrinkled):
    pictures = [p.draw(LOOKS["black glossy"], sun(70)) for p in (wrinkled, smooth)]
    mask = np.zeros(SIZE[::-1], dtype=bool)
    mask[60:300, 80:400] = True
    area = np.full(mask.shape, STEP**2)
    result = score(*pictures, pixels_per_degree=PPD, mask=mask, pixel_area=area)
    inside = result.map[mask]
    assert result.vwi == pytest.approx(np.sum(inside**3 / PPD**2) ** (1 / 3))
    assert result.vwi == pytest.approx(
        region_visibility(result.map, pixels_per_degree=PPD, mask=mask)
    )
    assert result.apparent_contrast == pytest.approx(
        np.mean(result.contrast_map[mask] ** 3) ** (1 / 3)
    )
    assert result.p995 == pytest.approx(np.quantile(inside, 0.995))
    assert result.visible_share == ((inside > 1).mean(), (inside > 3).mean())
    assert result.visible_area[1] == pytest.approx((inside > 3).sum() * STEP**2)
    # Bands are pooled at their own size; their sum misses the whole by the edges only.
    assert sum(b.vwi**3 for b in result.bands) ** (1 / 3) == pytest.approx(result.vwi, rel=0.02)
    frequencies = [b.frequency for b in result.bands]
    assert frequencies[0] == pytest.approx(PEAK * PPD)
    assert np.allclose(np.diff(np.log2(frequencies)), -1)
    assert frequencies[-1] >= OBSERVER.lowest_frequency > frequencies[-1] / 2


def test_a_cause_takes_the_map_where_its_weight_is():
    D = np.array([[1.0, 4.0], [2.0, 2.0]])
    first, below = np.array([[0.0, 3.0], [0.0, 0.0]]), np.array([[0.0, 3.0], [1.0, 1.0]])
    assert region_visibility(D, pixels_per_degree=1.0, weight=first) == pytest.approx(4.0)
    assert region_visibility(D, pixels_per_degree=2.0, weight=first) == pytest.approx(
        4.0 * 0.25 ** (1 / 3)
    )
    assert region_visibility(D, pixels_per_degree=1.0, mask=D < 3, weight=below) == pytest.approx(
        2.0 * 2 ** (1 / 3)
    )
    assert region_contrast(D, weight=first) == pytest.approx(4.0)
    assert region_contrast(D, mask=D < 3, weight=below) == pytest.approx(2.0)
    with pytest.raises(InputError, match="weight: got 0 everywhere"):
        region_contrast(D, weight=np.zeros((2, 2)))


def test_refuses_what_it_cannot_score():
    good = np.full((32, 32), 10.0)
    bad = good.copy()
    bad[3, 4:6] = (np.nan, -1.0)
    with pytest.raises(InputError) as caught:
        score(bad, good[:, :20], pixels_per_degree=45)
    assert "test_luminance: got 1 pixels nan or inf, expected finite" in str(caught.value)
    assert "test_luminance: got 1 pixels below 0, expected cd/m2 from 0 up" in str(caught.value)
    with pytest.raises(InputError, match=r"got shape \(32, 20\), expected shape \(32, 32\)"):
        score(good, good[:, :20], pixels_per_degree=45)
    with pytest.raises(InputError, match=r"got shape \(8, 32\), expected \(h, w\), at least 16"):
        score(good[:8], good[:8], pixels_per_degree=45)
    with pytest.raises(InputError, match="mask: got no pixel inside"):
        score(good, good, pixels_per_degree=45, mask=np.zeros((32, 32), dtype=bool))
    with pytest.raises(InputError, match=r"mask: got float64 of shape \(32, 32\), expected bool"):
        score(good, good, pixels_per_degree=45, mask=np.ones((32, 32)))
    with pytest.raises(InputError, match="pixels_per_degree: got -1"):
        score(good, good, pixels_per_degree=-1)
    with pytest.raises(InputError, match=r"at least one octave above 0\.2 cycles/deg"):
        score(good, good, pixels_per_degree=0.4)


def test_darkness_is_scored_without_a_warning():
    dark = np.zeros((64, 64))
    assert score(dark, dark, pixels_per_degree=45).vwi == 0
    assert np.isfinite(score(dark + 1e-6, dark, pixels_per_degree=45).vwi)


@pytest.mark.bench
def test_time_at_1280x720(capsys):
    rng = np.random.default_rng(0)
    pictures = [100 * np.exp(0.1 * rng.normal(size=(720, 1280))) for _ in range(2)]
    times = []
    for _ in range(6):
        start = time.process_time()
        score(*pictures, pixels_per_degree=45)
        times.append(time.process_time() - start)
    with capsys.disabled():
        sys.stdout.write(f"\nVWI 1280x720: {min(times[1:]):.3f} CPU s\n")
