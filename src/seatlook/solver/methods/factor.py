"""Prefactored matrices that stand for the Hessian in the minimiser."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable
from hashlib import blake2b
from typing import Protocol

import numpy as np
import numpy.typing as npt
from scipy.sparse import csc_array

from seatlook.errors import SolverError
from seatlook.model import FloatArray, IntArray
from seatlook.solver.methods.multifrontal import Cholesky, Pattern

_CACHE_SIZE = 6  # patterns: those of a process, while ties join one after the other
_patterns: OrderedDict[bytes, tuple[Pattern, IntArray, IntArray]] = OrderedDict()
_ROUNDING = 1e-12  # of the diagonal, that holds what nothing holds but rounding


class Preconditioner(Protocol):
    """Inverse of a symmetric positive definite guess of the Hessian."""

    def solve(self, right: FloatArray, out: FloatArray) -> None:
        """Apply it to (n, 3) forces."""
        ...


class Renewed:
    """Preconditioner made again from the state at hand after every few uses, or on demand.

    Parameters
    ----------
    make : returns it for the state that is being minimised
    """

    LASTS = 6

    def __init__(self, make: Callable[[], Preconditioner]) -> None:
        self._make, self._uses = make, 0
        self._current: Preconditioner | None = None

    def solve(self, right: FloatArray, out: FloatArray) -> None:
        """Apply it to (n, 3) forces."""
        if self._current is None or self._uses == 0:
            self._current, self._uses = self._make(), self.LASTS
        self._uses -= 1
        self._current.solve(right, out)

    def expire(self) -> None:
        """Have it made again at the next use."""
        self._uses = 0


class Factor:
    """Factor of a symmetric positive definite matrix, (n, n) for each coordinate or (3n, 3n).

    A sheet that falls freely has next to no stiffness as a whole; there the matrix may be
    indefinite by rounding, and is lifted by as much.

    Raises
    ------
    SolverError   the matrix is not positive definite
    """

    def __init__(self, matrix: csc_array) -> None:
        pattern, lower, diagonal = _pattern(matrix)
        self._cholesky = Cholesky(pattern)
        entries = matrix.data[lower].reshape(-1, 1, 1)
        if not self._cholesky.factor(entries):
            entries[diagonal] *= 1.0 + _ROUNDING
            if not self._cholesky.factor(entries):
                raise SolverError("stiffness matrix cannot be factored: it is not positive")
        self._size = matrix.shape[0]

    def solve(self, right: FloatArray, out: FloatArray) -> None:
        """Solve for (n, 3) right-hand sides."""
        if self._size == len(right):
            out[...] = self._cholesky.solve(right)
        else:
            out[...] = self._cholesky.solve(right.reshape(-1, 1)).reshape(-1, 3)

    def column(self, right: FloatArray) -> FloatArray:
        """Solve for one right-hand side (n,)."""
        return self._cholesky.solve(right[:, None])[:, 0]


def _pattern(matrix: csc_array) -> tuple[Pattern, IntArray, IntArray]:
    """Order of elimination, of an earlier matrix if possible, entries needed, the diagonal's."""
    key = _digest(matrix.indptr, matrix.indices)
    if key not in _patterns:
        rows = matrix.indices.astype(np.int64)
        columns = np.repeat(np.arange(matrix.shape[0]), np.diff(matrix.indptr))
        lower = np.flatnonzero(rows >= columns)
        rows, columns = rows[lower], columns[lower]
        pattern = Pattern(rows, columns, matrix.shape[0])
        _patterns[key] = pattern, lower, np.flatnonzero(rows == columns)
        if len(_patterns) > _CACHE_SIZE:
            _patterns.popitem(last=False)
    _patterns.move_to_end(key)
    return _patterns[key]


def _digest(*arrays: npt.NDArray[np.integer]) -> bytes:
    """Stands for the arrays, which are half as large as the rest of what is kept of a pattern."""
    digest = blake2b()
    for array in arrays:
        digest.update(np.ascontiguousarray(array).data)
    return digest.digest()


class SplitFactor:
    """One matrix along the sheet, a softer one across it.

    A sheet gives way across itself far more easily than along itself; near rest, where its normals
    hardly turn, telling the two apart saves most iterations.

    Parameters
    ----------
    along, across : (n, n) scalar stiffness [N/m]
    normal : (n, 3) unit normals; zero where ``along`` is to count for all directions
    """

    def __init__(self, along: csc_array, across: csc_array, normal: FloatArray) -> None:
        self._along, self._across, self._normal = Factor(along), Factor(across), normal
        self._tangential = np.zeros_like(normal)

    def solve(self, right: FloatArray, out: FloatArray) -> None:
        """Solve for (n, 3) right-hand sides."""
        normal = self._normal
        pressing = np.einsum("ij,ij->i", right, normal)
        np.multiply(normal, -pressing[:, None], out=self._tangential)
        self._tangential += right
        self._along.solve(self._tangential, out)
        across = self._across.column(pressing)
        across -= np.einsum("ij,ij->i", out, normal)
        out += across[:, None] * normal


class SlidingFactor:
    """A preconditioner, and another one for movement along given directions that is let free.

    The sum of both serves either kind of movement to a factor of two (an additive Schwarz method
    of two subspaces).

    Parameters
    ----------
    held : preconditioner of (n, 3) forces in which nothing slides
    free : (n, n) scalar stiffness [N/m] of the same where what slides is let free
    vertices : (m,) int64       that may move so, the others stay
    along : (m, 3) float64      unit directions in which they move
    """

    def __init__(
        self, held: Preconditioner, free: csc_array, vertices: IntArray, along: FloatArray
    ) -> None:
        entries = free[vertices][:, vertices].tocoo()
        row, column = entries.coords
        entries.data *= np.einsum("ij,ij->i", along[row], along[column])
        self._held, self._free = held, Factor(csc_array(entries))
        self._vertices, self._along = vertices, along

    def solve(self, right: FloatArray, out: FloatArray) -> None:
        """Solve for (n, 3) right-hand sides."""
        self._held.solve(right, out)
        along = self._free.column(np.einsum("ij,ij->i", right[self._vertices], self._along))
        out[self._vertices] += along[:, None] * self._along
