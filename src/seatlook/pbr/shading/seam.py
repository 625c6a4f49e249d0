"""Seams on the drawn surface: closed gaps, the allowance turned in, and where the thread runs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import KDTree

from seatlook.mesh.closest import nearest_segments
from seatlook.model import Cover, FloatArray, IntArray, Thread
from seatlook.pbr.kernels import stitch
from seatlook.pbr.shading.subdivision import Refined, boundary_edges

# Distance [m] from a seam up to which its thread and groove are drawn.
_REACH = 0.014
# Two edges closer than this [m] after sewing are one seam.
_PARTNER = 0.002
_ALLOWANCE = 0.003


@dataclass(frozen=True, slots=True)
class SewnEdges:
    """Boundary edges that are sewn, each (s,) with the panel on its left.

    Parameters
    ----------
    start, end : (s,) int64 vertices; panel : (s,) int64; arc : (s,) float64 [m]
        ``arc`` is the length run along the outline up to ``start``, in the flat panel.
    side : (s,) int64     twice the number of the seam, and 1 more on its side b
    """

    start: IntArray
    end: IntArray
    panel: IntArray
    arc: FloatArray
    side: IntArray

    def __len__(self) -> int:
        return len(self.start)


# Share of white in a thread that has the panel's own colour: of an even one, and of one with plies,
# whose valleys are darker.
_LIGHTER, _LIGHTER_PLIED = 0.06, 0.10


def pack_thread(thread: Thread, *, built: bool = True, rows: int = 1) -> stitch.Thread:
    """Top stitch as the kernels take it.

    ``built``: whether seams are drawn as they are built; ``rows``: most that a seam has.
    """
    own = thread.colour is not None
    red, green, blue = np.ones(3) if thread.colour is None else thread.colour
    return stitch.Thread(
        thread.offset,
        thread.pitch,
        thread.length,
        thread.width,
        (float(red), float(green), float(blue)),
        1.0 if own else _LIGHTER_PLIED if built else _LIGHTER,
        thread.gauge if built and rows > 1 else 0.0,
        built,
    )


def sewn_edges(cover: Cover, refined: Refined, uv: FloatArray) -> SewnEdges:
    """Find the refined boundary edges that lie on a stitching of the cover."""
    n = len(refined.points)
    key = np.array([n, 1])
    panel_of = np.zeros(len(cover.rest), dtype=np.int64)
    panel_of[cover.faces] = cover.panel[:, None]
    edges, side = np.zeros((0, 2), dtype=np.int64), np.zeros(0, dtype=np.int64)
    if cover.stitchings:
        edges = boundary_edges(np.array(cover.faces))
        side = _sewn_side(cover, edges)
        edges, side = edges[side >= 0], side[side >= 0]
    panel = panel_of[edges[:, 0]]
    first = len(cover.rest)
    for ends in refined.parents:
        # The new vertices of a level come in the order of the edges they halve.
        order = np.argsort(ends @ key)
        index = np.searchsorted((ends @ key)[order], np.sort(edges, axis=1) @ key)
        middle = first + order[index]
        first += len(ends)
        edges = np.concatenate(
            [np.column_stack([edges[:, 0], middle]), np.column_stack([middle, edges[:, 1]])]
        )
        panel, side = np.concatenate([panel, panel]), np.concatenate([side, side])
    length = np.linalg.norm(uv[edges[:, 1]] - uv[edges[:, 0]], axis=1)
    return SewnEdges(edges[:, 0], edges[:, 1], panel, _arcs(edges, length), side)


def close(x: FloatArray, edges: SewnEdges) -> FloatArray:
    """Move sewn vertices half-way to the other panel's edge, so no gap is seen."""
    moved = x.copy()
    for panel in np.unique(edges.panel):
        own, other = edges.panel == panel, edges.panel != panel
        if not other.any():
            continue
        v = np.unique(np.concatenate([edges.start[own], edges.end[own]]))
        a, b = x[edges.start[other]], x[edges.end[other]]
        near, t, _ = nearest_segments(x[v], a, b)
        foot = a[near] + t[:, None] * (b[near] - a[near])
        close_by = np.linalg.norm(foot - x[v], axis=1) < _PARTNER
        moved[v[close_by]] = 0.5 * (x[v] + foot)[close_by]
    return moved


def turned_in(
    x: FloatArray, normals: FloatArray, edges: SewnEdges
) -> tuple[FloatArray, IntArray, IntArray]:
    """Strips below the seams: (k, 3) new points, (f, 3) faces into x and them, (k,) their origin.

    They stand for the seam allowance and stop the light and the eye at the seam.
    """
    v, place = np.unique(np.concatenate([edges.start, edges.end]), return_inverse=True)
    # All panels that meet at a seam take part in its inward direction.
    groups = KDTree(x[v]).query_ball_point(x[v], _PARTNER)
    inward = np.array([-normals[v[group]].sum(axis=0) for group in groups])
    length = np.linalg.norm(inward, axis=1, keepdims=True)
    inward = np.where(length > 1e-9, inward / np.maximum(length, 1e-9), -normals[v])
    below = len(x) + place
    s = len(edges)
    a, b = below[:s], below[s:]
    faces = np.concatenate(
        [np.column_stack([edges.end, edges.start, a]), np.column_stack([edges.end, a, b])]
    )
    return x[v] + _ALLOWANCE * inward, faces, v


def coordinates(
    uv: FloatArray, panel_of: IntArray, edges: SewnEdges, rows: FloatArray
) -> FloatArray:
    """Distance from the panel's nearest seam, length along it, and rows of stitches there, (n, 3).

    Both [m], in the flat panel. The distance is infinite beyond 14 mm.

    Parameters
    ----------
    rows : (2 k,) of both sides of each seam
    """
    out = np.full((len(uv), 3), np.inf)
    for panel in np.unique(edges.panel):
        own = edges.panel == panel
        v = np.flatnonzero(panel_of == panel)
        a, b = uv[edges.start[own]], uv[edges.end[own]]
        near, t, distance = nearest_segments(uv[v], a, b)
        length = np.linalg.norm(b - a, axis=1)
        reached = distance < _REACH
        arc = edges.arc[own][near] + t * length[near]
        there = rows[edges.side[own][near]]
        out[v[reached]] = np.column_stack([distance, arc, there])[reached]
    return out


def _sewn_side(cover: Cover, edges: IntArray) -> IntArray:
    """Which side of which stitching both ends of each boundary edge belong to; -1 for none."""
    out = np.full(len(edges), -1)
    for k, stitching in enumerate(cover.stitchings):
        for which, side in enumerate((stitching.a, stitching.b)):
            held = np.zeros(len(cover.rest), dtype=bool)
            held[side.vertices[side.weights > 0]] = True
            out[held[edges].all(axis=1)] = 2 * k + which
    return out


def _arcs(edges: IntArray, length: FloatArray) -> FloatArray:
    """Length run along each chain of edges up to the start of each edge."""
    starting = {int(a): k for k, a in enumerate(edges[:, 0])}
    ends = set(edges[:, 1].tolist())
    arcs = np.full(len(edges), -1.0)
    heads = [k for a, k in starting.items() if a not in ends]
    for head in [*heads, *starting.values()]:
        k: int | None = head
        run = 0.0
        while k is not None and arcs[k] < 0:
            arcs[k] = run
            run += length[k]
            k = starting.get(int(edges[k, 1]))
    return arcs
