"""Panels with several borders, such as ring-shaped strips and tubes, opened by closing seams."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from types import MappingProxyType

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import dijkstra

from seatlook import mesh
from seatlook.errors import InputError, InputWarning
from seatlook.flattening.cutting.parts import parted
from seatlook.flattening.surface import DesignSurface, Patch, millimetres
from seatlook.mesh.imprint import Imprinted, imprint
from seatlook.model import FloatArray, IntArray

# How much dearer a closing seam is at the front than at the rear, and at a side or on top than in
# the middle and below: it goes where it is seen least.
_FRONT, _SIDE, _TOP = 10.0, 1.0, 1.0
# A ring that turns more than this when it lies flat would meet itself: it becomes two panels.
_LARGEST_TURN = np.radians(300.0)
_CLEAR = 0.015  # [m] of a border, from where seams meet on it to the end of a closing seam


def opened(surface: DesignSurface) -> DesignSurface:
    """Cut panels with several borders from one border to the next, at the rear or below.

    A ring that would meet itself in the plane is cut twice and becomes two panels, and so does one
    of a cover that is closed all round. A panel in several pieces becomes as many. What is cut is
    said in a warning. A surface that needs nothing stays as it is.
    """
    surface = parted(surface)
    for index, name in enumerate(surface.panel_names):
        patch = surface.piece(index)
        borders = sorted(
            (loop for loop in mesh.boundary_loops(patch.faces) if not patch.is_slit(loop)),
            key=lambda loop: -mesh.length(patch.vertices[np.append(loop, loop[0])]),
        )
        if len(borders) < 2:
            continue
        lines = _closing_lines(patch, borders, surface)
        number = sum(line.startswith(f"{name}-CLOSING") for line in surface.seam_lines.values())
        named = {
            f"{name}-CLOSING" + (f"_{i}" if i > 1 else ""): line
            for i, line in enumerate(lines, start=number + 1)
        }
        for line in lines:
            ends = " to ".join(millimetres(patch.vertices[line[k]]) for k in (0, -1))
            warnings.warn(
                f"panel {name} has {len(borders)} borders: it is cut, and sewn again, from {ends} "
                "mm; draw a line from border to border to have this seam elsewhere",
                InputWarning,
                stacklevel=2,
            )
        return opened(_cut(surface, index, patch, named))
    return surface


def _closing_lines(patch: Patch, borders: list[IntArray], surface: DesignSurface) -> list[IntArray]:
    """Return vertices along edges from the longest border to the next, once or twice."""
    low, high = surface.vertices.min(axis=0), surface.vertices.max(axis=0)
    share = (patch.vertices - low) / (high - low).max()
    side = np.abs(patch.vertices[:, 0] - (low[0] + high[0]) / 2) / (high - low).max()
    seen = _FRONT * (share[:, 1].max() - share[:, 1]) + _SIDE * side + _TOP * share[:, 2]
    clear = [_clear_of_junctions(patch, loop, surface) for loop in borders]
    first = _way(patch, clear, 1 + seen)
    corner = mesh.angles(patch.vertices, patch.faces)
    around = np.bincount(patch.faces.ravel(), corner.ravel(), minlength=len(patch.vertices))
    joined = next(k for k, loop in enumerate(borders) if first[-1] in loop)
    turns = [float((np.pi - around[borders[k]]).sum()) for k in (0, joined)]
    # Nothing pulls a strip of one piece round the foam where the cover has no border of its own.
    held = bool(mesh.boundary_loops(surface.faces))
    if held and abs(turns[0] - turns[1]) / 2 < _LARGEST_TURN:
        return [first]
    far = dijkstra(_roads(patch, np.ones(len(patch.vertices))), False, first, min_only=True)
    return [first, _way(patch, [clear[0], clear[joined]], 1 + _FRONT * (1 - far / far.max()))]


def _clear_of_junctions(patch: Patch, loop: IntArray, surface: DesignSurface) -> IntArray:
    """Vertices of a border that are not beside a place where its neighbour changes.

    A closing seam that ended there would leave a seam too short to be sewn, or meshed. Where
    nothing is clear of such places the whole border counts.
    """
    ring = patch.source[loop].tolist()
    half = surface.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2).tolist()
    panel = dict(zip(map(tuple, half), np.repeat(surface.panel, 3).tolist(), strict=True))
    beyond = [
        (panel.get((b, a)), surface.seam_lines.get((min(a, b), max(a, b))))
        for a, b in zip(ring, ring[1:] + ring[:1], strict=True)
    ]
    changes = [i for i in range(len(ring)) if beyond[i] != beyond[i - 1]]
    arc = mesh.arc_length(patch.vertices[np.append(loop, loop[0])])
    away = np.abs(arc[:-1, None] - arc[changes])
    away = np.minimum(away, arc[-1] - away)
    clear = loop[away.min(axis=1, initial=np.inf) >= _CLEAR]
    return clear if len(clear) else loop


def _way(patch: Patch, borders: list[IntArray], cost: FloatArray) -> IntArray:
    """Return vertices along edges from the first border to the one that is reached most cheaply."""
    way, ahead, _ = dijkstra(
        _roads(patch, cost), False, borders[0], return_predecessors=True, min_only=True
    )
    others = np.concatenate(borders[1:])
    line = [int(others[way[others].argmin()])]
    while ahead[line[-1]] >= 0:
        line.append(int(ahead[line[-1]]))
    return np.array(line[::-1], dtype=np.int64)


def _roads(patch: Patch, cost: FloatArray) -> sp.csr_array:
    """Return what each edge costs: its length times the mean cost (n,) of its ends."""
    a, b = mesh.edges(patch.faces).T
    length = np.linalg.norm(patch.vertices[a] - patch.vertices[b], axis=1)
    n = len(patch.vertices)
    return sp.csr_array((length * (cost[a] + cost[b]) / 2, (a, b)), shape=(n, n))


def _cut(
    surface: DesignSurface, index: int, patch: Patch, lines: Mapping[str, IntArray]
) -> DesignSurface:
    """Cut a panel along straight lines between the ends of these, or else along their edges."""
    ways = {name: patch.vertices[line] for name, line in lines.items()}
    drawn = _straight(patch, lines) or imprint(patch.vertices, patch.faces, ways, border=False)
    # Vertices of the patch keep their numbers; those of a dart there are two of.
    number = np.append(patch.source, len(surface.vertices) + np.arange(len(drawn.vertices)))
    number = number[: len(drawn.vertices)]
    vertices = np.concatenate([surface.vertices, drawn.vertices[len(patch.vertices) :]])
    vertices[patch.source] = drawn.vertices[: len(patch.vertices)]
    others = surface.panel != index
    edges = {
        (min(number[a], number[b]), max(number[a], number[b])): name
        for (a, b), name in drawn.edges.items()
    }
    return DesignSurface(
        vertices=vertices,
        faces=np.concatenate([surface.faces[others], number[drawn.faces]]),
        panel=np.append(surface.panel[others], np.full(len(drawn.faces), index)),
        panel_names=surface.panel_names,
        seam_lines=MappingProxyType({**surface.seam_lines, **edges}),
    )


def _straight(patch: Patch, lines: Mapping[str, IntArray]) -> Imprinted | None:
    """Draw straight lines between the ends; None where one leaves the panel or meets its border."""
    ends = {name: patch.vertices[line[[0, -1]]] for name, line in lines.items()}
    try:
        drawn = imprint(patch.vertices, patch.faces, ends, border=False)
    except InputError:
        return None
    inner = [v for pair in drawn.edges for v in pair]
    border = np.concatenate(mesh.boundary_loops(patch.faces))
    met = np.isin(inner, border).sum()
    return drawn if met == 2 * len(lines) else None
