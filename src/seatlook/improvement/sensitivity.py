"""What every candidate would change, by one solve with the transposed stiffness (the adjoint)."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import zip_longest

import numpy as np

from seatlook.improvement.candidate import Candidate
from seatlook.improvement.changes import Changes
from seatlook.improvement.objective import Objective, Parts
from seatlook.model import Cover, FloatArray, IntArray
from seatlook.solver.balance import Balance

# [m], of differences by the rest shape and by targets: forces are smooth over elements of 1 mm.
_WAY = 1e-7


@dataclass(frozen=True, slots=True, kw_only=True)
class Sensitivities:
    """Derivatives of the objective at a balance.

    Parameters
    ----------
    value : the objective there
    slope : candidate -> change of the objective per m [1/m]
    explicit : candidate -> the part of it at a fixed shape [1/m]
    forces : candidate -> (rows, 3) [N/m], that the change of 1 m would leave out of balance
    downhill : negative pivots of the stiffness: 0 where the balance is stable, and slopes mean
        something
    """

    value: Parts
    slope: Mapping[Candidate, float]
    explicit: Mapping[Candidate, float]
    forces: Mapping[Candidate, FloatArray]
    downhill: int


def sensitivities(
    balance: Balance, changes: Changes, objective: Objective, candidates: Sequence[Candidate]
) -> Sensitivities:
    """Derive the objective by all candidates at once.

    With forces g(x, p) = 0 in balance, ``dJ/dp = J,p - a . g,p`` where ``K a = J,x``: one solve,
    however many candidates there are. What a candidate does to the forces and to J at a fixed
    shape is a difference over a sheet that is built anew. Panels are not connected but by their
    seams, so one such sheet serves a candidate of every panel.
    """
    process = balance.process
    n = len(process.x)
    right = np.zeros_like(process.state)
    right[:n] = objective.gradient(process.sheet, process.x)
    adjoint = balance.solve(right)
    explicit: dict[Candidate, float] = {}
    forces: dict[Candidate, FloatArray] = {}
    for candidate, force, part in _responses(balance, changes, objective, candidates):
        forces[candidate], explicit[candidate] = force, part
    return Sensitivities(
        value=objective.parts(process.sheet, process.x),
        slope={c: explicit[c] - float((adjoint * forces[c]).sum()) for c in candidates},
        explicit=explicit,
        forces=forces,
        downhill=balance.downhill,
    )


def _responses(
    balance: Balance, changes: Changes, objective: Objective, candidates: Sequence[Candidate]
) -> Iterator[tuple[Candidate, FloatArray, float]]:
    """Each candidate, its forces (rows, 3) [N/m], and the change of J at a fixed shape [1/m]."""
    base = balance.changed()
    start, at_start = base.forces(), _by_panel(base, objective)
    owner = _owners(balance.process.cover)
    cut = [c for c in candidates if c.kind in ("offset", "length")]
    of_panel = [[c for c in cut if c.panel == p] for p in sorted({c.panel for c in cut})]
    for group in zip_longest(*of_panel):
        together = {c: _WAY for c in group if c is not None}
        other = balance.changed(changes.cover(together))
        change = (other.forces() - start) / _WAY
        explicit = (_by_panel(other, objective) - at_start) / _WAY
        for candidate in together:
            own = _rows(owner == candidate.panel, change)
            yield candidate, own, float(explicit[candidate.panel])
    for candidate in candidates:
        if candidate.kind == "hook":
            other = balance.changed(changes.cover({candidate: _WAY}))
            yield candidate, (other.forces() - start) / _WAY, 0.0
    raised = [c for c in candidates if c.kind == "foam"]
    if raised:
        lift = np.sum([changes.lift(c) for c in raised], axis=0)
        other = balance.changed(lift=_WAY * lift)
        change = (other.forces() - start) / _WAY
        for candidate in raised:
            own = _rows(changes.lift(candidate) > 0.0, change)
            yield candidate, own, objective.rise(balance.x, changes.lift(candidate))


def _by_panel(balance: Balance, objective: Objective) -> FloatArray:
    """What the faces of every panel add to the objective."""
    cover = balance.process.cover
    w2, strain = objective.faces(balance.process.sheet, balance.x)
    count = len(cover.panel_names)
    return np.asarray(np.bincount(cover.panel, w2 + strain, minlength=count), dtype=float)


def _owners(cover: Cover) -> IntArray:
    """Panel of every vertex, (n,)."""
    owner = np.zeros(len(cover.rest), dtype=np.int64)
    owner[cover.faces] = cover.panel[:, None]
    return owner


def _rows(mine: np.ndarray, forces: FloatArray) -> FloatArray:
    """Forces (rows, 3) on some vertices and on the settlements below them, 0 elsewhere."""
    out = np.zeros_like(forces)
    count = len(mine)
    out[:count][mine] = forces[:count][mine]
    below, source = out[count:].reshape(-1), forces[count:].reshape(-1)
    below[:count][mine] = source[:count][mine]
    return out
