"""By how much one panel is too long along a seam, read from the shape that was solved.

Sewn lines lie on each other, so a line that is too long is compressed or lies in waves, and its
partner is stretched. The strain along the seam is read on both sides, in the faces beside it, and
carried to the seam; lengths of the pattern are not looked at.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from seatlook import mesh
from seatlook.mesh.polyline import directions_at
from seatlook.model import Cover, FloatArray, IntArray, Points, Solution, Stitching
from seatlook.wrinkle.waves import waves_along

# Beside a seam, on each side: wide enough for the strain's slope, and three rows of elements.
_REACH, _ROWS = 0.02, 3.0
_FEWEST = 8  # faces beside a stretch on each side; fewer fix no slope
_SURE = 2.0  # standard errors of an excess that is called its scatter


@dataclass(frozen=True, slots=True, kw_only=True)
class SeamStretch:
    """A stretch of a seam between two notches, and by how much one panel is longer there.

    Parameters
    ----------
    seam : name of the stitching
    begin, end : "notch 2", counted from the seam's beginning, or "the end at REAR"
    long_panel, short_panel : names; the long one is compressed or lies in waves
    length : float [m]             of the sewn line as it was solved
    middle : (3,) float64 [m]      in space
    long_uv, short_uv : (2,) float64 [m]     middle of either line in pattern coordinates
    excess : float [m] >= 0        what the long line is longer by; the sum of the next two
    compression : float [m]        of it, what the long side is compressed by at the seam
    tension : float [m]            of it, what the short side is stretched by at the seam
    waves : float [m]              what lies in waves, arc minus chord, 20 mm inside the
        long panel, where some of the compression at the seam has turned into them
    scatter : float [m]            of ``excess``: two standard errors, and the doubt of the fit
    long_strain, short_strain : float [1]    along the seam, at the seam
    resolved : whether the mesh carries the faces that it was read from
    """

    seam: str
    begin: str
    end: str
    long_panel: str
    short_panel: str
    length: float
    middle: FloatArray
    long_uv: FloatArray
    short_uv: FloatArray
    excess: float
    compression: float
    tension: float
    waves: float
    scatter: float
    long_strain: float
    short_strain: float
    resolved: bool = True

    @property
    def share(self) -> float:
        """Excess over the length of the stretch."""
        return self.excess / self.length

    @property
    def place(self) -> str:
        """Between which notches it lies."""
        return f"from {self.begin} to {self.end}"


def seam_excess(
    solution: Solution, *, unresolved: np.ndarray | None = None
) -> tuple[SeamStretch, ...]:
    """Read every seam of a solved cover, stretch by stretch, in the order of its seams.

    A stretch with too few faces beside it is left out.

    Parameters
    ----------
    unresolved : (m,) bool    faces that the mesh does not carry
    """
    bad = np.zeros(len(solution.cover.faces), bool) if unresolved is None else unresolved
    along = _Along(solution)
    return tuple(
        stretch
        for stitching in solution.cover.stitchings
        for stretch in _stretches(along, stitching, bad)
    )


def _stretches(along: _Along, seam: Stitching, bad: np.ndarray) -> Iterator[SeamStretch]:
    cover, x = along.solution.cover, along.solution.positions
    stops = _stops(along, seam)
    number = {float(at): f"notch {k}" for k, at in enumerate(seam.notches, 1)}
    line = 0.5 * (seam.a.at(x) + seam.b.at(x))
    arc = mesh.arc_length(line)
    place = np.arange(len(line), dtype=float)
    for first, last in stops:
        sides = [along.side(points, first, last) for points in (seam.a, seam.b)]
        if min(len(side.faces) for side in sides) < _FEWEST:
            continue
        fits = [side.at_seam() for side in sides]
        long, short = sorted(range(2), key=lambda k: fits[k].strain)
        at_first, at_last = np.interp([first, last], place, arc)
        length = float(at_last - at_first)
        a, b = fits[long], fits[short]
        centres = [points.at(cover.uv)[round(0.5 * (first + last))] for points in (seam.a, seam.b)]
        yield SeamStretch(
            seam=seam.name,
            begin=number.get(first) or along.neighbour(seam, int(first)),
            end=number.get(last) or along.neighbour(seam, int(last)),
            long_panel=cover.panel_names[sides[long].panel],
            short_panel=cover.panel_names[sides[short].panel],
            length=length,
            middle=mesh.points_at(line, np.array([0.5 * (at_first + at_last)]))[0],
            long_uv=centres[long],
            short_uv=centres[short],
            excess=length * (b.strain - a.strain),
            waves=along.waves(sides[long], (seam.a, seam.b)[long], first, last),
            long_strain=a.strain,
            short_strain=b.strain,
            compression=length * (min(b.strain, 0.0) - min(a.strain, 0.0)),
            tension=length * (max(b.strain, 0.0) - max(a.strain, 0.0)),
            scatter=length * _scatter(a, b),
            resolved=not any(bad[side.faces].any() for side in sides),
        )


def _stops(along: _Along, seam: Stitching) -> list[tuple[float, float]]:
    """Pairs, counted from 0, at which the stretches of a seam begin and end.

    At notches, and where the seam goes on to another panel.
    """
    owners = np.stack([along.owner[side.vertices[:, 0]] for side in (seam.a, seam.b)])
    ends = np.flatnonzero((np.diff(owners, axis=1) != 0).any(axis=0))
    begins = np.concatenate([[0], ends + 1]).astype(float)
    lasts = np.concatenate([ends, [owners.shape[1] - 1]]).astype(float)
    stops = []
    for begin, last in zip(begins, lasts, strict=True):
        inner = [float(n) for n in seam.notches if begin < n < last]
        stops += list(pairwise([float(begin), *inner, float(last)]))
    return stops


@dataclass(frozen=True, slots=True)
class _Side:
    """Faces (k,) beside one side of a stretch: how far from it and where, and their strains."""

    panel: int
    faces: IntArray
    distance: FloatArray
    place: FloatArray
    strain: FloatArray

    def at_seam(self) -> _Fit:
        """Fit the strains by a plane and by a parabola in the distance; take both at the seam.

        The strain falls off steeply beside a line that is too long. Where the two fits differ, so
        much is not known.
        """
        ones, place = np.ones(len(self.faces)), self.place - self.place.mean()
        plane = np.column_stack([ones, self.distance, place])
        curved = np.column_stack([plane, self.distance**2])
        inverse = np.linalg.pinv(curved)
        fit = inverse @ self.strain
        spare = max(len(curved) - curved.shape[1], 1)
        spread = np.sqrt(((self.strain - curved @ fit) ** 2).sum() / spare)
        straight = float((np.linalg.pinv(plane) @ self.strain)[0])
        at = float(fit[0])
        return _Fit(at, float(spread * np.linalg.norm(inverse[0])), abs(at - straight))


class _Fit(NamedTuple):
    """Strain along a seam at the seam, its standard error, and by how much another fit differs."""

    strain: float
    error: float
    doubt: float


def _scatter(a: _Fit, b: _Fit) -> float:
    """Uncertainty of the difference of two strains."""
    return float(np.linalg.norm([_SURE * a.error, _SURE * b.error, a.doubt, b.doubt]))


class _Along:
    """Strains of a solved cover along any seam."""

    def __init__(self, solution: Solution) -> None:
        self.solution = solution
        cover = self.solution.cover
        self.owner = owners(cover)
        self._middle = cover.rest[cover.faces].mean(axis=1)
        self._reach = max(_REACH, _ROWS * cover.element_size)

    def side(self, points: Points, first: float, last: float) -> _Side:
        """Faces beside the pairs ``first`` to ``last`` of one side of a seam."""
        cover = self.solution.cover
        low, high = int(np.ceil(first)), int(np.floor(last))
        panel = int(self.owner[points.vertices[low, 0]])
        line = points.at(cover.rest)[low : high + 1]
        faces = np.flatnonzero(cover.panel == panel)
        box = (self._middle[faces] > line.min(axis=0) - self._reach).all(axis=1)
        box &= (self._middle[faces] < line.max(axis=0) + self._reach).all(axis=1)
        faces = faces[box]
        distance, place = mesh.nearest_places(line, self._middle[faces])
        beside = (distance < self._reach) & (place > 0.0) & (place < mesh.length(line))
        faces, distance, place = faces[beside], distance[beside], place[beside]
        tangent = directions_at(line, place)
        green = np.einsum("fi,fij,fj->f", tangent, self.solution.strain_mid[faces], tangent)
        return _Side(panel, faces, distance, place, np.sqrt(1.0 + 2.0 * green) - 1.0)

    def waves(self, side: _Side, points: Points, first: float, last: float) -> float:
        """Length [m] in waves on a line inside the panel, beside a stretch."""
        line = points.at(self.solution.cover.rest)[int(np.ceil(first)) : int(np.floor(last)) + 1]
        tangent = directions_at(line, mesh.arc_length(line))
        inward = np.column_stack([-tangent[:, 1], tangent[:, 0]])
        off = self._middle[side.faces] - mesh.points_at(line, side.place)
        if (off * inward[mesh.arc_length(line).searchsorted(side.place) - 1]).sum() < 0:
            inward = -inward
        return waves_along(self.solution, side.panel, line + _REACH * inward)

    def neighbour(self, seam: Stitching, pair: int) -> str:
        """Name an end of a seam by what the panel meets there."""
        cover = self.solution.cover
        vertex = int(seam.a.vertices[pair][seam.a.weights[pair].argmax()])
        for other in cover.stitchings:
            for side, far in ((other.a, other.b), (other.b, other.a)):
                at = (side.vertices == vertex) & (side.weights > 0.5)
                if other is not seam and at.any():
                    row = int(np.flatnonzero(at.any(axis=1))[0])
                    return f"the end at {cover.panel_names[self.owner[far.vertices[row, 0]]]}"
        return "the free end" if pair == 0 else "the other free end"


def owners(cover: Cover) -> IntArray:
    """Panel (n,) of each vertex; -1 for one without a face."""
    panel = np.full(len(cover.rest), -1, dtype=np.int64)
    panel[cover.faces] = cover.panel[:, None]
    return panel
