"""Static equilibrium by Newton's method with a line search and a check of the inertia.

At an equilibrium the factors of the true Hessian tell how many directions lead downhill. Where
there are any the sheet has "not yet buckled": it is pushed along the softest one and goes on.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt
from scipy.sparse import csc_array, eye_array
from scipy.sparse.linalg import LinearOperator, SuperLU, eigsh, splu

from seatlook.model import FloatArray
from seatlook.solver.energy import Energy

BoolArray = npt.NDArray[np.bool_]
# A negative pivot below this share of the largest one is rounding, not a mode.
_ROUNDING = 1e-12
_ARMIJO, _SHORTEST = 1e-4, 2.0**-30
_NOISE = 16 * np.finfo(float).eps  # of a nodal force over stiffness times size


@dataclass(frozen=True, slots=True)
class Equilibrium:
    """Where Newton's method stopped.

    Parameters
    ----------
    x : (n, 3) float64 [m]
    residual : float [1]        largest force out of balance over the mean elastic nodal force
    energy : (k,) float64 [J]   potential after every accepted step
    downhill : int              negative pivots of the Hessian; 0 = stable, -1 = not known
    kicks : int                 how often an unstable equilibrium was left
    """

    x: FloatArray
    residual: float
    energy: FloatArray
    iterations: int
    downhill: int
    kicks: int

    @property
    def stable(self) -> bool:
        """Whether every small movement costs energy."""
        return self.downhill == 0


class Potential:
    """Sum of energies with some of the positions held.

    Parameters
    ----------
    elastic : terms whose nodal forces measure the residual
    others : loads and supports
    free : (n, 3) bool
    """

    def __init__(
        self, elastic: Sequence[Energy], others: Sequence[Energy], free: BoolArray
    ) -> None:
        self.elastic, self.others, self.free = tuple(elastic), tuple(others), free
        self._index = np.flatnonzero(free)
        parts = [matrix for term in elastic if (matrix := term.stiffness()) is not None]
        self._stiffest = max((float(part.diagonal().max()) for part in parts), default=0.0)

    def value(self, x: FloatArray) -> tuple[float, FloatArray]:
        """Return the potential [J] and its gradient [N]."""
        gradient = np.zeros_like(x)
        total = sum(term.value(x, gradient) for term in (*self.elastic, *self.others))
        return float(total), gradient

    def rounding(self, x: FloatArray) -> float:
        """Return the noise of the potential [J]: what translations change, that should not."""
        size = np.abs(x).max()
        energies = [
            sum(term.value(x + share * size, np.zeros_like(x)) for term in self.elastic)
            for share in (0.0, 0.0717, -0.1393, 0.2371)
        ]
        loads = sum(abs(term.value(x, np.zeros_like(x))) for term in self.others)
        return float(2.0 * np.ptp(energies) + 1e-14 * (abs(energies[0]) + loads))

    def force_scale(self, x: FloatArray) -> float:
        """Return the mean elastic nodal force [N]."""
        mean = 0.0
        for term in self.elastic:
            part = np.zeros_like(x)
            term.value(x, part)
            mean += float(np.linalg.norm(part, axis=1).mean())
        return mean

    def residual(self, x: FloatArray, gradient: FloatArray) -> float:
        """Return the largest force out of balance over the mean elastic nodal force.

        0 where both are no more than rounding: a sheet at rest that nothing pulls.
        """
        mean = self.force_scale(x)
        worst = float(np.linalg.norm(np.where(self.free, gradient, 0.0), axis=1).max())
        if max(mean, worst) <= _NOISE * self._stiffest * float(np.ptp(x, axis=0).max()):
            return 0.0
        return worst / mean if mean > 0.0 else np.inf

    def hessian(self, x: FloatArray, *, definite: bool) -> csc_array:
        """Second derivative over the free positions."""
        terms = (*self.elastic, *self.others)
        full = csc_array((x.size, x.size))
        for term in terms:
            full = csc_array(full + term.hessian(x, definite=definite))
        return csc_array(full[self._index][:, self._index])

    def spread(self, values: FloatArray) -> FloatArray:
        """Return an (n, 3) array with ``values`` at the free positions."""
        out = np.zeros(self.free.shape)
        out.flat[self._index] = values
        return out

    def gather(self, values: FloatArray) -> FloatArray:
        """Return the free entries of an (n, 3) array."""
        return np.asarray(values.ravel()[self._index])


def newton(
    potential: Potential,
    x: FloatArray,
    *,
    tolerance: float = 1e-6,
    max_iterations: int = 200,
    kick: float = 0.0,
    max_step: float = np.inf,
) -> Equilibrium:
    """Minimise the potential from ``x``.

    Parameters
    ----------
    tolerance : largest residual taken as converged
    kick : float [m]      length of the push away from an unstable equilibrium, 0 = stay there
    max_step : float [m]  longest move of a vertex in one step
    """
    x = np.array(x, dtype=np.float64, order="C")
    energy, gradient = potential.value(x)
    state = Equilibrium(x, potential.residual(x, gradient), np.array([energy]), 0, -1, 0)
    history = [energy]
    while state.iterations < max_iterations:
        hessian = potential.hessian(state.x, definite=False)
        factor, downhill = factorise(hessian)
        if state.residual <= tolerance:
            if downhill == 0 or kick == 0.0:
                return replace(state, downhill=downhill, energy=np.array(history))
            x = push(potential, state.x, hessian, factor, kick)
            energy, gradient = potential.value(x)
            state = replace(state, x=x, kicks=state.kicks + 1)
        else:
            if downhill:
                factor = _definite(potential, state.x, hessian, factor)
            step = potential.spread(-factor.solve(potential.gather(gradient)))
            point = line_search(potential, (state.x, energy, gradient), step, max_step)
            if point is None:
                break
            x, energy, gradient = point
        history.append(energy)
        state = replace(
            state,
            x=x,
            residual=potential.residual(x, gradient),
            iterations=state.iterations + 1,
        )
    if state.residual <= tolerance:
        downhill = factorise(potential.hessian(state.x, definite=False))[1]
        state = replace(state, downhill=downhill)
    return replace(state, energy=np.array(history))


def line_search(
    potential: Potential,
    at: tuple[FloatArray, float, FloatArray],
    step: FloatArray,
    max_step: float,
) -> tuple[FloatArray, float, FloatArray] | None:
    """Shorten ``step`` until the potential falls enough (Armijo); None if it never does.

    Where the fall drowns in rounding, a slope that has flattened tells the same; so does one that
    leads down all the way, as at the top of a ridge.
    """
    x, energy, gradient = at
    slope = float((gradient * step).sum())
    longest = float(np.linalg.norm(step, axis=1).max())
    share = min(1.0, max_step / longest) if longest > 0.0 else 1.0
    noise = potential.rounding(x) if abs(slope) < 1e-8 * abs(energy) else 0.0
    while share > _SHORTEST:
        trial = x + share * step
        value, fresh = potential.value(trial)
        if value <= energy + _ARMIJO * share * slope:
            return trial, value, fresh
        if value <= energy + noise and float((fresh * step).sum()) <= -0.5 * slope:
            return trial, value, fresh
        share *= 0.5
    return None


def factorise(hessian: csc_array) -> tuple[SuperLU, int]:
    """Return the factors of a symmetric matrix and its number of negative pivots."""
    try:
        factor = _factors(hessian)
    except RuntimeError:
        # Exactly singular: a slack sheet swings without stiffness. Rounding holds it.
        factor = _factors(_lifted(hessian, _ROUNDING * float(np.abs(hessian.diagonal()).max())))
    pivots = factor.U.diagonal()
    return factor, int((pivots < -_ROUNDING * np.abs(pivots).max(initial=0.0)).sum())


def _factors(hessian: csc_array) -> SuperLU:
    return splu(
        hessian,
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    )


def _definite(potential: Potential, x: FloatArray, hessian: csc_array, factor: SuperLU) -> SuperLU:
    """Factor the Hessian lifted by little more than its lowest eigenvalue, or the projected one."""
    lowest, _ = softest(hessian, factor)
    projected = potential.hessian(x, definite=True)
    scale = float(projected.diagonal().mean())
    shift = max(2.0 * abs(lowest), 1e-12 * scale)
    while shift < 0.01 * scale:
        lifted, downhill = factorise(_lifted(hessian, shift))
        if downhill == 0:
            return lifted
        shift *= 8.0
    return factorise(_lifted(projected, 1e-6 * scale))[0]


def _lifted(matrix: csc_array, shift: float) -> csc_array:
    return csc_array(matrix + shift * eye_array(matrix.shape[0]))


def softest(hessian: csc_array, factor: SuperLU) -> tuple[float, FloatArray]:
    """Return the lowest of the eigenvalues around zero, and its mode."""
    inverse = LinearOperator(hessian.shape, matvec=factor.solve, dtype=np.float64)
    start = np.random.default_rng(0).standard_normal(hessian.shape[0])
    count = min(6, hessian.shape[0] - 1)
    values, modes = eigsh(
        hessian, k=count, sigma=0.0, which="LM", OPinv=inverse, v0=start, tol=1e-3
    )
    low = int(np.argmin(values))
    return float(values[low]), np.asarray(modes[:, low])


def push(
    potential: Potential, x: FloatArray, hessian: csc_array, factor: SuperLU, kick: float
) -> FloatArray:
    """Move along the softest mode, to the side where the potential is lower."""
    mode = potential.spread(softest(hessian, factor)[1])
    mode *= kick / np.linalg.norm(mode, axis=1).max()
    sides = [x + mode, x - mode]
    return min(sides, key=lambda side: potential.value(side)[0])
