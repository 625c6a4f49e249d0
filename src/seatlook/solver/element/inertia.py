"""Mass: what resists a fast change, and weight."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csc_array, diags_array

from seatlook.model import FloatArray


class Inertia:
    """m / (2 dt^2) |x - free|^2, the backward-Euler term; ``free`` is where mass alone would go."""

    def __init__(self, mass: FloatArray, dt: float) -> None:
        self.mass = mass
        self.free = np.zeros((len(mass), 3))
        self.rate = np.empty_like(mass)
        self._difference = np.zeros_like(self.free)
        self.set_step(dt)

    def set_step(self, dt: float) -> None:
        """Take time steps of ``dt`` [s]."""
        self.dt = dt
        np.multiply(self.mass, 1.0 / dt**2, out=self.rate)

    def value(self, x: FloatArray, gradient: FloatArray) -> float:
        """Return the energy [J] and add its gradient [N]."""
        n = len(self.mass)
        d = np.subtract(x[:n], self.free, out=self._difference)
        energy = 0.5 * float(np.einsum("i,ij,ij->", self.rate, d, d))
        d *= self.rate[:, None]
        gradient[:n] += d
        return energy

    def stiffness(self) -> csc_array:
        """Mass over dt squared."""
        return diags_array(self.rate).tocsc()

    def hessian(self, x: FloatArray, *, definite: bool = False) -> csc_array:
        """Second derivative [N/m]."""
        del x, definite
        return diags_array(np.repeat(self.rate, 3)).tocsc()


class Gravity:
    """Weight, energy m g z."""

    def __init__(self, mass: FloatArray, acceleration: float = 9.81) -> None:
        self.weight = mass * acceleration

    def value(self, x: FloatArray, gradient: FloatArray) -> float:
        """Return the energy [J] and add its gradient [N]."""
        n = len(self.weight)
        gradient[:n, 2] += self.weight
        return float(np.einsum("i,i->", self.weight, x[:n, 2]))

    def stiffness(self) -> None:
        """A constant force has none."""

    def hessian(self, x: FloatArray, *, definite: bool = False) -> csc_array:
        """Zero."""
        del x, definite
        n = 3 * len(self.weight)
        return csc_array((n, n))
