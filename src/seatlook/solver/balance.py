"""A cover in balance: how it answers a small change, by its true stiffness."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.sparse.linalg import SuperLU

from seatlook.errors import InputError
from seatlook.model import Cover, FloatArray, Solution
from seatlook.solver.kernels.lbfgs import largest_row
from seatlook.solver.methods.newton import factorise
from seatlook.solver.process.process import Process

_WAY = 1e-7  # m, of differences of forces
_REFINEMENTS = 4
_ENOUGH = 1e-8  # of the right-hand side, what is left of it
_SHORTEST = 2.0**-10
_SLOW = 0.2  # of the forces left by a step, from which the matrix is too old


class Balance:
    """The state of a cover at rest, and the matrix that says how it gives way.

    Positions and settlements are one state, (rows, 3). Seams hold by springs and multipliers as at
    rest, and the foam keeps the columns that it was found to have.

    Parameters
    ----------
    solution : at rest; its mesh and its state are taken over
    cover : the same mesh changed a little, such as a panel cut wider; None for its own
    lift : (n,) float64 [m], optional   how much higher the foam below each vertex is
    slides : the cover slides on its foam: friction stays the force that it is, as when changes are
        far larger than the 0.2 mm that it sticks for; else it holds the cover like springs

    Raises
    ------
    InputError
        Another mesh, or a solution that is not at rest.
    """

    def __init__(
        self,
        solution: Solution,
        cover: Cover | None = None,
        *,
        lift: FloatArray | None = None,
        slides: bool = False,
    ) -> None:
        self._solution, self._slides = solution, slides
        if solution.stage != "at rest":
            raise InputError.single("stage", got=repr(solution.stage), expected="at rest")
        if cover is not None and not np.array_equal(cover.faces, solution.cover.faces):
            raise InputError.single("cover", got="another mesh", expected="that of the solution")
        self.process = Process(solution.cover if cover is None else cover)
        self.process.resume(solution, time=0.0)
        if lift is not None and self.process.foundation is not None:
            contact = self.process.foundation.contact
            contact.half_thickness = contact.half_thickness + lift
        self.process.begin(rest=True)
        self.process.lag()
        self._friction = np.zeros_like(self.process.state)
        if slides:
            self._let_slide()
        self._factor: SuperLU | None = None
        self._downhill, self._current = -1, True

    def changed(self, cover: Cover | None = None, *, lift: FloatArray | None = None) -> Balance:
        """The changed cover in this very state, which is out of balance by what has changed."""
        own = cover or self.process.cover
        other = Balance(self._solution, own, lift=lift, slides=self._slides)
        np.copyto(other.process.state, self.process.state)
        np.copyto(other.process.ties.multiplier, self.process.ties.multiplier)
        other.process.lag()
        if self._slides:
            other._let_slide()
            other._friction = self._friction
        # Close to its own: good for first steps, and renewed where they are not.
        other._factor, other._current = self._factor, False
        return other

    def forces(self) -> FloatArray:
        """Forces (rows, 3) [N] that the state is out of balance by."""
        return self.process.forces() + self._friction

    def _let_slide(self) -> None:
        """Make friction the force that it is in this state, whatever moves."""
        foundation = self.process.foundation
        if foundation is not None:
            self._friction = np.zeros_like(self.process.state)
            foundation.friction.value(self.process.state, self._friction)
            foundation.friction.limit.fill(0.0)

    def residual(self, forces: FloatArray) -> float:
        """Largest of forces (rows, 3) [N] over the mean elastic nodal force."""
        return float(largest_row(forces)) / self.process.force_scale()

    def polish(self, tolerance: float = 1e-9, *, most: int = 30) -> float:
        """Newton's method with the true stiffness, to a balance far better than a solve's.

        The matrix is factored anew where the one at hand has become too old. Returns the residual
        [1] that was reached, which may be above ``tolerance``.
        """
        process, forces = self.process, self.forces()
        start = process.state.copy()
        for _ in range(most):
            if self.residual(forces) <= tolerance:
                break
            if self._factor is None:
                self._factor, self._downhill = factorise(process.stiffness())
            fresh = self._step(forces)
            if fresh is None and self._current:
                break
            slow = fresh is None or np.linalg.norm(fresh) > _SLOW * np.linalg.norm(forces)
            if fresh is not None:
                forces, self._current = fresh, False
            if slow:
                self._factor, self._current = None, True
        if not np.array_equal(start, process.state):
            self._factor = None
        return self.residual(forces)

    def _step(self, forces: FloatArray) -> FloatArray | None:
        """Take a step of Newton's, or a part of it; the forces there, None if none is better."""
        process, start = self.process, self.process.state.copy()
        assert self._factor is not None
        step = self._factor.solve(-forces.ravel()).reshape(forces.shape)
        share, before = 1.0, np.linalg.norm(forces)
        while share > _SHORTEST:
            np.copyto(process.state, start + share * step)
            fresh = self.forces()
            if np.linalg.norm(fresh) < (1.0 - 0.1 * share) * before:
                return fresh
            share *= 0.5
        np.copyto(process.state, start)
        return None

    @property
    def downhill(self) -> int:
        """Negative pivots of the stiffness: directions in which the potential falls."""
        self._factored()
        return self._downhill

    def _factored(self) -> SuperLU:
        if self._factor is None:
            self._factor, self._downhill = factorise(self.process.stiffness())
        return self._factor

    def solve(self, right: FloatArray) -> FloatArray:
        """How the state moves (rows, 3) [m] under small forces (rows, 3) [N].

        The matrix leaves out what is small, as the bend of wires; differences of the forces do
        not, and refine what it gives.
        """
        factor = self._factored()
        out = np.zeros_like(right)
        left, size = right.copy(), np.linalg.norm(right)
        for _ in range(_REFINEMENTS):
            step = factor.solve(left.ravel()).reshape(right.shape)
            trial = right - self.product(out + step)
            if not np.linalg.norm(trial) < np.linalg.norm(left):
                break
            out, left = out + step, trial
            if np.linalg.norm(left) <= _ENOUGH * size:
                break
        return out

    def product(self, way: FloatArray) -> FloatArray:
        """Stiffness times a movement (rows, 3) [m], by differences of the forces; (rows, 3) [N]."""
        size = largest_row(way)
        if size == 0.0:
            return np.zeros_like(way)
        process, state = self.process, self.process.state.copy()
        step = _WAY / size
        ends = []
        for sign in (1.0, -1.0):
            np.copyto(process.state, state + sign * step * way)
            ends.append(self.forces())
        np.copyto(process.state, state)
        return np.asarray((ends[0] - ends[1]) / (2.0 * step))

    @property
    def x(self) -> FloatArray:
        """Positions (n, 3) [m]."""
        return self.process.x

    def solution(self) -> Solution:
        """The state as a solution of this cover; what it was solved from stays on it."""
        top, mid, bottom = self.process.sheet.strains(self.process.x)
        return replace(
            self._solution, cover=self.process.cover, positions=self.process.x.copy(),
            strain_top=top, strain_mid=mid, strain_bottom=bottom,
        )  # fmt: skip
