"""Loops of shear and bending: an elastic part, and the friction between the way out and back."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from seatlook.identify.fit import (
    Fit,
    Unknowns,
    criterion,
    drift_rows,
    drifted,
    fit,
    together,
)
from seatlook.io.laboratory.types import LabTest
from seatlook.model import Curve, FloatArray, Hysteresis
from seatlook.solver.element.yarn_friction import friction_constants
from seatlook.solver.kernels.yarn_friction import loop

_LADDER = ((0.0,), (0.0, 1.0), (0.0, 0.5, 1.0))
_PILOTS = 6
_SHORTEST = 0.002  # of the reach, over which friction builds up at least


@dataclass(frozen=True, slots=True)
class Loop:
    """What the loops of all specimens say.

    Parameters
    ----------
    curve : elastic part over the shear 2 E12, or over the curvature
    friction : width, growth and the reach over which friction builds up
    sigma : (k,) of the curve's stiffness; ``friction_sigma`` (2,) of width and growth
    residual : RMS over the peak
    """

    curve: Curve
    friction: Hysteresis | None
    sigma: FloatArray
    friction_sigma: FloatArray
    residual: float
    reach: float
    peak: float


def identify_shear(test: LabTest) -> Loop:
    """Fit the shear curve and its friction to loops of force over shear angle.

    Simple shear with the jaws at a fixed distance: 2 E12 = tan(angle), and the pretension pulls its
    share of the force along the jaws, which is no stiffness of the cloth.
    """
    pull = test.numbers["pretension_n_per_m"]
    loops = []
    for one in test.specimens:
        x, y = np.tan(one.x), one.y
        loops.append(_oriented(x, y, pull * x))
    return _identify(loops, test.knots, _LADDER)


def identify_bending(test: LabTest) -> Loop:
    """Fit one stiffness [N m] and its friction [N] to loops of moment over curvature."""
    loops = [_oriented(one.x, one.y, np.zeros_like(one.x)) for one in test.specimens]
    return _identify(loops, None, _LADDER[:1], grows=False)


def loop_reading(curve: Curve, friction: Hysteresis | None, path: FloatArray) -> FloatArray:
    """Return what a loop tester reads along a path, from a piece that has never been turned.

    Examples
    --------
    >>> friction = Hysteresis(width=2.0, strain=0.01)
    >>> loop_reading(Curve.linear(100.0), friction, np.array([0.0, 0.1, 0.05])).tolist()
    [0.0, 11.0, 4.0]
    """
    elastic = np.sign(path) * curve.tension(np.abs(path))
    if friction is None:
        return np.asarray(elastic)
    rubbed = loop(np.ascontiguousarray(path), *friction_constants(friction))
    return np.asarray(elastic + rubbed)


def _oriented(x: FloatArray, y: FloatArray, share: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Count x so that it first goes up, y as x, less the share of y that is not the cloth's."""
    x = x * np.sign(x[int(np.abs(x).argmax())])
    y = y * np.sign(np.polyfit(x, y, 1)[0])
    return x, y - np.abs(share) * np.sign(x)


def _identify(
    loops: Sequence[tuple[FloatArray, FloatArray]],
    given: FloatArray | None,
    ladder: Sequence[Sequence[float]],
    *,
    grows: bool = True,
) -> Loop:
    reach = min(float(np.abs(x).max()) for x, _ in loops)
    choices = [np.array(s) * reach for s in ladder] if given is None else [given]
    knots = choices[0]
    if len(choices) > 1:
        knots = min(choices, key=lambda k: _score(loops[:_PILOTS], k, grows))
    fits = [_fit(x, y, knots, grows) for x, y in loops]
    k = len(knots)
    mean = together([Fit(f.values[: k + 3], f.covariance[: k + 3, : k + 3], 0.0) for f in fits])
    curve, friction = _parts(mean.values, k)
    rests = [
        (y - _model(f.values, x, k, knots)) / np.abs(y).max()
        for (x, y), f in zip(loops, fits, strict=True)
    ]
    return Loop(
        Curve(strain=knots, stiffness=curve), friction, mean.sigma[:k], mean.sigma[k : k + 2],
        float(np.sqrt(np.mean(np.concatenate(rests) ** 2))), reach,
        float(np.mean([np.abs(y).max() for _, y in loops])),
    )  # fmt: skip


def _parts(values: FloatArray, k: int) -> tuple[FloatArray, Hysteresis | None]:
    width, growth, strain = values[k : k + 3].tolist()
    if width <= 0.0:
        return values[:k], None
    # What the least squares may try on its way stays within what friction can be.
    growth = min(growth, 0.9 * width / strain, 1.9 * float(values[:k].min()))
    return values[:k], Hysteresis(width=width, growth=growth, strain=strain)


def _model(values: FloatArray, x: FloatArray, k: int, knots: FloatArray) -> FloatArray:
    stiffness, friction = _parts(values, k)
    path = x - values[k + 3]
    reading = loop_reading(Curve(strain=knots, stiffness=stiffness), friction, path)
    return np.asarray(reading + drifted(values[-2:], len(x)))


def _fit(x: FloatArray, y: FloatArray, knots: FloatArray, grows: bool) -> Fit:
    peak, reach = float(np.abs(y).max()), float(np.abs(x).max())
    secant, k = peak / reach, len(knots)
    width = max(_width(x, y), 1e-4 * peak)
    rows = [(0.8 * secant, 1e-4 * secant, 1e3 * secant, secant, np.inf)] * k
    rows.append((width, 1e-6 * peak, 2.0 * peak, 0.1 * peak, np.inf))
    # Without growth the number is held at nothing.
    rows.append((0.0, 0.0, (20.0 if grows else 1e-9) * secant, secant, np.inf))
    least, most = _SHORTEST * reach, 0.25 * reach
    rows.append((0.05 * reach, least, most, 0.02 * reach, np.inf))
    rows.append((0.0, -0.05 * reach, 0.05 * reach, 0.01 * reach, 0.01 * reach))
    rows += drift_rows(peak)
    return fit(lambda values: _model(values, x, k, knots), y, Unknowns.rows(*rows))


def _width(x: FloatArray, y: FloatArray) -> float:
    """Width of a loop where x is 0, from its crossings; 0 where it has only one."""
    cross = np.flatnonzero(np.diff(np.sign(x)) != 0)
    if len(cross) < 2:
        return 0.0
    at = [float(np.interp(0.0, *_rising(x[i : i + 2], y[i : i + 2]))) for i in cross[-2:]]
    return abs(at[1] - at[0])


def _rising(x: FloatArray, y: FloatArray) -> tuple[FloatArray, FloatArray]:
    order = np.argsort(x)
    return x[order], y[order]


def _score(loops: Sequence[tuple[FloatArray, FloatArray]], knots: FloatArray, grows: bool) -> float:
    """How good a choice of knots is; the lower, the better."""
    residuals = [_fit(x, y, knots, grows).residual / np.abs(y).max() for x, y in loops]
    return criterion(residuals, [len(y) for _, y in loops], len(knots))
