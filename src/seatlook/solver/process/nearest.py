"""The projected Hessian of a sheet between nearest neighbours, made to be factored often.

The element's arcs and recovered slopes couple some fifty vertices to each. Chords and hinges couple
thirteen, and once the mesh resolves the folds they answer all but the same: a factor of theirs
serves L-BFGS as Newton's matrix would, at a tenth of the cost.
"""

from __future__ import annotations

import numpy as np
from scipy.sparse import csc_array, csr_array, eye_array

from seatlook.errors import SolverError
from seatlook.model import FloatArray, IntArray
from seatlook.solver.element.elastic import ElasticSheet
from seatlook.solver.kernels import nearest as kernel
from seatlook.solver.methods.multifrontal import Cholesky, Pattern
from seatlook.solver.process.sliding import Released

_HINGE = 1.5  # times B l^2 / A, nearest to the element's bending
_FLOOR = 1e-10  # of the mean diagonal: holds what nothing else does


class NearestHessian:
    """Positive definite (3n, 3n) matrix in blocks, and its factor.

    Parameters
    ----------
    sheet : whose stiffness and hinges count
    points : (n, 3) float64 [m]   where vertices lie, those tied to each other near each other
    ties : (n, n) sparse          not zero where further scalar terms may be
    """

    def __init__(self, sheet: ElasticSheet, points: FloatArray, ties: csc_array) -> None:
        self._sheet, self._count = sheet, len(points)
        constant = csr_array(_hinges(sheet))
        if sheet.folds is not None:
            constant = csr_array(constant + sheet.folds.matrix())
        pattern = csr_array(_stencil(sheet) + abs(constant) + ties + eye_array(len(points)))
        rows = np.repeat(np.arange(len(points)), np.diff(pattern.indptr))
        lower = rows >= pattern.indices
        rows, columns = rows[lower], pattern.indices[lower].astype(np.int64)
        self._keys = rows * len(points) + columns
        order = np.argsort(self._keys)
        self._keys, rows, columns = self._keys[order], rows[order], columns[order]
        self._diagonal = np.flatnonzero(rows == columns)
        self._constant = np.zeros(len(rows))
        self._add(constant, self._constant)
        self._edge_slot, self._pair_slot = self._places()
        self._blocks = np.empty((len(rows), 3, 3))
        self._cholesky = Cholesky(Pattern(rows, columns, len(points), size=3))

    def factor(
        self,
        x: FloatArray,
        scalar: csc_array,
        diagonal: FloatArray,
        released: Released | None = None,
    ) -> None:
        """Factor at ``x``.

        Scalar terms (n, n) and diagonal blocks (n, 3, 3) are added; what of the scalar terms is
        released along wires is taken away.
        """
        sheet, blocks = self._sheet, self._blocks
        material, pull = sheet.membrane.tangent(x, definite=True)
        entries = self._constant.copy()
        self._add(scalar, entries)
        blocks.fill(0.0)
        for axis in range(3):
            blocks[:, axis, axis] = entries
        blocks[self._diagonal] += diagonal
        if released is not None:
            self._release(released, blocks)
        edges = sheet.edges
        kernel.chords(
            x,
            edges.ends,
            edges.length,
            edges.of_face,
            material,
            pull,
            self._edge_slot,
            self._pair_slot,
            blocks,
        )
        floor = _FLOOR * float(np.trace(blocks[self._diagonal], axis1=1, axis2=2).mean())
        for axis in range(3):
            blocks[self._diagonal, axis, axis] += floor
        if not self._cholesky.factor(blocks):
            raise SolverError("projected Hessian cannot be factored: it is not positive")

    def solve(self, right: FloatArray, out: FloatArray) -> None:
        """Solve for (n, 3) forces."""
        out[...] = self._cholesky.solve(right)

    def _add(self, matrix: csr_array | csc_array, entries: FloatArray) -> None:
        """Add the lower triangle of a scalar matrix to ``entries`` of the pattern."""
        listed = matrix.tocoo()
        row, column = listed.coords
        lower = (row >= column) & (listed.data != 0.0)
        key = row[lower].astype(np.int64) * self._count + column[lower]
        at = np.minimum(np.searchsorted(self._keys, key), len(self._keys) - 1)
        if (self._keys[at] != key).any():
            raise SolverError("stiffness outside the pattern that was given")
        np.add.at(entries, at, listed.data[lower])

    def _release(self, released: Released, blocks: FloatArray) -> None:
        """Take the springs away that rings do not have along their wires."""
        shape = released.weights.shape[0], 2, 2
        row = np.broadcast_to(released.vertices[:, :, None], shape)
        column = np.broadcast_to(released.vertices[:, None, :], shape)
        slot = self._slot(row, column)
        there = (slot >= 0) & (released.weights[:, :, None] * released.weights[:, None, :] != 0.0)
        np.subtract.at(blocks, slot[there], released.blocks()[there])

    def _slot(self, rows: IntArray, columns: IntArray) -> IntArray:
        """Where the blocks of pairs of vertices are; -1 above the diagonal."""
        at = np.searchsorted(self._keys, rows * self._count + columns)
        return np.where(rows >= columns, at, -1)

    def _places(self) -> tuple[IntArray, IntArray]:
        """Blocks of every edge and of every pair of edges of a triangle."""
        ends = self._sheet.edges.ends
        a, b = ends.T
        edge = np.stack(
            [self._slot(a, a), self._slot(b, b), self._slot(np.maximum(a, b), np.minimum(a, b))],
            axis=1,
        )
        of_face = ends[self._sheet.edges.of_face]
        first = np.repeat(of_face, 3, axis=1)
        second = np.tile(of_face, (1, 3, 1))
        sides = [self._slot(first[..., p], second[..., q]) for p in (0, 1) for q in (0, 1)]
        return np.ascontiguousarray(edge), np.ascontiguousarray(np.stack(sides, axis=2))


def _stencil(sheet: ElasticSheet) -> csr_array:
    """Pattern (n, n) of what shares an inner edge's two triangles, or a triangle."""
    edges, faces = sheet.edges, sheet.faces
    inner = edges.faces[~edges.free]
    groups = np.concatenate([faces[inner].reshape(-1, 6), np.repeat(faces, 2, axis=1)])
    start = np.arange(0, groups.size + 1, 6)
    member = csr_array(
        (np.ones(groups.size), groups.ravel(), start), shape=(len(groups), len(sheet.rest))
    )
    return csr_array(member.T @ member)


def _hinges(sheet: ElasticSheet) -> csr_array:
    """Scalar matrix (n, n) [N/m] of springs between the slopes of neighbouring triangles."""
    edges, count = sheet.edges, len(sheet.rest)
    inner = np.flatnonzero(~edges.free)
    faces, normal = edges.faces[inner], edges.normal[inner]
    p = sheet.rest[sheet.faces]
    # Gradients of the linear shape functions: the opposite edge, turned, over twice the area.
    opposite = np.roll(p, -2, axis=1) - np.roll(p, -1, axis=1)
    gradient = np.stack([-opposite[..., 1], opposite[..., 0]], axis=2)
    gradient /= 2.0 * sheet.area[:, None, None]
    shape = (len(inner), count)
    row = np.repeat(np.arange(len(inner)), 3)
    one, other = (
        csr_array(
            (
                np.einsum("eki,ei->ek", gradient[faces[:, side]], normal).ravel(),
                (row, sheet.faces[faces[:, side]].ravel()),
            ),
            shape=shape,
        )
        for side in (0, 1)
    )
    voigt = np.stack([normal[:, 0] ** 2, normal[:, 1] ** 2, 2.0 * normal[:, 0] * normal[:, 1]], 1)
    D = sheet.bending_stiffness[faces].mean(axis=1)
    stiffness = np.einsum("ei,eij,ej->e", voigt, D, voigt)
    weight = _HINGE * stiffness * edges.length[inner] ** 2 / sheet.area[faces].sum(axis=1)
    jump = csr_array(one - other)
    return csr_array(jump.T @ jump.multiply(weight[:, None]))
