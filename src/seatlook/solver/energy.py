"""What every term of the potential offers to the methods."""

from __future__ import annotations

from typing import Protocol

from scipy.sparse import csc_array

from seatlook.model import FloatArray


class Energy(Protocol):
    """One term of the incremental potential over vertex positions ``x`` (n, 3) [m]."""

    def value(self, x: FloatArray, gradient: FloatArray) -> float:
        """Return the energy [J] and add its gradient [N], (n, 3), to ``gradient``."""
        ...

    def stiffness(self) -> csc_array | None:
        """Scalar stiffness (n, n) [N/m] that stands for the term in the prefactored matrix."""
        ...

    def hessian(self, x: FloatArray, *, definite: bool = False) -> csc_array:
        """Second derivative (3n, 3n) [N/m] by vertices; ``definite`` drops what is not >= 0."""
        ...
