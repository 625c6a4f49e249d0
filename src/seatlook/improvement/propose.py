"""The corrections that would help most, from one adjoint; each is checked by a warm solve."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from seatlook.chain.assess import Assessment
from seatlook.errors import SolverError
from seatlook.improvement.candidate import Candidate
from seatlook.improvement.changes import Changes, added
from seatlook.improvement.moves import Move
from seatlook.improvement.objective import Goal, Objective, Parts, objective_of
from seatlook.improvement.warm import solve_warm
from seatlook.improvement.ways import LEAST_GAIN, SHORT_LIST, SMALLEST, Ways, checked, ways_at
from seatlook.model import FloatArray, Scene, Solution


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
        return self.move.amounts(self.amount)


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
    refuse_unbalanced(solution)
    changes = Changes(solution, scene.pattern)
    objective = objective_of(scene, assessment, goal or Goal())
    ways = ways_at(scene, solution, changes, objective)
    search = _Search(ways, changes, objective)
    return Proposals(
        value=ways.value,
        proposals=tuple(search.best(ways.moves[:SHORT_LIST], count)),
        slope=tuple((move, ways.slope(move)) for move in ways.moves),
    )


def refuse_unbalanced(solution: Solution) -> None:
    """Refuse a result that slopes mean nothing at.

    Raises
    ------
    SolverError
        It is not converged.
    """
    if solution.status != "converged":
        raise SolverError(f"nothing can be proposed from a result that is not: {solution.reason}")


class _Search:
    """Looks for one move after the other from a balance."""

    def __init__(self, ways: Ways, changes: Changes, objective: Objective) -> None:
        self._ways, self._changes, self._objective = ways, changes, objective
        self._start = ways.value.total

    def best(self, moves: Sequence[Move], count: int) -> list[Proposal]:
        """Up to ``count`` moves one after the other, each checked by a warm solve.

        A wire that holds nothing ends the list: it cannot be checked, and what else to do shows
        when it is hooked.
        """
        start = value = self._start
        x, left, proposals = self._ways.x, list(moves), list[Proposal]()
        for move in self._ways.repairs[:1]:
            amount, gain, there = self._checked(move, move.closes, value, ())
            if amount == move.closes and gain >= 0.0:
                x, value = there, value - gain
                left = [other for other in left if not _same(other, move)]
                proposals.append(_proposal(move, amount, gain, start))
        while left and len(proposals) < count:
            gain, amount, move = self._ways.choose(left, x=x)
            if gain < LEAST_GAIN * start or abs(amount) < SMALLEST:
                break
            left = [other for other in left if not _same(other, move)]
            if move.kind == "wire":
                gain, left = min(gain, value), []
            else:
                amount, gain, x = self._checked(move, amount, value, proposals)
                if gain < LEAST_GAIN * start:
                    continue
                value -= gain
            proposals.append(_proposal(move, amount, gain, start))
        return proposals

    def _checked(
        self, move: Move, amount: float, value: float, before: Sequence[Proposal]
    ) -> tuple[float, float, FloatArray]:
        """Amount, gain and shape of a move that is made warm, on top of those before."""
        shapes = {0.0: self._ways.x}

        def change(one: float) -> float:
            parts = [p.amounts for p in before] + [move.amounts(one)]
            cover = self._changes.cover(added(*parts))
            solution = solve_warm(self._changes.solution, cover)
            shapes[one] = solution.positions
            return self._objective.of(solution).total - value

        closes = move.closes if abs(move.closes) <= self._ways.room(move) else 0.0
        best, gain = checked(change, amount, self._ways.slope(move), closes)
        return best, gain, shapes[best]


def _proposal(move: Move, amount: float, gain: float, start: float) -> Proposal:
    share = gain / start
    return Proposal(
        move=move, amount=amount, gain=gain, share=share, sentence=sentence(move, amount, share)
    )


def _same(a: Move, b: Move) -> bool:
    """Whether both change one edge the same way, or one hook, wire or panel."""
    return a.kind == b.kind and bool(set(a.names) & set(b.names))


def sentence(move: Move, amount: float, share: float) -> str:
    """Say a correction in the words of the trade, and what it gains.

    Examples
    --------
    >>> move = Move(kind="length", names=("INSERT.SIDE",), places=(("", ""),), share={})
    >>> sentence(move, -0.0042, 0.31)
    'edge INSERT.SIDE: make it 4.2 mm shorter; 31 % of what is wrong goes with it'
    """
    most = "up to " if move.kind == "wire" else ""
    return f"{in_words(move, amount)}; {most}{100 * share:.0f} % of what is wrong goes with it"


def in_words(move: Move, amount: float) -> str:
    """Say a correction in the words of the trade."""
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
    return text
