"""How a cover or a bare sheet is solved: the method, its steps, its iterations."""

from __future__ import annotations

from dataclasses import dataclass

from seatlook.errors import InputError
from seatlook.solver.methods.choice import MethodName, method_of
from seatlook.solver.methods.explicit import Explicit


@dataclass(frozen=True, slots=True, kw_only=True)
class SolverSettings:
    """Settings of ``solve``.

    Parameters
    ----------
    method : "auto" begins with L-BFGS and goes over to Newton where L-BFGS is too slow to come to
        rest, and back; "lbfgs" with prefactored scalar matrices; "newton" with the projected
        Hessian of chords and hinges factored every few iterations, for limp sheets that turn far;
        both test at rest whether the balance is stable, and leave it if it is not; "explicit"
        central differences with the time step their mesh allows, or ``Explicit(time_step=...,
        scale_mass=True)``
    dt : float [s]      time step; what lags is updated once in it
    iterations : int    most iterations in a time step
    """

    method: MethodName | Explicit = "auto"
    dt: float = 0.02
    iterations: int = 8

    def __post_init__(self) -> None:
        method_of(self.method)
        if not self.dt > 0.0:
            raise InputError.single("dt", got=self.dt, expected="above 0 s")
        if self.iterations < 1:
            raise InputError.single("iterations", got=self.iterations, expected="1 or more")


@dataclass(frozen=True, slots=True, kw_only=True)
class SheetSettings:
    """How ``solve_sheet`` goes about it.

    Parameters
    ----------
    method : "newton" or "auto" (with a softened membrane first where the sheet is thin), "lbfgs"
        with a prefactored matrix, or "explicit" (damped, masses make all waves equally slow;
        ``Explicit(time_step=...)`` moves in real time with the sheet's own mass). With each the
        exact Hessian is looked at last: an equilibrium that is unstable is left.
    steps : loads and prescribed movements are applied in this many equal steps; strains count as
        history only at the end of each
    tolerance : residual that counts as converged
    max_iterations : 300 for Newton, 10,000 for L-BFGS, 4,000 times 50 steps for explicit
    """

    method: MethodName | Explicit = "newton"
    steps: int = 1
    tolerance: float = 1e-3
    max_iterations: int | None = None

    def __post_init__(self) -> None:
        method_of(self.method)
        if self.steps < 1:
            raise InputError.single("steps", got=self.steps, expected="1 or more")


DEFAULT = SolverSettings()
