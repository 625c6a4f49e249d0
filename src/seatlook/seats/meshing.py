"""A drawn seat as triangles: even on the surface, with every line as edges."""

from __future__ import annotations

import functools
import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from seatlook import mesh
from seatlook.flattening.relax import flatten_patch
from seatlook.flattening.surface import DesignSurface
from seatlook.mesh.closest import closest_places
from seatlook.model import FloatArray, IntArray
from seatlook.seats.drawing import Arc, Form, Region, parted

_CELLS = 56  # of a chart, along the mean width of the whole drawing


@dataclass(frozen=True, slots=True, kw_only=True)
class FoamMesh:
    """A closed foam surface with its named curves, before it is given a material.

    Parameters
    ----------
    vertices : (n, 3) float64 [m]; faces : (m, 3) int64, normals outward
    curves : name -> (k, 3) float64 [m]
    """

    vertices: FloatArray
    faces: IntArray
    curves: MappingProxyType[str, FloatArray]


@dataclass(frozen=True, slots=True, kw_only=True)
class SeatMesh:
    """The meshed plane of a form.

    Parameters
    ----------
    points : (n, 2) [m]; faces : (m, 3) int64, counter-clockwise
    panel : (m,) int64      index into ``names``, -1 where no cover is
    lines : name -> vertices of each of its arcs
    """

    points: FloatArray
    faces: IntArray
    panel: IntArray
    names: tuple[str, ...]
    lines: MappingProxyType[str, tuple[IntArray, ...]]

    def along(self, names: Sequence[str]) -> IntArray:
        """Vertices of lines that follow one another, each once."""
        arcs = [arc for name in names for arc in self.lines[name]]
        return np.concatenate([arcs[0][:1], *(arc[1:] for arc in arcs)])


@functools.lru_cache(maxsize=4)
def meshed(form: Form, element_size: float) -> SeatMesh:
    """Mesh the plane of a form so that the triangles are even on its surface.

    Each region is flattened as a panel would be; the flat region is meshed, and its points go
    back through the plane onto the surface.
    """
    arcs, regions, charts = _charts(form)
    points: list[FloatArray] = []
    number: dict[tuple[float, ...], int] = {}
    on_arcs = []
    for arc in arcs:
        placed = _even(form, arc, element_size)
        on_arcs.append(np.array([_numbered(p, number, points) for p in placed], dtype=np.int64))
    faces, panel = [], []
    names = tuple(form.drawing().panels)
    for region, chart in zip(regions, charts, strict=True):
        ring = [on_arcs[i] if forward else on_arcs[i][::-1] for i, forward in region.sides]
        free, own = chart.filled([len(side) - 1 for side in ring], element_size)
        first = len(points)
        points += list(free)
        index = np.concatenate([*(side[:-1] for side in ring), first + np.arange(len(free))])
        faces.append(index[own])
        panel.append(np.full(len(own), -1 if region.panel is None else names.index(region.panel)))
    lines: dict[str, tuple[IntArray, ...]] = {}
    for arc, vertices in zip(arcs, on_arcs, strict=True):
        lines[arc.line] = (*lines.get(arc.line, ()), vertices)
    return SeatMesh(
        points=np.array(points),
        faces=np.concatenate(faces),
        panel=np.concatenate(panel),
        names=names,
        lines=MappingProxyType(lines),
    )


def design_surface(form: Form, *, element_size: float = 0.006) -> DesignSurface:
    """Return the design surface of a form, cut into its panels."""
    plane = meshed(form, element_size)
    own = plane.panel >= 0
    used, faces = np.unique(plane.faces[own], return_inverse=True)
    seam_lines = {
        (min(a, b), max(a, b)): name
        for name, line in form.drawing().cuts.items()
        for a, b in itertools.pairwise(np.searchsorted(used, plane.along([line])).tolist())
    }
    return DesignSurface(
        vertices=form.position(plane.points[used]),
        faces=np.asarray(faces.reshape(-1, 3), dtype=np.int64),
        panel=plane.panel[own],
        panel_names=plane.names,
        seam_lines=seam_lines,
    )


def cut_lines(form: Form, *, element_size: float = 0.006) -> dict[str, FloatArray]:
    """Return the seams (k, 3) [m] that the borders of the panels do not show."""
    plane = meshed(form, element_size)
    return {
        name: form.position(plane.points[plane.along([line])])
        for name, line in form.drawing().cuts.items()
    }


def foam_mesh(
    form: Form, *, element_size: float = 0.006, cover_thickness: float = 0.0012
) -> FoamMesh:
    """Return the foam of a form: half a cover thickness inside it, closed by a flat base.

    Its curves are the form's wires, on the design surface.
    """
    plane, drawing = meshed(form, element_size), form.drawing()
    tied = {name for lines in drawing.wires.values() for name in lines}
    room = np.zeros(len(plane.points))
    for line in (plane.along([name]) for name in tied):
        room[line] = form.room(plane.points[line])
    surface = form.position(plane.points)
    vertices, faces = closed_below(
        inside(surface, plane.faces, cover_thickness, room), plane.faces, element_size
    )
    curves = {
        wire: form.position(plane.points[plane.along(lines)])
        for wire, lines in drawing.wires.items()
    }
    return FoamMesh(vertices=vertices, faces=faces, curves=MappingProxyType(curves))


def inside(
    surface: FloatArray, faces: IntArray, cover_thickness: float, room: FloatArray
) -> FloatArray:
    """Move a surface (n, 3) inward by half a thickness, and by ``room`` (n,) more."""
    normals = mesh.vertex_normals(surface, faces)
    # At a trench's crease the normals of both flanks lean away from the vertex normal.
    flank = np.einsum("md,mkd->mk", mesh.face_normals(surface, faces), normals[faces])
    lean = np.bincount(faces.ravel(), flank.ravel()) / np.bincount(faces.ravel())
    return np.asarray(surface - (0.5 * cover_thickness / lean + room)[:, None] * normals)


def closed_below(
    vertices: FloatArray, faces: IntArray, element_size: float
) -> tuple[FloatArray, IntArray]:
    """Close a surface with one border by a flat base there."""
    rim = mesh.boundary_loops(faces)[0]
    middle = vertices[rim].mean(axis=0)
    out = vertices[rim] - middle
    up = np.cross(out, np.roll(out, -1, axis=0)).sum(axis=0)
    ahead = out[0] - (out[0] @ up) / (up @ up) * up
    side = np.array([ahead, np.cross(up, ahead)])
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    base, base_faces = mesh.triangulate(out @ side.T, element_size)
    below = middle + base[len(rim) :] @ side
    number = np.concatenate([rim, len(vertices) + np.arange(len(below))])
    return (
        np.concatenate([vertices, below]),
        np.concatenate([faces, number[base_faces[:, ::-1]]]),
    )


@dataclass(frozen=True, slots=True)
class _Chart:
    """A region laid flat, to be meshed there.

    Parameters
    ----------
    plane : (n, 2) [m]; flat : (n, 2) [m]    its points in the plane and laid flat
    faces : (m, 3) int64
    sides : vertices along each side, in the ring's order
    along : length run through on the surface at these vertices [m]
    """

    plane: FloatArray
    flat: FloatArray
    faces: IntArray
    sides: tuple[IntArray, ...]
    along: tuple[FloatArray, ...]

    def filled(self, counts: list[int], element_size: float) -> tuple[FloatArray, IntArray]:
        """Mesh the region with its sides in so many parts.

        Returns
        -------
        points (k, 2) in the plane, and faces into the ring's points and these.
        """
        outline = []
        for side, s, count in zip(self.sides, self.along, counts, strict=True):
            at = np.linspace(0.0, s[-1], count + 1)[:-1]
            outline.append(np.column_stack([np.interp(at, s, x) for x in self.flat[side].T]))
        ring = np.concatenate(outline)
        points, faces = mesh.triangulate(ring, element_size)
        free = np.column_stack([points[len(ring) :], np.zeros(len(points) - len(ring))])
        sheet = np.column_stack([self.flat, np.zeros(len(self.flat))])
        place = closest_places(free, sheet, self.faces, reach=np.inf)
        back = np.einsum("kc,kcd->kd", place.weights, self.plane[self.faces[place.face]])
        return back, faces


@functools.lru_cache(maxsize=4)
def _charts(form: Form) -> tuple[tuple[Arc, ...], tuple[Region, ...], tuple[_Chart, ...]]:
    """Part a form's plane and lay every region flat."""
    arcs, regions = parted(form.drawing())
    reach = np.concatenate([arc.points for arc in arcs])
    size = float(np.sqrt(np.ptp(reach, axis=0).prod())) / _CELLS
    return arcs, regions, tuple(_chart(form, arcs, region, size) for region in regions)


def _chart(form: Form, arcs: tuple[Arc, ...], region: Region, size: float) -> _Chart:
    sides, first = [], 0
    outline = []
    for number, forward in region.sides:
        line = mesh.resample(arcs[number].points[:: 1 if forward else -1], size)
        sides.append(first + np.arange(len(line)))
        outline.append(line[:-1])
        first += len(line) - 1
    sides = [side % first for side in sides]
    plane, faces = mesh.triangulate(np.concatenate(outline), size)
    surface = form.position(plane)
    return _Chart(
        plane=plane,
        flat=flatten_patch(surface, faces),
        faces=faces,
        sides=tuple(sides),
        along=tuple(mesh.arc_length(surface[side]) for side in sides),
    )


def _even(form: Form, arc: Arc, spacing: float) -> FloatArray:
    """Points (k, 2) of an arc, evenly spaced on the surface."""
    along = mesh.arc_length(form.position(arc.points))
    at = np.linspace(0.0, along[-1], max(1, round(along[-1] / spacing)) + 1)
    placed = np.column_stack([np.interp(at, along, column) for column in arc.points.T])
    placed[[0, -1]] = arc.points[[0, -1]]
    return placed


def _numbered(
    point: FloatArray, number: dict[tuple[float, ...], int], points: list[FloatArray]
) -> int:
    """Number of a point, a new one if it was not there."""
    key = tuple(point.tolist())
    if key not in number:
        number[key] = len(points)
        points.append(point)
    return number[key]
