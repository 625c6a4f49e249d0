"""The finished shape against the design surface: how far off it is, and where the seams lie."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from seatlook.errors import InputError
from seatlook.mesh import vertex_normals
from seatlook.mesh.closest import (
    border_segments,
    closest_places,
    distance_to_segments,
    pseudonormals,
)
from seatlook.model import Cover, Design, FloatArray, IntArray, Solution, Stitching

_REACH = 0.05  # m; what is farther from the design belongs to no place of it
_BESIDE = 0.001  # m; what lies farther beyond the design's rim lies beside it


@dataclass(frozen=True, slots=True, kw_only=True)
class SeamLine:
    """How far a sewn seam lies from its line on the design [m]; None where that has no such line.

    Parameters
    ----------
    mean, largest : distance of the seam's points, weighted by its length
    """

    seam: str
    length: float
    mean: float | None
    largest: float | None


def deviation(solution: Solution, design: Design) -> FloatArray:
    """Signed distance (m,) [m] of every face from the design surface, a mean of its corners.

    Above 0 the cover stands outside. Faces farther than 50 mm from the design, or beside its rim,
    are nan. Where the visible side was drawn, it is the visible side that is compared.

    Raises
    ------
    InputError
        The design's normals point inward.
    """
    cover = solution.cover
    closest = closest_places(solution.positions, design.vertices, design.faces, reach=_REACH)
    normal, on_rim = pseudonormals(design.vertices, design.faces, closest)
    near = closest.face >= 0
    offset = np.where(near[:, None], closest.offset, 0.0)
    height = np.einsum("nd,nd->n", offset, normal)
    aside = np.linalg.norm(offset - height[:, None] * normal, axis=1)
    # Off the rim the offset is along the normal, but for rounding and creases.
    signed = np.where(on_rim, height, np.copysign(closest.distance, height))
    signed[~near | (on_rim & (aside > _BESIDE))] = np.nan
    _check_side(solution, normal, near)
    off = signed[cover.faces].mean(axis=1)
    return np.asarray(off + 0.5 * cover.thickness if design.visible else off)


def seam_lines(solution: Solution, design: Design) -> tuple[SeamLine, ...]:
    """Compare every seam with the border that its panels have on the design surface.

    A dart, or the closing seam of a ring, is compared with the lines drawn inside its panel.
    """
    cover = solution.cover
    pairs, labels = _lines_of(design)
    number = {name: i for i, name in enumerate(design.panel_names)}
    rows = []
    for seam in cover.stitchings:
        near, far = (_panels(cover, side) for side in (seam.a.vertices, seam.b.vertices))
        neighbours = {
            tuple(sorted((number.get(a, -1), number.get(b, -1)))) for a in near for b in far
        }
        on_seam = np.array([tuple(pair) in neighbours for pair in labels.tolist()], dtype=bool)
        rows.append(_seam_line(seam, solution.positions, design, pairs[on_seam]))
    return tuple(rows)


def _lines_of(design: Design) -> tuple[IntArray, IntArray]:
    """Edges (e, 2) on borders between panels and on lines in them, and the two panels (e, 2)."""
    pairs, labels = border_segments(design.faces, design.panel)
    ends = np.sort(np.stack([design.faces, np.roll(design.faces, -1, axis=1)], axis=2), axis=2)
    owner = np.repeat(design.panel, 3).tolist()
    panel = dict(zip(map(tuple, ends.reshape(-1, 2).tolist()), owner, strict=True))
    between = {tuple(pair) for pair in pairs.tolist()}
    drawn = [edge for edge in design.seam_lines if edge in panel and edge not in between]
    if not drawn:
        return pairs, labels
    own = np.array([panel[edge] for edge in drawn], dtype=np.int64)
    return np.concatenate([pairs, drawn]), np.concatenate([labels, np.column_stack([own, own])])


def _seam_line(seam: Stitching, x: FloatArray, design: Design, line: IntArray) -> SeamLine:
    length = float(seam.length.sum())
    if not len(line):
        return SeamLine(seam=seam.name, length=length, mean=None, largest=None)
    middle = 0.5 * (seam.a.at(x) + seam.b.at(x))
    start, end = (design.vertices[line[:, k]] for k in (0, 1))
    away = distance_to_segments(middle, start, end)
    return SeamLine(
        seam=seam.name,
        length=length,
        mean=float(away @ seam.length / length),
        largest=float(away.max()),
    )


def _panels(cover: Cover, vertices: IntArray) -> set[str]:
    """Names of the panels that some vertices belong to."""
    inside = np.isin(cover.faces, vertices).any(axis=1)
    return {cover.panel_names[k] for k in np.unique(cover.panel[inside])}


def _check_side(solution: Solution, normal: FloatArray, near: npt.NDArray[np.bool_]) -> None:
    """Refuse a design that is turned inside out."""
    own = vertex_normals(solution.positions, solution.cover.faces)
    agree = np.einsum("nd,nd->n", own, normal)[near]
    if len(agree) and np.median(agree) < 0:
        raise InputError.single(
            "design", got="normals pointing inward", expected="the visible side outward"
        )
