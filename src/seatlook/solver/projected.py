"""Newton's method for time steps: the exact Hessian where positive, else the projected one."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from seatlook.model import FloatArray
from seatlook.solver.factor import Factor, Preconditioner
from seatlook.solver.kernels import lbfgs as kernel
from seatlook.solver.lbfgs import Descent, Potential
from seatlook.solver.newton import factorise

_ARMIJO, _SHORTEST = 1e-4, 1e-10


class ProjectedNewton:
    """Minimiser that factors a Hessian in every iteration.

    The projection is analytic: membrane stress loses its compressive part, contact its curvature;
    bending, ties and friction are never negative.

    Parameters
    ----------
    shape : of the unknowns, (n, 3)
    step_cap : float [m]   longest way a vertex may go in one iteration
    """

    def __init__(self, shape: tuple[int, int], *, step_cap: float = 0.02) -> None:
        self.step_cap = step_cap
        self.gradient = np.zeros(shape)
        self._direction, self._trial = np.zeros(shape), np.zeros(shape)
        self._trial_gradient = np.zeros(shape)

    def minimise(
        self,
        potential: Potential,
        x: FloatArray,
        factor: Preconditioner | None,
        *,
        done: Callable[[FloatArray], bool],
        iterations: int,
    ) -> Descent:
        """Lower the potential in place of ``x``; ``factor`` is not used."""
        del factor
        value, evaluations = potential.value(x, self.gradient), 1
        for iteration in range(iterations):
            if done(self.gradient):
                return Descent(value, iteration, evaluations, stalled=False)
            self._turn(potential, x)
            slope = kernel.dot(self._direction, self.gradient)
            step = min(1.0, self.step_cap / max(kernel.largest_row(self._direction), 1e-300))
            while step > _SHORTEST:
                evaluations += 1
                kernel.add_scaled(x, step, self._direction, self._trial)
                new = potential.value(self._trial, self._trial_gradient)
                if new <= value + _ARMIJO * step * slope:
                    break
                step *= 0.5
            else:
                return Descent(value, iteration, evaluations, stalled=True)
            value = new
            np.copyto(x, self._trial)
            np.copyto(self.gradient, self._trial_gradient)
        return Descent(value, iterations, evaluations, stalled=False)

    def _turn(self, potential: Potential, x: FloatArray) -> None:
        """Newton's direction at ``x``."""
        exact, downhill = factorise(potential.hessian(x, definite=False))
        if downhill == 0:
            self._direction.ravel()[:] = exact.solve(-self.gradient.ravel())
            return
        Factor(potential.hessian(x, definite=True)).solve(-self.gradient, self._direction)
