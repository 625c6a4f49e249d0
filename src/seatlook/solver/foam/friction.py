"""Coulomb friction of the cover on the foam."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csc_array, diags_array

from seatlook.model import FloatArray
from seatlook.solver.foam.contact import FoamContact, diagonal_blocks
from seatlook.solver.kernels import friction as kernel


class Friction:
    """Friction with the normal force of the last update, so that a potential exists.

    A vertex slides by up to ``slip`` from its anchor before the full friction acts; an anchor is
    dragged along when its vertex slides further, and stays when nothing moves, so a cover at rest
    does not creep.

    Parameters
    ----------
    contact : where the normal force comes from
    coefficient : float [1]
    slip : float [m]
    anchor : (n, 3) float64 [m]   nan where a vertex is free
    """

    def __init__(
        self,
        contact: FoamContact,
        coefficient: float,
        *,
        slip: float = 2e-4,
        anchor: FloatArray | None = None,
    ) -> None:
        n = len(contact.force)
        self.contact, self.coefficient, self.slip = contact, coefficient, slip
        self.anchor = np.full((n, 3), np.nan) if anchor is None else np.array(anchor, order="C")
        self.limit, self.normal = np.zeros(n), np.zeros((n, 3))
        self._blocks = np.zeros((n, 3, 3))

    def update(self, x: FloatArray) -> None:
        """Take normal force and normal from the contact at ``x`` and drag the anchors."""
        np.copyto(self.normal, self.contact.normal)
        np.multiply(self.contact.force, self.coefficient, out=self.limit)
        kernel.drag_anchor(x, self.anchor, self.normal, self.contact.force, self.slip)

    def value(self, x: FloatArray, gradient: FloatArray) -> float:
        """Return the energy [J] and add its gradient [N]."""
        return float(
            kernel.friction_value(x, self.anchor, self.normal, self.limit, self.slip, gradient)
        )

    def stiffness(self) -> csc_array:
        """Stiffness of sticking."""
        return diags_array(2.0 * self.limit / self.slip).tocsc()

    def hessian(self, x: FloatArray, *, definite: bool = False) -> csc_array:
        """Second derivative [N/m], never indefinite."""
        del definite
        return diagonal_blocks(self.blocks(x))

    def blocks(self, x: FloatArray) -> FloatArray:
        """Diagonal blocks (n, 3, 3) of the Hessian; overwritten by the next call."""
        kernel.friction_blocks(x, self.anchor, self.normal, self.limit, self.slip, self._blocks)
        return self._blocks
