"""Wrinkles of a stretched clamped sheet, 250 x 100 x 0.1 mm at 10 %, Poisson's ratio 0.5."""

import numpy as np
import pytest

import fabrics
import meshes
from seatlook.solver.elastic import ElasticSheet
from seatlook.solver.newton import Potential
from seatlook.solver.statics import equilibrium

pytestmark = pytest.mark.validate
LENGTH, WIDTH, THICKNESS, STRETCH, MODULUS = 0.25, 0.1, 1e-4, 0.1, 1e6
# Regular grid, tension along its edges, h 1.25 mm; wave [m] and amplitude over the thickness.
WAVE, AMPLITUDE = 13.35e-3, 3.22


def stretched(kind, h, *, seed=0, chords=False):
    """Half of the sheet in equilibrium: rest, positions; ``chords`` leaves out the arcs."""
    X, T = meshes.rectangle(kind, LENGTH / 2, WIDTH, h, seed=seed)
    stiff = MODULUS * THICKNESS / (1 - 0.5**2)
    fabric = fabrics.isotropic(stiff, stiff * THICKNESS**2 / 12, 0.5, thickness=THICKNESS)
    end, middle = X[:, 0] < 1e-9, X[:, 0] > LENGTH / 2 - 1e-9
    x = np.pad(X * [1 + STRETCH, 1.0], ((0, 0), (0, 1)))
    # The mirror at mid-length holds the slope along the sheet, the clamp all.
    sheet = ElasticSheet(X, T, np.zeros(len(T)), [fabric], clamped=end | middle, positions=x)
    if chords:
        sheet.membrane._rows[2][:] = 0.0
        sheet.membrane._bow_offset[:] = 0.0
    free = np.repeat(~end[:, None], 3, axis=1)
    free[middle, 0] = False
    found = equilibrium(
        sheet,
        Potential(sheet.energies, (), free),
        x,
        "newton",
        tolerance=1e-3,
        max_iterations=None,
    )
    assert found.residual <= 1e-3
    assert found.stable
    return X, found.x


def wave_and_amplitude(X, x):
    """Wave length by zero crossings among the tall wrinkles at mid-length, half their range / t."""
    middle = X[:, 0] > LENGTH / 2 - 1e-9
    order = np.argsort(X[middle, 1])
    y, z = x[middle][order, 1], x[middle][order, 2]
    at = np.flatnonzero(np.diff(np.sign(np.diff(z)))) + 1
    # A parabola through each extreme vertex and its neighbours.
    fits = [np.polyfit(y[i - 1 : i + 2] - y[i], z[i - 1 : i + 2], 2) for i in at]
    peaks = np.array([c - b**2 / (4 * a) for a, b, c in fits])
    tall = at[np.abs(peaks) > 0.4 * np.abs(peaks).max()]
    zero = np.flatnonzero(z[:-1] * z[1:] < 0)
    crossing = y[zero] - z[zero] * (y[zero + 1] - y[zero]) / (z[zero + 1] - z[zero])
    crossing = crossing[(crossing > y[tall[0]]) & (crossing < y[tall[-1]])]
    return 2 * np.diff(crossing).mean(), np.abs(np.diff(peaks)).max() / 2 / THICKNESS


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
