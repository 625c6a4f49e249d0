"""Wrinkles of a stretched clamped sheet, 250 x 100 x 0.1 mm at 10 %, Poisson's ratio 0.5."""

import pytest

from support.reference.stretched import AMPLITUDE, WAVE, stretched, wave_and_amplitude

pytestmark = pytest.mark.validate


@pytest.mark.parametrize(
    ("kind", "h", "seed", "chords", "tolerance"),
    [
        ("right", 1.25e-3, 0, False, 0.03),
        ("right", 1.25e-3, 0, True, 0.03),
        *[("uns", 2.5e-3, seed, False, 0.10) for seed in range(5)],
    ],
)
def test_wrinkles_of_a_stretched_sheet(kind, h, seed, chords, tolerance, capsys):
    wave, amplitude = wave_and_amplitude(*stretched(kind, h, seed=seed, chords=chords))
    with capsys.disabled():
        print(
            f"\n    {kind} {h * 1e3} mm seed {seed}: {wave * 1e3:.2f} mm, {amplitude:.2f} t", end=""
        )
    assert wave == pytest.approx(WAVE, rel=tolerance)
    assert amplitude == pytest.approx(AMPLITUDE, rel=tolerance)
