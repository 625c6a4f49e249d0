"""Slow part of the foam's answer: its columns."""

from numba import njit


@njit(cache=True)
def column_energy(settlement, knots, stress, area, gradient, slope):
    """Energy of columns that gave way by ``settlement``; adds its gradient, fills its slope."""
    last, energy = len(stress) - 1, 0.0
    for i in range(len(area)):
        s, total, k = settlement[i], 0.0, 1
        while k < last and s > knots[i, k]:
            total += 0.5 * (stress[k - 1] + stress[k]) * (knots[i, k] - knots[i, k - 1])
            k += 1
        rise = (stress[k] - stress[k - 1]) / (knots[i, k] - knots[i, k - 1])
        rest = s - knots[i, k - 1]
        pressure = stress[k - 1] + rise * rest
        energy += area[i] * (total + 0.5 * (stress[k - 1] + pressure) * rest)
        gradient[i] += area[i] * pressure
        slope[i] = area[i] * rise
    return energy
