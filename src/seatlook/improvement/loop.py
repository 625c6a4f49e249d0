"""Corrections one after the other, each from slopes where the cover now is, checked warm."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import Protocol

import numpy as np

from seatlook.chain.assess import Assessment
from seatlook.errors import InvertedElementError, SolverError
from seatlook.improvement.candidate import Candidate
from seatlook.improvement.changes import Amounts, Changes, added
from seatlook.improvement.moves import Move
from seatlook.improvement.objective import Goal, Parts, objective_of
from seatlook.improvement.propose import in_words, refuse_unbalanced
from seatlook.improvement.warm import solve_warm
from seatlook.improvement.ways import (
    LEAST_GAIN,
    REACH,
    SHORT_LIST,
    SMALLEST,
    Ways,
    checked,
    free_of,
    ways_at,
)
from seatlook.model import Scene, Solution

MOST_ITERATIONS = 8
GOOD = 1e-3  # mean of what is beyond the goals, in units of W2: as good as nothing
_REFUSALS = 3  # moves from one place that gained nothing
_TRUSTED, _MISTRUSTED = 0.75, 0.25  # of the expected gain: the reach grows, or shrinks
_SHORTEST = 0.2  # of the reach
_COUNTS = 0.01  # of the objective for a mm, from which it is said that something limits it


@dataclass(frozen=True, slots=True, kw_only=True)
class Iteration:
    """Where the loop is.

    Parameters
    ----------
    number : 0 for the start
    value : parts of the objective, from a warm solve
    beyond : the same with sharp kinks: 0 where nothing is beyond its goal
    made : candidate -> amount [m], all in all
    chosen : moves that were first made, in order; later ones of the same edges adjust them
    sentence : what this iteration changed
    expected : gain that slopes and straight answers promised
    solves : warm ones up to here
    closed : numbers of seams whose lines were made equal; they stay so
    ended : why it is the last; "" before
    limit : what would help most and may not be changed, "" where nothing is known
    """

    number: int
    value: Parts
    beyond: float
    made: Amounts = field(default_factory=lambda: MappingProxyType({}))
    chosen: tuple[Move, ...] = ()
    sentence: str = "as it is"
    expected: float = 0.0
    solves: int = 0
    closed: frozenset[int] = frozenset()
    ended: str = ""
    limit: str = ""

    @property
    def good(self) -> bool:
        """Whether nothing is beyond its goal."""
        return self.beyond <= GOOD


class Place(Protocol):
    """What is known of moves where a cover is: slopes, and gains along straight answers."""

    moves: tuple[Move, ...]
    repairs: tuple[Move, ...]
    fixed: tuple[Move, ...]

    def slope(self, move: Move) -> float:
        """Derivative of the objective per m."""

    def room(self, move: Move) -> float:
        """How far [m] a move may still go downhill."""

    def choose(self, moves: Sequence[Move], *, reach: float) -> tuple[float, float, Move]:
        """Gain, amount and move of what helps most."""


class Task(Protocol):
    """What is to be improved."""

    def value(self, made: Amounts) -> tuple[Parts, float] | None:
        """Objective with amounts made, and the same with sharp kinks; None if not solvable."""

    def place(self, made: Amounts) -> Place:
        """Look around with amounts made; ``SolverError`` where slopes mean nothing."""


def improve(
    scene: Scene, assessment: Assessment, *, goal: Goal | None = None
) -> Iterator[Iteration]:
    """Correct a seat step by step, within [improve] of its scene.

    Every iteration takes slopes where the cover now is, makes what helps most, and checks the
    amount by warm solves. What was chosen before may be adjusted. It ends when nothing is beyond
    the goal, nothing helps by more than 3 %, or after eight iterations.

    Yields
    ------
    Iteration
        The start, every correction, and where it ended. None is worse than the one before.

    Raises
    ------
    InputError
        Nothing may change.
    SolverError
        The result is not converged, or its balance is unstable.
    """
    refuse_unbalanced(assessment.solution)
    return descend(SeatTask(scene, assessment, goal or Goal()), most=scene.improve.corrections)


def descend(task: Task, *, most: int) -> Iterator[Iteration]:
    """Make the loop's steps for any task, see ``improve``.

    Parameters
    ----------
    most : corrections, not counting those that adjust one
    """
    first = task.value({})
    if first is None:
        raise SolverError("the start cannot be solved again from its own balance")
    now = Iteration(number=0, value=first[0], beyond=first[1])
    start, reach, place = now.value.total, REACH, None
    yield now
    ended = _AS_GOOD if now.good else ""
    while not ended and now.number < MOST_ITERATIONS:
        try:
            place = task.place(now.made)
        except SolverError as error:
            if now.number == 0:
                raise
            ended = str(error)
            break
        step = _Step(task, place, now, most)
        found, ended = step.best(reach, LEAST_GAIN * start)
        if found is not None:
            if found.expected > 0.0:
                share = (now.value.total - found.value.total) / found.expected
                reach = _next_reach(reach, share)
            ended = _AS_GOOD if found.good else ""
            now = found
            yield now
        else:
            now = replace(now, solves=now.solves + step.solves)
    limit = _limit(place, now, most, start) if place and ended != _AS_GOOD else ""
    yield replace(
        now, number=now.number + 1, sentence="ended", expected=0.0, limit=limit,
        ended=ended or f"{MOST_ITERATIONS} iterations are made",
    )  # fmt: skip


_AS_GOOD = "nothing is beyond its goal"
_NO_GAIN = f"nothing that may change helps by more than {100 * LEAST_GAIN:.0f} %"


class _Step:
    """One iteration: the best move that is confirmed by a warm solve."""

    def __init__(self, task: Task, place: Place, now: Iteration, most: int) -> None:
        self._task, self._place, self._now, self._most = task, place, now, most
        self.solves = 0

    def best(self, reach: float, least: float) -> tuple[Iteration | None, str]:
        """The next iteration, or None and why there is none.

        Sewn lines that do not agree say where a pattern was changed. They are put right first,
        if that makes nothing worse.
        """
        for move in self._place.repairs[:_REFUSALS]:
            if _allowed(move, self._now.chosen, self._most):
                found = self._mended(move)
                if found is not None and found.value.total <= self._now.value.total:
                    return found, ""
        left = [
            m
            for m in self._place.moves
            if _allowed(m, self._now.chosen, self._most) and not m.seams & self._now.closed
        ][:SHORT_LIST]
        for _ in range(_REFUSALS):
            if not left:
                break
            gain, amount, move = self._place.choose(left, reach=reach)
            if gain < least or abs(amount) < SMALLEST:
                break
            if move.kind == "wire":
                return None, in_words(move, amount)
            found = self._checked(move, amount, gain)
            if found is not None and self._now.value.total - found.value.total >= least:
                return found, ""
            left.remove(move)
        return None, _NO_GAIN

    def _mended(self, move: Move) -> Iteration | None:
        self.solves += 1
        found = self._task.value(self._made(move, move.closes))
        return None if found is None else self._iteration(move, move.closes, found, 0.0)

    def _checked(self, move: Move, amount: float, gain: float) -> Iteration | None:
        values: dict[float, tuple[Parts, float]] = {}

        def change(one: float) -> float | None:
            self.solves += 1
            found = self._task.value(self._made(move, one))
            if found is None:
                return None
            values[one] = found
            return found[0].total - self._now.value.total

        closes = move.closes if abs(move.closes) <= self._place.room(move) else 0.0
        best, _ = checked(change, amount, self._place.slope(move), closes)
        return self._iteration(move, best, values[best], gain) if best in values else None

    def _iteration(
        self, move: Move, amount: float, value: tuple[Parts, float], expected: float
    ) -> Iteration:
        again = _adjusts(move, self._now.chosen)
        closed = move.seams if move.closes and amount == move.closes else frozenset[int]()
        return Iteration(
            number=self._now.number + 1,
            value=value[0],
            beyond=value[1],
            made=self._made(move, amount),
            chosen=self._now.chosen if again else (*self._now.chosen, move),
            sentence=f"{'adjusted: ' if again else ''}{in_words(move, amount)}",
            expected=expected,
            solves=self._now.solves + self.solves,
            closed=self._now.closed | closed,
        )

    def _made(self, move: Move, amount: float) -> Mapping[Candidate, float]:
        return added(self._now.made, move.amounts(amount))


def _adjusts(move: Move, chosen: Sequence[Move]) -> bool:
    """Whether a move changes nothing but what earlier ones did."""
    names = {name for other in chosen if other.kind == move.kind for name in other.names}
    return set(move.names) <= names


def _allowed(move: Move, chosen: Sequence[Move], most: int) -> bool:
    return len(chosen) < most or _adjusts(move, chosen)


def _next_reach(reach: float, share: float) -> float:
    """How far the next step may go after one that gained a share of what was expected."""
    if share > _TRUSTED:
        return min(2.0 * reach, REACH)
    return max(0.5 * reach, _SHORTEST * REACH) if share < _MISTRUSTED else reach


def _limit(place: Place, now: Iteration, most: int, start: float) -> str:
    """What would help most for each mm, of all that may not be changed, and why it may not."""
    blocked = [(move, "it is frozen") for move in place.fixed]
    for move in place.moves:
        if move.kind == "wire":
            blocked.append((move, ""))
        elif not _allowed(move, now.chosen, most):
            blocked.append((move, f"{most} corrections are made"))
        elif place.room(move) < SMALLEST:
            blocked.append((move, "it is at its limit in [improve]"))
    steepest = max(blocked, key=lambda one: abs(place.slope(one[0])), default=None)
    if steepest is None or 1e-3 * abs(place.slope(steepest[0])) < _COUNTS * start:
        return ""
    move, why = steepest
    if move.kind == "wire":
        return in_words(move, 0.0)
    share = 1e-3 * abs(place.slope(move)) / start
    words = in_words(move, -1e-3 * float(np.sign(place.slope(move))))
    return f"{words}: {100 * share:.0f} % for this mm, but {why}"


class SeatTask:
    """The task of a seat; each value is solved from the start, whatever was tried before.

    Raises
    ------
    InputError
        Nothing may change.
    """

    def __init__(self, scene: Scene, assessment: Assessment, goal: Goal) -> None:
        self._scene, self._start = scene, assessment.solution
        self._changes = Changes(self._start, scene.pattern)
        free_of(scene, self._changes)  # refuses before anything is done
        self._objective = objective_of(scene, assessment, goal)
        self._solved: dict[frozenset[tuple[Candidate, float]], Solution] = {}

    def value(self, made: Amounts) -> tuple[Parts, float] | None:
        """Objective of a warm solve with amounts made, rounded and sharp; None if not at rest."""
        try:
            solution = self._solution(made)
        except (SolverError, InvertedElementError):
            return None
        if solution.status != "converged":
            return None
        return self._objective.of(solution), self._objective.literal().of(solution).total

    def place(self, made: Amounts) -> Ways:
        """Slopes and moves with amounts made."""
        solution = self._solution(made)
        return ways_at(
            self._scene, solution, self._changes, self._objective.over(solution.cover),
            made=made, with_fixed=True,
        )  # fmt: skip

    def _solution(self, made: Amounts) -> Solution:
        if not made:
            return self._start
        key = frozenset(made.items())
        if key not in self._solved:
            self._solved[key] = solve_warm(self._start, self._changes.cover(made))
        return self._solved[key]
