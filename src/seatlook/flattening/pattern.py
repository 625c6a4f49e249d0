"""From flat patches to a sewable pattern: seams, allowance, notches, grain."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from types import MappingProxyType

import numpy as np
import shapely

from seatlook import mesh
from seatlook.errors import InputError, SeatlookError
from seatlook.flattening.surface import Patch, Side, darts
from seatlook.model import Edge, FloatArray, IntArray, Notch, Panel, Pattern, Seam

_NOTCH_DEPTH = 0.004
_NOTCH_SPACING = 0.3
_ROUNDING = 1e-6  # [m]
_SHARP_TURN = np.radians(25.0)


def cut_outline(
    outline: FloatArray, allowance: float, *, darts: Sequence[FloatArray] = (), panel: str = ""
) -> FloatArray:
    """Return the cutting line (k, 2) [m], ``allowance`` outside the sew line, corners mitred.

    Mitres longer than twice the allowance are cut square, as in a cutting room. Where allowances
    meet inside a dart, its (k, 2) outline given, the cloth is left whole.

    Raises
    ------
    InputError
        The allowance is negative or so wide that the cutting line meets itself.

    Examples
    --------
    >>> square = np.array([[0, 0], [0.1, 0], [0.1, 0.1], [0, 0.1]])
    >>> line = cut_outline(square, 0.01)
    >>> line.min(axis=0), line.max(axis=0)
    (array([-0.01, -0.01]), array([0.11, 0.11]))
    """
    key = f"panel {panel}, allowance" if panel else "allowance"
    if allowance < 0:
        raise InputError.single(key, got=allowance, expected="at least 0")
    if allowance == 0:
        return outline.copy()
    grown = shapely.Polygon(outline).buffer(allowance, join_style="mitre", mitre_limit=2.0)
    inside = shapely.unary_union([shapely.Polygon(dart) for dart in darts]).buffer(_ROUNDING)
    for hole in grown.interiors:
        if not inside.contains(hole):
            x, y = 1e3 * shapely.get_coordinates(hole.centroid)[0]
            raise InputError.single(
                key,
                got=f"{1e3 * allowance:g} mm",
                expected="a cutting line that does not meet itself, as near "
                f"[{x:.0f}, {y:.0f}] mm of the flat panel",
            )
    ring = shapely.get_coordinates(shapely.geometry.polygon.orient(grown).exterior)
    return np.ascontiguousarray(ring[:-1])


def notch_fractions(length: float) -> FloatArray:
    """Return where on a seam of ``length`` [m] notches go: the middle, and more on long seams.

    An odd number, evenly spread, so the two sides' marks meet whichever end sewing starts at.

    Examples
    --------
    >>> notch_fractions(0.1), notch_fractions(0.5)
    (array([0.5]), array([0.25, 0.5 , 0.75]))
    """
    count = 2 * int(length / _NOTCH_SPACING) + 1
    return np.asarray(np.arange(1, count + 1) / (count + 1))


def sewing_pattern(
    patches: tuple[Patch, ...],
    borders: tuple[Side, ...],
    flat: Mapping[str, FloatArray],
    allowance: float,
    *,
    seam_lines: Mapping[tuple[int, int], str] = MappingProxyType({}),
) -> Pattern:
    """Return the pattern of flat patches (n, 2) whose grain runs along the second axis."""
    seams = pair(borders, seam_lines)
    partner = {seam.a: seam.b[0] for seam in seams} | {seam.b[0]: seam.a for seam in seams}
    panels = []
    for patch in patches:
        outline = flat[patch.name][patch.boundary]
        _check_outline(patch, outline)
        own = [side for side in borders if side.panel == patch.name]
        notches = [
            Notch(position=point, kind="v", depth=_NOTCH_DEPTH)
            for side in own
            if side.name in partner
            for point in _notch_points(patch, side, flat[patch.name])
        ]
        panels.append(
            Panel(
                name=patch.name,
                outline=outline,
                corners=_corners(outline, [side.start for side in own]),
                cut_outline=cut_outline(
                    outline,
                    allowance,
                    darts=[flat[patch.name][np.append(a, b[-2::-1])] for a, b in darts(patch, own)],
                    panel=patch.name,
                ),
                grain=np.array([0.0, 1.0]),
                notches=tuple(notches),
            )
        )
    return Pattern(
        panels=tuple(panels), edges=MappingProxyType(_edges(patches, borders)), seams=seams
    )


def _check_outline(patch: Patch, outline: FloatArray) -> None:
    """Refuse a flat outline that crosses itself: it cannot be cut from one piece."""
    pieces = shapely.linestrings(np.stack([outline, np.roll(outline, -1, axis=0)], axis=1))
    first, second = shapely.STRtree(pieces).query(pieces, predicate="crosses")
    ends = shapely.points(outline)
    for i, j in zip(first.tolist(), second.tolist(), strict=True):
        # Pieces that touch in a corner cross by rounding.
        near = shapely.distance(pieces[j], ends[[i, (i + 1) % len(ends)]])
        if near.min() > _ROUNDING:
            place = 1e3 * patch.vertices[patch.boundary[i]]
            raise SeatlookError(
                f"panel {patch.name}: its flat outline crosses itself near {place.round(1)} mm: "
                "cut it into two panels there"
            )


def pair(
    borders: tuple[Side, ...], seam_lines: Mapping[tuple[int, int], str] = MappingProxyType({})
) -> tuple[Seam, ...]:
    """Pair the sides that are sewn to each other; the one that comes first is side a.

    A seam is called after its panels, ``A-B``, with its place where they share several,
    ``A-B.left``. One on a line of the user has the name of the line; where a line makes several
    seams, each has that of its panels too: ``LINE.A-B``.
    """
    first: dict[str, Side] = {}
    for side in borders:
        if side.partner is not None and side.partner not in first:
            first[side.name] = side
    lines = {name: _line(side, seam_lines) for name, side in first.items()}
    made = Counter(lines.values())
    seams = []
    for name, side in first.items():
        line = lines[name]
        panels = f"{side.panel}-{side.neighbour}{'.' * bool(side.place)}{side.place}"
        own = line if line and made[line] == 1 else ".".join(filter(None, (line, panels)))
        seams.append(Seam(name=own, a=name, b=(str(side.partner),)))
    return tuple(seams)


def _line(side: Side, seam_lines: Mapping[tuple[int, int], str]) -> str:
    """Return the name of the line that most of a side lies on; empty for none."""
    ends = np.sort(np.column_stack([side.vertices[:-1], side.vertices[1:]]), axis=1)
    lines = Counter(seam_lines[a, b] for a, b in ends.tolist() if (a, b) in seam_lines)
    return lines.most_common(1)[0][0] if lines else ""


def _corners(outline: FloatArray, starts: list[int]) -> IntArray:
    """Return the outline's vertices that must survive resampling: ends of edges, sharp turns."""
    ahead = np.roll(outline, -1, axis=0) - outline
    behind = np.roll(ahead, 1, axis=0)
    cross = behind[:, 0] * ahead[:, 1] - behind[:, 1] * ahead[:, 0]
    turn = np.abs(np.arctan2(cross, (behind * ahead).sum(axis=1)))
    return np.union1d(starts, np.flatnonzero(turn > _SHARP_TURN))


def _edges(patches: tuple[Patch, ...], borders: tuple[Side, ...]) -> dict[str, Edge]:
    size = {patch.name: len(patch.boundary) for patch in patches}
    return {
        side.name: Edge(
            name=side.name,
            panel=side.panel,
            start=side.start,
            end=(side.start + side.count) % size[side.panel],
        )
        for side in borders
    }


def _notch_points(patch: Patch, side: Side, flat: FloatArray) -> FloatArray:
    """Return the notches (k, 2) of a side where the seam on the design surface has them.

    Measured on the surface, both panels of the seam get them at the same stitches, eased or not.
    """
    at = side.indices(patch)
    s = mesh.arc_length(patch.vertices[at])
    where = notch_fractions(s[-1]) * s[-1]
    return np.column_stack([np.interp(where, s, column) for column in flat[at].T])
