"""Seam allowances folded inward: what they add to the cover, without a mesh of their own."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import shapely
from scipy.spatial import cKDTree

from seatlook.assembly.builder import Builder
from seatlook.assembly.ease import seam_ease
from seatlook.assembly.lines import Line
from seatlook.mesh import arc_length
from seatlook.mesh.polyline import sizes_at
from seatlook.model import Fabric, FloatArray, Hem, IntArray, Panel, Pattern, Scene, Seam

_STEP = 0.001  # of the points on a sew line at which its allowance is measured [m]
_SLIVER = 1e-9  # share of an edge that is rounding
_RAYS = 5  # points per side of a triangle that tell how much of it lies over an allowance


@dataclass(frozen=True, slots=True)
class _Sewn:
    """Points on the sewn edges of one panel."""

    points: FloatArray
    along: FloatArray  # unit tangent (k, 2)
    width: FloatArray  # allowance there [m]


def allowance(panel: Panel, points: FloatArray) -> FloatArray:
    """Distance (k,) [m] of points on the sew line from the line the panel is cut along."""
    ring = shapely.LinearRing(panel.cut_outline)
    return np.asarray(shapely.distance(ring, shapely.points(points)))


def fold_stiffness(fabric: Fabric, normal: FloatArray) -> FloatArray:
    """Moment per length and angle (k,) [N] of a sheet folded flat on itself.

    The mid surface turns by pi on a half circle of diameter t: B over its length pi t / 2.

    Parameters
    ----------
    normal : (k, 2) float64   unit vectors across the fold, in warp/weft axes
    """
    n0, n1 = normal.T
    across = np.stack([n0 * n0, n1 * n1, 2.0 * n0 * n1], axis=1)
    bending = np.einsum("ki,ij,kj->k", across, fabric.bending_matrix, across)
    return np.asarray(2.0 * bending / (np.pi * fabric.thickness))


def strip_bending(fabric: Fabric, along: FloatArray) -> FloatArray:
    """Bending matrices (k, 3, 3) [N m] of allowances that run ``along`` (k, 2), in warp/weft axes.

    Folded over, the allowance is the panel's mirror image at the seam, so its coupling of bending
    and twist changes sign; its outer edge is free, so it bears no moment across itself.
    """
    t0, t1 = along.T
    # Rows: curvature (tt, nn, 2 tn) of a curvature (11, 22, 2 x 12).
    turn = np.stack(
        [
            np.stack([t0 * t0, t1 * t1, t0 * t1], axis=1),
            np.stack([t1 * t1, t0 * t0, -t0 * t1], axis=1),
            np.stack([-2 * t0 * t1, 2 * t0 * t1, t0 * t0 - t1 * t1], axis=1),
        ],
        axis=1,
    )
    back = np.linalg.inv(turn)
    mirror = np.diag([1.0, 1.0, -1.0])
    local = mirror @ (back.transpose(0, 2, 1) @ fabric.bending_matrix @ back) @ mirror
    across = local[:, :, 1]
    local = local - across[:, :, None] * across[:, None, :] / local[:, 1, 1][:, None, None]
    return np.asarray(turn.transpose(0, 2, 1) @ local @ turn)


def hem_of(builder: Builder, scene: Scene, uv: FloatArray, faces: IntArray) -> Hem:
    """Build the hem of all seams.

    Below a seam every panel carries its allowance as a second, unbonded layer; across the seam the
    two folds are springs in series that are slack when both panels lie in one plane, as in a seam
    that is pressed open. In the plane an allowance carries nothing, as with relief cuts.
    """
    owner = builder.arrays()[2]
    bending = np.zeros((len(faces), 3, 3))
    density, lift = np.zeros(len(faces)), np.zeros(len(uv))
    for i, panel in enumerate(scene.pattern.panels):
        sewn = _sewn(panel, scene.pattern)
        if sewn is None:
            continue
        fabric = scene.materials[panel.name].fabric
        rows = np.flatnonzero(owner[faces[:, 0]] == i)
        share, nearest = _coverage(uv[faces[rows]], sewn)
        tangent = panel.in_grain(sewn.along[nearest])
        bending[rows] = share[:, None, None] * strip_bending(fabric, tangent)
        density[rows] = share * fabric.density
        vertices = np.flatnonzero(owner == i)
        distance, at = _nearest(sewn, uv[vertices])
        lift[vertices] = fabric.thickness * _ramp(
            distance, sewn.width[at], sizes_at(builder.size[panel.name], uv[vertices])
        )
    folds = _folds(builder, scene, uv)
    return Hem(bending=bending, density=density, lift=lift, **folds)


def _sewn(panel: Panel, pattern: Pattern) -> _Sewn | None:
    """Sample the sewn edges of a panel; None if it has no allowance there."""
    names = {name for seam in pattern.seams for name in (seam.a, *seam.b)}
    points, along = [np.zeros((0, 2))], [np.zeros((0, 2))]
    for edge in pattern.edges.values():
        if edge.panel != panel.name or edge.name not in names:
            continue
        line = pattern.edge_points(edge.name)
        arc = arc_length(line)
        at = np.linspace(0.0, arc[-1], max(2, int(arc[-1] / _STEP)))
        points.append(np.column_stack([np.interp(at, arc, column) for column in line.T]))
        step = np.gradient(points[-1], axis=0)
        along.append(step / np.linalg.norm(step, axis=1, keepdims=True))
    every = np.concatenate(points)
    width = allowance(panel, every) if len(every) else np.zeros(0)
    if not len(width) or width.max() < _STEP:
        return None
    return _Sewn(every, np.concatenate(along), width)


def _coverage(corners: FloatArray, sewn: _Sewn) -> tuple[FloatArray, IntArray]:
    """Share (m,) of every triangle that lies over an allowance, and its nearest sewn point."""
    i, j = np.meshgrid(np.arange(_RAYS), np.arange(_RAYS))
    u, v = ((np.stack([i, j]) + 1.0 / 3.0) / _RAYS)[:, i + j < _RAYS]
    inside = np.einsum("sk,mkd->msd", np.column_stack([1 - u - v, u, v]), corners)
    distance, nearest = _nearest(sewn, inside.reshape(-1, 2))
    covered = (distance < sewn.width[nearest]).reshape(len(corners), -1)
    return covered.mean(axis=1), _nearest(sewn, corners.mean(axis=1))[1]


def _nearest(sewn: _Sewn, points: FloatArray) -> tuple[FloatArray, IntArray]:
    distance, index = cKDTree(sewn.points).query(points)
    return np.asarray(distance), np.asarray(index, dtype=np.int64)


def _ramp(distance: FloatArray, width: FloatArray, h: FloatArray) -> FloatArray:
    """1 over the allowance, falling to 0 over one element: a sheet bridges the step."""
    return np.clip((width + 0.5 * h - distance) / h, 0.0, 1.0) * (width > _STEP)


def _folds(builder: Builder, scene: Scene, uv: FloatArray) -> dict[str, Any]:
    """Columns of ``Hem`` that describe the folds of all seams."""
    columns = [_fold(builder, scene, seam, uv) for seam in scene.pattern.seams]
    first = np.cumsum([0, *(len(c["near"]) for c in columns)])
    for start, column in zip(first, columns, strict=False):
        column["row"] = column["row"] + start
    return {name: np.concatenate([c[name] for c in columns]) for name in columns[0]}


def _fold(builder: Builder, scene: Scene, seam: Seam, uv: FloatArray) -> dict[str, Any]:
    """Rim edges of one seam's coarser side, and what each of them is sewn to."""
    knots_a, knots_b = seam_ease(scene.pattern, seam).knots
    a = _side(builder, scene, [seam.a], builder.chain([seam.a]), uv)
    b = _side(builder, scene, seam.b, builder.chain(seam.b, reverse=seam.reverse), uv)
    b = replace(b, ends=np.interp(b.ends, knots_b, knots_a))
    coarse, fine = (a, b) if len(a.edges) <= len(b.edges) else (b, a)
    low = np.maximum(coarse.ends[:, :1], fine.ends[:, 0])
    shared = np.maximum(np.minimum(coarse.ends[:, 1:], fine.ends[:, 1]) - low, 0.0)
    row, other = np.nonzero(shared > _SLIVER * np.diff(coarse.ends))
    total = np.bincount(row, shared[row, other], minlength=len(coarse.edges))
    weight = shared[row, other] / total[row]
    soft = np.bincount(row, weight * fine.stiffness[other], minlength=len(coarse.edges))
    return {
        "near": coarse.edges,
        "far": fine.edges[other],
        "row": row,
        "weight": weight,
        "length": coarse.length,
        "stiffness": 1.0 / (1.0 / coarse.stiffness + 1.0 / soft),
    }


@dataclass(frozen=True, slots=True)
class _Side:
    """Rim edges on one side of a seam, in the order in which it is sewn."""

    edges: IntArray
    ends: FloatArray  # shares of the side's length where each begins and ends (k, 2)
    length: FloatArray  # [m]
    stiffness: FloatArray  # of the fold [N]


def _side(
    builder: Builder, scene: Scene, names: Sequence[str], lines: Sequence[Line], uv: FloatArray
) -> _Side:
    starts = np.cumsum([0.0, *(line.length for line in lines)])
    ends, edges, stiffness = [], [], []
    for name, line, start in zip(names, lines, starts, strict=False):
        ends.append((start + np.column_stack([line.arc[:-1], line.arc[1:]])) / starts[-1])
        edges.append(np.column_stack([line.vertices[:-1], line.vertices[1:]]))
        panel = builder.pattern.panel(builder.pattern.edges[name].panel)
        step = np.diff(uv[line.vertices], axis=0)
        along = panel.in_grain(step / np.linalg.norm(step, axis=1, keepdims=True))
        normal = np.column_stack([along[:, 1], -along[:, 0]])
        stiffness.append(fold_stiffness(scene.materials[panel.name].fabric, normal))
    return _Side(
        edges=np.concatenate(edges),
        ends=np.concatenate(ends),
        length=np.concatenate([np.diff(line.arc) for line in lines]),
        stiffness=np.concatenate(stiffness),
    )
