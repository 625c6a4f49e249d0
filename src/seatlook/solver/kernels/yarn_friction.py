"""Dry friction between yarns that turn on each other, within one step a potential of the shear."""

import numpy as np
from numba import njit


@njit(cache=True)
def rub(e, rest, limit, growth, spring):
    """Energy [J/m2], stress and stiffness [N/m] of friction at a shear ``e``.

    A spring from the shear ``rest`` at which friction carries nothing; it slips where its stress
    reaches ``limit + growth |e|`` of either sign.
    """
    high = slip(rest, limit, growth, spring)
    low = -slip(-rest, limit, growth, spring)
    if e > high:
        psi, s = beyond(high, e, rest, limit, growth, spring)
        return psi, s, growth if e >= 0.0 else -growth
    if e < low:
        psi, s = beyond(-low, -e, -rest, limit, growth, spring)
        return psi, -s, growth if e <= 0.0 else -growth
    d = e - rest
    return 0.5 * spring * d * d, spring * d, spring


@njit(cache=True)
def slip(rest, limit, growth, spring):
    """Shear at which the spring from ``rest`` begins to slip forward."""
    e = (limit + spring * rest) / (spring - growth)
    return e if e >= 0.0 else (limit + spring * rest) / (spring + growth)


@njit(cache=True)
def beyond(start, e, rest, limit, growth, spring):
    """Energy and stress past the slip at ``start``, which is followed to the shear ``e``."""
    d = start - rest
    rubbed = limit * (e - start) + 0.5 * growth * (e * abs(e) - start * abs(start))
    return 0.5 * spring * d * d + rubbed, limit + growth * abs(e)


@njit(cache=True)
def wear(E, fabric, constants, history):
    """Let friction rest where it would without the shears of E; ``history`` is rest and loss."""
    for t in range(len(E)):
        limit, growth, spring = constants[fabric[t]]
        if spring == 0.0:
            continue
        psi, s, _ = rub(E[t, 2], history[t, 0], limit, growth, spring)
        history[t, 0] = E[t, 2] - s / spring
        history[t, 1] += psi - 0.5 * s * s / spring


@njit(cache=True)
def friction(E, fabric, constants, history, out):
    """Fill ``out`` (m, 3): energy with what was lost before, stress and stiffness; 0 if none."""
    for t in range(len(E)):
        limit, growth, spring = constants[fabric[t]]
        out[t, :] = 0.0
        if spring == 0.0:
            continue
        psi, s, k = rub(E[t, 2], history[t, 0], limit, growth, spring)
        out[t, 0], out[t, 1], out[t, 2] = psi + history[t, 1], s, k


@njit(cache=True)
def load(rubbing, area, S):
    """Add the stress of friction to S (m, 3) [J], areas times stresses; return the energy [J]."""
    total = 0.0
    for t in range(len(rubbing)):
        total += area[t] * rubbing[t, 0]
        S[t, 2] += area[t] * rubbing[t, 1]
    return total


@njit(cache=True)
def stiffen(rubbing, natural, area, out):
    """Add the stiffness of friction to that of every triangle's edge strains, (m, 3, 3) [J]."""
    for t in range(len(area)):
        d = area[t] * rubbing[t, 2]
        for i in range(3):
            for j in range(3):
                out[t, i, j] += d * natural[t, 2, i] * natural[t, 2, j]


@njit(cache=True)
def loop(shears, limit, growth, spring):
    """Stress [N/m] of friction along a path of shears, taken into the history at every point."""
    rest = 0.0
    out = np.empty(len(shears))
    for i in range(len(shears)):
        _, out[i], _ = rub(shears[i], rest, limit, growth, spring)
        rest = shears[i] - out[i] / spring
    return out
