"""The worst wrinkles of a solved cover: where, how long, wide, deep, how much too long, why.

Lengths and directions are measured on the flat panel, heights and distances in space.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
import numpy.typing as npt

from seatlook.mesh import boundary_sides
from seatlook.model import Cover, FloatArray, IntArray, Points, Solution, WrinkleMap
from seatlook.wrinkle.profile import Profile, profile, section_reach
from seatlook.wrinkle.region import extent, regions
from seatlook.wrinkle.section import Section, section

Cause = Literal["stretch", "compression", "both"]
Kind = Literal["wrinkle", "tie", "corner", "spot"]
MIXED = (0.4, 0.6)  # shares of stretch between which neither cause is named alone
_STATIONS = 7  # sections along a wrinkle, of which the deepest counts
_SMALLEST = 2.0  # elements; what is shorter is no wrinkle that the mesh can show
_CORNER = np.radians(25.0)  # turn of an outline in a corner


@dataclass(frozen=True, slots=True, kw_only=True)
class Wrinkle:
    """One connected region with W2 above the level.

    Parameters
    ----------
    kind : "wrinkle"; "tie" or "corner" if it is no farther from one than a quarter of the
        wavelength, or shorter than two elements and at one; "spot" if it is as short elsewhere
    panel, zone : names
    rest : (2,) float64 [m]       deepest face, in ``Cover.rest`` coordinates
    uv : (2,) float64 [m]         the same in pattern coordinates
    position : (3,) float64 [m]   the same in space
    along : (2,) float64          unit vector along the valley, in rest coordinates
    length, width : float [m]     of the region along it, and its area over the length
    depth : float [m]             below a straight edge laid across, from crest to crest
    reach : float [m]             from the deepest place across to where the section ends
    excess : float [m] >= 0       fabric too long across it: arc minus chord from crest to crest,
        and what is compressed between
    waves : float [m]             the part of it that is arc minus chord
    scatter : float [m]           two standard errors of ``excess``, from sections along it
    w2_max, w2_area : float [1], [m2]    largest W2 and its integral, by which they are ranked
    stretch_share : float in [0, 1]      part of W2 that is W_stretch
    cause : the larger part; "both" from 40 to 60 % of stretch
    near_kind, near, distance : nearest seam, hook or frame, its name, and how far [m]
    resolved : whether the mesh carries it
    """

    kind: Kind = "wrinkle"
    panel: str
    zone: str
    rest: FloatArray
    uv: FloatArray
    position: FloatArray
    along: FloatArray
    length: float
    width: float
    depth: float
    reach: float
    excess: float
    waves: float
    scatter: float
    w2_max: float
    w2_area: float
    stretch_share: float
    cause: Cause
    near_kind: str
    near: str
    distance: float
    resolved: bool = True

    @property
    def across(self) -> FloatArray:
        """The unit vector (2,) across it, in rest coordinates."""
        return np.array([-self.along[1], self.along[0]])


def worst_wrinkles(
    solution: Solution,
    indices: WrinkleMap,
    *,
    count: int = 5,
    level: float = 1.0,
    unresolved: npt.NDArray[np.bool_] | None = None,
    wavelengths: Sequence[float | None] = (),
) -> tuple[Wrinkle, ...]:
    """Rank the connected regions of W2 above ``level`` by the integral of W2 over their area.

    Wrinkles come first, then what lies at ties and corners. Regions end at panel edges. Fewer than
    ``count`` come back where there are fewer.

    Parameters
    ----------
    unresolved : (m,) bool   faces that the mesh does not carry
    wavelengths : float [m]  of the shortest wrinkle of each panel; where it is not known, that of
        the wrinkle itself counts
    """
    cover = solution.cover
    region = regions(cover.faces, indices.w2 > level)
    weight = indices.w2 * cover.rest_area
    numbered = region >= 0
    total = np.bincount(region[numbered], weight[numbered])
    bad = set() if unresolved is None else set(region[unresolved].tolist())
    corners = _corners(cover)
    waves = tuple(wavelengths) or (None,) * len(cover.panel_names)
    wrinkles: list[Wrinkle] = []
    others: list[Wrinkle] = []
    for r in np.argsort(-total, kind="stable").tolist():
        if len(wrinkles) == count:
            break
        faces = np.flatnonzero(region == r)
        wrinkle = replace(_describe(solution, indices, faces, level), resolved=r not in bad)
        wrinkle = replace(wrinkle, kind=_kind(solution, wrinkle, waves, corners))
        (wrinkles if wrinkle.kind == "wrinkle" else others).append(wrinkle)
    return (*wrinkles, *others)[:count]


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
        direction=wrinkle.across,
        half_length=wrinkle.reach,
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
        along = np.maximum(np.abs(off @ wrinkle.across) - wrinkle.reach, 0.0)
        near[rows[np.hypot(along, off @ wrinkle.along) < reach]] = True
    return near


def cause_of(stretch_share: float) -> Cause:
    """Name the cause of a wrinkle by the part of its W2 that is W_stretch.

    Examples
    --------
    >>> [cause_of(share) for share in (0.39, 0.4, 0.6, 0.61)]
    ['compression', 'both', 'both', 'stretch']
    """
    low, high = MIXED
    if stretch_share > high:
        return "stretch"
    return "compression" if stretch_share < low else "both"


def _describe(solution: Solution, indices: WrinkleMap, faces: IntArray, level: float) -> Wrinkle:
    cover = solution.cover
    area, w2 = cover.rest_area[faces], indices.w2[faces]
    size = extent(solution, indices.w2, faces, level)
    cuts = [
        profile(solution, face, size.across) for face in _stations(cover, faces, w2, size.along)
    ]
    deepest = max(cuts, key=lambda cut: cut.depth)
    corners = cover.faces[deepest.face]
    position = solution.positions[corners].mean(axis=0)
    kind, name, distance = _nearest(cover, solution.positions, position)
    w2_area = float(w2 @ area)
    excess, waves, scatter = _excess(cuts)
    share = float(indices.w_stretch[faces] @ area) / w2_area
    return Wrinkle(
        panel=cover.panel_names[cover.panel[deepest.face]],
        zone=cover.zone_names[cover.zone[deepest.face]],
        rest=cover.rest[corners].mean(axis=0), uv=cover.uv[corners].mean(axis=0),
        position=position, along=size.along, length=size.length, width=size.width,
        depth=deepest.depth, reach=section_reach(deepest),
        excess=excess, waves=waves, scatter=scatter,
        w2_max=float(w2.max()), w2_area=w2_area, stretch_share=share, cause=cause_of(share),
        near_kind=kind, near=name, distance=distance,
    )  # fmt: skip


def _excess(cuts: Sequence[Profile]) -> tuple[float, float, float]:
    """Excess, the waves in it, and its scatter, from sections along a wrinkle."""
    total = np.array([cut.waves + cut.compression for cut in cuts])
    # Cuts near a border end before the crest: the middle one of all is none of them.
    middle = int(np.argsort(total)[len(total) // 2])
    error = float(total.std(ddof=1) / np.sqrt(len(total))) if len(total) > 1 else float(total[0])
    return float(total[middle]), cuts[middle].waves, 2.0 * error


def _stations(cover: Cover, faces: IntArray, w2: FloatArray, along: FloatArray) -> list[int]:
    """Return the face of largest W2 in each of some equal stretches along the wrinkle."""
    s = cover.rest[cover.faces[faces]].mean(axis=1) @ along
    span = float(np.ptp(s))
    part = (
        np.minimum(((s - s.min()) / span * _STATIONS).astype(int), _STATIONS - 1) if span else 0 * s
    )
    stretches = [np.flatnonzero(part == k) for k in range(_STATIONS)]
    return [int(faces[rows[np.argmax(w2[rows])]]) for rows in stretches if len(rows)]


def _kind(
    solution: Solution,
    wrinkle: Wrinkle,
    wavelengths: Sequence[float | None],
    corners: IntArray,
) -> Kind:
    """Tell wrinkles from what a tie, a corner or a single element makes."""
    cover = solution.cover
    near = (wavelengths[cover.panel_names.index(wrinkle.panel)] or 2.0 * wrinkle.reach) / 4.0
    ties = [anchor.points.at(solution.positions) for anchor in cover.anchors]
    tie, corner = (
        float(np.linalg.norm(points - wrinkle.position, axis=1).min(initial=np.inf))
        for points in (np.concatenate(ties) if ties else np.zeros((0, 3)),
                       solution.positions[corners])
    )  # fmt: skip
    if min(tie, corner) <= near:
        return "tie" if tie <= corner else "corner"
    return "spot" if wrinkle.length < _SMALLEST * cover.element_size else "wrinkle"


def _corners(cover: Cover) -> IntArray:
    """Vertices at which the outline of a panel turns sharply."""
    edges = cover.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)[boundary_sides(cover.faces)]
    step = cover.rest[edges[:, 1]] - cover.rest[edges[:, 0]]
    ahead, behind = np.zeros_like(cover.rest), np.zeros_like(cover.rest)
    ahead[edges[:, 0]], behind[edges[:, 1]] = step, step
    cross = behind[:, 0] * ahead[:, 1] - behind[:, 1] * ahead[:, 0]
    turn = np.abs(np.arctan2(cross, (behind * ahead).sum(axis=1)))
    return np.flatnonzero(turn > _CORNER)


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
