"""Curves of which a laboratory printed only LT, WT and RT."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import nnls

from seatlook.identify.fit import unit_tension
from seatlook.identify.tensile import force, force_back, green
from seatlook.io.laboratory.types import LabTest
from seatlook.model import Curve

_KNOTS = np.array([0.0, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0])
_POINTS = 400
_SOFTEST = 1e-3  # of the secant
_FIRM = 1e4  # weight of the numbers that are known over the shape that is assumed


@dataclass(frozen=True, slots=True)
class Printed:
    """LT, WT [J/m2], RT of a tension test up to a force [N/m].

    Examples
    --------
    >>> Printed(lt=0.6, wt=9.0, rt=0.65, peak=490.0).exponent.__round__(3)
    2.333
    """

    lt: float
    wt: float
    rt: float
    peak: float

    @property
    def strain(self) -> float:
        """Engineering strain at the peak, by the definition of LT."""
        return 2.0 * self.wt / (self.lt * self.peak)

    @property
    def exponent(self) -> float:
        """Exponent of ``F = Fm (e/em)^n`` of this linearity: WT is Fm em / (n + 1)."""
        return 2.0 / self.lt - 1.0


def printed(test: LabTest) -> Printed:
    """Return the numbers of a test."""
    given = test.numbers
    names = ("lt", "wt_gf_cm_per_cm2", "rt_percent", "peak_gf_per_cm")
    return Printed(*(given[name] for name in names))


def curves_of(numbers: Printed) -> tuple[Curve, Curve]:
    """Return loading and unloading: power laws through the three numbers.

    The way back has the same exponent and starts at ``em (1 - RT)``: three numbers leave no more.
    """
    em, n = numbers.strain, numbers.exponent
    loading = _power(em, n, numbers.peak, numbers.wt, 0.0)
    set_ = em * (1.0 - numbers.rt)
    unloading = _power(em, n, numbers.peak, numbers.wt * numbers.rt, set_)
    return loading, unloading


def reading(loading: Curve, unloading: Curve | None, strain: float) -> Printed:
    """Return LT, WT and RT of curves that are drawn to an engineering strain and let back."""
    e = np.linspace(0.0, strain, 4001)
    out = force(loading, e)
    back = out if unloading is None else force_back(loading, unloading, e, strain)
    wt, peak = float(np.trapezoid(out, e)), float(out[-1])
    return Printed(
        lt=2.0 * wt / (peak * strain), wt=wt, rt=float(np.trapezoid(back, e)) / wt, peak=peak
    )


def _power(em: float, n: float, peak: float, work: float, start: float) -> Curve:
    """Curve over the Green strain from ``start``, with this work and this peak at ``em``."""
    e = np.linspace(start, em, _POINTS)
    F = peak * ((e - start) / (em - start)) ** n
    E = green(e) - green(start)
    knots = _KNOTS * float(E[-1])
    tension = np.column_stack([unit_tension(knots, i, E) for i in range(len(knots))])
    nominal = tension * (1.0 + e)[:, None]
    integral = np.asarray(np.trapezoid(nominal, e, axis=0))
    A = np.vstack([nominal / peak, _FIRM * nominal[-1:] / peak, _FIRM * integral[None] / work])
    floor = np.full(len(knots), _SOFTEST * peak / float(E[-1]))
    aim = np.concatenate([F / peak, [_FIRM, _FIRM]])
    found, _ = nnls(A, aim - A @ floor)
    return Curve(strain=knots, stiffness=found + floor)
