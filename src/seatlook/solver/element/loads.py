"""Loads on a bare sheet as terms of the potential."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csc_array

from seatlook.model import FloatArray, IntArray
from seatlook.solver.element.turning import cross_matrix


class DeadLoad:
    """Potential ``-f . x`` of forces that keep their direction; weight among them.

    Parameters
    ----------
    force : (n, 3) float64 [N]
    """

    def __init__(self, force: FloatArray) -> None:
        self.force = np.array(force, dtype=np.float64, order="C")

    def value(self, x: FloatArray, gradient: FloatArray) -> float:
        """Return the potential [J] and add its gradient [N] to ``gradient``."""
        gradient -= self.force
        return -float((self.force * x).sum())

    def stiffness(self) -> csc_array | None:
        """Nothing: the load does not change with the positions."""
        return None

    def hessian(self, x: FloatArray, *, definite: bool = False) -> csc_array:
        """Zero (3n, 3n)."""
        del definite
        return csc_array((x.size, x.size))


class Pressure:
    """Potential ``-p V`` of a pressure along the face normals, V the volume under the sheet.

    A following load; it has this potential where the rim is fixed or the surface closed.

    Parameters
    ----------
    faces : (m, 3) int64; pressure : float [Pa], positive along the normals
    """

    def __init__(self, faces: IntArray, pressure: float) -> None:
        self._faces, self.pressure = faces, pressure

    def value(self, x: FloatArray, gradient: FloatArray) -> float:
        """Return the potential [J] and add its gradient [N] to ``gradient``."""
        a, b, c = x[self._faces].transpose(1, 0, 2)
        scale = -self.pressure / 6.0
        for corner, u, v in ((0, b, c), (1, c, a), (2, a, b)):
            np.add.at(gradient, self._faces[:, corner], scale * np.cross(u, v))
        return float(scale * (a * np.cross(b, c)).sum())

    def stiffness(self) -> csc_array | None:
        """Nothing: a pressure has no stiffness of its own."""
        return None

    def hessian(self, x: FloatArray, *, definite: bool = False) -> csc_array:
        """Second derivative (3n, 3n) [N/m]; indefinite, so ``definite`` leaves it out."""
        if definite:
            return csc_array((x.size, x.size))
        rows, columns, values = [], [], []
        for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
            block = -self.pressure / 6.0 * cross_matrix(x[self._faces[:, k]])
            for p, q, sign in ((i, j, -1.0), (j, i, 1.0)):
                r = 3 * self._faces[:, p, None, None] + np.arange(3)[:, None]
                s = 3 * self._faces[:, q, None, None] + np.arange(3)
                shape = (len(self._faces), 3, 3)
                rows.append(np.broadcast_to(r, shape).ravel())
                columns.append(np.broadcast_to(s, shape).ravel())
                values.append((sign * block).ravel())
        index = (np.concatenate(rows), np.concatenate(columns))
        return csc_array((np.concatenate(values), index), shape=(x.size, x.size))
