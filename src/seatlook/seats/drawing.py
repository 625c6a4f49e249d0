"""Lines drawn in the plane of a seat's map, and the regions they part it into."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
import shapely

from seatlook.errors import SeatlookError
from seatlook.mesh import nearest_place, resample
from seatlook.mesh.polyline import arc_length
from seatlook.model import FloatArray

_MEETS = 2e-3  # [m] from which a line's end lies on another line
_STEP = 1e-3  # [m] between the points of a line


@dataclass(frozen=True, slots=True, kw_only=True)
class Drawing:
    """What is drawn in the plane: seam lines, borders, tie-downs, and where the panels lie.

    Parameters
    ----------
    lines : name -> (k, 2) [m]     closed ones repeat the first point; together they part the
                                   plane into regions without holes, the outermost is the foam's rim
    panels : name -> (r, 2) [m]    one place in each region of the panel; regions of none are bare
    wires : name -> lines, one after the other, that are tied down to it
    cuts : name of a seam -> its line, where a panel is sewn to itself and its border does not
        show the seam: then a file with all lines goes with the surface
    """

    lines: Mapping[str, FloatArray]
    panels: Mapping[str, FloatArray]
    wires: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    cuts: Mapping[str, str] = field(default_factory=dict)


class Form(Protocol):
    """A seat by formula: a smooth map of the plane, and what is drawn in it.

    Its mesh is kept for as long as forms are equal.
    """

    def __hash__(self) -> int: ...

    def position(self, p: FloatArray) -> FloatArray:
        """Map plane points (k, 2) onto the surface, (k, 3) [m]."""

    def drawing(self) -> Drawing:
        """Return the lines and panels."""

    def room(self, p: FloatArray) -> FloatArray:
        """Extra depth (k,) [m] of the foam below a tie-down at plane points (k, 2)."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Arc:
    """A stretch of a line from node to node, (k, 2) [m]; a closed line without nodes is one."""

    line: str
    points: FloatArray


@dataclass(frozen=True, slots=True, kw_only=True)
class Region:
    """A part of the plane without holes.

    Parameters
    ----------
    sides : (arc's number, whether it runs forward), counter-clockwise
    panel : name, or None where no cover is
    """

    sides: tuple[tuple[int, bool], ...]
    panel: str | None


def parted(drawing: Drawing) -> tuple[tuple[Arc, ...], tuple[Region, ...]]:
    """Part the plane along the lines of a drawing.

    Raises
    ------
    SeatlookError
        A region has a hole, or a panel's place lies in none.
    """
    arcs = tuple(_arcs(_noded(drawing.lines)))
    steps = {}
    for number, arc in enumerate(arcs):
        for a, b in itertools.pairwise(map(tuple, arc.points.tolist())):
            steps[a, b], steps[b, a] = (number, True), (number, False)
    areas = shapely.polygonize([shapely.LineString(arc.points) for arc in arcs]).geoms
    owner: dict[int, str] = {}
    for name, places in drawing.panels.items():
        for place in shapely.points(places):
            within = [i for i, area in enumerate(areas) if area.contains(place)]
            if not within:
                raise SeatlookError(f"panel {name}: no region at {place}")
            owner[within[0]] = name
    regions = []
    for index, area in enumerate(areas):
        if len(area.interiors):
            raise SeatlookError(f"a region with a hole round {area.representative_point()}")
        ring = shapely.get_coordinates(shapely.geometry.polygon.orient(area).exterior)
        along = [steps[a, b] for a, b in itertools.pairwise(map(tuple, ring.tolist()))]
        regions.append(Region(sides=_runs(along), panel=owner.get(index)))
    return arcs, tuple(regions)


def _runs(along: Sequence[tuple[int, bool]]) -> tuple[tuple[int, bool], ...]:
    """Sides of a closed ring of steps, each once."""
    runs = [key for key, _ in itertools.groupby(along)]
    return tuple(runs[1:] if len(runs) > 1 and runs[0] == runs[-1] else runs)


def _noded(lines: Mapping[str, FloatArray]) -> dict[str, FloatArray]:
    """Let every end of an open line be a point of all lines that it meets."""
    noded = {name: resample(line, _STEP) for name, line in lines.items()}
    nodes: list[FloatArray] = []
    for name, line in lines.items():
        for end in () if _closed(line) else (0, -1):
            near = [
                (other, at)
                for other, points in noded.items()
                for gap, at in [nearest_place(points, line[end])]
                if other != name and gap < _MEETS
            ]
            place = next((n for n in nodes if np.linalg.norm(n - line[end]) < _MEETS), None)
            if place is None:
                place = _at(noded[near[0][0]], near[0][1]) if near else line[end]
                nodes.append(place)
            noded[name][end] = place
            for other, at in near:
                noded[other] = _with_point(noded[other], place, at)
    return noded


def _at(line: FloatArray, at: float) -> FloatArray:
    along = arc_length(line)
    return np.array([np.interp(at, along, column) for column in line.T])


def _with_point(line: FloatArray, place: FloatArray, at: float) -> FloatArray:
    """A line that runs through ``place``, which lies on it at arc length ``at``."""
    near = int(np.abs(arc_length(line) - at).argmin())
    ends = (0, len(line) - 1)
    line = line.copy()
    line[list(ends) if _closed(line) and near in ends else near] = place
    return line


def _arcs(lines: Mapping[str, FloatArray]) -> list[Arc]:
    """Cut lines at the ends of all lines."""
    ends = {
        tuple(end) for line in lines.values() if not _closed(line) for end in line[[0, -1]].tolist()
    }
    arcs = []
    for name, line in lines.items():
        stops = [i for i, p in enumerate(line.tolist()) if tuple(p) in ends]
        if _closed(line) and stops:
            line = np.concatenate([line[stops[0] : -1], line[: stops[0] + 1]])
            stops = [i for i, p in enumerate(line.tolist()) if tuple(p) in ends]
        stops = sorted({0, *stops, len(line) - 1})
        arcs += [Arc(line=name, points=line[i : j + 1]) for i, j in itertools.pairwise(stops)]
    return arcs


def _closed(line: FloatArray) -> bool:
    return bool((line[0] == line[-1]).all())
