"""Least energy of a flat triangle mesh by projected Newton steps that turn no face over."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import SuperLU, splu

from seatlook.flattening.face_map import Gradient, determinants, largest_step
from seatlook.model import FloatArray, IntArray

_DAMPING = 1e-9  # share of the mean stiffness: rigid motions cost nothing
_SMALLEST_SCALE = 1e-10
# Share of the curvature's negative parts that is left out, and by how much it grows and shrinks.
_LEAST_SHARE, _SHARE_STEP = 1 / 64, 4.0
_SHORT = 0.1  # of a step: its curvature was no good guide
_DESCENT = 1e-4  # share of the energy that the slope promises, to be won at least (Armijo)
_HALF = np.sqrt(0.5)


class Law(Protocol):
    """Energy per area on the form of faces with a deformation F (m, 2, 2) without turned faces."""

    def energy(self, F: FloatArray) -> FloatArray:
        """Return the energy (m,)."""

    def derivatives(self, F: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return its slope (m, 2, 2), and of its curvature axes (m, 4, 4), rows, and sizes (m, 4).

        An axis is a change of F, its rows one after the other.
        """


class Tie(Protocol):
    """Energy of the way between two vertices each."""

    @property
    def vertices(self) -> IntArray:
        """The vertices (k, 2)."""

    def energy(self, span: FloatArray) -> FloatArray:
        """Return the energy (k,) of ways (k, 2) from the first vertex to the second."""

    def derivatives(self, span: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return its slope (k, 2), and of its curvature the parts (k, 2, 2) above 0 and below."""


@dataclass(frozen=True, slots=True)
class Separable:
    """The sum of one function of either principal stretch: value, slope, curvature of s (m, 2)."""

    function: Callable[[FloatArray], tuple[FloatArray, FloatArray, FloatArray]]

    def energy(self, F: FloatArray) -> FloatArray:
        """Return the energy (m,)."""
        return np.asarray(self.function(principal_stretches(F))[0].sum(axis=1))

    def derivatives(self, F: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return slope and curvature, whose axes are two stretches, a turn and a flip.

        Smith, De Goes, Kim 2019.
        """
        s = principal_stretches(F)
        _, slope, curvature = self.function(s)
        if not (slope.any() or curvature.any()):
            return np.zeros_like(F), np.zeros((len(F), 4, 4)), np.zeros((len(F), 4))
        turn = np.arctan2(F[:, 1, 0] - F[:, 0, 1], F[:, 0, 0] + F[:, 1, 1])
        stretch = _turned(-turn) @ F
        axes = _turned(0.5 * np.arctan2(2 * stretch[:, 0, 1], stretch[:, 0, 0] - stretch[:, 1, 1]))
        u = _turned(turn) @ axes
        # Of each column of u with each of the axes: (m, 2, 2) changes of F.
        (aa, ab), (ba, bb) = (
            [u[:, :, i, None] * axes[:, None, :, j] for j in (0, 1)] for i in (0, 1)
        )
        modes = np.stack([aa, bb, _HALF * (ba - ab), _HALF * (ba + ab)], axis=1)
        apart = s[:, 0] - s[:, 1]
        alike = apart < 1e-6 * s[:, 0]
        flip = (slope[:, 0] - slope[:, 1]) / np.where(alike, 1.0, apart)
        flip[alike] = curvature[alike].mean(axis=1)
        size = np.column_stack([curvature, slope.sum(axis=1) / s.sum(axis=1), flip])
        pushed = slope[:, 0, None, None] * aa + slope[:, 1, None, None] * bb
        return pushed, modes.reshape(-1, 4, 4), size


def principal_stretches(F: FloatArray) -> FloatArray:
    """Return the principal stretches (m, 2) of faces that are not turned, large one first."""
    # A difference of squares under a root would lose half the digits where both are alike.
    total = np.hypot(F[:, 0, 0] + F[:, 1, 1], F[:, 1, 0] - F[:, 0, 1])
    apart = np.hypot(F[:, 0, 0] - F[:, 1, 1], F[:, 1, 0] + F[:, 0, 1])
    high = 0.5 * (total + apart)
    # Of their product: the difference would lose the digits of the small one.
    return np.column_stack([high, determinants(F) / high])


def _turned(angle: FloatArray) -> FloatArray:
    c, s = np.cos(angle), np.sin(angle)
    return np.stack([np.stack([c, -s], axis=1), np.stack([s, c], axis=1)], axis=1)


def minimise(
    x: FloatArray,
    gradient: Gradient,
    area: FloatArray,
    laws: Sequence[Law],
    ties: Sequence[Tie] = (),
    *,
    steps: int,
    enough: Callable[[float, float, float], bool],
) -> tuple[FloatArray, FloatArray | None]:
    """Return flat positions (n, 2) of least energy, and the step that was left, or None.

    Parameters
    ----------
    x : (n, 2) [m]   a start without a turned face
    gradient : derivatives along two axes of each face; area : (m,) [m2]
    enough : whether to stop after a step: what it won, the energy, how far it moved [m]
    """
    problem = _Problem(gradient, area, tuple(laws), tuple(ties))
    matrix = _Matrix(len(x), gradient.faces, [tie.vertices for tie in ties])
    value = problem.value(x)
    share, step = 0.0, np.zeros_like(x)
    for _ in range(steps):
        slope, above, below = problem.derivatives(x)
        step, share = matrix.descent(above, below, -slope, share)
        promise = float((slope * step).sum())
        scale = largest_step(x, step, gradient) if promise < 0 else 0.0
        while (new := problem.value(x + scale * step)) > value + _DESCENT * scale * promise:
            scale /= 2
            if scale < _SMALLEST_SCALE:
                return x, None  # rounding hides what a smaller step would win
        if scale == 1.0:
            share = share / _SHARE_STEP if share > _LEAST_SHARE else 0.0
        elif scale < _SHORT:
            share = _larger(share)
        x = x + scale * step
        won, value = value - new, new
        if enough(won, value, scale * float(np.abs(step).max())):
            return x, None
    return x, step


def _larger(share: float) -> float:
    return min(1.0, max(_LEAST_SHARE, _SHARE_STEP * share))


@dataclass(frozen=True, slots=True)
class _Problem:
    gradient: Gradient
    area: FloatArray
    laws: tuple[Law, ...]
    ties: tuple[Tie, ...]

    def value(self, x: FloatArray) -> float:
        F = self.gradient.at(x)
        if (determinants(F) <= 0).any():
            return np.inf
        energy = sum(float(self.area @ law.energy(F)) for law in self.laws)
        return energy + sum(float(tie.energy(_span(x, tie)).sum()) for tie in self.ties)

    def derivatives(self, x: FloatArray) -> tuple[FloatArray, _Blocks, _Blocks]:
        """Return slope (n, 2), and of the curvature the parts above 0 and below."""
        F, m = self.gradient.at(x), len(self.area)
        across = self.gradient.slopes.transpose(0, 2, 1)
        nodal, stiff, soft = np.zeros((m, 2, 3)), np.zeros((m, 6, 6)), np.zeros((m, 6, 6))
        for law in self.laws:
            pushed, modes, size = law.derivatives(F)
            nodal += pushed @ across
            wide = (modes.reshape(m, 8, 2) @ across).reshape(m, 4, 6)
            for blocks, part in ((stiff, np.maximum(size, 0.0)), (soft, np.minimum(size, 0.0))):
                rows = np.flatnonzero(part.any(axis=1))
                own = wide[rows]
                blocks[rows] += own.transpose(0, 2, 1) @ (part[rows, :, None] * own)
        weight = self.area[:, None, None]
        nodal, stiff, soft = weight * nodal, weight * stiff, weight * soft
        index = self.gradient.faces.ravel()
        slope = np.zeros_like(x)
        for i in (0, 1):
            slope[:, i] = np.bincount(index, nodal[:, i].ravel(), minlength=len(x))
        above, below = _of_faces(stiff), _of_faces(soft)
        for tie in self.ties:
            pull, hard, weak = tie.derivatives(_span(x, tie))
            np.add.at(slope, tie.vertices[:, 0], -pull)
            np.add.at(slope, tie.vertices[:, 1], pull)
            above.append(_of_pairs(hard))
            below.append(_of_pairs(weak))
        return slope, above, below


_Blocks = list[FloatArray]  # 2 x 2 blocks as rows (k, 4): of faces, then of each tie's pairs


def _of_faces(blocks: FloatArray) -> _Blocks:
    return [blocks.reshape(-1, 2, 3, 2, 3).transpose(0, 2, 4, 1, 3).reshape(-1, 4)]


def _of_pairs(spring: FloatArray) -> FloatArray:
    signs = np.array([1.0, -1.0, -1.0, 1.0])[:, None, None]
    return np.asarray((signs * spring[:, None]).reshape(-1, 4))


def _span(x: FloatArray, tie: Tie) -> FloatArray:
    return np.asarray(x[tie.vertices[:, 1]] - x[tie.vertices[:, 0]])


class _Matrix:
    """A symmetric matrix of 2 x 2 blocks whose places stay the same from step to step."""

    def __init__(self, n: int, faces: IntArray, pairs: Sequence[IntArray]) -> None:
        rows = [np.repeat(faces, 3, axis=1).ravel()]
        columns = [np.tile(faces, (1, 3)).ravel()]
        for pair in pairs:
            rows.append(pair[:, [0, 0, 1, 1]].ravel())
            columns.append(pair[:, [0, 1, 0, 1]].ravel())
        key = np.concatenate(rows) * n + np.concatenate(columns)
        places, self._place = np.unique(key, return_inverse=True)
        row, self._column = np.divmod(places, n)
        self._start = np.searchsorted(row, np.arange(n + 1))
        self._size = 2 * n

    def descent(
        self, above: _Blocks, below: _Blocks, b: FloatArray, share: float
    ) -> tuple[FloatArray, float]:
        """Return the solution (n, 2) for a right side (n, 2), and the share that it took.

        The share of the negative parts that is left out grows until the matrix has no direction of
        negative curvature: along such a one steps would lead to a saddle and leave it slowly. With
        little left out they are long there.
        """
        stiff, soft = self._sums(above), self._sums(below)
        while True:
            factor = self._factor(stiff + (1.0 - share) * soft)
            if share == 1.0 or (factor.U.diagonal() > 0).all():
                return np.asarray(factor.solve(b.ravel()).reshape(-1, 2)), share
            share = _larger(share)

    def _sums(self, blocks: _Blocks) -> FloatArray:
        """Add up the blocks (k, 4) of each place."""
        count = len(self._column)
        entries = np.concatenate(blocks).T
        return np.column_stack([np.bincount(self._place, e, minlength=count) for e in entries])

    def _factor(self, data: FloatArray) -> SuperLU:
        rows = sp.bsr_array(
            (data.reshape(-1, 2, 2), self._column, self._start), shape=(self._size, self._size)
        ).tocsr()
        damping = sp.identity(self._size, format="csc") * (_DAMPING * rows.diagonal().mean())
        # Symmetric, so its rows are its columns.
        matrix = sp.csc_array((rows.data, rows.indices, rows.indptr), shape=rows.shape) + damping
        # Pivots stay on the diagonal: those below 0 are as many as the negative directions.
        return splu(
            matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0,
            options={"SymmetricMode": True},
        )  # fmt: skip
