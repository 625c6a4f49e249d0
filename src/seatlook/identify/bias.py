"""Bias extension: a strip at 45 degrees whose yarns turn, or whose sheet stretches."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import nnls

from seatlook.identify.fit import unit_tension
from seatlook.io.laboratory.types import LabTest
from seatlook.model import Curve, FloatArray

SWITCH = 0.031  # G over Ea beyond which yarns stretch as they turn; gallery/bias_extension.py
_KNOTS = 9
_STEPS = 64  # of the grid on which the recursion runs
_SOFTEST = 1e-3  # of the mean stiffness: a curve may not fall
_SLIP_DEG = 40.0  # beyond, yarns slip and the angle is not that of the kinematics


@dataclass(frozen=True, slots=True)
class Frame:
    """A strip of length H and width W [m], yarns at 45 degrees, inextensible.

    Three regions: sheared by the angle g, by g/2, and not at all.
    """

    length: float
    width: float

    @property
    def core(self) -> float:
        """Length of the diagonal by which all turns, H - W [m]."""
        return self.length - self.width

    def angle(self, displacement: FloatArray) -> FloatArray:
        """Shear angle [rad] of the middle at a displacement [m] of the jaws."""
        share = (self.core + np.asarray(displacement)) / (np.sqrt(2.0) * self.core)
        return np.asarray(np.pi / 2.0 - 2.0 * np.arccos(np.clip(share, 0.0, 1.0)))

    def displacement(self, angle: FloatArray) -> FloatArray:
        """Displacement [m] of the jaws at a shear angle [rad]."""
        share = np.sqrt(2.0) * np.cos(np.pi / 4.0 - 0.5 * np.asarray(angle))
        return np.asarray(self.core * (share - 1.0))

    def force(self, angle: FloatArray, shear: FloatArray, half: FloatArray) -> FloatArray:
        """Force [N] of the jaws, from the shear forces [N/m] at the angle and at its half."""
        g, H, W = np.asarray(angle), self.length, self.width
        work = (2.0 * H - 3.0 * W) * np.cos(g) * shear + W * np.cos(0.5 * g) * half
        return np.asarray(work / ((H / W - 1.0) * (np.cos(0.5 * g) - np.sin(0.5 * g))))


def shear_force(frame: Frame, angle: FloatArray, force: FloatArray) -> FloatArray:
    """Shear force [N/m] over rising angles [rad] from the forces [N] of the jaws.

    Energy normalisation: what the jaws do is what the two sheared regions take up; the one at half
    the angle is known from smaller angles. 2 E12 is the sine of the angle, and this force is
    S12 then, without a further factor.

    Sources: Cao et al. 2008 (doi 10.1016/j.compositesa.2008.02.016), Harrison et al. 2008.
    """
    grid = np.linspace(0.0, float(angle[-1]), _STEPS * max(len(angle), 8) + 1)
    F = np.interp(grid, np.append(0.0, angle), np.append(0.0, force))
    unit, zero = np.ones_like(grid), np.zeros_like(grid)
    own, other = frame.force(grid, unit, zero), frame.force(grid, zero, unit)
    out = np.zeros_like(grid)
    # The first step is a straight line from 0: half the angle carries half the force.
    out[1] = F[1] / (own[1] + 0.5 * other[1])
    for i in range(2, len(grid)):
        half = 0.5 * (out[i // 2] + out[(i + 1) // 2])
        out[i] = (F[i] - other[i] * half) / own[i]
    return np.asarray(np.interp(angle, grid, out))


def identify_bias(test: LabTest) -> tuple[Curve, FloatArray, float, float]:
    """Fit the shear curve to force over displacement of bias strips, without a further step.

    The forces are linear in the stiffness at the knots, so non-negative least squares find the one
    curve that rises; noise needs no smoothing beforehand.

    Returns
    -------
    curve over 2 E12, standard error of its stiffness, RMS residual over the peak, largest 2 E12
    """
    assert test.length is not None
    assert test.width is not None
    frame = Frame(test.length, test.width)
    pairs = [_oriented(one.x, one.y) for one in test.specimens]
    reach = min(float(np.sin(frame.angle(x.max()))) for x, _ in pairs)
    reach = min(reach, float(np.sin(np.radians(_SLIP_DEG))))
    knots = np.linspace(0.0, reach, _KNOTS) if test.knots is None else test.knots
    solved = [_solve(frame, x, y, knots, reach) for x, y in pairs]
    stiffness = np.array([one[0] for one in solved])
    residual = float(np.sqrt(np.mean([one[1] ** 2 for one in solved])))
    sigma = np.full(len(knots), np.nan)
    if len(solved) > 2:
        sigma = stiffness.std(axis=0, ddof=1) / np.sqrt(len(solved))
    return Curve(strain=knots, stiffness=stiffness.mean(axis=0)), sigma, residual, reach


def strip_force(frame: Frame, curve: Curve, displacement: FloatArray) -> FloatArray:
    """Force [N] of the jaws of a strip of this shear curve, inextensible along its yarns."""
    g = frame.angle(displacement)
    return frame.force(g, curve.tension(np.sin(g)), curve.tension(np.sin(0.5 * g)))


def shear_modulus(strip: float, warp: float, weft: float, poisson: float) -> float:
    """Shear stiffness [N/m] of an extensible sheet, from the first slope of a strip at 45 degrees.

    ``1/G = 4/E45 - 1/Ea - 1/Eb + 2 nu/Ea`` with the slopes of free strips [N/m].

    Examples
    --------
    >>> round(shear_modulus(1000.0, 1000.0, 1000.0, 0.3), 2)  # isotropic: E / 2 (1 + nu)
    384.62
    """
    inverse = 4.0 / strip - 1.0 / warp - 1.0 / weft + 2.0 * poisson / warp
    return 1.0 / max(inverse, 1e-12)


def _oriented(x: FloatArray, y: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The way out, counted positive from the length without load."""
    x = x * np.sign(x[int(np.abs(x).argmax())])
    turn = int(x.argmax()) + 1
    x, y = x[:turn], y[:turn]
    return x, y * (np.sign(np.polyfit(x, y, 1)[0]) or 1.0)


def _solve(
    frame: Frame, x: FloatArray, y: FloatArray, knots: FloatArray, reach: float
) -> tuple[FloatArray, float]:
    """Stiffness at the knots, and the RMS of the residual over the peak."""
    keep = np.sin(frame.angle(x)) <= reach * (1.0 + 1e-9)
    x, y = x[keep], y[keep]
    floor = _SOFTEST * y.max() / x.max()
    columns = [_unit_force(frame, knots, i, x) for i in range(len(knots))]
    A = np.column_stack([*columns, np.ones_like(x), -np.ones_like(x)])
    lift = A[:, : len(knots)].sum(axis=1) * floor
    found, _ = nnls(A, y - lift)
    rest = A @ found + lift - y
    return found[: len(knots)] + floor, float(np.sqrt(np.mean(rest**2)) / y.max())


def _unit_force(frame: Frame, knots: FloatArray, i: int, x: FloatArray) -> FloatArray:
    """Force of the jaws by a stiffness of 1 N/m at knot ``i`` alone."""
    g = frame.angle(x)
    return frame.force(
        g, unit_tension(knots, i, np.sin(g)), unit_tension(knots, i, np.sin(0.5 * g))
    )
