"""A first guess at where the free borders of a cover come to lie on the foam.

A cover leaves that part of the foam bare which it has no cloth for. Each border is a plane section
of the foam: in the direction in which the section is as long as the border, so far out that what
lies beyond is as large as what the cloth leaves.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from seatlook.assembly.sewn_surface import free_borders
from seatlook.errors import InputError
from seatlook.mesh import arc_length, face_areas
from seatlook.mesh.places import border_names
from seatlook.model import Border, FloatArray, Foam, Pattern, Pose

_POINTS = 400  # of a girth
_LEAST_BARE = 0.02  # share of the foam's surface beyond all borders, if the cloth leaves none
_FACES = 0.5  # cosine; no border opens where the first panel faces
# By how much worse [log] a section may fit in length that opens as the border's edges face, and
# behind the first panel.
_FACING, _BEHIND = 0.45, 0.15
_LESS = 0.2  # weight of a panel's place for each seam between it and the first: it lies anyhow


@dataclass(frozen=True, slots=True)
class _Girth:
    """A closed line (k, 3) round the foam, the first point repeated, and the way it opens.

    Seen from the covered side it runs counter-clockwise, as the outlines of panels do.
    """

    line: FloatArray
    opens: FloatArray

    @property
    def length(self) -> float:
        return float(arc_length(self.line)[-1])


def lay_borders(
    pattern: Pattern,
    foam: Foam,
    axes: FloatArray,
    poses: Mapping[str, Pose],
    depth: Mapping[str, int],
) -> tuple[Border, ...]:
    """Lay the free borders of a cover round its foam.

    Parameters
    ----------
    axes : (3, 3) directions of the foam, one a row
    poses : of all panels
    depth : panel -> how many seams it is away from the first one; of those of the cover

    Raises
    ------
    InputError
        A foam that no plane cuts.
    """
    loops = [
        edges
        for edges in free_borders(pattern)
        if all(pattern.edges[name].panel in depth for name in edges)
    ]
    loops.sort(key=lambda edges: -_length(pattern, edges))
    (first,) = (name for name, steps in depth.items() if steps == 0)
    face = poses[first].rotation[:, 2]
    ways = [w for axis in axes for w in (axis, -axis) if w @ face < _FACES]
    cloth = sum(panel.area for panel in pattern.panels if panel.name in depth)
    bare = _bare_share(foam, cloth) / max(len(loops), 1)
    girths = [_section(foam, way, bare) for way in ways]
    laid = []
    for edges in loops:
        out = _outward(pattern, edges, poses, depth)
        girth = min(girths, key=lambda g: _misfit(g, _length(pattern, edges), out, face))
        girths = [g for g in girths if g is not girth] or girths
        laid.append(_laid(pattern, edges, girth, poses, depth))
    names = border_names([border.curve for border in laid])
    return tuple(replace(b, name=name) for b, name in zip(laid, names, strict=True))


def _length(pattern: Pattern, edges: Sequence[str]) -> float:
    return float(sum(pattern.edge_length(name) for name in edges))


def _bare_share(foam: Foam, cloth: float) -> float:
    """Share of the foam's surface that the cloth does not reach."""
    whole = float(face_areas(foam.vertices, foam.faces).sum())
    return max(1.0 - cloth / whole, _LEAST_BARE)


def _outward(
    pattern: Pattern, edges: Sequence[str], poses: Mapping[str, Pose], depth: Mapping[str, int]
) -> FloatArray:
    """Mean direction (3,) in which the edges of a border face where their panels start."""
    total, weight = np.zeros(3), 0.0
    for name in edges:
        panel = pattern.edges[name].panel
        step = np.diff(pattern.edge_points(name), axis=0).sum(axis=0)
        own = _LESS ** depth[panel]
        total += own * (poses[panel].rotation[:, :2] @ np.array([step[1], -step[0]]))
        weight += own * pattern.edge_length(name)
    return np.asarray(total / weight)


def _misfit(girth: _Girth, length: float, outward: FloatArray, face: FloatArray) -> float:
    """How ill a section fits a border: its length, and where the border and the first panel face.

    Parameters
    ----------
    outward, face : directions of the border's edges, and of the first panel
    """
    facing = _FACING * float(girth.opens @ outward) - _BEHIND * float(girth.opens @ face)
    return abs(float(np.log(girth.length / length))) - facing


def _section(foam: Foam, way: FloatArray, bare: float) -> _Girth:
    """Section across a direction, with a share of the foam's surface beyond it."""
    height = foam.vertices @ way
    areas = face_areas(foam.vertices, foam.faces)
    lowest, highest = (pick(height[foam.faces], axis=1) for pick in (np.min, np.max))
    levels = np.linspace(height.min(), height.max(), 202)[1:-1]
    # Of a face that a plane cuts, the share of its height counts.
    beyond = np.clip((highest - levels[:, None]) / np.maximum(highest - lowest, 1e-12), 0.0, 1.0)
    share = (beyond * areas).sum(axis=1) / areas.sum()
    level = float(np.interp(bare, share[::-1], levels[::-1]))
    ends = height[foam.faces[:, [0, 1, 1, 2, 2, 0]]].reshape(-1, 2)
    sides = foam.vertices[foam.faces[:, [0, 1, 1, 2, 2, 0]]].reshape(-1, 2, 3)
    cut = (ends[:, 0] - level) * (ends[:, 1] - level) < 0.0
    part = (level - ends[cut, :1]) / (ends[cut, 1:] - ends[cut, :1])
    points = sides[cut, 0] + part * (sides[cut, 1] - sides[cut, 0])
    right = np.eye(3)[int(np.argmin(np.abs(way)))]
    up = np.cross(-way, right)
    flat = points @ np.column_stack([right, up])
    try:
        around = points[ConvexHull(flat).vertices]
    except (QhullError, ValueError) as error:
        raise InputError.single(
            "foam", got="no girth", expected="a closed body (is --unit right?)"
        ) from error
    closed = np.concatenate([around, around[:1]])
    arc = arc_length(closed)
    at = np.linspace(0.0, arc[-1], _POINTS + 1)
    return _Girth(np.column_stack([np.interp(at, arc, column) for column in closed.T]), way)


def _laid(
    pattern: Pattern,
    edges: Sequence[str],
    girth: _Girth,
    poses: Mapping[str, Pose],
    depth: Mapping[str, int],
) -> Border:
    """Spread edges over a girth by their lengths, turned to where their panels start."""
    ends = np.cumsum([0.0, *(pattern.edge_length(name) for name in edges)])
    ends /= ends[-1]
    points = girth.line[:-1]
    turn = 0.0 + 0.0j
    for name, low, high in zip(edges, ends, ends[1:], strict=False):
        edge = pattern.edges[name]
        line = _placed(pattern.edge_points(name), poses[edge.panel])
        nearest = [np.linalg.norm(points - at, axis=1).argmin() / _POINTS for at in line]
        expected = np.linspace(low, high, len(line))
        weight = (high - low) / len(line) * _LESS ** depth[edge.panel]
        turn += weight * np.exp(2j * np.pi * (np.array(nearest) - expected)).sum()
    start = round(float(np.angle(turn)) / (2 * np.pi) * _POINTS) % _POINTS
    curve = np.roll(points, -start, axis=0)
    curve = np.concatenate([curve, curve[:1]])
    return Border(
        name="",
        edges=tuple(edges),
        curve=curve,
        junctions=tuple((ends * arc_length(curve)[-1]).tolist()),
    )


def _placed(line: FloatArray, pose: Pose) -> FloatArray:
    """Points (k, 3) [m] of an edge where its panel starts, evenly spread."""
    arc = arc_length(line)
    at = np.linspace(0.0, arc[-1], 20)
    flat = np.column_stack([np.interp(at, arc, line[:, k]) for k in range(2)])
    return pose.at(flat)
