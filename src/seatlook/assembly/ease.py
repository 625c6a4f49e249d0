"""Ease: how much longer one side of a seam is, and between which notches it lies."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from seatlook.mesh import nearest_place
from seatlook.model import FloatArray, Pattern, Seam

# Notches are drawn on the cut line as often as on the sew line.
_WIDEST_ALLOWANCE = 0.025  # m
_AT_END = 0.002  # m; a notch that near an end of a seam marks the end


@dataclass(frozen=True, slots=True, kw_only=True)
class SeamEase:
    """Lengths of the two sides of a seam and where their notches meet.

    Parameters
    ----------
    name : of the seam
    length_a, length_b : float [m]       near side, and the far side's edges together
    notches_a, notches_b : (k,) float64  shares of these lengths in (0, 1), as the seam is sewn
    """

    name: str
    length_a: float
    length_b: float
    notches_a: FloatArray
    notches_b: FloatArray

    @property
    def ease(self) -> float:
        """Near side minus far side [m]."""
        return self.length_a - self.length_b

    @property
    def share(self) -> float:
        """Ease over the length of the far side."""
        return self.ease / self.length_b

    @property
    def matched(self) -> bool:
        """Whether both sides have the same number of notches, so that each meets its own."""
        return len(self.notches_a) == len(self.notches_b)

    @property
    def knots(self) -> tuple[FloatArray, FloatArray]:
        """Shares of the two sides that are sewn together, from 0 to 1."""
        if not self.matched:
            return np.array([0.0, 1.0]), np.array([0.0, 1.0])
        a, b = (np.concatenate([[0.0], n, [1.0]]) for n in (self.notches_a, self.notches_b))
        return a, b

    @property
    def shares(self) -> FloatArray:
        """Ease over the far side's length between one notch and the next, (k + 1,)."""
        a, b = self.knots
        return np.asarray(np.diff(a) * self.length_a / (np.diff(b) * self.length_b) - 1.0)

    @property
    def extreme(self) -> float:
        """The share that is largest in size between one notch and the next."""
        return float(self.shares[np.abs(self.shares).argmax()])


def seam_ease(pattern: Pattern, seam: Seam) -> SeamEase:
    """Measure one seam.

    A notch belongs to the nearest edge of its panel, within 25 mm: it may be drawn on the cut
    line. Those within 2 mm of an end of the seam mark the end and are left out.
    """
    near, far = [seam.a], list(seam.b)
    length_a, notches_a = _side(pattern, near, reverse=False)
    length_b, notches_b = _side(pattern, far, reverse=seam.reverse)
    return SeamEase(
        name=seam.name,
        length_a=length_a,
        length_b=length_b,
        notches_a=notches_a,
        notches_b=notches_b,
    )


def _side(pattern: Pattern, names: list[str], *, reverse: bool) -> tuple[float, FloatArray]:
    """Length [m] of edges run through one after the other, and the shares of their notches."""
    total, places = 0.0, []
    for name in names:
        length = pattern.edge_length(name)
        at = notches_on(pattern, name)
        places.append(total + (length - at if reverse else at))
        total += length
    at = np.sort(np.concatenate(places))
    return total, at[(at > _AT_END) & (at < total - _AT_END)] / total


def notches_on(pattern: Pattern, name: str) -> FloatArray:
    """Arc lengths (k,) [m] of the notches of an edge."""
    panel = pattern.panel(pattern.edges[name].panel)
    edges = [e.name for e in pattern.edges.values() if e.panel == panel.name]
    arcs = []
    for notch in panel.notches:
        nearest = {edge: nearest_place(pattern.edge_points(edge), notch.position) for edge in edges}
        distance, at = nearest[name]
        if distance < _WIDEST_ALLOWANCE and distance <= min(d for d, _ in nearest.values()):
            arcs.append(at)
    return np.array(arcs)
