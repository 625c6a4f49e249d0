"""The methods by their names."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal, Protocol

from seatlook.errors import InputError
from seatlook.model import FloatArray
from seatlook.solver.methods.explicit import DampedDynamics, Explicit
from seatlook.solver.methods.factor import Preconditioner
from seatlook.solver.methods.lbfgs import Descent, Lbfgs, Potential

Method = Literal["lbfgs", "newton"] | Explicit
MethodName = Literal["auto", "lbfgs", "newton", "explicit"]


class Minimiser(Protocol):
    """What lowers a potential; ``gradient`` is that of the last accepted point."""

    gradient: FloatArray

    def minimise(
        self,
        potential: Potential,
        x: FloatArray,
        factor: Preconditioner | None,
        *,
        stop: Callable[[FloatArray], bool],
        iterations: int,
    ) -> Descent:
        """Lower the potential in place of ``x`` until ``stop`` says so of the gradient."""
        ...


# A new method is one class here. "newton" differs by the matrix that it is given.
MINIMISERS: dict[str, Callable[[tuple[int, int]], Minimiser]] = {"lbfgs": Lbfgs, "newton": Lbfgs}


def method_of(
    method: MethodName | Explicit, *, first: Literal["lbfgs", "newton"] = "lbfgs"
) -> Method:
    """Return the method of a name; "explicit" is ``Explicit()``, "auto" begins with ``first``.

    Raises
    ------
    InputError   no such method

    Examples
    --------
    >>> method_of("explicit")
    Explicit(time_step=None, scale_mass=False)
    """
    if method == "explicit":
        return Explicit()
    if method == "auto":
        return first
    if isinstance(method, Explicit) or method in MINIMISERS:
        return method
    names = ", ".join(map(repr, MINIMISERS))
    raise InputError.single(
        "method", got=repr(method), expected=f"{names}, 'explicit' or Explicit(...), or 'auto'"
    )


def minimiser(method: Method, shape: tuple[int, int], mass: FloatArray | None = None) -> Minimiser:
    """Return what minimises over unknowns of ``shape``; ``mass`` is real, of the same shape."""
    if isinstance(method, Explicit):
        return DampedDynamics(shape, method, mass)
    return MINIMISERS[method](shape)
