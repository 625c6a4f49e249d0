"""The methods on a bare sheet: from a start to a stable equilibrium."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.sparse import csc_array, diags_array

from seatlook.mesh import vertex_normals
from seatlook.model import FloatArray
from seatlook.solver.element.elastic import ElasticSheet
from seatlook.solver.energy import Energy
from seatlook.solver.kernels.lbfgs import largest_row
from seatlook.solver.methods.choice import Method, minimiser
from seatlook.solver.methods.explicit import Explicit
from seatlook.solver.methods.factor import Factor, Preconditioner, SplitFactor
from seatlook.solver.methods.lbfgs import Potential as Sum
from seatlook.solver.methods.newton import (
    BoolArray,
    Equilibrium,
    Potential,
    factorise,
    newton,
    push,
)

_PATIENCE = 30
_SOFTENING = (1e-4, 1e-2)
_KICK = 0.5  # thickness
_MOST_KICKS = 20
_ROUND = 50  # iterations between two looks at the residual, with one matrix
_TAUT = 1e-3  # of the membrane's stiffness, across the sheet
_HELD = 1e12  # N/m, of vertices that are held

MOST = {"newton": 300, "lbfgs": 10_000, "explicit": 4_000}  # iterations


def equilibrium(
    sheet: ElasticSheet,
    potential: Potential,
    x: FloatArray,
    method: Method,
    *,
    tolerance: float,
    max_iterations: int | None,
) -> Equilibrium:
    """Find a stable equilibrium; whatever the method, the exact Hessian decides.

    Parameters
    ----------
    max_iterations : ``MOST`` of the method if not given; that of L-BFGS once Newton's has buckled
    """
    name = method if isinstance(method, str) else "explicit"
    most = MOST.get(name, MOST["lbfgs"]) if max_iterations is None else max_iterations
    if method == "newton":
        state = _by_newton(sheet, potential, x, tolerance, most)
        most = MOST["lbfgs"] if max_iterations is None else most
    else:
        state = _descend(sheet, potential, x, method, tolerance=tolerance, most=most)
    for kicks in range(_MOST_KICKS + 1):
        if state.residual > tolerance:
            return state
        hessian = potential.hessian(state.x, definite=False)
        factor, downhill = factorise(hessian)
        state = replace(state, downhill=downhill, kicks=kicks)
        rest = most - state.iterations
        if downhill == 0 or kicks == _MOST_KICKS or rest <= 0:
            return state
        x = push(potential, state.x, hessian, factor, _KICK * sheet.thickness.max())
        descent = _descend(sheet, potential, x, method, tolerance=tolerance, most=rest)
        state = replace(
            descent,
            iterations=state.iterations + descent.iterations,
            energy=np.concatenate([state.energy, descent.energy]),
            kicks=kicks + 1,
        )
    return state


class _Free(Sum):
    """A potential whose gradient is zero where positions are held."""

    def __init__(self, potential: Potential) -> None:
        super().__init__((*potential.elastic, *potential.others))
        self._held = np.flatnonzero(~potential.free)

    def value(self, x: FloatArray, gradient: FloatArray) -> float:
        total = super().value(x, gradient)
        gradient.ravel()[self._held] = 0.0
        return total


class _FreeFactor:
    """A preconditioner that leaves held positions where they are."""

    def __init__(self, factor: Preconditioner, free: BoolArray) -> None:
        self._factor, self._free = factor, free

    def solve(self, right: FloatArray, out: FloatArray) -> None:
        self._factor.solve(right, out)
        out *= self._free


def _descend(
    sheet: ElasticSheet,
    potential: Potential,
    x: FloatArray,
    method: Method,
    *,
    tolerance: float,
    most: int,
) -> Equilibrium:
    """Minimise in rounds, each with a fresh matrix or fresh masses.

    Away from an unstable equilibrium the exact Hessian stays indefinite for long. There Newton's
    method gives way to L-BFGS, with the projected Hessian as its matrix.
    """
    x = np.array(x, dtype=np.float64, order="C")
    own = np.asarray(np.repeat(sheet.mass[:, None], 3, axis=1), dtype=np.float64)
    lower = minimiser("lbfgs" if method == "newton" else method, x.shape, own)
    reduced = _Free(potential)
    energy, gradient = potential.value(x)
    residual, iterations, history = potential.residual(x, gradient), 0, [energy]
    while residual > tolerance and iterations < most:
        limit = 0.9 * tolerance * potential.force_scale(x)
        factor = _matrix(sheet, potential, x, method)
        descent = lower.minimise(
            reduced,
            x,
            factor,
            stop=lambda g, limit=limit: largest_row(g) <= limit,  # type: ignore[misc]
            iterations=min(_ROUND, most - iterations),
        )
        iterations += max(descent.iterations, 1)
        energy, gradient = potential.value(x)
        residual = potential.residual(x, gradient)
        history.append(energy)
        if descent.stalled and descent.iterations == 0:
            break
    return Equilibrium(x, residual, np.array(history), iterations, -1, 0)


def _matrix(
    sheet: ElasticSheet, potential: Potential, x: FloatArray, method: Method
) -> _FreeFactor | None:
    """What stands for the Hessian in a minimiser; the explicit method needs nothing."""
    if isinstance(method, Explicit):
        return None
    if method != "newton":
        return _split(sheet, potential, x)
    terms = (*potential.elastic, *potential.others)
    parts = [term.hessian(x, definite=True) for term in terms]
    full = csc_array(sum(parts[1:], parts[0]))
    held = np.where(potential.free.ravel(), 1e-7 * float(full.diagonal().mean()), _HELD)
    return _FreeFactor(Factor(csc_array(full + diags_array(held))), potential.free)


def _split(sheet: ElasticSheet, potential: Potential, x: FloatArray) -> _FreeFactor:
    """Matrix along and across the sheet as it lies."""
    held = np.where(potential.free.any(axis=1), 0.0, _HELD)
    tied = ~potential.free.all(axis=1)
    normal = vertex_normals(x, sheet.faces)
    normal[tied] = 0.0
    along = sheet.stiffness()
    base = 1e-9 * float(along.diagonal().mean())
    firm = diags_array(held + base)
    across = sheet.across() + _TAUT * along + diags_array(held + base)
    parts = [k for term in potential.others if (k := term.stiffness()) is not None]
    for part in parts:
        along, across = along + part, across + part
    return _FreeFactor(
        SplitFactor(csc_array(along + firm), csc_array(across), normal), potential.free
    )


class _Softened:
    """An energy times a factor."""

    def __init__(self, energy: Energy, factor: float) -> None:
        self._energy, self._factor = energy, factor

    def value(self, x: FloatArray, gradient: FloatArray) -> float:
        part = np.zeros_like(x)
        energy = self._energy.value(x, part)
        gradient += self._factor * part
        return self._factor * energy

    def stiffness(self) -> csc_array | None:
        matrix = self._energy.stiffness()
        return None if matrix is None else csc_array(self._factor * matrix)

    def hessian(self, x: FloatArray, *, definite: bool = False) -> csc_array:
        return csc_array(self._factor * self._energy.hessian(x, definite=definite))


def _by_newton(
    sheet: ElasticSheet, potential: Potential, x: FloatArray, tolerance: float, most: int
) -> Equilibrium:
    """Newton's method; where a stiff membrane makes it crawl, first with a softer one.

    A thin sheet swings along arcs that Newton's straight steps stretch, so the line search allows
    only short ones. A softer membrane lets it swing; its shape is close to the right one.
    """
    few = min(_PATIENCE, most)
    direct = newton(potential, x, max_iterations=few, tolerance=tolerance)
    if direct.residual <= tolerance:
        return direct
    kick = _KICK * sheet.thickness.max()
    for factor in _SOFTENING:
        soft = (_Softened(sheet.membrane, factor), sheet.bending)
        eased = Potential(soft, potential.others, potential.free)
        x = newton(eased, x, max_iterations=most, tolerance=1e-2, kick=kick).x
    return newton(potential, x, max_iterations=most, tolerance=tolerance)
