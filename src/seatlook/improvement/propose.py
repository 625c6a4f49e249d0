"""The corrections that would help most, from one adjoint; each is checked by a warm solve."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from seatlook.chain.assess import Assessment
from seatlook.errors import InputError, SolverError
from seatlook.improvement.candidate import Candidate, Kind, candidates_of
from seatlook.improvement.changes import Changes
from seatlook.improvement.missing_hooks import Unhooked, unhooked_wires
from seatlook.improvement.moves import Move, moves_of
from seatlook.improvement.objective import Goal, Objective, Parts, weights
from seatlook.improvement.sensitivity import Sensitivities, sensitivities
from seatlook.improvement.warm import solve_warm
from seatlook.model import FloatArray, Scene, Solution
from seatlook.model.scene import Freedom
from seatlook.solver.balance import Balance

_BALANCED = 1e-6  # residual at which slopes are taken
_SHORT_LIST = 12  # moves whose answer is looked at
_STEPS = (0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.8, 1.0)  # of the largest amount
_LINEAR = 0.015  # m of movement, beyond which straight answers mislead
_LEAST_GAIN = 0.03  # of the objective
_SMALLEST = 3e-4  # m that nobody cuts
_MEANT = 0.5  # of the foam's slope, from which a wire that holds nothing goes before it
_CHECKS = 3  # warm solves of one move
_CLOSE = 0.8  # of the amount: a better one that is closer is not looked at


@dataclass(frozen=True, slots=True, kw_only=True)
class Proposal:
    """A correction, and what it is expected to gain.

    Parameters
    ----------
    move : what is changed together
    amount : float [m]     outward, longer, deeper or higher above 0
    gain : float           fall of the objective, on top of the proposals before it
    share : float          of the objective at the start
    sentence : all of it for a reader
    """

    move: Move
    amount: float
    gain: float
    share: float
    sentence: str

    @property
    def amounts(self) -> dict[Candidate, float]:
        """Amount of each candidate [m]."""
        return {candidate: self.amount * part for candidate, part in self.move.share.items()}


@dataclass(frozen=True, slots=True, kw_only=True)
class Proposals:
    """What one adjoint says.

    Parameters
    ----------
    value : parts of the objective as the seat is
    proposals : the best first; each counts on those before it being made
    slope : move -> derivative of the objective per m, the steepest first
    """

    value: Parts
    proposals: tuple[Proposal, ...]
    slope: tuple[tuple[Move, float], ...]


def propose(
    scene: Scene, assessment: Assessment, *, goal: Goal | None = None, count: int = 3
) -> Proposals:
    """Find the corrections that help most.

    The slopes of all candidates come from one adjoint, with friction held as the force that it is.
    For the steepest moves the answer of the shape is solved too, with the same factors, and the
    objective followed along it: that gives amounts in mm, which slopes alone do not. The best move
    is made warm, and the next is looked for from there.

    Parameters
    ----------
    scene : with [improve], what may change
    assessment : of its result
    goal : what counts as good; None for the usual
    count : of proposals at most

    Raises
    ------
    InputError
        Nothing may change.
    SolverError
        The result is not converged, or its balance is unstable, so that slopes mean nothing.
    """
    solution = assessment.solution
    if solution.status != "converged":
        raise SolverError(f"nothing can be proposed from a result that is not: {solution.reason}")
    changes, limits = Changes(solution, scene.pattern), _limits(scene.improve)
    candidates = _free(scene, changes, limits)
    objective = _objective(scene, assessment, goal or Goal())
    balance = Balance(solution, slides=True)
    balance.polish(_BALANCED)
    found = sensitivities(balance, changes, objective, candidates)
    if found.downhill:
        raise SolverError(
            f"the balance is unstable in {found.downhill} directions: slopes mean nothing there"
        )
    moves = moves_of(changes, found.slope, pairs=scene.improve.symmetric)
    ways = _Ways(balance, changes, objective, found, limits)
    if limits["wire"] > 0.0:
        wires = unhooked_wires(scene, solution)
        moves = (*moves, *(ways.hooked(w) for w in wires if w.wire not in scene.improve.frozen))
    steepest = sorted(moves, key=lambda m: -abs(ways.slope(m)) * limits[m.kind])
    return Proposals(
        value=found.value,
        proposals=tuple(ways.best(steepest[:_SHORT_LIST], count)),
        slope=tuple((move, ways.slope(move)) for move in steepest),
    )


def _free(scene: Scene, changes: Changes, limits: Mapping[Kind, float]) -> list[Candidate]:
    """List candidates that are not frozen, neither by name nor by a limit of 0."""
    found = candidates_of(changes.solution.cover, changes.outlines, _frozen(scene))
    candidates = [c for c in found if limits[c.kind] > 0.0]
    if not candidates:
        raise InputError.single(
            "improve", got="all frozen", expected="something that may change", file=scene.path
        )
    return candidates


def _limits(freedom: Freedom) -> dict[Kind, float]:
    """Largest amount [m] of every kind."""
    return {
        "offset": freedom.edge,
        "length": freedom.length,
        "hook": freedom.hook,
        "wire": freedom.hook,
        "foam": freedom.foam,
    }


def _frozen(scene: Scene) -> frozenset[str]:
    """Names that stay, those of the edges of frozen seams among them."""
    names = set(scene.improve.frozen)
    sewn = [{seam.a, *seam.b} for seam in scene.pattern.seams if seam.name in names]
    return frozenset(names.union(*sewn))


def _objective(scene: Scene, assessment: Assessment, goal: Goal) -> Objective:
    solution = assessment.solution
    classes = {box.name: str(box.visibility) for box in scene.boxes}
    return Objective(
        solution,
        net=assessment.surface.net,
        c_threshold=assessment.surface.c_threshold,
        weight=weights(solution.cover, classes),
        goal=goal,
    )


class _Ways:
    """How the shape answers moves, and what the objective is along these ways."""

    def __init__(
        self,
        balance: Balance,
        changes: Changes,
        objective: Objective,
        found: Sensitivities,
        limits: Mapping[Kind, float],
    ) -> None:
        self._balance, self._changes, self._objective = balance, changes, objective
        self._found, self._limits = found, limits
        self._answers: dict[int, FloatArray] = {}
        self._wires: dict[int, tuple[float, float]] = {}
        self._x, self._sheet = balance.x.copy(), balance.process.sheet
        self._gradient = objective.gradient(self._sheet, self._x)

    def hooked(self, wire: Unhooked) -> Move:
        """The move that pulls a seam to a wire that holds nothing, by its mean way in."""
        force = np.zeros_like(self._balance.process.state)
        np.add.at(force, wire.points.vertices, wire.forces)
        answer = self._balance.solve(force)[: len(self._x)]
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

    def best(self, moves: Sequence[Move], count: int) -> list[Proposal]:
        """Up to ``count`` moves one after the other, each checked by a warm solve.

        Where a check finds less than was expected, as straight answers do beyond the taut cover,
        the amount is that of the parabola through slope and check. A wire that holds nothing ends
        the list: it cannot be checked, and what else to do shows when it is hooked.
        """
        start = value = self._objective.parts(self._sheet, self._x).total
        x, left, proposals = self._x, list(moves), list[Proposal]()
        while left and len(proposals) < count:
            gain, amount, move = self._choose(left, x)
            if gain < _LEAST_GAIN * start or abs(amount) < _SMALLEST:
                break
            left = [other for other in left if not _same(other, move)]
            if move.kind == "wire":
                gain, left = min(gain, value), []
            else:
                amount, gain, x = self._checked(move, amount, value, proposals)
                if gain < _LEAST_GAIN * start:
                    continue
                value -= gain
            share = gain / start
            proposals.append(
                Proposal(
                    move=move, amount=amount, gain=gain, share=share,
                    sentence=sentence(move, amount, share),
                )
            )  # fmt: skip
        return proposals

    def _choose(self, moves: Sequence[Move], x: FloatArray) -> tuple[float, float, Move]:
        """Gain, amount and move of what helps most from ``x``.

        A wire that is there and holds nothing is meant to be used: it goes before foam that gains
        about as much for each mm, however much foam could be added.
        """
        tried = [(*self._along(move, x), move) for move in moves]
        best = max(tried, key=lambda one: one[0])
        if best[2].kind != "foam":
            return best
        least = _MEANT * abs(self.slope(best[2]))
        wires = [t for t in tried if t[2].kind == "wire" and abs(self.slope(t[2])) > least]
        return max([t for t in wires if t[0] > 0.0], key=lambda one: one[0], default=best)

    def _checked(
        self, move: Move, amount: float, value: float, before: Sequence[Proposal]
    ) -> tuple[float, float, FloatArray]:
        """Amount, gain and shape of a move that is made warm, on top of those before."""
        fall = -abs(self.slope(move) * amount)
        best = (0.0, 0.0, self._x)
        for _ in range(_CHECKS):
            solution = self._made(move, amount, before)
            change = self._objective.of(solution).total - value
            if -change > best[1]:
                best = (amount, -change, solution.positions)
            turned = change - fall
            better = -0.5 * fall / turned if turned > 0.0 else 1.0
            if better > _CLOSE:
                break
            amount, fall = better * amount, better * fall
        return best

    def _made(self, move: Move, amount: float, before: Sequence[Proposal]) -> Solution:
        """The cover solved warm with a move and with those before it."""
        amounts: dict[Candidate, float] = {}
        parts = [p.amounts for p in before] + [{c: amount * v for c, v in move.share.items()}]
        for part in parts:
            for candidate, one in part.items():
                amounts[candidate] = amounts.get(candidate, 0.0) + one
        return solve_warm(self._changes.solution, self._changes.cover(amounts))

    def _along(self, move: Move, x: FloatArray) -> tuple[float, float]:
        """Largest gain along a move from ``x``, and the amount that gives it."""
        answer, slope = self._answer(move), self.slope(move)
        explicit = move.total(self._found.explicit) if move.share else 0.0
        limit = self._limits[move.kind]
        if move.kind == "wire":
            limit = min(limit, self._wires[id(move)][1])
        farthest = float(np.linalg.norm(answer, axis=1).max())
        largest = min(limit, _LINEAR / max(farthest, 1e-12))
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
            for candidate, part in move.share.items():
                force -= part * self._found.forces[candidate]
            self._answers[id(move)] = self._balance.solve(force)[: len(self._x)]
        return self._answers[id(move)]


def _same(a: Move, b: Move) -> bool:
    """Whether both change one edge the same way, or one hook, wire or panel."""
    return a.kind == b.kind and bool(set(a.names) & set(b.names))


def sentence(move: Move, amount: float, share: float) -> str:
    """Say a correction in the words of the trade.

    Examples
    --------
    >>> move = Move(kind="length", names=("INSERT.SIDE",), places=(("", ""),), share={})
    >>> sentence(move, -0.0042, 0.31)
    'edge INSERT.SIDE: make it 4.2 mm shorter; 31 % of what is wrong goes with it'
    """
    size, up = f"{1e3 * abs(amount):.1f} mm", amount > 0.0
    names = " and ".join(move.names)
    several = len(move.names) > 1
    if move.kind == "offset":
        parts = [
            f"edge {name}, from {begin} to {end}"
            for name, (begin, end) in zip(move.names, move.places, strict=True)
        ]
        way = f"let {size} into" if up else f"take {size} out of"
        text = f"{' and '.join(parts)}: {way} {'both panels' if several else 'the panel'} there"
    elif move.kind == "length":
        them = "both" if several else "it"
        text = f"edge {names}: make {them} {size} {'longer' if up else 'shorter'}"
    elif move.kind == "hook":
        them = "both" if several else "it"
        text = f"hook {names}: " + (
            f"pull {them} {size} deeper" if up else f"let {them} come up by {size}"
        )
    elif move.kind == "wire":
        text = f"wire {move.names[0]} holds nothing: hook seam {move.names[1]} to it"
    else:
        text = f"foam below {names}: " + (f"build it up by {size}" if up else f"take {size} off it")
    most = "up to " if move.kind == "wire" else ""
    return f"{text}; {most}{100 * share:.0f} % of what is wrong goes with it"
