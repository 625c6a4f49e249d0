"""Seams, hooks and frames: what pulls points of the cover together or to their targets."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.sparse import csc_array, csr_array, diags_array, identity, kron

from seatlook.model import Anchor, Cover, FloatArray, IntArray, Stitching
from seatlook.solver.kernels import ties as kernel
from seatlook.solver.process.sliding import Released, Rings, Sliding

Kind = Literal["seam", "hook", "frame"]
_STIFFER = 100.0  # than a strip of fabric one element long: a softer tie lets a buckled edge flip
_SMALL_GAP = 5e-5  # m, that needs no multiplier
# A tie closes by pulling ever harder; only when closed does it reach its full stiffness.
_SLIDES = 0.8  # of its stage, from which on a ring slides: the cover still settles anyway
_PROGRESS, _SHARE = (0.0, 1.0, 1.4), (1e-5, 1e-2, 1.0)


@dataclass(frozen=True, slots=True)
class Tie:
    """One seam, hook line or frame edge: a stretch of the rows of ``Ties``."""

    name: str
    kind: Kind
    stage: str
    rows: slice


class Ties:
    """Zero-length springs with an augmented Lagrangian.

    Rings of a hook are drawn in to their places on the wire, and slide along it when they are all
    but there: from then on their springs act across the wire, and along it only at a stop.

    Parameters
    ----------
    cover : its stitchings and anchors
    stiffness : (n,) float64 [N/m2]   EA / h of the fabric at each vertex
    """

    def __init__(self, cover: Cover, stiffness: FloatArray) -> None:
        self.ties: list[Tie] = []
        vertices, weights, target, length = [], [], [], []
        self._rings: dict[str, Rings] = {}
        count = 0
        parts: list[Stitching | Anchor] = [*cover.stitchings, *cover.anchors]
        for part in parts:
            rows = slice(count, count + len(part.length))
            v, w, t = _rows(part)
            kind: Kind = "seam" if isinstance(part, Stitching) else part.kind
            self.ties.append(Tie(part.name, kind, part.stage, rows))
            if isinstance(part, Anchor) and part.wire is not None:
                self._rings[part.name] = Rings(part.points, part.wire, rows)
            vertices.append(v)
            weights.append(w)
            target.append(t)
            length.append(part.length)
            count = rows.stop
        self.vertices: IntArray = np.concatenate([np.zeros((0, 4), np.int64), *vertices])
        self.weights: FloatArray = np.concatenate([np.zeros((0, 4)), *weights])
        self.goal: FloatArray = np.concatenate([np.zeros((0, 3)), *target])
        softest = np.where(self.weights != 0, stiffness[self.vertices], np.inf).min(axis=1)
        self.full: FloatArray = np.concatenate([np.zeros(0), *length]) * softest * _STIFFER
        self.stiff = np.zeros(count)
        self.target = self.goal.copy()
        self.multiplier = np.zeros((count, 3))
        self.sliding = Sliding(count)
        self._gap, self._force = np.zeros((count, 3)), np.zeros((count, 3))
        self._weights = csr_array(
            (self.weights.ravel(), self.vertices.ravel(), 4 * np.arange(count + 1)),
            shape=(count, len(stiffness)),
            copy=True,  # its rows are sorted, which those of ``vertices`` must not be
        )
        self._weights.sum_duplicates()

    def value(self, x: FloatArray, gradient: FloatArray) -> float:
        """Return the energy [J] and add its gradient [N]."""
        return float(
            kernel.tie_value(
                x,
                self.vertices,
                self.weights,
                self.target,
                self.stiff,
                self.multiplier,
                self.sliding.direction,
                self.sliding.play,
                self._force,
                gradient,
            )
        )

    def gap(self, x: FloatArray) -> FloatArray:
        """Distance left between the points of every row, (s, 3) [m]."""
        kernel.tie_gap(x, self.vertices, self.weights, self.goal, self._gap)
        return self._gap

    def pull(self, x: FloatArray, before: Mapping[str, float], after: Mapping[str, float]) -> None:
        """Set targets for a step in which the progress of each stage goes from 0 (slack) to 1.

        The gap there is shrinks by the share of the way that the step covers, and the springs
        stiffen from weak to full: points travel evenly and around what lies in the way.
        """
        drawn = [t.name for t in self.ties if before[t.stage] >= _SLIDES]
        self.sliding.begin([self._rings[name] for name in drawn if name in self._rings])
        self.sliding.seat(x, self.goal)
        gap = self.gap(x)
        for tie in self.ties:
            s0, s1 = before[tie.stage], after[tie.stage]
            share = max(1.0 - s1, 0.0) / (1.0 - s0) if s0 < 1.0 else 0.0
            self.stiff[tie.rows] = self.full[tie.rows] * _ramp(s1)
            self.target[tie.rows] = self.goal[tie.rows] + share * gap[tie.rows]

    def close(self) -> None:
        """Give all ties their full stiffness and final targets, and let all rings slide."""
        np.copyto(self.stiff, self.full)
        np.copyto(self.target, self.goal)
        self.sliding.begin([*self._rings.values()])

    def lag(self, x: FloatArray) -> None:
        """Seat rings that slide anew; until the next time they slide along a straight line."""
        left = self.target - self.goal
        self.sliding.seat(x, self.goal)
        np.add(self.goal, left, out=self.target)

    def points(self, kind: Kind) -> csc_array:
        """Weights (s, n) of the vertices in the gaps of a kind."""
        rows = [np.arange(t.rows.start, t.rows.stop) for t in self.ties if t.kind == kind]
        return csc_array(self._weights[np.concatenate([np.zeros(0, np.int64), *rows])])

    def largest_gap(self, x: FloatArray, kind: Kind) -> float:
        """Largest gap of all ties of a kind [m], 0 if there is none."""
        size = np.linalg.norm(self.gap(x), axis=1)
        return max((float(size[t.rows].max()) for t in self.ties if t.kind == kind), default=0.0)

    def figures(self, x: FloatArray) -> dict[str, float]:
        """Gaps [m] of each kind, and for every tie its gaps and its pull in all [N]."""
        result: dict[str, float] = {}
        force = np.linalg.norm(self.force(x), axis=1)
        size = np.linalg.norm(self.gap(x), axis=1)
        for kind in ("seam", "hook", "frame"):
            rows = [size[t.rows] for t in self.ties if t.kind == kind]
            gaps = np.concatenate([np.zeros(0), *rows])
            result[f"{kind}_gap_max"] = float(gaps.max(initial=0.0))
            result[f"{kind}_gap_mean"] = float(gaps.mean()) if gaps.size else 0.0
        for tie in self.ties:
            result[f"{tie.kind}/{tie.name}/gap_max"] = float(size[tie.rows].max(initial=0.0))
            result[f"{tie.kind}/{tie.name}/gap_mean"] = float(size[tie.rows].mean())
            result[f"{tie.kind}/{tie.name}/force_max"] = float(force[tie.rows].max(initial=0.0))
            result[f"{tie.kind}/{tie.name}/force_sum"] = float(force[tie.rows].sum())
        return result

    def update(self, x: FloatArray) -> None:
        """One step of the augmented Lagrangian: multipliers take the force where a gap is left.

        Points that cannot all reach their targets (more of them than vertices) would make the
        multipliers grow for ever, so a gap that is small enough is left to the spring.
        """
        gap = self.gap(x)
        closed = (self.target == self.goal).all(axis=1) & (np.abs(gap).max(axis=1) > _SMALL_GAP)
        self.multiplier[closed] = -self.force(x)[closed]

    def force(self, x: FloatArray) -> FloatArray:
        """Pull of every row on its first side, (s, 3) [N]: minus spring and multiplier."""
        self.value(x, np.zeros_like(x))
        return -self._force

    def forces(self, x: FloatArray) -> dict[str, FloatArray]:
        """Pull of every tie, (s, 3) [N], by its name."""
        force = self.force(x)
        return {tie.name: force[tie.rows].copy() for tie in self.ties}

    def stiffness(self) -> csc_array:
        """Scalar stiffness of all springs that pull, as if no ring slid."""
        w = self._weights
        return csc_array(w.T @ (diags_array(self.stiff) @ w))

    def released(self, x: FloatArray) -> Released:
        """Stiffness along the wires, which rings do not have while they slide and meet no stop."""
        low, high = self.sliding.play.T
        kernel.tie_gap(x, self.vertices, self.weights, self.target, self._gap)
        along = np.einsum("ij,ij->i", self.multiplier, self.sliding.direction)
        along /= np.where(self.stiff > 0.0, self.stiff, 1.0)
        along += np.einsum("ij,ij->i", self._gap, self.sliding.direction)
        free = (low < high) & (low <= along) & (along <= high)
        return Released(
            self.vertices[free, :2],
            self.weights[free, :2],
            self.stiff[free],
            self.sliding.direction[free],
        )

    def pattern(self) -> csc_array:
        """Not zero where springs may couple two vertices, (n, n)."""
        w = abs(self._weights)
        return csc_array(w.T @ w)

    def hessian(self, x: FloatArray, *, definite: bool = False) -> csc_array:
        """Second derivative [N/m], never indefinite; constant but for rings that meet a stop."""
        del definite
        held = kron(self.stiffness(), identity(3), format="csc")
        return csc_array(held - self.released(x).matrix(self._weights.shape[1]))


def _ramp(progress: float) -> float:
    """Share of the full stiffness: none, then growing evenly on a logarithmic scale."""
    if progress <= 0.0:
        return 0.0
    return float(np.exp(np.interp(progress, _PROGRESS, np.log(_SHARE))))


def _rows(part: Stitching | Anchor) -> tuple[IntArray, FloatArray, FloatArray]:
    """Four vertices, their weights and a target for every row."""
    if isinstance(part, Stitching):
        v = np.concatenate([part.a.vertices, part.b.vertices], axis=1)
        w = np.concatenate([part.a.weights, -part.b.weights], axis=1)
        return v, w, np.zeros((len(v), 3))
    v = np.concatenate([part.points.vertices, part.points.vertices], axis=1)
    w = np.concatenate([part.points.weights, np.zeros_like(part.points.weights)], axis=1)
    return v, w, part.target
