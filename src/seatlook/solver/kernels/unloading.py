"""What a fabric's tension lacks on the way back from its peak."""

import numpy as np
from numba import njit

from seatlook.solver.kernels.membrane import curve


@njit(cache=True)
def wear(E, fabric, loading, counts, back, back_counts, history):
    """Raise the peaks to the strains E; ``history`` (m, 2, 3) is peak, set [1] and loss [J/m2]."""
    for t in range(len(E)):
        f = fabric[t]
        for axis in range(2):
            e = E[t, axis]
            if back_counts[f, axis] == 0 or e <= max(history[t, axis, 0], 0.0):
                continue
            energy_out, s, _ = curve(loading, counts, f, axis, e)
            start = strain_at(back, back_counts, f, axis, s)
            energy_back, _, _ = curve(back, back_counts, f, axis, start)
            history[t, axis, 0], history[t, axis, 1] = e, e - start
            history[t, axis, 2] = energy_out - energy_back


@njit(cache=True)
def strain_at(tables, counts, f, axis, s):
    """Strain at which a curve reaches the tension s > 0."""
    i = counts[f, axis] - 1
    while i > 0 and s < tables[f, axis, i, 2]:
        i -= 1
    k, rest = tables[f, axis, i, 1], s - tables[f, axis, i, 2]
    root = np.sqrt(k * k + 2.0 * tables[f, axis, i, 4] * rest)
    return tables[f, axis, i, 0] + 2.0 * rest / (k + root)


@njit(cache=True)
def lack(E, fabric, loading, counts, back, back_counts, history, out):
    """Fill ``out`` (m, 2, 3): energy, stress and stiffness of the way back less the way out.

    Zero from the peak on, and everywhere in a fabric that goes back as it came.
    """
    for t in range(len(E)):
        f = fabric[t]
        for axis in range(2):
            e = E[t, axis]
            out[t, axis, :] = 0.0
            if back_counts[f, axis] == 0 or e >= history[t, axis, 0]:
                continue
            psi, s, k = curve(back, back_counts, f, axis, e - history[t, axis, 1])
            psi_out, s_out, k_out = curve(loading, counts, f, axis, e)
            out[t, axis, 0] = psi + history[t, axis, 2] - psi_out
            out[t, axis, 1] = s - s_out
            out[t, axis, 2] = k - k_out


@njit(cache=True)
def relieve(lacking, area, S):
    """Add the lacking stress to S (m, 3) [J], areas times stresses; return the energy [J]."""
    total = 0.0
    for t in range(len(lacking)):
        a = area[t]
        total += a * (lacking[t, 0, 0] + lacking[t, 1, 0])
        S[t, 0] += a * lacking[t, 0, 1]
        S[t, 1] += a * lacking[t, 1, 1]
    return total


@njit(cache=True)
def soften(lacking, natural, area, out):
    """Add the lacking stiffness to that of every triangle's edge strains, (m, 3, 3) [J]."""
    for t in range(len(area)):
        for c in range(2):
            d = area[t] * lacking[t, c, 2]
            for i in range(3):
                for j in range(3):
                    out[t, i, j] += d * natural[t, c, i] * natural[t, c, j]
