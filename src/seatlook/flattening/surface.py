"""A seat's design surface: one mesh, cut into panels along its seam lines."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from seatlook import mesh
from seatlook.errors import InputError, Problem
from seatlook.mesh.places import place_words
from seatlook.model import FloatArray, IntArray

FREE = "free"  # stands for the neighbour where a panel is not sewn
_Segment = tuple[int, int]  # outline and segment of it


@dataclass(frozen=True, slots=True, kw_only=True)
class DesignSurface:
    """The shape the cover is to have, middle surface, with the panel of each face.

    Parameters
    ----------
    vertices : (n, 3) float64 [m]
    faces : (m, 3) int64           normals outward, the visible side
    panel : (m,) int64             index into ``panel_names``
    panel_names : names of the panels; two panels share the vertices of the seam between them
    seam_lines : edge, smaller vertex first -> name of the line it was cut along, if any; a line
        inside a panel cuts that, and both sides are sewn: a dart, or the closing seam of a ring
    """

    vertices: FloatArray
    faces: IntArray
    panel: IntArray
    panel_names: tuple[str, ...]
    seam_lines: Mapping[tuple[int, int], str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if (
            self.panel.shape != (len(self.faces),)
            or not np.isin(self.panel, np.arange(len(self.panel_names))).all()
        ):
            raise InputError.single(
                "DesignSurface.panel",
                got=f"shape {self.panel.shape}, labels {np.unique(self.panel).tolist()}",
                expected=f"a label 0..{len(self.panel_names) - 1} for each of {len(self.faces)}"
                " faces",
            )

    def patches(self) -> tuple[Patch, ...]:
        """Return the panels' patches in the order of ``panel_names``.

        Raises
        ------
        InputError
            Panels that are no disk once they are cut along the seam lines in them.
        """
        patches, problems = [], []
        for index in range(len(self.panel_names)):
            patch = self.piece(index)
            problem = self._no_disk(patch)
            if problem is None:
                patches.append(patch)
            else:
                problems.append(problem)
        if problems:
            raise InputError(problems)
        return tuple(patches)

    def piece(self, index: int) -> Patch:
        """Cut a panel out, of whatever shape, and along the lines in it, whose vertices double."""
        of_surface = self.faces[self.panel == index]
        pairs = mesh.inner_sides(of_surface)
        half = np.sort(of_surface[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)[pairs[:, 0]], axis=1)
        cut = np.array([(a, b) in self.seam_lines for a, b in half.tolist()], dtype=bool)
        source, faces = _fans(of_surface, pairs[~cut])
        return Patch(
            name=self.panel_names[index],
            vertices=self.vertices[source],
            faces=faces,
            source=source,
            boundary=(mesh.boundary_loops(faces) or [np.zeros(0, dtype=np.int64)])[0],
        )

    def _no_disk(self, patch: Patch) -> Problem | None:
        """Return what keeps a patch from being one piece with one outline."""
        loops = mesh.boundary_loops(patch.faces)
        euler = len(patch.vertices) - len(mesh.edges(patch.faces)) + len(patch.faces)
        if len(loops) == 1 and euler == 1:
            return None
        for loop in loops:
            if len(loops) > 1 and patch.is_slit(loop):
                ring = patch.source[loop]
                ends = np.sort(np.column_stack([ring, np.roll(ring, -1)]), axis=1)
                names = sorted({self.seam_lines[a, b] for a, b in ends.tolist()})
                return Problem(
                    key=f"panel {patch.name}",
                    got=f"{' and '.join(names)}, inside it near {_place(patch.vertices[loop])}",
                    expected="a dart that starts at the border or at another line",
                )
        got = f"{len(loops)} boundary curves, Euler number {euler}"
        if not loops:
            got = f"a closed surface round {_place(patch.vertices)}"
        elif len(loops) > 1:
            got += f", near {' and '.join(_place(patch.vertices[loop[:1]]) for loop in loops)}"
        return Problem(
            key=f"panel {patch.name}",
            got=got,
            expected="one connected piece without holes",
            hint="cut it along a line that is closed" if not loops else
            "cut it along a line from one of its borders to another; what should be no hole is "
            "filled by: seatlook mend SURFACE --close --sheet",
        )  # fmt: skip


def _fans(faces: IntArray, pairs: IntArray) -> tuple[IntArray, IntArray]:
    """Give each vertex once to every fan of faces round it that hang together by their sides.

    Returns the vertex (n,) that each one was, and the faces (m, 3) in the new numbers.
    """
    face, k = np.divmod(pairs, 3)
    first, second = 3 * face + k, 3 * face + (k + 1) % 3
    # The two sides of an edge run against each other.
    a = np.concatenate([first[:, 0], second[:, 0]])
    b = np.concatenate([second[:, 1], first[:, 1]])
    graph = sp.coo_array((np.ones(len(a)), (a, b)), shape=(faces.size, faces.size))
    fan = connected_components(graph, directed=False)[1]
    corner = faces.ravel()
    source = np.empty(fan.max(initial=-1) + 1, dtype=np.int64)
    source[fan] = corner
    order = np.argsort(source, kind="stable")
    number = np.empty_like(order)
    number[order] = np.arange(len(order))
    return source[order], np.asarray(number[fan].reshape(-1, 3), dtype=np.int64)


def millimetres(point: FloatArray) -> str:
    """Return a point (3,) [m] as it stands in messages."""
    return "[" + ", ".join(f"{round(1e3 * c)}" for c in point.tolist()) + "]"


def _place(points: FloatArray) -> str:
    return f"{millimetres(points.mean(axis=0))} mm"


@dataclass(frozen=True, slots=True, kw_only=True)
class Patch:
    """One panel's part of the design surface.

    Parameters
    ----------
    vertices : (n, 3) [m]; faces : (m, 3) into ``vertices``
    source : (n,) int64     the vertices' indices in the whole surface; twice along a dart
    boundary : (b,) int64   the outline, counter-clockwise seen from outside
    """

    name: str
    vertices: FloatArray
    faces: IntArray
    source: IntArray
    boundary: IntArray

    def is_slit(self, loop: IntArray) -> bool:
        """Whether a boundary curve is a line inside the panel, run along on both of its sides."""
        ring = self.source[loop]
        ends = np.sort(np.column_stack([ring, np.roll(ring, -1)]), axis=1)
        return 2 * len(np.unique(ends, axis=0)) == len(ends)


@dataclass(frozen=True, slots=True, kw_only=True)
class Side:
    """A stretch of a patch's outline with the same neighbour all along.

    Parameters
    ----------
    panel, neighbour : names; the neighbour of a free edge is FREE, that of a dart its own panel
    place : word by which it is told from other sides of the same two panels; empty for one alone
    partner : name of the side it is sewn to; None for a free edge
    start, count : first position in ``Patch.boundary`` and number of segments
    vertices : (count + 1,) int64   indices in the whole surface, in outline order
    """

    name: str
    panel: str
    neighbour: str
    place: str
    partner: str | None
    start: int
    count: int
    vertices: IntArray

    def indices(self, patch: Patch) -> IntArray:
        """Return the vertices (count + 1,) in the patch's own numbering."""
        at = (self.start + np.arange(self.count + 1)) % len(patch.boundary)
        return np.asarray(patch.boundary[at])


def sides(patches: tuple[Patch, ...]) -> tuple[Side, ...]:
    """Split every patch's outline where its partner changes, and at the tips of darts.

    A side is called ``PANEL.NEIGHBOUR``; where panels share several seams, with the place of each:
    ``PANEL.NEIGHBOUR.left`` (see :func:`seatlook.mesh.places.place_words`). Of both sides of a dart
    the one that runs to its tip ends with ``.in``, the other with ``.out``; where a panel is sewn
    to itself from border to border, the one that runs to the left, the rear or the top. An outline
    with one neighbour all round is one side, closed.
    """
    rings = [patch.source[patch.boundary].tolist() for patch in patches]
    across = _across(rings)
    stretches = [
        _Stretch(p, start, (stop - start) % len(rings[p]) or len(rings[p]))
        for p, starts in enumerate(_starts(rings, across))
        for start, stop in zip(starts, [*starts[1:], starts[0]], strict=True)
    ]
    sewn = {(s.patch, s.start): across[s.patch][s.last(rings)] for s in stretches}
    places = _places(patches, stretches, sewn)
    names = {}
    for stretch in stretches:
        key = (stretch.patch, stretch.start)
        own, other = patches[stretch.patch].name, sewn[key]
        parts = [own, FREE if other is None else patches[other[0]].name, places[key]]
        if other is not None and other[0] == stretch.patch:
            parts.append(_flank(patches[stretch.patch], stretch, other[1]))
        names[key] = ".".join(filter(None, parts))
    return tuple(
        Side(
            name=names[s.patch, s.start],
            panel=patches[s.patch].name,
            neighbour=FREE if (other := sewn[s.patch, s.start]) is None else patches[other[0]].name,
            place=places[s.patch, s.start],
            partner=None if other is None else names[other],
            start=s.start,
            count=s.count,
            vertices=np.array(rings[s.patch], dtype=np.int64)[s.at(rings)],
        )
        for s in stretches
    )


@dataclass(frozen=True, slots=True)
class _Stretch:
    """A side before it has a name: the first segment of an outline, and how many."""

    patch: int
    start: int
    count: int

    def at(self, rings: list[list[int]]) -> list[int]:
        """Positions in the outline of its points."""
        return [(self.start + i) % len(rings[self.patch]) for i in range(self.count + 1)]

    def last(self, rings: list[list[int]]) -> int:
        """Its last segment, whose partner is the first one of the side it is sewn to."""
        return (self.start + self.count - 1) % len(rings[self.patch])

    def points(self, patch: Patch) -> FloatArray:
        """Its points (count + 1, 3) [m]."""
        at = (self.start + np.arange(self.count + 1)) % len(patch.boundary)
        return np.asarray(patch.vertices[patch.boundary[at]])


def _places(
    patches: tuple[Patch, ...],
    stretches: list[_Stretch],
    sewn: Mapping[_Segment, _Segment | None],
) -> dict[_Segment, str]:
    """The place of each side among those of the same two panels; one for both sides of a seam."""
    alike: dict[tuple[int, int], list[_Stretch]] = {}
    for stretch in stretches:
        key = (stretch.patch, stretch.start)
        other = sewn[key]
        if other is None or key <= other:
            pair = (stretch.patch, -1 if other is None else other[0])
            alike.setdefault(pair, []).append(stretch)
    places: dict[_Segment, str] = {}
    for group in alike.values():
        words = place_words([s.points(patches[s.patch]) for s in group])
        for stretch, word in zip(group, words, strict=True):
            key = (stretch.patch, stretch.start)
            other = sewn[key]
            places |= {key: word} | ({} if other is None else {other: word})
    return places


def _flank(patch: Patch, stretch: _Stretch, partner: int) -> str:
    """Tell the sides of a dart, or of a seam of a panel with itself, from each other."""
    end = (stretch.start + stretch.count) % len(patch.boundary)
    to_tip = end == partner
    from_tip = (partner + stretch.count) % len(patch.boundary) == stretch.start
    if to_tip != from_tip:
        return "in" if to_tip else "out"
    points = stretch.points(patch)
    way = points[-1] - points[0]
    return "in" if way[np.abs(way).argmax()] > 0 else "out"


def darts(patch: Patch, own: Sequence[Side]) -> list[tuple[IntArray, IntArray]]:
    """Return the vertices of both sides of each dart of a patch, from the mouth to the tip.

    A line that lies inside the panel with both ends, in an else closed surface, has two tips.
    """
    result = []
    for side in own:
        other = next((s for s in own if s.name == side.partner), None)
        if other is not None:
            a, b = side.indices(patch), other.indices(patch)[::-1]
            if a[-1] == b[-1] and (a[0] != b[0] or side.name < other.name):
                result.append((a, b))
    return result


def _across(rings: list[list[int]]) -> list[list[_Segment | None]]:
    """Return for each segment of each outline the segment that it is sewn to."""
    segment = {
        (ring[i], ring[(i + 1) % len(ring)]): (p, i)
        for p, ring in enumerate(rings)
        for i in range(len(ring))
    }
    return [
        [segment.get((ring[(i + 1) % len(ring)], ring[i])) for i in range(len(ring))]
        for ring in rings
    ]


def _starts(rings: list[list[int]], across: list[list[_Segment | None]]) -> list[list[int]]:
    """Return where the sides of each outline start."""
    result: list[list[int]] = []
    for p, ring in enumerate(rings):
        starts = []
        for i in range(len(ring)):
            before, here = across[p][i - 1], across[p][i]
            if before is None or here is None:
                goes_on = before is here
            else:
                q, j = before
                goes_on = here == (q, (j - 1) % len(rings[q])) and before != (p, i)
            if not goes_on:
                starts.append(i)
        if not starts:  # one neighbour all round: both start at the same vertex
            other = across[p][0]
            if other is not None and other[0] < p:
                twin = across[other[0]][result[other[0]][0] - 1]
                starts = [twin[1]] if twin is not None else []
            else:
                starts = [int(np.argmin(ring))]
        result.append(starts)
    return result
