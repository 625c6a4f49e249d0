"""The unknowns of a cover: positions, and below them the settlements of the foam."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.sparse import block_array, block_diag, csc_array, csr_array, eye_array

from seatlook.model import FloatArray
from seatlook.solver.energy import Energy
from seatlook.solver.foam.foundation import Foundation
from seatlook.solver.methods.lbfgs import Potential


class OfPositions:
    """An energy that knows positions only, in a state that goes on after them."""

    def __init__(self, energy: Energy, count: int) -> None:
        self._energy, self._count = energy, count

    def value(self, x: FloatArray, gradient: FloatArray) -> float:
        """Return the energy [J] and add its gradient [N]."""
        return self._energy.value(x[: self._count], gradient[: self._count])

    def stiffness(self) -> csc_array | None:
        """Scalar stiffness of the energy."""
        return self._energy.stiffness()

    def hessian(self, x: FloatArray, *, definite: bool = False) -> csc_array:
        """Second derivative in the positions."""
        return self._energy.hessian(x[: self._count], definite=definite)


class StatePotential(Potential):
    """Sum of energies over a state; its Hessian has rows for the settlements too."""

    def __init__(self, energies: Sequence[Energy], foundation: Foundation | None) -> None:
        super().__init__(energies)
        self._foundation = foundation

    def hessian(self, x: FloatArray, *, definite: bool = False) -> csc_array:
        """Second derivative over the flattened state, 1 on the diagonal of unused places."""
        inner = super().hessian(x, definite=definite)
        if self._foundation is None:
            return inner
        contact = self._foundation.contact
        contact.update(x)
        n = len(contact.area)
        link = np.where(contact.force > 0.0, contact.per_vertex, 0.0)
        index = np.arange(3 * n), np.repeat(np.arange(n), 3)
        down = csr_array(((link[:, None] * contact.normal).ravel(), index), shape=(3 * n, n))
        settled = self._foundation.settlement.matrix()
        whole = csc_array(block_array([[inner, csc_array(down)], [csc_array(down.T), settled]]))
        return csc_array(block_diag([whole, eye_array(x.size - 4 * n)]))

    def dormant(self, x: FloatArray) -> FloatArray:
        """Stiffness of all springs between sheet and foam, in contact or not."""
        out = np.zeros(x.size)
        if self._foundation is not None:
            springs = self._foundation.contact.per_vertex
            out[: 3 * len(springs)] = np.repeat(2.0 * springs, 3)
            out[3 * len(springs) : 4 * len(springs)] = 2.0 * springs
        return out


def masses(mass: FloatArray, rows: int) -> FloatArray:
    """Masses (rows, 3) [kg] of a state; settlements have none of their own."""
    out = np.zeros((rows, 3))
    out[: len(mass)] = mass[:, None]
    return out
