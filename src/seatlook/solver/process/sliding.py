"""Rings that have been drawn in to a wire and slide along it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array, csc_array, csr_array, diags_array
from scipy.spatial import cKDTree

from seatlook import mesh
from seatlook.model import FloatArray, IntArray, Points, Wire

_STRAIGHT = 2e-4  # m that a ring slides along a straight line

_NEAR = 0.05  # m from a wire, within which the cover moves along with what slides


@dataclass(frozen=True, slots=True)
class Rings:
    """Points of the cover, the wire that they are hooked to, and their rows in ``Ties``."""

    points: Points
    wire: Wire
    rows: slice


@dataclass(frozen=True, slots=True)
class Released:
    """Springs along a wire that are not there, since rings slide.

    Parameters
    ----------
    vertices : (r, 2) int64; weights : (r, 2) float64   of the points that the rings hold
    stiffness : (r,) float64 [N/m]; direction : (r, 3) float64
    """

    vertices: IntArray
    weights: FloatArray
    stiffness: FloatArray
    direction: FloatArray

    def scalar(self, count: int) -> csc_array:
        """Stiffness (n, n), whichever way the wires run."""
        row = np.repeat(np.arange(len(self.stiffness)), 2)
        shape = (len(self.stiffness), count)
        points = csr_array((self.weights.ravel(), (row, self.vertices.ravel())), shape=shape)
        return csc_array(points.T @ (diags_array(self.stiffness) @ points))

    def blocks(self) -> FloatArray:
        """Stiffness (r, 2, 2, 3, 3) between the vertices of each point."""
        w, t = self.weights, self.direction
        return np.asarray(np.einsum("r,ra,rb,ri,rj->rabij", self.stiffness, w, w, t, t))

    def matrix(self, count: int) -> csc_array:
        """Stiffness (3n, 3n)."""
        at = 3 * self.vertices[..., None] + np.arange(3)
        shape = (len(at), 2, 2, 3, 3)
        row = np.broadcast_to(at[:, :, None, :, None], shape)
        column = np.broadcast_to(at[:, None, :, None, :], shape)
        entries = self.blocks().ravel(), (row.ravel(), column.ravel())
        return csc_array(coo_array(entries, shape=(3 * count, 3 * count)))


class Sliding:
    """Where rings are on their wires, which way those run there, and how far they may go.

    Near a ring its wire counts as straight. When the ring has slid on, it is seated anew: a
    polyline and its direction, that turns evenly, would else push it about for ever. The bend of
    the wire enters no second derivative: it is the pull over the bend's radius, about a thousandth
    of the cover's stiffness.

    Parameters
    ----------
    count : rows of ``Ties``
    """

    def __init__(self, count: int) -> None:
        self.rings: list[Rings] = []
        self.direction: FloatArray = np.zeros((count, 3))
        self.play: FloatArray = np.zeros((count, 2))  # m, along the direction; none is held
        self._place: FloatArray = np.full(count, np.nan)
        self._near: IntArray | None = None

    def begin(self, rings: Sequence[Rings]) -> None:
        """Let these slide, and no others."""
        if [ring.rows for ring in rings] != [ring.rows for ring in self.rings]:
            self._near = None
        self.rings = list(rings)
        held = np.ones(len(self.play), dtype=bool)
        for ring in rings:
            held[ring.rows] = False
        self._place[held] = np.nan
        self.play[held] = 0.0

    def forget(self) -> None:
        """Have all rings seated anew, wherever they are."""
        self._place.fill(np.nan)
        self._near = None

    def seat(self, x: FloatArray, goal: FloatArray) -> None:
        """Bring rings to the places next to what they hold, and ``goal`` (s, 3) with them."""
        for ring in self.rings:
            place = ring.wire.nearest(ring.points.at(x))
            there = self._place[ring.rows]
            moved = np.flatnonzero(~(np.abs(place - there) <= _STRAIGHT))
            rows, place = ring.rows.start + moved, place[moved]
            self._place[rows] = place
            goal[rows] = mesh.points_at(ring.wire.curve, place)
            self.direction[rows] = mesh.directions_at(ring.wire.curve, place)
            self.play[rows] = ring.wire.stops[moved] - place[:, None]

    def along(self, x: FloatArray) -> tuple[IntArray, FloatArray]:
        """Vertices (m,) near rings, and the direction (m, 3) of the wire at the nearest one.

        The vertices stay the same during a stage, and with them the pattern of a matrix.
        """
        points = cKDTree(np.concatenate([ring.points.at(x) for ring in self.rings]))
        direction = np.concatenate([self.direction[ring.rows] for ring in self.rings])
        if self._near is None:
            self._near = np.flatnonzero(points.query(x, distance_upper_bound=_NEAR)[0] < _NEAR)
        return self._near, np.asarray(direction[points.query(x[self._near])[1]])
