"""L-BFGS with a prefactored matrix as its first guess of the Hessian."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_array

from seatlook.model import FloatArray
from seatlook.solver.energy import Energy
from seatlook.solver.kernels import lbfgs as kernel
from seatlook.solver.methods.factor import Preconditioner, Renewed

_SHORTEST = 1e-10  # part of the full step; shorter ones are lost in rounding
_ROUNDING = 1e-12  # of the value; smaller changes are rounding, and the slope decides
_CUT = 0.1  # part of the full step; shorter ones tell that matrix and pairs are out of date
_FLATTER = 0.8  # of the slope, in size, that such a step must end with


class Potential:
    """Sum of energies."""

    def __init__(self, energies: Sequence[Energy]) -> None:
        self.energies = tuple(energies)

    def value(self, x: FloatArray, gradient: FloatArray) -> float:
        """Return the sum [J] and fill ``gradient`` [N]."""
        gradient.fill(0.0)
        total = 0.0
        for energy in self.energies:
            total += energy.value(x, gradient)
        return total

    def stiffness(self) -> csc_array:
        """Sum of the scalar stiffness matrices (n, n)."""
        parts = [k for e in self.energies if (k := e.stiffness()) is not None]
        return csc_array(sum(parts[1:], parts[0]))

    def hessian(self, x: FloatArray, *, definite: bool = False) -> csc_array:
        """Sum of the second derivatives (3n, 3n)."""
        parts = [e.hessian(x, definite=definite) for e in self.energies]
        return csc_array(sum(parts[1:], parts[0]))

    def dormant(self, x: FloatArray) -> FloatArray:
        """Stiffness [N/m], flattened, that may wake beside that of the Hessian, as contact does."""
        return np.zeros(x.size)


@dataclass(frozen=True, slots=True)
class Descent:
    """How a minimisation went."""

    value: float
    iterations: int
    evaluations: int
    stalled: bool


class Lbfgs:
    """Minimiser with its memory allocated once.

    Parameters
    ----------
    shape : of the unknowns, (n, 3)
    memory : number of pairs
    step_cap : float [m]   longest way a vertex may go in one iteration
    """

    ARMIJO = 1e-4

    def __init__(self, shape: tuple[int, int], *, memory: int = 8, step_cap: float = 0.02) -> None:
        self.memory, self.step_cap = memory, step_cap
        self._s = np.zeros((memory, *shape))
        self._y = np.zeros((memory, *shape))
        self._rho, self._alpha = np.zeros(memory), np.zeros(memory)
        self.gradient = np.zeros(shape)
        self._trial_gradient, self._trial = np.zeros(shape), np.zeros(shape)
        self._direction, self._work = np.zeros(shape), np.zeros(shape)
        self._share = 1.0

    def minimise(
        self,
        potential: Potential,
        x: FloatArray,
        factor: Preconditioner | None,
        *,
        stop: Callable[[FloatArray], bool],
        iterations: int,
    ) -> Descent:
        """Lower the potential in place of ``x``; every step obeys Armijo's rule, up to rounding.

        ``stop`` looks at the gradient, which stays readable as ``self.gradient``. Where a fresh
        matrix can be had, pairs that led to a step cut short are forgotten for one: they come from
        before a contact or a fold, and lead on into it.
        """
        value = potential.value(x, self.gradient)
        pairs, evaluations = 0, 1
        for iteration in range(iterations):
            if stop(self.gradient):
                return Descent(value, iteration, evaluations, stalled=False)
            self._turn(factor, pairs)
            slope = kernel.dot(self._direction, self.gradient)
            if not slope < 0.0:
                pairs = 0
                self._turn(factor, pairs)
                slope = kernel.dot(self._direction, self.gradient)
            new, tries = self._search(potential, x, value, slope)
            evaluations += tries
            if new is None:
                if pairs == 0:
                    return Descent(value, iteration, evaluations, stalled=True)
                pairs = 0
                continue
            pairs = self._remember(x, pairs)
            value = new
            if self._share < _CUT and isinstance(factor, Renewed):
                pairs = 0
                factor.expire()
        return Descent(value, iterations, evaluations, stalled=False)

    def _turn(self, factor: Preconditioner | None, pairs: int) -> None:
        """Two-loop recursion over the last ``min(pairs, memory)`` pairs."""
        q, work = self._direction, self._work
        np.negative(self.gradient, out=work)
        kernel.first_loop(work, self._s, self._y, self._rho, self._alpha, pairs)
        if factor is None:
            np.copyto(q, work)
        else:
            factor.solve(work, q)
        kernel.second_loop(q, self._s, self._y, self._rho, self._alpha, pairs)

    def _search(
        self, potential: Potential, x: FloatArray, value: float, slope: float
    ) -> tuple[float | None, int]:
        """Backtrack by parabolas until Armijo's rule holds; leaves the trial point and gradient.

        Near rest the value falls by less than it is rounded by. There a step is taken that makes
        the slope flatter, which says the same of a parabola (Hager and Zhang 2005).
        """
        longest = kernel.largest_row(self._direction)
        step = min(1.0, self.step_cap / longest) if longest > 0 else 0.0
        tries = 0
        while step > _SHORTEST:
            tries += 1
            kernel.add_scaled(x, step, self._direction, self._trial)
            new = potential.value(self._trial, self._trial_gradient)
            self._share = step
            if new <= value + self.ARMIJO * step * slope:
                return new, tries
            if new <= value + _ROUNDING * abs(value):
                end_slope = kernel.dot(self._direction, self._trial_gradient)
                if abs(end_slope) <= -_FLATTER * slope:
                    return new, tries
            excess = new - value - step * slope
            if not np.isfinite(excess):
                step *= 0.1
            else:
                step *= min(max(-0.5 * step * slope / excess, 0.1), 0.5)
        return None, tries

    def _remember(self, x: FloatArray, pairs: int) -> int:
        """Store the accepted pair, move ``x`` there; a pair without positive curvature is left."""
        i = pairs % self.memory
        np.subtract(self._trial, x, out=self._work)
        np.subtract(self._trial_gradient, self.gradient, out=self._direction)
        curvature = kernel.dot(self._work, self._direction)
        norm = kernel.dot(self._direction, self._direction)
        np.copyto(x, self._trial)
        np.copyto(self.gradient, self._trial_gradient)
        if curvature <= 1e-14 * norm or norm == 0.0:
            return pairs
        np.copyto(self._s[i], self._work)
        np.copyto(self._y[i], self._direction)
        self._rho[i] = 1.0 / curvature
        return pairs + 1
