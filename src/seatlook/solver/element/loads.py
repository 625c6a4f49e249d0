"""Loads on a bare sheet as terms of the potential."""

from __future__ import annotations

import numpy as np
from scipy.sparse import block_diag, csc_array, csr_array, eye_array, kron

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

    A following load; it has this potential where the rim is fixed or the surface closed. Elsewhere
    ``rim_force`` is what it does besides.

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

    def rim_force(self, x: FloatArray, rim: IntArray) -> FloatArray:
        """Force (n, 3) [N] that no potential has, on the edges ``rim`` (r, 2) of the surface."""
        force = np.zeros_like(x)
        pull = self.pressure / 6.0 * np.cross(x[rim[:, 0]], x[rim[:, 1]])
        np.add.at(force, rim[:, 0], pull)
        np.add.at(force, rim[:, 1], pull)
        return force

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


class EdgeMoment:
    """Potential ``-m l phi`` of a moment that turns edges about an axis of one direction.

    ``phi`` is the angle by which the slope across an edge has turned about the axis since ``x``; it
    is known to less than a turn, from a quarter against the moment to three quarters along it.

    Parameters
    ----------
    slope : (k, n) sparse [1/m]     conormal slope of the positions at every edge
    length : (k,) float64 [m]
    moment : (3,) float64 [N]       moment per length, along its axis
    x : (n, 3) float64 [m]          positions from which the angle counts
    """

    def __init__(
        self, slope: csr_array, length: FloatArray, moment: FloatArray, x: FloatArray
    ) -> None:
        size = float(np.linalg.norm(moment))
        axis = moment / size
        self._slope, self._weight = slope, -size * length
        start = slope @ x
        first = start - np.outer(start @ axis, axis)
        first /= np.linalg.norm(first, axis=1)[:, None]
        self._plane: FloatArray = np.stack([first, np.cross(axis, first)], axis=1)

    def value(self, x: FloatArray, gradient: FloatArray) -> float:
        """Return the potential [J] and add its gradient [N] to ``gradient``."""
        u, v = self._in_plane(x)
        angle = np.arctan2(v, u)
        angle = np.where(angle < -0.5 * np.pi, angle + 2.0 * np.pi, angle)
        rate = np.stack([-v, u], axis=1) / (u * u + v * v)[:, None]
        pull = np.einsum("k,kp,kpi->ki", self._weight, rate, self._plane)
        gradient += self._slope.T @ pull
        return float(self._weight @ angle)

    def stiffness(self) -> csc_array | None:
        """Nothing: a moment has no stiffness of its own."""
        return None

    def hessian(self, x: FloatArray, *, definite: bool = False) -> csc_array:
        """Second derivative (3n, 3n) [N/m]; indefinite, so ``definite`` leaves it out."""
        if definite:
            return csc_array((x.size, x.size))
        u, v = self._in_plane(x)
        a, b = 2.0 * u * v, v * v - u * u
        turn = np.stack([a, b, b, -a], axis=1).reshape(-1, 2, 2)
        turn *= (self._weight / (u * u + v * v) ** 2)[:, None, None]
        blocks = np.swapaxes(self._plane, 1, 2) @ turn @ self._plane
        slopes = kron(self._slope, eye_array(3))
        return csc_array(slopes.T @ (block_diag(list(blocks)) @ slopes))

    def _in_plane(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Parts of the slopes along where they began, and a quarter turn on, (k,) each."""
        u, v = np.einsum("kpi,ki->pk", self._plane, self._slope @ x)
        return u, v
