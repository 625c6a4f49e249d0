"""Whether a corrected seat is better: both solved cold, from the same seeds."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from scipy.stats import t

from seatlook.assembly import with_mesh
from seatlook.chain.assess import Assessment
from seatlook.chain.case import Case
from seatlook.improvement.objective import Goal, Parts, objective_of
from seatlook.model import Scene
from seatlook.model.progress import Progress, silent

SEEDS = 3
_SURE = 0.95


@dataclass(frozen=True, slots=True, kw_only=True)
class Proof:
    """What cold solves of the same seeds say of a correction.

    Parameters
    ----------
    seeds : of mesh and imperfection
    before, after : parts of the objective, one for each seed
    error : of the gain by the mesh, as an estimate
    missed : limits of [accept] that the corrected seat misses with some seed, a sentence each
    unsolved : why some solve is not at rest, a sentence each
    corrected : the corrected seat with the first of the seeds, None where it was not kept
    """

    seeds: tuple[int, ...]
    before: tuple[Parts, ...]
    after: tuple[Parts, ...]
    error: float
    missed: tuple[str, ...] = ()
    unsolved: tuple[str, ...] = ()
    corrected: Assessment | None = field(default=None, repr=False, compare=False)

    @property
    def gains(self) -> tuple[float, ...]:
        """Fall of the objective for each seed."""
        return tuple(a.total - b.total for a, b in zip(self.before, self.after, strict=True))

    @property
    def gain(self) -> float:
        """Mean fall of the objective."""
        return float(np.mean(self.gains))

    @property
    def scatter(self) -> float:
        """95 % half-width of that mean, by Student's t; infinite from fewer than two seeds."""
        count = len(self.gains)
        if count < 2:
            return math.inf
        width = float(t.ppf(0.5 + 0.5 * _SURE, count - 1))
        return width * float(np.std(self.gains, ddof=1)) / math.sqrt(count)

    @property
    def better(self) -> bool:
        """Whether the gain is above error and scatter together, and all solves are at rest."""
        return not self.unsolved and self.gain > self.error + self.scatter

    @property
    def sentence(self) -> str:
        """All of it for a reader.

        Examples
        --------
        >>> parts = [Parts(w2=w2, strain=0.0, gap=0.0) for w2 in (0.04, 0.05, 0.02, 0.03)]
        >>> proof = Proof(seeds=(0, 1), before=parts[:2], after=parts[2:], error=0.001)
        >>> proof.sentence
        'better: 44 % of what was wrong is gone (error 2 %, scatter 0 %, 2 seeds)'
        """
        if self.unsolved:
            return f"not proven: {'; '.join(self.unsolved)}"
        start = float(np.mean([p.total for p in self.before]))
        gain, error, scatter = (100 * v / start for v in (self.gain, self.error, self.scatter))
        what = f"{gain:.0f} % of what was wrong is gone"
        with_ = f"(error {error:.0f} %, scatter {scatter:.0f} %, {len(self.seeds)} seeds)"
        return (
            f"better: {what} {with_}" if self.better else f"not proven to be better: {what} {with_}"
        )


def prove(
    scene: Scene,
    assessment: Assessment,
    corrected: Scene,
    *,
    goal: Goal | None = None,
    seeds: int = SEEDS,
    progress: Progress = silent,
) -> Proof:
    """Solve a seat and its correction cold, with the same seeds, and compare the objectives.

    Parameters
    ----------
    assessment : of the start with the scene's own seed, which is the first
    corrected : the scene changed

    Raises
    ------
    InputError, SolverError
    """
    numbers = tuple(scene.seed + k for k in range(seeds))
    before, after = [assessment], list[Assessment]()
    for number in numbers:
        progress("proof", step=len(after), steps=seeds)
        if number != scene.seed:
            before.append(_cold(scene, number, progress))
        after.append(_cold(corrected, number, progress))
    goal = goal or Goal()
    parts = [
        tuple(objective_of(scene, one, goal).of(one.solution) for one in side)
        for side in (before, after)
    ]
    return Proof(
        seeds=numbers,
        before=parts[0],
        after=parts[1],
        error=_error(assessment, *parts),
        missed=_missed(corrected, numbers, after),
        unsolved=_unsolved(numbers, before, after),
        corrected=after[0],
    )


def _cold(scene: Scene, seed: int, progress: Progress) -> Assessment:
    case = Case(with_mesh(scene, seed=seed))
    case.solve(progress=progress)
    return case.assessment


def _error(assessment: Assessment, before: Sequence[Parts], after: Sequence[Parts]) -> float:
    """What the mesh may be wrong by: both have the same one, so the error goes with the gain."""
    resolution = assessment.resolution
    share = resolution.error or max((wave.error for wave in resolution.waves), default=0.0)
    pairs = list(zip(before, after, strict=True))
    gains = (
        np.mean([a.w2 - b.w2 for a, b in pairs]),
        np.mean([a.strain - b.strain for a, b in pairs]),
        np.mean([a.gap - b.gap for a, b in pairs]),
    )
    return share * float(np.abs(gains).sum())


def _missed(scene: Scene, seeds: Sequence[int], after: Sequence[Assessment]) -> tuple[str, ...]:
    return tuple(
        f"seed {seed}: {v.limit.zone}: {v.limit.measure} is {v.value:.4g}, "
        f"the limit is {v.limit.maximum:.4g}"
        for seed, one in zip(seeds, after, strict=True)
        for v in one.verdicts(scene)
        if not v.kept
    )


def _unsolved(
    seeds: Sequence[int], before: Sequence[Assessment], after: Sequence[Assessment]
) -> tuple[str, ...]:
    return tuple(
        f"{name} with seed {seed}: {one.solution.reason}"
        for name, side in (("the start", before), ("the correction", after))
        for seed, one in zip(seeds, side, strict=True)
        if one.solution.status != "converged"
    )
