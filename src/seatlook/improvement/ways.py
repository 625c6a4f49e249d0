"""How the shape answers moves at a balance, and what the objective is along these ways."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType

import numpy as np

from seatlook.errors import SolverError
from seatlook.improvement.candidate import (
    Candidate,
    Kind,
    candidates_of,
    free_candidates,
    frozen_names,
    limits_of,
)
from seatlook.improvement.changes import Amounts, Changes
from seatlook.improvement.missing_hooks import Unhooked, unhooked_wires
from seatlook.improvement.moves import MENDS, Move, followed, mending, moves_of, sewable
from seatlook.improvement.objective import Objective
from seatlook.improvement.sensitivity import Sensitivities, sensitivities
from seatlook.model import FloatArray, Scene, Solution
from seatlook.solver.balance import Balance

_BALANCED = 1e-6  # residual at which slopes are taken
SHORT_LIST = 12  # moves whose answer is looked at
_RIVAL = 0.8  # of what the best repair mends, from which another is its rival
LEAST_GAIN = 0.03  # of the objective
REACH = 0.015  # m of movement, beyond which straight answers mislead
SMALLEST = 3e-4  # m that nobody cuts
CHECKS = 3  # warm solves of one move
_STEPS = (0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.8, 1.0)  # of the largest amount
_MEANT = 0.5  # of the foam's slope, from which a wire that holds nothing goes before it
_NEAR = (0.3, 3.0)  # of the amount that closes a seam: so near, that is looked at
_CLOSING = 0.75  # of the largest gain, for which a seam is closed
_CLOSE = 0.8  # of the amount: a better one that is closer is not looked at


class Ways:
    """How the shape answers moves, and what the objective is along these ways.

    Parameters
    ----------
    balance : of the cover as it is
    changes : on top of which amounts come
    found : slopes at the balance
    limits : kind -> largest amount [m]
    made : amounts [m] that have been made, which count against the limits

    Attributes
    ----------
    value : Parts                  of the objective at the balance
    moves : tuple of Move          that may be made, the steepest first
    repairs : tuple of Move        that make sewn lines agree which do not, the likeliest first
    fixed : tuple of Move          that may not, if they were asked for
    """

    def __init__(
        self,
        balance: Balance,
        changes: Changes,
        objective: Objective,
        found: Sensitivities,
        limits: Mapping[Kind, float],
        made: Amounts = MappingProxyType({}),
    ) -> None:
        self._balance, self._changes, self._objective = balance, changes, objective
        self._found, self._limits, self._made = found, limits, made
        self._answers: dict[int, FloatArray] = {}
        self._wires: dict[int, tuple[float, float]] = {}
        self.x, self._sheet = balance.x.copy(), balance.process.sheet
        self._gradient = objective.gradient(self._sheet, self.x)
        self.value = found.value
        self.moves: tuple[Move, ...] = ()
        self.repairs: tuple[Move, ...] = ()
        self.fixed: tuple[Move, ...] = ()

    def hooked(self, wire: Unhooked) -> Move:
        """The move that pulls a seam to a wire that holds nothing, by its mean way in."""
        force = np.zeros_like(self._balance.process.state)
        np.add.at(force, wire.points.vertices, wire.forces)
        answer = self._balance.solve(force)[: len(self.x)]
        inward = float((wire.points.at(answer) * wire.inward).sum(axis=1).mean())
        move = Move(kind="wire", names=(wire.wire, wire.seam), places=(("", ""),) * 2, share={})
        self._answers[id(move)] = answer / inward
        self._wires[id(move)] = (float((self._gradient * answer).sum()) / inward, wire.away)
        return move

    def slope(self, move: Move) -> float:
        """Derivative of the objective per m."""
        if move.kind == "wire":
            return self._wires[id(move)][0]
        return move.total(self._found.slope)

    def rivals(self, moves: Sequence[Move]) -> tuple[Move, ...]:
        """Those that mend about as much as the best, by what slopes say of them."""
        able = [m for m in moves if m.mends > MENDS and abs(m.closes) <= self._limits[m.kind]]
        most = max((m.mends for m in able), default=0.0)
        alike = [m for m in able if m.mends >= _RIVAL * most]
        return tuple(sorted(alike, key=lambda m: self.slope(m) * m.closes))

    def room(self, move: Move) -> float:
        """How far [m] a move may still go the way that the objective falls."""
        sign, limit = -np.sign(self.slope(move)), self._limits[move.kind]
        if move.kind == "wire":
            return min(limit, self._wires[id(move)][1])
        rooms = [
            (limit - sign * np.sign(part) * self._made.get(candidate, 0.0)) / abs(part)
            for candidate, part in move.share.items()
        ]
        return max(0.0, float(min(rooms)))

    def choose(
        self, moves: Sequence[Move], *, x: FloatArray | None = None, reach: float = REACH
    ) -> tuple[float, float, Move]:
        """Gain, amount and move of what helps most from ``x``, or from the balance.

        A wire that is there and holds nothing is meant to be used: it goes before foam that gains
        about as much for each mm, however much foam could be added.

        Parameters
        ----------
        reach : float [m] that no vertex moves farther than
        """
        start = self.x if x is None else x
        tried = [(*self._along(move, start, reach), move) for move in moves]
        best = max(tried, key=lambda one: one[0])
        if best[2].kind != "foam":
            return best
        least = _MEANT * abs(self.slope(best[2]))
        wires = [t for t in tried if t[2].kind == "wire" and abs(self.slope(t[2])) > least]
        return max([t for t in wires if t[0] > 0.0], key=lambda one: one[0], default=best)

    def _along(self, move: Move, x: FloatArray, reach: float) -> tuple[float, float]:
        """Largest gain along a move from ``x``, and the amount that gives it."""
        answer, slope = self._answer(move), self.slope(move)
        explicit = move.total(self._found.explicit) if move.share else 0.0
        farthest = float(np.linalg.norm(answer, axis=1).max())
        largest = min(self.room(move), reach / max(farthest, 1e-12))
        base = self._objective.parts(self._sheet, x).total
        best = (0.0, 0.0)
        for step in _STEPS:
            amount = -np.sign(slope) * step * largest
            there = self._objective.parts(self._sheet, x + amount * answer).total
            best = max(best, (base - there - amount * explicit, float(amount)))
        return best

    def _answer(self, move: Move) -> FloatArray:
        """How positions move per m, (n, 3) [1]."""
        if id(move) not in self._answers:
            force = np.zeros_like(self._balance.process.state)
            for candidate, part in move.every.items():
                force -= part * self._found.forces[candidate]
            self._answers[id(move)] = self._balance.solve(force)[: len(self.x)]
        return self._answers[id(move)]


def ways_at(
    scene: Scene,
    solution: Solution,
    changes: Changes,
    objective: Objective,
    *,
    made: Amounts = MappingProxyType({}),
    with_fixed: bool = False,
) -> Ways:
    """Find moves and slopes by one adjoint, with friction held as the force that it is.

    Parameters
    ----------
    solution : at rest with ``made`` on the mesh of ``changes``
    objective : on the foam of that solution
    with_fixed : look at what is frozen as well

    Raises
    ------
    InputError
        Nothing may change.
    SolverError
        The balance is unstable, so that slopes mean nothing.
    """
    limits = limits_of(scene.improve)
    every, frozen = candidates_of(changes.solution.cover, changes.outlines), frozen_names(scene)
    free = set(free_of(scene, changes))
    balance = Balance(solution, slides=True)
    balance.polish(_BALANCED)
    here = changes.beyond(made)
    # Lengths are asked in any case: they follow, so that seams can be sewn.
    asked = [c for c in every if with_fixed or c in free or c.kind == "length"]
    found = sensitivities(balance, here, objective, asked)
    if found.downhill:
        raise SolverError(
            f"the balance is unstable in {found.downhill} directions: slopes mean nothing there"
        )
    ways = Ways(balance, here, objective, found, limits, made)
    pairs = scene.improve.symmetric
    slope, follows = sewable(changes, found.slope, frozen)
    gathered = moves_of(changes, {c: v for c, v in slope.items() if c in free}, pairs=pairs)
    moves = tuple(followed(changes, move, follows, made) for move in gathered)
    if limits["wire"] > 0.0:
        wires = unhooked_wires(scene, solution)
        moves = (*moves, *(ways.hooked(w) for w in wires if w.wire not in scene.improve.frozen))
    held = {c: v for c, v in found.slope.items() if c not in free} if with_fixed else {}
    ways.moves = tuple(sorted(moves, key=lambda m: -abs(ways.slope(m)) * limits[m.kind]))
    ordered = [c for c in every if c in free]
    ways.repairs = ways.rivals((*moves, *mending(changes, ordered, made, limits["offset"])))
    ways.fixed = moves_of(changes, held, pairs=pairs)
    return ways


def free_of(scene: Scene, changes: Changes) -> tuple[Candidate, ...]:
    """List what may change: not frozen, and nothing that would move a frozen edge by its corner.

    Raises
    ------
    InputError
        None is left.
    """
    frozen = frozen_names(scene)
    every = candidates_of(changes.solution.cover, changes.outlines)
    apart = [c for c in every if not changes.moves_any(c, frozen)]
    return free_candidates(scene, apart, limits_of(scene.improve))


def checked(
    change: Callable[[float], float | None], amount: float, slope: float, closes: float = 0.0
) -> tuple[float, float]:
    """Amount [m] and gain of a move, by a few looks at what it really changes.

    Where a check finds less than was expected, as straight answers do beyond the taut cover, the
    next amount is that of the parabola through slope and check, and half where nothing was found.

    Lines of a seam that differ are a fault of their own. An amount that makes them equal is looked
    at first, and taken if it gains nearly as much as the best.

    Parameters
    ----------
    change : what an amount changes of the objective; None where that cannot be solved
    amount : that straight answers propose
    slope : of the objective
    closes : amount [m] that makes the lines of its seam equal; 0 where nothing does

    Examples
    --------
    >>> checked(lambda a: (a - 0.002) ** 2 - 0.002**2, 0.004, -0.004)[0]
    0.002
    >>> checked(lambda a: (a - 0.002) ** 2 - 0.002**2, 0.004, -0.004, 0.0025)[0]
    0.0025
    >>> checked(lambda a: 1.0, 0.004, -0.004)
    (0.0, 0.0)
    """
    if closes and _NEAR[0] <= amount / closes <= _NEAR[1]:
        amount = closes
    fall, gains = -abs(slope * amount), {0.0: 0.0}
    for _ in range(CHECKS):
        found = change(amount)
        if found is None:
            better = 0.5
        else:
            gains[amount] = -found
            turned = found - fall
            better = -0.5 * fall / turned if turned > 0.0 else 1.0
        if better > _CLOSE:
            break
        amount, fall = better * amount, better * fall
    best = max(gains, key=gains.__getitem__)
    if gains.get(closes, 0.0) > _CLOSING * gains[best]:
        best = closes
    return best, gains[best]
