"""Extensible planar elastica of a strip under its own weight, the reference of the solver."""

import numpy as np
from scipy.integrate import solve_bvp


def hanging_tip(gamma, slenderness):
    """Tip (x, z) of a clamped strip of length 1, level at the clamp, for Gamma = q L^3 / B.

    ``slenderness`` t/L sets the stretch: N = EA e (1 + e)(1 + e/2) with EA = 12 B / t^2, the
    second Piola-Kirchhoff law of the sheet; infinite EA for 0.
    """
    stretch = slenderness**2 / 12.0

    def extension(tension):
        e = stretch * tension
        for _ in range(30):
            e = e - ((1 + e) * (e + 0.5 * e * e) - stretch * tension) / (1 + 3 * e + 1.5 * e * e)
        return e

    def rates(s, y):
        weight = gamma * (1 - s)
        e = extension(-weight * np.sin(y[0]))
        along, across = (1 + e) * np.cos(y[0]), (1 + e) * np.sin(y[0])
        return np.stack([y[1], weight * along, along, across])

    def ends(a, b):
        return np.array([a[0], b[1], a[2], a[3]])

    s = np.linspace(0, 1, 401) ** 2
    guess = np.zeros((4, len(s)))
    for load in np.geomspace(min(1.0, gamma), gamma, 12) if gamma > 1 else [gamma]:
        full, gamma = gamma, load
        solved = solve_bvp(rates, ends, s, guess, tol=1e-8, max_nodes=100000)
        gamma = full
        if not solved.success:
            raise RuntimeError(solved.message)
        s, guess = solved.x, solved.y
    return solved.y[2, -1], solved.y[3, -1]


def blown_tip(pressure):
    """Tip (x, z) of a strip of length 1 and stiffness 1, clamped level, blown up from below.

    The pressure stays normal to the strip, which does not stretch.
    """

    def rates(s, y, load):
        bend, shear, pull = y[1], y[2], y[3]
        return np.stack(
            [bend, -shear, -load - pull * bend, shear * bend, np.cos(y[0]), np.sin(y[0])]
        )

    def ends(a, b):
        return np.array([a[0], b[1], b[2], b[3], a[4], a[5]])

    s, guess = np.linspace(0, 1, 200), np.zeros((6, 200))
    for load in np.linspace(0, pressure, 12)[1:]:
        solved = solve_bvp(lambda s, y, q=load: rates(s, y, q), ends, s, guess, tol=1e-8)
        if not solved.success:
            raise RuntimeError(solved.message)
        s, guess = solved.x, solved.y
    return guess[4, -1], guess[5, -1]
