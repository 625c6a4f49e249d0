"""A strip that hangs over an edge by its own weight: the exact inextensible elastica."""

from __future__ import annotations

from functools import cache

import numpy as np
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline
from scipy.optimize import least_squares

from seatlook import mesh
from seatlook.model import FloatArray

_FLATTEST, _STEEPEST = 0.3, 89.995  # degrees of the tip
_STRIPS = 400


def load_of_angle(angle: FloatArray) -> FloatArray:
    """Return w l^3 / B of a strip whose chord from clamp to tip hangs by ``angle`` [rad].

    Parameters
    ----------
    angle : (k,) below the horizontal, 1 to 80 degrees

    Examples
    --------
    >>> load_of_angle(np.radians([41.5, 43.0])).round(3).tolist()
    [8.004, 8.516]
    """
    angles, loads = _table()
    return np.asarray(np.exp(CubicSpline(angles, np.log(loads))(angle)))


def outline(load: float, count: int = 101) -> FloatArray:
    """Return points (count, 2) of the strip, from the clamp, lengths 1: along and down."""
    _, loads = _table()
    tips = _tips()
    tip = float(np.exp(CubicSpline(np.log(loads), np.log(tips))(np.log(load))))
    s, x, z, _ = _hang(tip)
    at = np.linspace(0.0, s[-1], count)
    along, down = CubicSpline(s, x)(at), CubicSpline(s, z)(at)
    points = np.column_stack([along[-1] - along, down[-1] - down])[::-1] / s[-1]
    return np.asarray(points)


def load_of_outline(points: FloatArray) -> tuple[float, float, float]:
    """Fit the elastica to a traced outline.

    Parameters
    ----------
    points : (k, 2) [m]   from the clamp to the tip, along and down

    Returns
    -------
    w l^3 / B, the length [m] that hangs over, and the RMS distance [m] of the points
    """
    length = mesh.length(points)
    chord = points[-1] - points[0]
    start = float(np.log(load_of_angle(np.clip(np.arctan2(chord[1], chord[0]), 0.02, 1.39))))

    def misfit(unknowns: FloatArray) -> FloatArray:
        size = np.exp(unknowns[1])
        curve = points[0] + unknowns[2:] * length + outline(float(np.exp(unknowns[0]))) * size
        return _distance(points, curve) / length

    loads = _table()[1]
    low, high = np.log([loads[0], loads[-1]])
    solved = least_squares(
        misfit, [np.clip(start, low + 1e-6, high - 1e-6), np.log(length), 0.0, 0.0],
        bounds=([low, np.log(0.8 * length), -0.05, -0.05],
                [high, np.log(1.25 * length), 0.05, 0.05]),
    )  # fmt: skip
    size = float(np.exp(solved.x[1]))
    return float(np.exp(solved.x[0])), size, float(np.sqrt(np.mean(solved.fun**2)) * length)


def _distance(points: FloatArray, curve: FloatArray) -> FloatArray:
    """Distance (k,) of points from a polyline, and of its tip from the last of them."""
    a, b = curve[:-1], curve[1:]
    along = b - a
    offset = points[:, None] - a
    share = np.clip((offset * along).sum(axis=2) / (along * along).sum(axis=1), 0.0, 1.0)
    gap = offset - share[..., None] * along
    nearest = np.linalg.norm(gap, axis=2).argmin(axis=1)
    rows = np.arange(len(points))
    side = along[nearest, 0] * gap[rows, nearest, 1] - along[nearest, 1] * gap[rows, nearest, 0]
    signed = np.sign(side) * np.linalg.norm(gap[rows, nearest], axis=1)
    signed[-1] = np.linalg.norm(points[-1] - curve[-1])
    return np.asarray(signed)


def _hang(tip: float) -> tuple[FloatArray, FloatArray, FloatArray, float]:
    """Shape from the tip to where the strip is level, with w = B = 1.

    From the tip the moment is known to be 0 and its rate the weight below, so that no shooting is
    needed; the length at which the strip is level is the cube root of the load.
    """

    def rates(s: float, y: FloatArray) -> list[float]:
        return [-y[1], s * np.cos(y[0]), np.cos(y[0]), np.sin(y[0])]

    def level(s: float, y: FloatArray) -> float:
        return float(y[0])

    level.terminal = True  # type: ignore[attr-defined]
    solved = solve_ivp(
        rates, (0.0, 60.0), [tip, 0.0, 0.0, 0.0], events=level, rtol=1e-10, atol=1e-12,
        dense_output=True,
    )  # fmt: skip
    assert solved.t_events is not None
    assert solved.sol is not None
    length = float(solved.t_events[0][0])
    s = np.linspace(0.0, length, _STRIPS + 1)
    _, _, x, z = solved.sol(s)
    return s, x, z, float(np.arctan2(z[-1], x[-1]))


@cache
def _tips() -> FloatArray:
    # Close to the vertical, where the load goes with the logarithm of what is missing to it.
    steep = 90.0 - np.geomspace(45.0, 90.0 - _STEEPEST, 60)
    flat = np.geomspace(_FLATTEST, 45.0, 50)[:-1]
    return np.asarray(np.radians(np.concatenate([flat, steep])))


@cache
def _table() -> tuple[FloatArray, FloatArray]:
    """Angle of the chord and w l^3 / B for every angle of the tip."""
    hung = [_hang(float(tip)) for tip in _tips()]
    return np.array([h[3] for h in hung]), np.array([h[0][-1] ** 3 for h in hung])
