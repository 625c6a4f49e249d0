"""The flat pattern: panels, their edges, and which edges are sewn together."""

from __future__ import annotations

from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Literal

import numpy as np

from seatlook.mesh.polyline import length
from seatlook.model._check import FloatArray, IntArray, floats, ints, positive

NotchKind = Literal["point", "v", "t", "castle", "u", "check"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Notch:
    """A mark on the outline where two panels meet.

    Parameters
    ----------
    position : (2,) float64 [m]
    kind : how the notch is cut; "point" is a mark without a cut
    depth : float [m]
    """

    position: FloatArray
    kind: NotchKind = "point"
    depth: float = 0.0

    def __post_init__(self) -> None:
        floats(self, "position", 2)


@dataclass(frozen=True, slots=True, kw_only=True)
class Panel:
    """One flat piece, seen with its visible face up.

    Parameters
    ----------
    name : str
    outline : (n, 2) float64 [m]
        The sew line (the free edge where nothing is sewn): closed, counter-clockwise, the first
        vertex not repeated.
    corners : (c,) int64
        Indices into ``outline`` where an edge may start or end: corners and turn points.
    cut_outline : (k, 2) float64 [m]
        The line the panel is cut along; equals ``outline`` where there is no seam allowance.
    grain : (2,) float64
        Unit vector along the warp.
    notches, internal_lines
        Marks on the outline; named open polylines (p, 2) [m] inside it, such as tie-down lines.
    holes : (k, 2) float64 [m] each
        Cut-outs inside the outline: closed, counter-clockwise, the first vertex not repeated. Their
        borders are free.
    """

    name: str
    outline: FloatArray
    corners: IntArray
    cut_outline: FloatArray
    grain: FloatArray
    notches: tuple[Notch, ...] = ()
    internal_lines: MappingProxyType[str, FloatArray] = field(
        default_factory=lambda: MappingProxyType({})
    )
    holes: tuple[FloatArray, ...] = ()

    def __post_init__(self) -> None:
        floats(self, "outline", None, 2)
        ints(self, "corners", None, below=len(self.outline))
        floats(self, "cut_outline", None, 2)
        floats(self, "grain", 2)

    @property
    def area(self) -> float:
        """Area inside the sew line [m2], without the cut-outs."""
        rings = [self.outline.T, *(hole.T for hole in self.holes)]
        outline, *holes = [0.5 * (x * np.roll(y, -1) - y * np.roll(x, -1)).sum() for x, y in rings]
        return float(outline - sum(holes))

    def in_grain(self, vectors: FloatArray) -> FloatArray:
        """Turn vectors (k, 2) of the pattern into the axes of warp and weft, as a cover has them.

        Examples
        --------
        >>> square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
        >>> panel = Panel(name="A", outline=square, corners=np.arange(4), cut_outline=square,
        ...               grain=np.array([0.0, 1.0]))
        >>> panel.in_grain(np.array([[0.5, 2.0]])).tolist()
        [[2.0, -0.5]]
        """
        warp = self.grain / np.hypot(*self.grain)
        return np.asarray(vectors @ np.column_stack([warp, [-warp[1], warp[0]]]))


@dataclass(frozen=True, slots=True, kw_only=True)
class Edge:
    """A stretch of a panel's outline from one corner to another, in outline order.

    Parameters
    ----------
    start, end : indices into ``Panel.outline``; the edge may run over the outline's last vertex
    """

    name: str
    panel: str
    start: int
    end: int

    def points(self, panel: Panel) -> FloatArray:
        """Return the polyline of the edge, (k, 2) [m], both ends included."""
        n = len(panel.outline)
        count = (self.end - self.start) % n or n
        return panel.outline[(self.start + np.arange(count + 1)) % n]


@dataclass(frozen=True, slots=True, kw_only=True)
class Seam:
    """One edge sewn to one or several edges that follow each other.

    Parameters
    ----------
    a : name of the edge on one side
    b : names of the edges on the other side, in the order in which they meet ``a``
    reverse : whether the far side is run through against its outline order, which is the normal
        case: two counter-clockwise outlines meet head to tail
    pitch : stitch length [m]
    """

    name: str
    a: str
    b: tuple[str, ...]
    reverse: bool = True
    pitch: float = 0.005

    def __post_init__(self) -> None:
        positive(self, "pitch")


@dataclass(frozen=True, slots=True, kw_only=True)
class Pattern:
    """Panels, named edges and seams of one cover."""

    panels: tuple[Panel, ...]
    edges: MappingProxyType[str, Edge]
    seams: tuple[Seam, ...]

    def panel(self, name: str) -> Panel:
        """Return the panel called ``name``."""
        return next(p for p in self.panels if p.name == name)

    def edge_points(self, name: str) -> FloatArray:
        """Return the polyline (k, 2) [m] of the edge called ``name``."""
        edge = self.edges[name]
        return edge.points(self.panel(edge.panel))

    def edge_length(self, name: str) -> float:
        """Return the length [m] of the edge called ``name``."""
        return length(self.edge_points(name))
