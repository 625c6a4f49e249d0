"""The outline of a panel's mesh, side by side, and how a change of one side moves all of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from seatlook import mesh
from seatlook.assembly.ease import notches_on
from seatlook.errors import InputError
from seatlook.model import Cover, FloatArray, IntArray, Panel, Pattern

_NEAR = 1e-6  # m, that is the same place
# Below it two sides meet smoothly: they have no corner that could be kept sharp.
_SHARP = np.sin(np.radians(25.0))
_AT_END = 0.002  # m; a notch that near an end of an edge marks the end

Shape = Callable[[FloatArray], FloatArray]


@dataclass(frozen=True, slots=True)
class Side:
    """A stretch of an outline from one end of an edge to the next.

    Parameters
    ----------
    edge : name; "" where the outline has none
    at : (k,) int64              places of its vertices in ``Outline.vertices``, ends included
    arc : (k,) float64 [m]       of these along the side, from 0
    tangent, normal : (k, 2)     unit vectors along it and out of the panel, in pattern coordinates
    notches : (q,) float64 [m]   places of its notches, in order
    """

    edge: str
    at: IntArray
    arc: FloatArray
    tangent: FloatArray
    normal: FloatArray
    notches: FloatArray

    @property
    def length(self) -> float:
        """Length of the side [m]."""
        return float(self.arc[-1])

    @property
    def closed(self) -> bool:
        """Whether it goes all the way round, and ends where it begins."""
        return bool(self.at[0] == self.at[-1])

    @property
    def stops(self) -> FloatArray:
        """Places [m] of its ends and notches."""
        return np.concatenate([[0.0], self.notches, [self.length]])


@dataclass(frozen=True, slots=True)
class Outline:
    """The outer border of one panel's mesh.

    Parameters
    ----------
    panel : index of the panel in the cover
    vertices : (r,) int64    vertices of the cover round the panel, counter-clockwise
    sides : one after the other
    """

    panel: int
    vertices: IntArray
    sides: tuple[Side, ...]

    def offset(self, number: int, shape: Shape) -> FloatArray:
        """Move a side along its normal by ``shape`` of the arc length [m]; return (r, 2) [m].

        Corners stay sharp: where the offset reaches one, it slides along the neighbour, whose
        vertices follow evenly. A corner that is none moves along the normal.
        """
        side = self.sides[number]
        amount = shape(side.arc)
        way = np.zeros((len(self.vertices), 2))
        if side.closed:
            way[side.at] = amount[:, None] * side.normal
            way[side.at[0]] = 0.5 * (amount[[0, -1]] @ side.normal[[0, -1]])
            return way
        ends = [self._corner(number, end, float(amount[end])) for end in (0, -1)]
        way[side.at] += amount[:, None] * side.normal + self._evenly(side, ends)
        for end, corner in zip((0, -1), ends, strict=True):
            self._follow(way, number, end, corner)
        return way

    def lengthen(self, number: int, amount: float = 1.0) -> FloatArray:
        """Make a side longer by ``amount`` [m], half at each end; return (r, 2) [m].

        It keeps its form; its neighbours turn about their far corners. A closed side grows evenly.
        """
        side = self.sides[number]
        if side.closed:
            # Whatever its form, it gets longer by a full turn times what it moves outward.
            return self.offset(number, lambda arc: np.full_like(arc, amount / (2.0 * np.pi)))
        ends = [sign * 0.5 * amount * side.tangent[end] for sign, end in ((-1.0, 0), (1.0, -1))]
        share = side.arc / side.length
        way = np.zeros((len(self.vertices), 2))
        way[side.at] += amount * (share - 0.5)[:, None] * side.tangent
        for end, corner in zip((0, -1), ends, strict=True):
            self._follow(way, number, end, corner)
        return way

    def _corner(self, number: int, end: int, amount: float) -> FloatArray:
        """Where the corner at an end of a side goes, (2,) [m], when that end moves outward."""
        side = self.sides[number]
        normal = side.normal[end]
        along = self._beside(number, end).tangent[0 if end else -1]
        reach = float(normal @ along)
        if abs(reach) < _SHARP:
            return np.asarray(amount * normal)
        return np.asarray(amount / reach * along)

    def _evenly(self, side: Side, ends: list[FloatArray]) -> FloatArray:
        """What the vertices of a side move along it, (k, 2) [m], when its ends do."""
        share = side.arc / side.length
        slide = (1.0 - share) * (ends[0] @ side.tangent[0]) + share * (ends[1] @ side.tangent[-1])
        return np.asarray(slide[:, None] * side.tangent)

    def _follow(self, way: FloatArray, number: int, end: int, corner: FloatArray) -> None:
        """Let the neighbour at an end of a side turn and stretch to where their corner goes."""
        side = self._beside(number, end)
        share = side.arc / side.length
        far, near = (share, -1) if end == 0 else (1.0 - share, 0)
        moved = far[:, None] * (
            (corner @ side.tangent[near]) * side.tangent
            + (corner @ side.normal[near]) * side.normal
        )
        moved[near] = 0.0  # the corner itself has moved with the side
        way[side.at] += moved

    def _beside(self, number: int, end: int) -> Side:
        return self.sides[(number - 1 if end == 0 else number + 1) % len(self.sides)]


def mesh_outlines(cover: Cover, pattern: Pattern) -> tuple[Outline, ...]:
    """Return the outline of every panel's mesh.

    Parameters
    ----------
    cover : assembled from ``pattern``; its vertices lie on the drawn outlines

    Raises
    ------
    InputError
        The cover is of another pattern.
    """
    if cover.panel_names != tuple(panel.name for panel in pattern.panels):
        raise InputError.single(
            "cover", got=", ".join(cover.panel_names), expected="the panels of the pattern"
        )
    return tuple(
        Outline(number, *_sides(pattern, panel, *_rim(cover, number, panel)))
        for number, panel in enumerate(pattern.panels)
    )


def drawn_outlines(pattern: Pattern) -> tuple[Outline, ...]:
    """Return the outline of every panel as it is drawn; vertices are those of the drawing."""
    return tuple(
        Outline(number, *_sides(pattern, p, np.arange(len(p.outline)), _ring(p)[1][:-1]))
        for number, p in enumerate(pattern.panels)
    )


def _ring(panel: Panel) -> tuple[FloatArray, FloatArray]:
    """The closed sew line (r + 1, 2) [m] of a panel, and the lengths along it [m]."""
    ring = np.vstack([panel.outline, panel.outline[:1]])
    return ring, mesh.arc_length(ring)


def _rim(cover: Cover, number: int, panel: Panel) -> tuple[IntArray, FloatArray]:
    """Vertices (r,) on the sew line of a panel, and where on it they are (r,) [m]."""
    ring, arc = _ring(panel)
    for loop in mesh.boundary_loops(cover.faces[cover.panel == number]):
        away, place = mesh.nearest_places(ring, cover.uv[loop])
        if away.max() < _NEAR:
            place = np.where(place > arc[-1] - _NEAR, 0.0, place)
            order = np.argsort(place)
            return loop[order], place[order]
    raise InputError.single(
        f"panel.{panel.name}", got="a mesh off its outline", expected="one of this pattern"
    )


def _sides(
    pattern: Pattern, panel: Panel, vertices: IntArray, place: FloatArray
) -> tuple[IntArray, tuple[Side, ...]]:
    """The vertices, and the sides between the ends of a panel's edges."""
    _, arc = _ring(panel)
    edges = [edge for edge in pattern.edges.values() if edge.panel == panel.name]
    names = {float(arc[e.start]): e.name for e in edges}
    stops = sorted({float(arc[k]) for e in edges for k in (e.start, e.end)}) or [0.0]
    parts = zip(stops, [*stops[1:], stops[0] + float(arc[-1])], strict=True)
    return vertices, tuple(
        _side(pattern, panel, names.get(begin, ""), (begin, end), place) for begin, end in parts
    )


def _side(
    pattern: Pattern, panel: Panel, edge: str, part: tuple[float, float], place: FloatArray
) -> Side:
    """The side from one place on a panel's sew line to another [m]."""
    ring, along = _ring(panel)
    (begin, end), whole = part, float(along[-1])
    at, arc = _between(place, part, whole)
    _, knots = _between(along[:-1], part, whole)
    tangent = mesh.directions_at(mesh.points_at(ring, begin + knots), arc)
    notches = notches_on(pattern, edge) if edge else np.zeros(0)
    inner = (notches > _AT_END) & (notches < end - begin - _AT_END)
    normal = np.column_stack([tangent[:, 1], -tangent[:, 0]])
    return Side(edge, at, arc, tangent, normal, np.sort(notches[inner]))


def _between(
    place: FloatArray, part: tuple[float, float], whole: float
) -> tuple[IntArray, FloatArray]:
    """Which places on a closed line lie on a part of it, ends included, and how far along it.

    Raises
    ------
    InputError
        No place at an end of the part.
    """
    begin, end = part
    ahead = (place - begin + _NEAR) % whole - _NEAR
    at = np.flatnonzero(ahead <= end - begin + _NEAR)
    at = at[np.argsort(ahead[at])]
    arc = ahead[at]
    if end - begin > whole - _NEAR:  # one closed side ends where it begins
        at, arc = np.append(at, at[0]), np.append(arc, whole)
    if len(arc) < 2 or max(abs(arc[0]), abs(arc[-1] - (end - begin))) > _NEAR:
        raise InputError.single(
            "outline",
            got="an edge that ends between two vertices",
            expected="a mesh of this pattern",
        )
    return at, np.clip(arc, 0.0, end - begin)
