"""Garment patterns with known stitches, from the specification files of GarmentCode.

The JSON files of GarmentCode and of its data set hold panels with edges (straight, Bezier, circle)
and stitches between edges. A panel whose loop runs clockwise faces the other way and is turned over
here, so that every panel is seen with its visible face up.

Source: Korosteleva & Sorkine-Hornung, GarmentCode, ACM Trans. Graph. 42 (2023),
doi:10.1145/3618351.
"""

from __future__ import annotations

import json
from itertools import pairwise
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np

from seatlook.mesh import arc_length
from seatlook.model import Edge, FloatArray, Panel, Pattern, Seam

_SPACING = 0.004  # m between points of a curved edge


def read_garment(path: Path) -> Pattern:
    """Read one specification file as a pattern with its true seams, in metres."""
    document = json.loads(path.read_text())
    scale = 1.0 / float(document.get("properties", {}).get("units_in_meter", 100))
    panels, edges, numbers = [], {}, {}
    for name, drawn in document["pattern"]["panels"].items():
        lines = [_line(drawn, edge, scale) for edge in drawn["edges"]]
        outline = np.concatenate([line[:-1] for line in lines])
        starts = np.concatenate([[0], np.cumsum([len(line) - 1 for line in lines])])
        stops = [(int(a), int(b) % len(outline)) for a, b in pairwise(starts)]
        if _area(outline) < 0:
            outline = outline * (-1.0, 1.0)
        for k, (a, b) in enumerate(stops):
            key = f"{name}.e{k}"
            numbers[name, k] = key
            edges[key] = Edge(name=key, panel=name, start=a, end=b)
        panels.append(
            Panel(
                name=name, outline=np.ascontiguousarray(outline),
                corners=np.array(sorted({a for a, _ in stops}), dtype=np.int64),
                cut_outline=np.ascontiguousarray(outline), grain=np.array([0.0, 1.0]),
            )
        )  # fmt: skip
    seams = []
    for stitch in document["pattern"]["stitches"]:
        a, b = (numbers[side["panel"], side["edge"]] for side in stitch[:2])
        seams.append(Seam(name=f"{a} - {b}", a=a, b=(b,)))
    return Pattern(panels=tuple(panels), edges=MappingProxyType(edges), seams=tuple(seams))


def _line(drawn: dict[str, Any], edge: dict[str, Any], scale: float) -> FloatArray:
    """Points of one edge, (k, 2) [m]; curves are sampled evenly."""
    start, end = (np.array(drawn["vertices"][k], dtype=np.float64) for k in edge["endpoints"])
    curvature = edge.get("curvature")
    if curvature is None:
        return scale * np.array([start, end])
    if isinstance(curvature, list):
        curvature = {"type": "quadratic", "params": [curvature]}
    if curvature["type"] == "circle":
        return scale * _even(_circle(start, end, *curvature["params"]), scale)
    along = end - start
    across = np.array([-along[1], along[0]])
    inner = [start + p[0] * along + p[1] * across for p in curvature["params"]]
    return scale * _even(_bezier(np.array([start, *inner, end])), scale)


def _bezier(points: FloatArray) -> FloatArray:
    t = np.linspace(0.0, 1.0, 257)[:, None, None]
    rows = np.broadcast_to(points, (len(t), *points.shape))
    while rows.shape[1] > 1:
        rows = (1 - t) * rows[:, :-1] + t * rows[:, 1:]
    return np.asarray(rows[:, 0])


def _circle(
    start: FloatArray, end: FloatArray, radius: float, large: int, right: int
) -> FloatArray:
    """Arc of a radius; ``right`` turns it counter-clockwise, as in SVG's coordinates."""
    chord = end - start
    half = np.hypot(*chord) / 2
    rise = np.sqrt(max(radius**2 - half**2, 0.0))
    normal = np.array([-chord[1], chord[0]]) / (2 * half)
    sign = 1.0 if right else -1.0
    centre = (start + end) / 2 + sign * (-rise if large else rise) * normal
    a, b = (np.arctan2(*(p - centre)[::-1]) for p in (start, end))
    turn = sign * ((sign * (b - a)) % (2 * np.pi))
    at = a + np.linspace(0.0, 1.0, 257) * turn
    return np.asarray(centre + radius * np.column_stack([np.cos(at), np.sin(at)]))


def _even(line: FloatArray, scale: float) -> FloatArray:
    arc = arc_length(line)
    at = np.linspace(0.0, arc[-1], max(2, round(arc[-1] * scale / _SPACING) + 1))
    even = np.column_stack([np.interp(at, arc, column) for column in line.T])
    even[[0, -1]] = line[[0, -1]]
    return even


def _area(outline: FloatArray) -> float:
    x, y = outline.T
    return 0.5 * float(x @ np.roll(y, -1) - y @ np.roll(x, -1))
