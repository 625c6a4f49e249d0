"""Bending of a sheet that is curved at rest: Morley curvature less the natural one."""

from __future__ import annotations

import numpy as np
from scipy.sparse import bsr_array, csc_array, csr_array, eye_array, kron

from seatlook.model import FloatArray
from seatlook.solver.element.bending import Bending, jump_weights
from seatlook.solver.element.curvature import Curvature
from seatlook.solver.element.edgeslope import Edges
from seatlook.solver.element.natural import NaturalShape
from seatlook.solver.element.turning import (
    normal_curvatures,
    normal_rates,
    normals,
    opposite_sides,
    spread,
)


class ShellBending:
    """Bending energy ``1/2 sum A k . D k`` [J] of a curved sheet, and of its jumps.

    ``k = x,ij - b_ij n``: the second derivatives within the shape less the natural curvature along
    the normal ``n`` of the deformed triangle. At rest, and in every rigid motion of it, k is zero,
    and so are its jumps. A flat sheet has no b and the energy of ``Bending``.

    Parameters
    ----------
    edges : of the flat mesh
    curvature : second derivatives within ``shape``, rims released
    area : (m,) float64 [m2]               on the shape
    stiffness : (m, 3, 3) float64 [N m]    for second derivatives on the flat mesh
    shape : NaturalShape
    """

    def __init__(
        self,
        edges: Edges,
        curvature: Curvature,
        area: FloatArray,
        stiffness: FloatArray,
        shape: NaturalShape,
    ) -> None:
        self._plain = Bending(edges, curvature, area, stiffness)
        self.measure: FloatArray = shape.measure
        self._faces, self._offset = shape.faces, curvature.offset.reshape(-1, 3)
        self._second = _rows(curvature)
        self._moment = _moment_matrix(edges, area, stiffness)
        normal, _ = normals(shape.positions, shape.faces)
        at_rest = curvature.at(shape.positions)
        self.natural: FloatArray = np.einsum("tci,ti->tc", at_rest, normal)

    def value(self, x: FloatArray, gradient: FloatArray) -> float:
        """Return the energy [J] and add its gradient [N] to ``gradient``."""
        normal, size = normals(x, self._faces)
        change, moment = self._strained(x, normal)
        gradient += self._second.T @ moment
        pull = self._pull(moment)
        lateral = (pull - (pull * normal).sum(axis=1)[:, None] * normal) / size[:, None]
        turn = np.cross(lateral[:, None], opposite_sides(x, self._faces))
        np.subtract.at(gradient, self._faces, turn)
        return 0.5 * float((change * moment).sum())

    def change(self, x: FloatArray) -> FloatArray:
        """Curvature along the normals less the natural one, (m, 3) of (11, 22, 2 x 12) [1/m]."""
        normal, _ = normals(x, self._faces)
        change, _ = self._strained(x, normal)
        along = np.einsum("tci,ti->tc", change.reshape(-1, 3, 3), normal)
        return np.asarray(np.einsum("tck,tk->tc", self.measure, along))

    def stiffness(self) -> csc_array:
        """Matrix (n, n) [N/m] of the second derivatives alone."""
        return self._plain.stiffness()

    def hessian(self, x: FloatArray, *, definite: bool = False) -> csc_array:
        """Second derivative (3n, 3n) [N/m]; ``definite`` leaves out how the normals' turn turns."""
        rates = self.natural[:, :, None, None, None] * normal_rates(x, self._faces)[:, None]
        # (m, derivative, corner, axis, by axis): rows by derivative and axis, columns by corner.
        turn = spread(rates.transpose(0, 1, 3, 2, 4).reshape(-1, 9, 9), self._faces, len(x))
        rate = csr_array(kron(self._second, eye_array(3)) - turn)
        whole = rate.T @ (kron(self._moment, eye_array(3)) @ rate)
        if definite:
            return csc_array(whole)
        _, moment = self._strained(x, normals(x, self._faces)[0])
        second = normal_curvatures(x, self._faces, self._pull(moment))
        corners = np.broadcast_to(np.eye(9), second.shape)
        gather = spread(corners, self._faces, len(x))
        return csc_array(whole - gather.T @ spread(second, self._faces, len(x)))

    def _strained(self, x: FloatArray, normal: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Change of curvature [1/m] and its moment [N], both (3m, 3)."""
        natural = (self.natural[:, :, None] * normal[:, None]).reshape(-1, 3)
        change = self._second @ x + self._offset - natural
        return change, self._moment @ change

    def _pull(self, moment: FloatArray) -> FloatArray:
        """What turns the normals, (m, 3) [N/m]: natural curvature times moment."""
        return np.asarray(np.einsum("tc,tci->ti", self.natural, moment.reshape(-1, 3, 3)))


def _rows(curvature: Curvature) -> csr_array:
    """Second derivatives as a matrix (3m, n), three rows to a triangle."""
    count = np.diff(curvature.start)
    triangle = np.repeat(np.arange(len(count)), count)
    rows = (3 * triangle[:, None] + np.arange(3)).ravel()
    index = (rows, np.repeat(curvature.nodes, 3))
    shape = (3 * len(count), len(curvature.reference))
    return csr_array((curvature.weights.ravel(), index), shape=shape)


def _moment_matrix(edges: Edges, area: FloatArray, stiffness: FloatArray) -> csr_array:
    """Matrix (3m, 3m) [N m3] from changes of curvature to moments, jumps among them."""
    jump, own = jump_weights(edges, area), area[:, None, None] * stiffness
    first, second = edges.faces[~edges.free].T
    between = 0.5 * jump[~edges.free, None, None] * (stiffness[first] + stiffness[second])
    np.add.at(own, first, between)
    np.add.at(own, second, between)
    row = np.concatenate([np.arange(len(area)), first, second])
    column = np.concatenate([np.arange(len(area)), second, first])
    blocks = np.concatenate([own, -between, -between])
    order = np.lexsort((column, row))
    begin = np.concatenate([[0], np.cumsum(np.bincount(row))])
    return csr_array(bsr_array((blocks[order], column[order], begin)))
