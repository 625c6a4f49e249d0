"""Whether the parts of a scene can fit each other in space: wires, foam, placed panels."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from itertools import combinations
from typing import Any

import numpy as np
import shapely
import trimesh.triangles
from scipy.spatial import cKDTree

from seatlook import mesh
from seatlook.errors import InputWarning
from seatlook.io.toml import Document
from seatlook.mesh.overlap import shared_area
from seatlook.mesh.surface import winding
from seatlook.model import FloatArray, Foam, Pattern, Pose

# A cover is cut a little small and never much larger; beyond this the line and the wire do not
# belong together, or a whole line is sent to a piece of the wire.
LONGEST_LINE = 1.05
# How far a tie can press soft foam in where no trench is modelled.
DEEPEST_WIRE = 0.030  # m
_SPACING = 0.005  # of the points at which a wire is looked at [m]
_FARTHEST = 10.0  # times the diagonal of the foam, from its middle to where a panel starts
_IN_SCALE = (0.13, 3.5)  # largest panel over the diagonal of the foam; wrong by ten is outside
_nearest: Any = trimesh.triangles.closest_point  # one point for each of (m, 3, 3) triangles


def check_wires(
    document: Document, row: dict[str, Any], pattern: Pattern | None, foam: Foam | None
) -> None:
    """Report hooks whose line is longer than their wire, and wires inside solid foam."""
    if foam is None:
        return
    depth = {name: _depth(points, foam) for name, points in foam.curves.items()}
    for number, hook in enumerate(row["hook"]):
        wire = foam.curves.get(hook["wire"])
        if wire is None:
            continue
        key = ("hook", number, "wire")
        lines = (hook["line"],) if hook["line"] else hook["chain"] or ()
        length, chain = mesh.length(wire), chain_length(lines, pattern)
        part = hook["junctions_mm"]
        piece = length if part is None else float(np.ptp(part))
        if chain is not None and part is not None:  # junctions are those of the part pulled
            end = chain if hook["to_mm"] is None else hook["to_mm"]
            chain = end - (hook["from_mm"] or 0.0)
        if chain is not None and chain > LONGEST_LINE * piece:
            at = f"its wire {hook['wire']!r}" if part is None else f"its part of {hook['wire']!r}"
            document.report(
                ("hook", number, "line" if hook["line"] else "chain"),
                f"{' + '.join(map(repr, lines))}, {1e3 * chain:.1f} mm long",
                f"at most the length of {at}, {1e3 * piece:.1f} mm",
            )
        if depth[hook["wire"]] > DEEPEST_WIRE:
            document.report(
                key,
                f"{hook['wire']!r}, {1e3 * depth[hook['wire']]:.1f} mm inside solid foam",
                f"a wire in a trench, or at most {1e3 * DEEPEST_WIRE:g} mm below the surface",
            )


def check_overlap(
    document: Document, pattern: Pattern | None, placement: Mapping[str, Pose]
) -> None:
    """Report panels that are placed in one plane and cover each other."""
    if pattern is None:
        return
    placed = [p for p in pattern.panels if p.name in placement]
    for a, b in combinations(placed, 2):
        shared = shared_area(placement[a.name].at(a.outline), placement[b.name].at(b.outline))
        if shared > 0.0:
            document.report(
                ("placement", b.name),
                f"{1e4 * shared:.1f} cm2 on {a.name}, in the same plane",
                "panels beside or above each other",
            )


def check_distance(document: Document, placement: Mapping[str, Pose], foam: Foam | None) -> None:
    """Report panels that start so far away that they cannot be meant for this foam."""
    if foam is None:
        return
    low, high = foam.vertices.min(axis=0), foam.vertices.max(axis=0)
    size = float(np.linalg.norm(high - low))
    for name, pose in placement.items():
        away = float(np.linalg.norm(pose.translation - (low + high) / 2))
        if not away <= _FARTHEST * size:
            document.report(
                ("placement", name, "translation_mm"),
                f"a place {away:.3g} m from the middle of the foam",
                f"at most {_FARTHEST * size:.3g} m, {_FARTHEST:g} times the foam's size",
            )


def check_scale(document: Document, pattern: Pattern | None, foam: Foam | None) -> None:
    """Warn of a pattern that is far too small or too large for its foam."""
    if pattern is None or foam is None:
        return
    size = float(np.linalg.norm(np.ptp(foam.vertices, axis=0)))
    largest = max(float(np.ptp(panel.outline, axis=0).max()) for panel in pattern.panels)
    low, high = _IN_SCALE
    if not low * size <= largest <= high * size:
        warnings.warn(
            f"{document.file}: the largest panel is {largest:.3g} m and the foam {size:.3g} m: "
            "is the unit of one of them wrong?",
            InputWarning,
            4,
        )


def check_hem(document: Document, pattern: Pattern | None, hem: bool | None) -> None:
    """Report panels that their folded allowances would not fit below."""
    if not hem or pattern is None:
        return
    for panel in pattern.panels:
        points = _sewn_points(panel.name, pattern)
        if not len(points):
            continue
        ring = shapely.LinearRing(panel.cut_outline)
        width = float(shapely.distance(ring, shapely.points(points)).max())
        body = shapely.Polygon(panel.outline)
        if body.buffer(-0.5 * width).is_empty:
            document.report(
                ("hem",),
                f"an allowance of {1e3 * width:.1f} mm on {panel.name}, "
                f"which is {2e3 * shapely.maximum_inscribed_circle(body).length:.1f} mm wide",
                "an allowance narrower than its panel",
            )


def _sewn_points(name: str, pattern: Pattern) -> FloatArray:
    """Vertices (k, 2) of a panel's sewn edges."""
    sewn = {edge for seam in pattern.seams for edge in (seam.a, *seam.b)}
    lines = [
        pattern.edge_points(e.name)
        for e in pattern.edges.values()
        if e.panel == name and e.name in sewn
    ]
    return np.concatenate([np.zeros((0, 2)), *lines])


def chain_length(lines: Sequence[str], pattern: Pattern | None) -> float | None:
    """Return the length [m] of lines, each a seam's near side or PANEL/LINE; None if unknown."""
    lengths = [None if pattern is None else _line_length(line, pattern) for line in lines]
    known = [length for length in lengths if length is not None]
    return sum(known) if known and len(known) == len(lengths) else None


def _line_length(line: str, pattern: Pattern) -> float | None:
    for seam in pattern.seams:
        if seam.name == line:
            return pattern.edge_length(seam.a)
    panel, _, name = line.partition("/")
    for p in pattern.panels:
        if p.name == panel and name in p.internal_lines:
            return mesh.length(p.internal_lines[name])
    return None


def _depth(curve: FloatArray, foam: Foam) -> float:
    """Largest depth of a curve below the surface of the foam [m], 0 outside."""
    arc = mesh.arc_length(curve)
    at = np.linspace(0.0, arc[-1], max(2, int(np.ceil(arc[-1] / _SPACING)) + 1))
    points = np.column_stack([np.interp(at, arc, column) for column in curve.T])
    # Vertices lie on the surface: a point near one is not deep, and few points are left.
    far = points[cKDTree(foam.vertices).query(points)[0] > DEEPEST_WIRE]
    triangles = foam.vertices[foam.faces]
    deepest = 0.0
    for point in far:
        if winding(point, triangles) > 0.5:
            here = np.tile(point, (len(triangles), 1))
            nearest = _nearest(triangles, here)
            deepest = max(deepest, float(np.linalg.norm(nearest - point, axis=1).min()))
    return deepest
