"""Explicit central differences, with the mass scaled where the time step requires it.

The baseline of crash codes: no matrix is factored, but a step longer than 2 / omega_max makes the
shortest wave grow without bound. That is seen in the potential, and raised.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt
from scipy.sparse import csc_array, diags_array
from scipy.sparse.linalg import eigsh

from seatlook.errors import InputError, SolverError
from seatlook.model import FloatArray
from seatlook.solver.methods.factor import Preconditioner
from seatlook.solver.methods.lbfgs import Descent, Potential

Gradient = Callable[[FloatArray, FloatArray], float]

SAFETY = 0.9  # of the stable step
_GAIN = 100.0  # times the energy there was
_FOLLOWING = 4.0  # least masses
_HEAVIEST = 64.0  # times the least mass


@dataclass(frozen=True, slots=True, kw_only=True)
class Explicit:
    """Options of the explicit method.

    Parameters
    ----------
    time_step : float [s]   0.9 of the stable step if not given
    scale_mass : bool       add mass where the time step requires it
    """

    time_step: float | None = None
    scale_mass: bool = False

    def __post_init__(self) -> None:
        if self.time_step is not None and not self.time_step > 0.0:
            raise InputError.single("time_step", got=self.time_step, expected="above 0 s")
        if self.scale_mass and self.time_step is None:
            raise InputError.single(
                "time_step", got="nothing", expected="the step to scale the mass for"
            )


class UnstableStepError(SolverError):
    """The time step is longer than the shortest wave of the mesh allows."""


def stable_step(hessian: csc_array, mass: FloatArray) -> float:
    """Return 2 / omega_max [s] of a stiffness (k, k) [N/m] and lumped masses (k,) [kg].

    Examples
    --------
    >>> round(stable_step(csc_array(np.diag([4.0, 1.0, 100.0])), np.array([1.0, 1.0, 4.0])), 6)
    0.4
    """
    root = diags_array(1.0 / np.sqrt(mass))
    start = np.random.default_rng(0).standard_normal(len(mass))
    scaled = csc_array(root @ hessian @ root)
    top = eigsh(scaled, k=1, which="LA", v0=start, tol=1e-3, return_eigenvectors=False)
    return float(2.0 / np.sqrt(max(top[0], np.finfo(float).tiny)))


def least_mass(hessian: csc_array, dt: float) -> FloatArray:
    """Return masses (k,) [kg] with which steps of ``dt`` [s] are stable: Gershgorin's circles.

    Examples
    --------
    >>> least_mass(csc_array(np.array([[2.0, -1.0], [-1.0, 2.0]])), 1.0)
    array([0.75, 0.75])
    """
    return np.asarray(0.25 * dt**2 * abs(hessian).sum(axis=1)).ravel()


class EnergyWatch:
    """Tells a motion that grows from one that moves.

    The potential cannot rise far above where it started, given what it has fallen, the first push
    and what was put in; close to the limit of stability a wave may hold fifty times its energy.
    """

    def __init__(self) -> None:
        self._spare, self._top, self._low, self._last = np.nan, np.nan, np.nan, np.nan

    def begin(self, energy: float, kinetic: float) -> None:
        """Take over what changed in the potential since the last look."""
        jump = energy - self._last
        if np.isnan(jump):
            self._top = self._low = energy
            self._spare = kinetic
        else:
            self._top, self._low = self._top + jump, self._low + jump
            self._spare += abs(jump)

    def sound(self, energy: float) -> bool:
        """Look at the potential energy [J]."""
        self._last, self._low = energy, min(energy, self._low)
        scale = _GAIN * (self._spare + self._top - self._low) + 1e-9 * abs(self._top)
        return bool(energy - self._top <= scale)


@dataclass(slots=True)
class Motion:
    """What moves under a potential.

    Parameters
    ----------
    x, v : of one shape [m], [m/s]   moved in place; ``v`` is that of half a step before
    mass : of their shape [kg]       0 where nothing moves
    watch : of the stretches of motion before
    """

    x: FloatArray
    v: FloatArray
    mass: FloatArray
    watch: EnergyWatch = field(default_factory=EnergyWatch)

    def advance(self, gradient: Gradient, *, dt: float, steps: int, damping: float = 0.0) -> None:
        """Go on by ``steps`` steps of ``dt`` [s].

        Parameters
        ----------
        gradient : fills its second argument with the gradient [N] at the first, returns the energy
            [J]
        damping : float [1/s]   share of the velocity lost per second

        Raises
        ------
        UnstableStepError   the energy rises; ``x`` and ``v`` are those of the beginning
        """
        x, v, mass = self.x, self.v, self.mass
        pull, start = np.zeros_like(x), (x.copy(), v.copy())
        drag = 0.5 * damping * dt
        push = np.divide(dt / (1.0 + drag), mass, out=np.zeros_like(mass), where=mass > 0.0)
        with np.errstate(over="ignore", invalid="ignore"):
            for step in range(steps):
                energy = gradient(x, pull)
                v *= (1.0 - drag) / (1.0 + drag)
                v -= push * pull
                if step == 0:
                    self.watch.begin(energy, 0.5 * float((mass * v * v).sum()))
                if not self.watch.sound(energy):
                    np.copyto(x, start[0])
                    np.copyto(v, start[1])
                    raise UnstableStepError(f"energy grew without bound in steps of {dt:.3g} s")
                x += dt * v


class Integrator:
    """Motion of a state under a potential, in steps that its stiffness allows.

    Parameters
    ----------
    options : time step and whether mass is added
    mass : of the shape of the state [kg]; unknowns without mass get the least that is stable
    damping : float [1/s]
    """

    def __init__(self, options: Explicit, mass: FloatArray, damping: float) -> None:
        self.options, self.damping, self._own = options, damping, mass
        self.velocity, self.mass, self.dt = np.zeros_like(mass), mass, 0.0
        self._watch = EnergyWatch()

    def renew(self, potential: Potential, x: FloatArray) -> None:
        """Choose step and masses by the stiffness at ``x``."""
        hessian = _stiffest(potential, x)
        has = self._own.ravel() > 0.0
        self.dt = self.options.time_step or SAFETY * self._limit(hessian, has)
        least = least_mass(hessian, self.dt / SAFETY)
        # Without mass of their own, unknowns follow the others: so that they do not drive them.
        least = np.where(has, least if self.options.scale_mass else 0.0, _FOLLOWING * least)
        self.mass = np.maximum(self._own, least.reshape(self._own.shape))

    def run(self, potential: Potential, x: FloatArray, span: float) -> int:
        """Move ``x`` in place through ``span`` [s]; return the number of steps."""
        steps = max(1, round(span / self.dt))
        motion = Motion(x, self.velocity, self.mass, self._watch)
        try:
            motion.advance(potential.value, dt=self.dt, steps=steps, damping=self.damping)
        except UnstableStepError as error:
            limit = self._limit(_stiffest(potential, x), self._own.ravel() > 0.0)
            raise _explained(error, limit) from None
        return steps

    @property
    def added(self) -> float:
        """Mass added, over the mass there is."""
        real = self._own > 0.0
        return float((self.mass - self._own)[real].sum() / self._own.sum())

    def _limit(self, hessian: csc_array, has: npt.NDArray[np.bool_]) -> float:
        inner = np.flatnonzero(has)
        return stable_step(csc_array(hessian[inner][:, inner]), self._own.ravel()[inner])


class DampedDynamics:
    """Minimiser by damped explicit dynamics with masses that make every wave equally slow.

    Damping follows the lowest frequency that the last movement shows (Underwood 1983).

    Parameters
    ----------
    shape : of the unknowns, (n, 3)
    options : a time step requires real masses, (n, 3) [kg]
    """

    CHUNK = 50  # steps with the same damping, an iteration
    _RENEW = 20  # iterations with the same masses

    def __init__(
        self,
        shape: tuple[int, int],
        options: Explicit | None = None,
        own: FloatArray | None = None,
    ) -> None:
        self.gradient = np.zeros(shape)
        self._heavier = 1.0
        step = None if options is None or own is None else options.time_step
        self._own = None if step is None else own
        self._dt = 1.0 if step is None else step
        self._fixed = options is not None and not options.scale_mass

    def minimise(
        self,
        potential: Potential,
        x: FloatArray,
        factor: Preconditioner | None,
        *,
        stop: Callable[[FloatArray], bool],
        iterations: int,
    ) -> Descent:
        """Lower the potential in place of ``x``; no matrix is factored, ``factor`` is not used."""
        del factor
        value, damping = potential.value(x, self.gradient), 0.0
        motion = Motion(x, np.zeros_like(x), self._masses(potential, x))
        for iteration in range(iterations):
            if stop(self.gradient):
                return Descent(value, iteration, self.CHUNK * iteration, stalled=False)
            if iteration % self._RENEW == self._RENEW - 1:
                motion.mass = self._masses(potential, x)
            start, pull = x.copy(), self.gradient.copy()
            try:
                motion.advance(potential.value, dt=self._dt, steps=self.CHUNK, damping=damping)
            except UnstableStepError as error:
                self._more_mass(potential, x, error)
                motion = Motion(x, np.zeros_like(x), self._masses(potential, x))
                continue
            value = potential.value(x, self.gradient)
            way = x - start
            inertia = float((motion.mass * way * way).sum())
            stiffness = float((way * (self.gradient - pull)).sum())
            damping = 2.0 * np.sqrt(max(stiffness, 0.0) / inertia) if inertia > 0.0 else 0.0
        return Descent(value, iterations, self.CHUNK * iterations, stalled=False)

    def _masses(self, potential: Potential, x: FloatArray) -> FloatArray:
        if self._own is not None and self._fixed:
            return self._own
        least = least_mass(_stiffest(potential, x), self._dt / SAFETY).reshape(x.shape)
        least *= self._heavier
        return least if self._own is None else np.maximum(self._own, least)

    def _more_mass(self, potential: Potential, x: FloatArray, error: UnstableStepError) -> None:
        """What stiffens on the way, as contact does, needs more mass; given mass is not changed."""
        self._heavier *= 2.0
        if self._own is not None and self._fixed:
            raise _explained(error, stable_step(_stiffest(potential, x),
                                                self._own.ravel()))  # fmt: skip
        if self._heavier > _HEAVIEST:
            raise error


def _stiffest(potential: Potential, x: FloatArray) -> csc_array:
    """Positive Hessian with the stiffness that may still come."""
    hessian = potential.hessian(x, definite=True)
    return csc_array(hessian + diags_array(potential.dormant(x)))


def _explained(error: UnstableStepError, limit: float) -> UnstableStepError:
    return UnstableStepError(
        f"{error}; the mesh allows {limit:.3g} s: shorten time_step or scale the mass"
    )
