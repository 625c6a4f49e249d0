"""The worst wrinkles of a solved cover: where, how large, why, and what to do about them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
import numpy.typing as npt
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from seatlook import mesh
from seatlook.model import Cover, FloatArray, IntArray, Points, Solution, Stitching, WrinkleMap
from seatlook.wrinkle.section import Section, section

Cause = Literal["stretch", "compression"]
NO_ADVICE = "none: the mesh does not resolve this wrinkle"
_STATIONS = 7  # sections along a wrinkle, of which the deepest counts
_LONGEST_SECTION = 0.03  # [m] to each side of a wrinkle
_EQUAL = 0.005  # sewn lengths that differ by less count as equal


@dataclass(frozen=True, slots=True, kw_only=True)
class Wrinkle:
    """One connected region with W2 above the level.

    Parameters
    ----------
    panel, zone : names
    rest : (2,) float64 [m]       deepest face, in ``Cover.rest`` coordinates
    uv : (2,) float64 [m]         the same in pattern coordinates
    position : (3,) float64 [m]   the same in space
    along : (2,) float64          unit vector along the wrinkle, in rest coordinates
    length, width : float [m]     of the rectangle with the region's second moments
    depth : float [m]             below a straight edge laid across
    w2_max, w2_area : float [1], [m2]    largest W2 and its integral, by which they are ranked
    stretch_share : float in [0, 1]      part of W2 that is W_stretch
    near_kind, near, distance : nearest seam, hook or frame, its name, and how far [m]
    ease : float                  excess of the longer sewn line over the other; 0 for no seam
    resolved : whether the mesh carries it
    advice : one sentence; that there is none where it does not
    """

    panel: str
    zone: str
    rest: FloatArray
    uv: FloatArray
    position: FloatArray
    along: FloatArray
    length: float
    width: float
    depth: float
    w2_max: float
    w2_area: float
    stretch_share: float
    cause: Cause
    near_kind: str
    near: str
    distance: float
    ease: float
    advice: str
    resolved: bool = True


def worst_wrinkles(
    solution: Solution,
    indices: WrinkleMap,
    *,
    count: int = 5,
    level: float = 1.0,
    unresolved: npt.NDArray[np.bool_] | None = None,
) -> tuple[Wrinkle, ...]:
    """Rank the connected regions of W2 above ``level`` by the integral of W2 over their area.

    Regions end at panel edges. Fewer than ``count`` come back where there are fewer.

    Parameters
    ----------
    unresolved : (m,) bool   faces that the mesh does not carry; a wrinkle with one has no advice
    """
    cover = solution.cover
    region = _regions(cover.faces, indices.w2 > level)
    weight = indices.w2 * cover.rest_area
    numbered = region >= 0
    total = np.bincount(region[numbered], weight[numbered])
    ranked = np.argsort(-total, kind="stable")[:count]
    result = (_describe(solution, indices, np.flatnonzero(region == r)) for r in ranked)
    if unresolved is None:
        return tuple(result)
    bad = set(region[unresolved].tolist())
    return tuple(
        replace(wrinkle, resolved=False, advice=NO_ADVICE) if r in bad else wrinkle
        for r, wrinkle in zip(ranked.tolist(), result, strict=True)
    )


def section_across(
    solution: Solution, wrinkle: Wrinkle, *, design: FloatArray | None = None
) -> Section:
    """Cut the cover across a wrinkle at its deepest place; ``design`` as for ``section``."""
    cover = solution.cover
    return section(
        cover,
        solution.positions,
        panel=cover.panel_names.index(wrinkle.panel),
        middle=wrinkle.rest,
        direction=_across(wrinkle),
        half_length=_half_section(cover, wrinkle),
        design=design,
    )


def beside_sections(
    cover: Cover, wrinkles: Iterable[Wrinkle], reach: float
) -> npt.NDArray[np.bool_]:
    """Vertices (n,) within ``reach`` [m] of the sections across some wrinkles."""
    panel = np.full(len(cover.rest), -1)
    panel[cover.faces] = cover.panel[:, None]
    near = np.zeros(len(cover.rest), dtype=bool)
    for wrinkle in wrinkles:
        rows = np.flatnonzero(panel == cover.panel_names.index(wrinkle.panel))
        off = cover.rest[rows] - wrinkle.rest
        half = _half_section(cover, wrinkle)
        along = np.maximum(np.abs(off @ _across(wrinkle)) - half, 0.0)
        near[rows[np.hypot(along, off @ wrinkle.along) < reach]] = True
    return near


def _across(wrinkle: Wrinkle) -> FloatArray:
    return np.array([-wrinkle.along[1], wrinkle.along[0]])


def _half_section(cover: Cover, wrinkle: Wrinkle) -> float:
    return min(2.0 * wrinkle.width + 2.0 * cover.element_size, _LONGEST_SECTION)


def _regions(faces: IntArray, marked: np.ndarray) -> IntArray:
    """Number (m,) of the region of each marked face, joined over edges; -1 elsewhere."""
    corners = faces[marked]
    half = np.sort(corners[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    key = half @ np.array([int(faces.max()) + 1, 1])
    order = np.argsort(key, kind="stable")
    same = np.flatnonzero(key[order][1:] == key[order][:-1])
    a, b = order[same] // 3, order[same + 1] // 3
    graph = coo_array((np.ones(len(a), dtype=np.int8), (a, b)), shape=(len(corners), len(corners)))
    region = np.full(len(faces), -1, dtype=np.int64)
    region[marked] = connected_components(graph, directed=False)[1]
    return region


def _describe(solution: Solution, indices: WrinkleMap, faces: IntArray) -> Wrinkle:
    cover = solution.cover
    area, w2 = cover.rest_area[faces], indices.w2[faces]
    along, length, width = _extent(cover.rest[cover.faces[faces]], area)
    w2_area = float(w2 @ area)
    share = float(indices.w_stretch[faces] @ area) / w2_area
    cause: Cause = "stretch" if share > 0.5 else "compression"
    stations = []
    for face in _stations(cover, faces, w2, along):
        corners = cover.faces[face]
        position = solution.positions[corners].mean(axis=0)
        kind, name, distance = _nearest(cover, solution.positions, position)
        ease = _ease(cover, name) if kind == "seam" else 0.0
        wrinkle = Wrinkle(
            panel=cover.panel_names[cover.panel[face]], zone=cover.zone_names[cover.zone[face]],
            rest=cover.rest[corners].mean(axis=0), uv=cover.uv[corners].mean(axis=0),
            position=position, along=along, length=length, width=width, depth=0.0,
            w2_max=float(w2.max()), w2_area=w2_area, stretch_share=share, cause=cause,
            near_kind=kind, near=name, distance=distance, ease=ease,
            advice=_advice(cause, kind, name, ease),
        )  # fmt: skip
        stations.append(replace(wrinkle, depth=section_across(solution, wrinkle).depth))
    return max(stations, key=lambda w: w.depth)


def _stations(cover: Cover, faces: IntArray, w2: FloatArray, along: FloatArray) -> list[int]:
    """Return the face of largest W2 in each of some equal stretches along the wrinkle."""
    s = cover.rest[cover.faces[faces]].mean(axis=1) @ along
    span = float(np.ptp(s))
    part = (
        np.minimum(((s - s.min()) / span * _STATIONS).astype(int), _STATIONS - 1) if span else 0 * s
    )
    stretches = [np.flatnonzero(part == k) for k in range(_STATIONS)]
    return [int(faces[rows[np.argmax(w2[rows])]]) for rows in stretches if len(rows)]


def _extent(corners: FloatArray, area: FloatArray) -> tuple[FloatArray, float, float]:
    """Axis, length and width of the rectangle with the same second moments."""
    centre = corners.mean(axis=1)
    weight = area / area.sum()
    off = centre - weight @ centre
    # A triangle's own second moment about its centroid is that of its corners over 4.
    own = corners - centre[:, None]
    moments = np.einsum("f,fi,fj->ij", weight, off, off)
    moments += np.einsum("f,fci,fcj->ij", weight, own, own) / 12.0
    values, axes = np.linalg.eigh(moments)
    width, length = np.sqrt(12.0 * np.maximum(values, 0.0))
    return axes[:, 1], float(length), float(width)


def _nearest(cover: Cover, x: FloatArray, position: FloatArray) -> tuple[str, str, float]:
    """Kind, name and distance of the nearest seam, hook or frame.

    A seam that is hooked lies on its hook: it is named rather than the hook, for its two lines can
    be told apart.
    """
    lines: list[tuple[str, str, Points]] = [
        ("seam", s.name, side) for s in cover.stitchings for side in (s.a, s.b)
    ]
    lines += [(a.kind, a.name, a.points) for a in cover.anchors]
    distances = [
        (float(np.linalg.norm(points.at(x) - position, axis=1).min()), kind, name)
        for kind, name, points in lines
        if len(points)
    ]
    if not distances:
        return "", "", np.inf
    nearest = min(distances)
    beside = [f for f in distances if f[1] == "seam" and f[0] <= nearest[0] + cover.element_size]
    distance, kind, name = min(beside, default=nearest)
    return kind, name, distance


def _ease(cover: Cover, name: str) -> float:
    """Share by which one sewn line is longer than the other at rest."""
    stitching = next(s for s in cover.stitchings if s.name == name)
    a, b = _sewn_lengths(cover, stitching)
    return max(a, b) / min(a, b) - 1.0 if min(a, b) > 0 else 0.0


def _sewn_lengths(cover: Cover, stitching: Stitching) -> tuple[float, float]:
    """Rest length [m] of both sides between the same pairs, within panels."""
    panel = np.zeros(len(cover.rest), dtype=np.int64)
    panel[cover.faces] = cover.panel[:, None]
    sides = (stitching.a, stitching.b)
    steps = [mesh.segment_lengths(s.at(cover.rest)) for s in sides]
    owners = [panel[s.vertices[:, 0]] for s in sides]
    within = np.logical_and.reduce([np.diff(o) == 0 for o in owners])
    return float(steps[0][within].sum()), float(steps[1][within].sum())


def _advice(cause: Cause, kind: str, name: str, ease: float) -> str:
    """Say what the method's authors advise for the cause at this place."""
    if cause == "compression":
        if kind == "seam" and ease > _EQUAL:
            return (
                f"fabric in excess: make the two lines of seam {name} equally long; "
                f"they differ by {100 * ease:.1f} %"
            )
        return "fabric in excess: take length out of the panel beside the wrinkle"
    where = f" at {kind} {name}" if name else ""
    return f"uneven stretch: balance the in-plane stress{where}, by hooking or by the foam's height"
