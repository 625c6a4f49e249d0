"""Sew, hook, cover, come to rest: from the placed panels to the cover at rest on its foam."""

from __future__ import annotations

import time
from collections.abc import Callable
from types import MappingProxyType
from typing import Protocol

import numpy as np

from seatlook._version import __version__
from seatlook.errors import InputError, SolverError
from seatlook.model import Cover, FloatArray, Solution, stage_units
from seatlook.solver.process.pace import too_slow
from seatlook.solver.process.process import RESIDUAL, Process, Record
from seatlook.solver.process.settings import DEFAULT, SolverSettings
from seatlook.solver.process.stages import Step, check_stages, schedule
from seatlook.solver.process.verdict import figures, reasons, unrest

# Raised whenever the same cover comes to rest in another shape: results kept until then are not
# taken again. tests/solver/test_revision.py compares the shapes.
REVISION = 3
_REST = "at rest"
_ROUNDS = 40  # of the way to rest, each with the inertia of a time step twice as long
_LONGER = 10.0  # than a time step, the first of them
_REST_ITERATIONS = 300  # of one round
_MOST_ITERATIONS = 10_000  # of all rounds
_TURNS = 8  # of both methods together, each until it is too slow
_KICK, _KICKS = 0.5, 5  # thickness; how often an unstable balance is left
_REFACTOR = 3  # time steps that share a factor


class ConvergenceError(SolverError):
    """The solver stopped before equilibrium; ``solution`` is the last state it had."""

    def __init__(self, reason: str, solution: Solution) -> None:
        super().__init__(reason)
        self.solution = solution


class Progress(Protocol):
    """What ``solve`` calls after every step; lengths in m, energy in J."""

    def __call__(
        self, *, stage: str, step: int, steps: int, energy: float, residual: float, gap: float
    ) -> None:
        """Show the state."""
        ...


def solve(
    cover: Cover,
    *,
    settings: SolverSettings = DEFAULT,
    start: Solution | None = None,
    progress: Progress | None = None,
    snapshot: Callable[[Solution], None] | None = None,
    shape: Callable[[str, float, FloatArray], None] | None = None,
    strict: bool = False,
) -> Solution:
    """Carry out the stages of a cover and let it come to rest.

    Damped backward Euler; every step minimises one potential (inertia, sheet, weight, foam,
    lagged friction, ties), then the static balance is sought with friction and tie forces updated
    until they agree with the shape.

    Parameters
    ----------
    settings : method, time step and iterations
    start : earlier solution; the process goes on after its stage. From another mesh of the same
        panels the shape is taken over, by quadratics, and what its fabrics have gone through: a
        coarse solution at rest saves a fine mesh the way there
    progress : called after every step
    snapshot : called with the state at the end of every stage
    shape : called with stage, time [s] and positions (n, 3) [m] after every time step; the
        positions are those the solver goes on with, so copy what is kept
    strict : raise when the result is not converged

    Returns
    -------
    Solution
        ``status`` is "converged" when the largest out-of-balance force is below 1e-3 of the mean
        elastic nodal force, seams are closed to 0.1 mm, kinetic energy is below 1e-4 of the
        elastic, the foam stays within its curve, and the cover lies on it, neither buried in it nor
        below bare foam; else ``reason`` says what is not.

    Raises
    ------
    InputError              a tie names a stage that is not planned, the foam is not closed
    InvertedElementError    a triangle without area, before or after
    SolverError             the energy is not a number
    UnstableStepError       the explicit time step is longer than the mesh allows
    ConvergenceError        only with ``strict``; carries the last Solution
    """
    check_stages(cover)
    clock = time.process_time()
    process = Process(cover, settings)
    plan = schedule(cover.stages, settings.dt)
    ahead = plan if start is None else _after(plan, start, cover)
    if start is not None:
        count = len(plan) - len(ahead)
        process.resume(start, time=plan[count - 1].time if count else 0.0)
    run = _Run(process, plan, clock, progress, settings_of(settings), settings.method == "auto")
    for i, step in enumerate(ahead):
        first = i == 0 or ahead[i - 1].stage != step.stage
        if first:
            process.begin()
        refactor = first or plan.index(step) % _REFACTOR == 0
        run.add(step.stage, process.step(step, refactor=refactor))
        if shape is not None:
            shape(step.stage, step.time, process.x)
        last = i + 1 == len(ahead) or ahead[i + 1].stage != step.stage
        if last and snapshot is not None:
            snapshot(run.solution(step.stage, ["not yet brought to rest"]))
    causes = run.come_to_rest()
    solution = run.solution(_REST, [*reasons(process, run.records[-1]), *causes])
    if strict and solution.status != "converged":
        raise ConvergenceError(solution.reason, solution)
    return solution


def settings_of(settings: SolverSettings = DEFAULT) -> str:
    """How a result was solved, in one line: revision of the solver, method, steps.

    Examples
    --------
    >>> settings_of(SolverSettings(dt=0.01))
    'revision 3, auto, dt 0.01 s, 8 iterations'
    """
    steps = f"dt {settings.dt:g} s, {settings.iterations} iterations"
    return f"revision {REVISION}, {settings.method}, {steps}"


SETTINGS = settings_of()


class _Run:
    """History and clock of one call of ``solve``."""

    def __init__(
        self,
        process: Process,
        plan: list[Step],
        clock: float,
        progress: Progress | None,
        settings: str,
        may_change: bool,
    ) -> None:
        self.settings = settings
        self.may_change, self.turns = may_change, 0
        self.process, self.progress, self.clock = process, progress, clock
        self.steps, self.plan = len(plan) + 1, plan
        self.records: list[Record] = []
        self.seconds: list[float] = []

    def add(self, stage: str, record: Record) -> None:
        """Keep and show a step."""
        self.records.append(record)
        self.seconds.append(time.process_time() - self.clock)
        if self.progress is not None:
            self.progress(
                stage=stage,
                step=min(len(self.records), self.steps),
                steps=self.steps,
                energy=record.energy,
                residual=record.residual,
                gap=record.seam_gap,
            )

    def come_to_rest(self) -> list[str]:
        """Come to rest and leave unstable balances; return why it did not work."""
        self.process.begin(rest=True)
        kick = _KICK * float(self.process.cover.thickness.max())
        for push in (*[kick] * _KICKS, 0.0):
            if not self._rest() or not self.process.downhill(push):
                return []
        return ["unstable: negative stiffness in one direction"]

    def _rest(self) -> bool:
        """Come to rest, by the other method in turn where one is too slow; whether it worked."""
        for _ in range(_TURNS if self.may_change else 1):
            if self._settle():
                return True
            if self.may_change:
                self.turns += 1
                self.process.take("lbfgs" if self.process.method == "newton" else "newton")
        return False

    def _settle(self) -> bool:
        """Repeat the static solve until all that lags agrees with the shape; whether it does."""
        process, residuals = self.process, list[float]()
        record, iterations, dt = process.record(), 0, _LONGER * process.dt
        for count in range(1, _ROUNDS + 1):
            limit = min(_REST_ITERATIONS, _MOST_ITERATIONS - iterations)
            record = process.approach_rest(dt, record, limit)
            self.add(_REST, record)
            iterations += record.iterations
            dt *= 2.0
            if not unrest(process, record):
                return True
            residuals.append(record.residual)
            left = min(_ROUNDS - count, count * (_MOST_ITERATIONS / max(iterations, 1) - 1.0))
            if left <= 0 or (self.may_change and too_slow(residuals, RESIDUAL, left)):
                break
        return False

    def solution(self, stage: str, causes: list[str]) -> Solution:
        """The state as a Solution."""
        process = self.process
        top, mid, bottom = process.sheet.strains(process.x)
        ties = process.ties
        columns = {
            name: np.array([getattr(record, name) for record in self.records], dtype=float)
            for name in Record._fields
        }
        foundation, free = process.foundation, np.full_like(process.x, np.nan)
        spent = {
            "cpu_seconds": time.process_time() - self.clock,
            "changes_of_method": float(self.turns),
        }
        return Solution(
            cover=process.cover,
            positions=process.x,
            velocities=process.v,
            strain_top=top,
            strain_mid=mid,
            strain_bottom=bottom,
            multipliers=MappingProxyType(
                {t.name: ties.multiplier[t.rows].copy() for t in ties.ties}
            ),
            forces=MappingProxyType(ties.forces(process.x)),
            friction_anchor=free if foundation is None else foundation.friction.anchor,
            strain_peak=process.sheet.membrane.peaks,
            stage=stage,
            status="not converged" if causes else "converged",
            reason="; ".join(causes),
            history=MappingProxyType(columns | {"cpu_seconds": np.array(self.seconds)}),
            figures=MappingProxyType(figures(process, self.records) | spent),
            settings=self.settings,
            version=__version__,
        )


def _after(plan: list[Step], start: Solution, cover: Cover) -> list[Step]:
    """Steps after the stage at whose end ``start`` was taken."""
    if start.stage == _REST:
        return []
    numbers = [i for i, step in enumerate(plan) if step.stage == start.stage]
    if not numbers:
        raise InputError.single(
            "start.stage",
            got=repr(start.stage),
            expected=f"one of {stage_units(cover.stages)}",
        )
    return plan[numbers[-1] + 1 :]
