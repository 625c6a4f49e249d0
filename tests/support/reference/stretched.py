"""A sheet stretched between clamps, 250 x 100 mm, which wrinkles along the pull."""

import numpy as np

from seatlook.solver.element.elastic import ElasticSheet
from seatlook.solver.methods.newton import Potential
from seatlook.solver.process.statics import equilibrium
from support import fabrics, meshes
from support.reference.counter_examples import sheet_of

LENGTH, WIDTH, MODULUS, POISSON = 0.25, 0.1, 1e6, 0.5
# Thickness 0.1 mm, stretch 10 %, regular grid with tension along its edges, h 1.25 mm:
# wave length [m] and amplitude over the thickness.
WAVE, AMPLITUDE = 13.35e-3, 3.22


def stretched(kind, h, *, seed=0, chords=False, thickness=1e-4, stretch=0.1, element="edgeslope"):
    """Half of the sheet in equilibrium: rest, positions; ``chords`` leaves out the arcs.

    Elements of the counter-examples do not know clamps: their ends turn freely.
    """
    X, T = meshes.rectangle(kind, LENGTH / 2, WIDTH, h, seed=seed)
    stiff = MODULUS * thickness / (1 - POISSON**2)
    fabric = fabrics.isotropic(stiff, stiff * thickness**2 / 12, POISSON, thickness=thickness)
    end, middle = X[:, 0] < 1e-9, X[:, 0] > LENGTH / 2 - 1e-9
    x = np.pad(X * [1 + stretch, 1.0], ((0, 0), (0, 1)))
    if element == "edgeslope":
        # The mirror at mid-length holds the slope along the sheet, the clamp all.
        held = end | middle
        sheet = ElasticSheet(X, T, np.zeros(len(T)), [fabric], clamped=held, positions=x)
    else:
        sheet = sheet_of(element, X, T, fabric)
    if chords:
        sheet.membrane._rows[2][:] = 0.0
        sheet.membrane._bow_offset[:] = 0.0
    free = np.repeat(~end[:, None], 3, axis=1)
    free[middle, 0] = False
    potential = Potential(sheet.energies, (), free)
    found = equilibrium(sheet, potential, x, "newton", tolerance=1e-3, max_iterations=None)
    assert found.residual <= 1e-3
    assert found.stable
    return X, found.x


def wave_and_amplitude(X, x, thickness=1e-4):
    """Wave length by zero crossings among the tall wrinkles at mid-length, half their range / t.

    No wave length (nan) of a sheet that is flat, or bulges without a train of waves.
    """
    middle = X[:, 0] > LENGTH / 2 - 1e-9
    order = np.argsort(X[middle, 1])
    y, z = x[middle][order, 1], x[middle][order, 2]
    if np.ptp(z) < 0.05 * thickness:
        return np.nan, 0.0
    at = np.flatnonzero(np.diff(np.sign(np.diff(z)))) + 1
    # A parabola through each extreme vertex and its neighbours.
    fits = [np.polyfit(y[i - 1 : i + 2] - y[i], z[i - 1 : i + 2], 2) for i in at]
    peaks = np.array([c - b**2 / (4 * a) for a, b, c in fits])
    tall = at[np.abs(peaks) > 0.4 * np.abs(peaks).max()]
    zero = np.flatnonzero(z[:-1] * z[1:] < 0)
    crossing = y[zero] - z[zero] * (y[zero + 1] - y[zero]) / (z[zero + 1] - z[zero])
    crossing = crossing[(crossing > y[tall[0]]) & (crossing < y[tall[-1]])]
    if len(crossing) < 2:
        return np.nan, np.abs(peaks).max() / thickness
    return 2 * np.diff(crossing).mean(), np.abs(np.diff(peaks)).max() / 2 / thickness
