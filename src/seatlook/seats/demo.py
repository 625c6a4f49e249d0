"""The demo seat: design surface, foam and wires of one procedural cushion.

See docs/reference/demo-seat.md.
"""

from __future__ import annotations

import functools
import itertools
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from seatlook import mesh
from seatlook.flattening.surface import DesignSurface
from seatlook.model import FloatArray, IntArray
from seatlook.seats.cushion import Cushion
from seatlook.seats.meshing import FoamMesh, inside
from seatlook.seats.pad import QUARTERS

PANELS = ("INSERT", "BOLSTER_L", "BOLSTER_R", "FRONT", "SIDE_L", "SIDE_R", "REAR")


def demo_design(cushion: Cushion | None = None, *, element_size: float = 0.006) -> DesignSurface:
    """Return the design surface of the demo cushion, cut into its seven panels.

    Parameters
    ----------
    cushion : the shape; None takes the documented default
    element_size : float [m]   edge length aimed at
    """
    shape = cushion or Cushion()
    plane = _plane(shape, element_size)
    panel = _panels(shape, plane.points[plane.faces].mean(axis=1))
    used, faces = np.unique(plane.faces[panel >= 0], return_inverse=True)
    return DesignSurface(
        vertices=shape.position(plane.points[used]),
        faces=np.asarray(faces.reshape(-1, 3), dtype=np.int64),
        panel=panel[panel >= 0],
        panel_names=PANELS,
    )


def demo_foam_mesh(
    cushion: Cushion | None = None, *, element_size: float = 0.006, cover_thickness: float = 0.0012
) -> FoamMesh:
    """Return the foam below the design surface: half a cover thickness inside it, closed below.

    Under the trenches it is cut deeper by the cushion's ``slot``, to give the wires room.

    Parameters
    ----------
    cushion, element_size : as in ``demo_design``
    cover_thickness : float [m]

    Returns
    -------
    FoamMesh
        Curves ``trench_left``, ``trench_right`` run from front to rear; ``frame_front``,
        ``frame_left``, ``frame_rear``, ``frame_right`` clockwise seen from above, each the lower
        edge of one panel in that panel's outline order.
    """
    shape = cushion or Cushion()
    plane = _plane(shape, element_size)
    surface = shape.position(plane.points)
    x, y = plane.points.T
    slot = np.where(
        np.abs(np.abs(x) - shape.trench_x(y)) < 1e-9, shape.slot * shape.depth_share(y), 0.0
    )
    vertices = inside(surface, plane.faces, cover_thickness, slot)
    rim = mesh.boundary_loops(plane.faces)[0]
    vertices[rim, 2] = 0.0
    bottom, bottom_faces = mesh.triangulate(vertices[rim, :2], element_size)
    below = np.column_stack([bottom[len(rim) :], np.zeros(len(bottom) - len(rim))])
    number = np.concatenate([rim, len(vertices) + np.arange(len(below))])
    curves = {name: shape.position(line) for name, line in plane.curves.items()}
    return FoamMesh(
        vertices=np.concatenate([vertices, below]),
        faces=np.concatenate([plane.faces, number[bottom_faces[:, ::-1]]]),
        curves=MappingProxyType(curves),
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class _Plane:
    """The meshed parameter plane: top, walls and the strip down to the foam's bottom."""

    points: FloatArray
    faces: IntArray
    curves: dict[str, FloatArray]


@functools.lru_cache(maxsize=1)
def _plane(shape: Cushion, h: float) -> _Plane:
    """Mesh the parameter plane with all seam lines and the frame line as edges."""
    feet, normals = shape.perimeter()
    seam, frame, bottom = (
        shape.ring(feet, normals, level=level) for level in (None, shape.frame_height, 0.0)
    )
    quarter = len(feet) // 4
    trenches = {
        "left": _trench(shape, seam, 1.0),
        "right": _trench(shape, seam, -1.0),
    }
    meets = [int(np.linalg.norm(seam - p, axis=1).argmin()) for t in trenches.values() for p in t]
    ends = np.concatenate(list(trenches.values()))
    seam[meets] = ends
    corners = [k * quarter for k in range(4)]
    lines = _split(seam, sorted({*corners, *meets}), h)
    frames = _split(frame, corners, h)
    lines += frames
    lines += [mesh.resample(np.array([seam[k], frame[k]]), h) for k in corners]
    wires = {f"trench_{name}": mesh.resample(line, h) for name, line in trenches.items()}
    lines += list(wires.values())
    rim = np.concatenate([part[:-1] for part in _split(bottom, corners, h)])
    points, faces = mesh.triangulate(rim, h, lines=lines)
    frame_curves = dict(zip((f"frame_{q}" for q in QUARTERS), frames, strict=True))
    return _Plane(
        points=points,
        faces=faces,
        curves=wires | {name: line[::-1] for name, line in frame_curves.items()},
    )


def _trench(shape: Cushion, seam: FloatArray, side: float) -> FloatArray:
    """Return the straight trench line (2, 2), front to rear, between front and rear seams."""
    off = side * seam[:, 0] - shape.trench_x(seam[:, 1])
    ends = []
    for along in (-1.0, 1.0):
        half = np.flatnonzero((along * seam[:, 1] > 0.5 * shape.half[1]) & (off < 0))
        near = half[off[half].argmax()]
        y = seam[near, 1]
        ends.append([side * shape.trench_x(y), y])
    return np.array(ends)


def _split(loop: FloatArray, at: list[int], h: float) -> list[FloatArray]:
    """Cut a closed curve (k, 2) at the given points and sample each part at ``h``."""
    closed = np.concatenate([loop, loop[: at[0] + 1]])
    stops = [*at, len(loop) + at[0]]
    return [mesh.resample(closed[i : j + 1], h) for i, j in itertools.pairwise(stops)]


def _panels(shape: Cushion, p: FloatArray) -> IntArray:
    """Return the panel of each plane point (k, 2), -1 below the frame."""
    foot, normal, _ = shape.outline(p)
    reach = np.einsum("kd,kd->k", p - foot, normal)
    seam, frame = (
        np.einsum("kd,kd->k", shape.ring(foot, normal, level=level) - foot, normal)
        for level in (None, shape.frame_height)
    )
    insert = np.abs(p[:, 0]) < shape.trench_x(p[:, 1])
    top = np.where(insert, 0, np.where(p[:, 0] > 0, 1, 2))
    level = np.abs(normal[:, 0]) > np.abs(normal[:, 1])
    wall = np.where(level, np.where(normal[:, 0] > 0, 4, 5), np.where(normal[:, 1] < 0, 3, 6))
    return np.where(reach < seam, top, np.where(reach < frame, wall, -1))
