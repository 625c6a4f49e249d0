"""Pressing: the thickness of a cloth under a stated pressure, and the column curve of a foam."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import nnls

from seatlook.errors import InputError
from seatlook.identify.fit import Estimate
from seatlook.io.laboratory.types import LabTest, Specimen
from seatlook.model import FloatArray, FoamMaterial

# Where foams change their course: the rise, the plateau, densification.
_KNOTS = np.array([0.0, 0.025, 0.05, 0.10, 0.15, 0.25, 0.40, 0.50, 0.60, 0.70, 0.80, 0.90])
_SMALL = 0.05  # strain up to which the first slope is that of small waves
_RISE = 1e-3  # of the mean slope: a curve may not be level
CLD = 0.40


@dataclass(frozen=True, slots=True)
class FoamCurve:
    """Compression of a foam, out and back, over the strains [1] of its knots; stresses in Pa."""

    strain: FloatArray
    stress: FloatArray
    back: FloatArray | None
    sigma: FloatArray
    residual: float

    @property
    def cld40(self) -> float:
        """Stress [Pa] at 40 %."""
        return float(np.interp(CLD, self.strain, self.stress))

    @property
    def hysteresis(self) -> float | None:
        """Share of the work of pressing that does not come back."""
        if self.back is None:
            return None
        return float(1.0 - np.trapezoid(self.back, self.strain)
                     / np.trapezoid(self.stress, self.strain))  # fmt: skip

    @property
    def young(self) -> float:
        """Secant [Pa] of the first 5 %."""
        return float(np.interp(_SMALL, self.strain, self.stress)) / _SMALL


def thickness_under(test: LabTest) -> Estimate:
    """Thickness [m] under the stated pressure, of every specimen by its own curve.

    Raises
    ------
    InputError
        The pressure was not reached.
    """
    at = test.numbers["at_pa"]
    found = []
    for one in test.specimens:
        order = np.argsort(one.x[: int(one.x.argmax()) + 1])
        x, y = one.x[order], one.y[order]
        if not x[0] <= at <= x[-1]:
            raise InputError.single(
                f"{test.name}.at_pa", got=f"{at:g} Pa", expected=f"{x[0]:.4g} to {x[-1]:.4g} Pa",
                file=one.file, line=int(one.lines[-1]),
            )  # fmt: skip
        found.append(float(np.interp(np.log(at), np.log(np.maximum(x, 1e-9)), y)))
    error = np.std(found, ddof=1) / np.sqrt(len(found)) if len(found) > 1 else 0.0
    return Estimate(np.array([np.mean(found)]), np.array([float(error)]))


def identify_foam(test: LabTest) -> FoamCurve:
    """Fit the rising curve of a foam to its cycles; the last cycle of a record counts.

    The first ones break cells that a seat in use has broken long ago.
    """
    pairs = [_last_cycle(one) for one in test.specimens]
    reach = min(float(out[0].max()) for out, _ in pairs)
    knots = _KNOTS[0.98 * reach > _KNOTS]
    knots = np.append(knots, reach)
    outs = [_rising(*out, knots) for out, _ in pairs]
    backs = [_rising(*back, knots) for _, back in pairs if len(back[0]) > 4]
    stress = np.mean([one[0] for one in outs], axis=0)
    back = None
    if len(backs) == len(pairs):
        back = np.minimum(np.mean([one[0] for one in backs], axis=0), stress)
        back[0] = 0.0
    scatter = np.std([one[0] for one in outs], axis=0, ddof=1) if len(outs) > 1 else 0.0 * stress
    residual = float(np.sqrt(np.mean([one[1] ** 2 for one in outs])))
    return FoamCurve(knots, stress, back, scatter / np.sqrt(len(outs)), residual)


def foam_of(curve: FoamCurve, base: FoamMaterial, name: str) -> FoamMaterial:
    """Return a foam of this curve, with Poisson's ratio and friction of another one."""
    return replace(
        base, name=name, strain=curve.strain, stress=curve.stress, young=curve.young,
        unloading_stress=curve.back,
    )  # fmt: skip


Pair = tuple[FloatArray, FloatArray]


def _last_cycle(one: Specimen) -> tuple[Pair, Pair]:
    """Strain and stress of the last way out and the last way back."""
    e, s = np.abs(one.x), one.y * np.sign(one.y[int(np.abs(one.y).argmax())])
    high = e > 0.98 * e.max()
    turn = int(np.flatnonzero(high)[-1])
    before = np.flatnonzero(np.diff(np.concatenate([[0], (e[: turn + 1] > 0.5 * e.max())
                                                    .astype(int)])) == 1)  # fmt: skip
    start = 0
    if len(before) > 1:
        low = slice(int(before[-2]), int(before[-1]))
        start = low.start + int(e[low].argmin())
    top = start + int(e[start : turn + 1].argmax())
    return (e[start : top + 1], s[start : top + 1]), (e[top:], s[top:])


def _rising(e: FloatArray, s: FloatArray, knots: FloatArray) -> tuple[FloatArray, float]:
    """Stress at the knots of the rising polygon through the points, and its residual."""
    keep = e <= knots[-1] * (1.0 + 1e-9)
    e, s = e[keep], s[keep]
    steps = np.diff(knots)
    A = np.clip((e[:, None] - knots[:-1]) / steps, 0.0, 1.0)
    floor = _RISE * s.max() * steps / knots[-1]
    found, _ = nnls(A, s - A @ floor)
    stress = np.concatenate([[0.0], np.cumsum(found + floor)])
    rest = A @ (found + floor) - s
    return stress, float(np.sqrt(np.mean(rest**2)) / s.max())
