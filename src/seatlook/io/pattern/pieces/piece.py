"""From the entities of one piece to a panel."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
import shapely
from scipy.spatial import cKDTree

from seatlook.errors import InputError
from seatlook.io.pattern.drawing.entities import Drawn, Left
from seatlook.io.pattern.drawing.layers import (
    BOUNDARY,
    CUT_OUT,
    GRAIN,
    INTERNAL,
    LINE_LAYERS,
    MIRROR,
    NOTCH,
    NOTCH_LAYERS,
    SEW,
    TURN,
)
from seatlook.io.pattern.pieces.boundary import outermost, sort_boundary, take_sew_line
from seatlook.io.pattern.pieces.cuts import DEEPEST_SLIT, with_cuts
from seatlook.io.pattern.pieces.holes import cut_outs, take_sew_lines
from seatlook.io.pattern.pieces.join import MEETING_MM, Chain, join, join_outline
from seatlook.io.pattern.pieces.outline import (
    closed_outline,
    corners,
    distance_to,
    reflect,
    trimmed,
    unfold,
)
from seatlook.model import FloatArray, Notch, Panel
from seatlook.model.pattern import NotchKind

_NAMED_WITHIN_MM = 5 * MEETING_MM  # of a text at the end of a line


@dataclass(slots=True)
class Piece:
    """One piece, in millimetres, unfolded."""

    name: str
    boundary: list[Chain]
    sew: list[Chain]
    internal: list[Chain]
    cut_outs: list[Chain]
    other: dict[str, list[Chain]]
    grain: list[FloatArray]
    marks: FloatArray
    notches: list[Notch]
    notch_lines: list[tuple[NotchKind, FloatArray]]
    line_names: list[tuple[str, FloatArray]]
    left: Counter[Left]
    notes: list[str]

    @classmethod
    def read(cls, name: str, drawn: Drawn, notes: list[str]) -> Piece:
        """Unfold a half piece and join the lines of each layer."""
        lines = drawn.lines
        _refuse_nan(name, lines)
        marks = np.array([m.place for m in drawn.points if m.layer == TURN]).reshape(-1, 2)
        notches = [n for layer in NOTCH_LAYERS for n in _notches(drawn, layer)]
        axis = _axis(lines[MIRROR], lines[BOUNDARY])
        if axis is not None:
            for layer in [n for n in lines if n not in (MIRROR, GRAIN)]:
                lines[layer] = unfold(lines[layer], axis)
            marks = np.vstack([marks, reflect(marks, axis)])
            notches += _mirrored(notches, axis)
        boundary, gaps = join_outline(lines[BOUNDARY])
        sew, sew_gaps = join_outline(lines[SEW])
        if gaps or sew_gaps:
            widest = max(gaps + sew_gaps)
            notes.append(f"piece {name}: gaps up to {widest:.2f} mm in the outline are joined")
        return cls(
            name=name,
            boundary=boundary,
            sew=sew,
            internal=join(lines[INTERNAL]),
            cut_outs=join_outline(lines[CUT_OUT])[0],
            other={n: join(rows) for n, rows in lines.items() if n not in LINE_LAYERS},
            grain=lines[GRAIN],
            marks=marks,
            notches=notches,
            notch_lines=[(NOTCH_LAYERS[n], x) for n in NOTCH_LAYERS for x in lines[n]],
            line_names=[(m.text, m.place) for m in drawn.texts if m.layer == INTERNAL],
            left=drawn.left,
            notes=notes,
        )

    def panel(self, smallest_notch: float, grain_deg: float | None) -> Panel:
        """Make the panel.

        Raises
        ------
        InputError
            When the outline is open, crosses itself or a cut-out, or is too small or too large.
        """
        sorted_out = sort_boundary(self.boundary, DEEPEST_SLIT * smallest_notch, self.left)
        rings = [c.points for c in sorted_out.outline if c.closed and len(c.points) > 2]
        self.sew = take_sew_lines(
            rings[0] if len(rings) == 1 else None, (sorted_out.inner, self.cut_outs), self.sew
        )
        self._find_sew_line(sorted_out.outline, sorted_out.inner)
        cut, outline = self._outlines(sorted_out.outline, smallest_notch)
        _check_size(self.name, cut.points, self.notes)
        holes = cut_outs(
            self.name, outline.points, sorted_out.inner, self.cut_outs, smallest_notch, self.notes
        )
        cuts = (*cut.notches, *outline.notches, *sorted_out.slits, *self._drawn_notches(cut))
        mm = 1e-3
        marks = np.vstack([self.marks, outline.joints])
        return Panel(
            name=self.name,
            outline=mm * outline.points,
            # A round panel has no corner; an edge may still start somewhere.
            corners=at if len(at := corners(outline.points, marks)) else np.zeros(1, np.int64),
            cut_outline=mm * cut.points,
            grain=self._grain(grain_deg),
            notches=with_cuts(self.notches, cuts),
            internal_lines=MappingProxyType(self._internal_lines()),
            holes=tuple(mm * hole for hole in holes),
        )

    def _note(self, text: str) -> None:
        self.notes.append(f"piece {self.name}: {text}")

    def _find_sew_line(self, outline: Sequence[Chain], inner: list[Chain]) -> None:
        """Take a closed line that runs parallel inside the outline where layer 14 is empty."""
        self.sew = outermost(self.sew, SEW, self.left)
        if self.sew or len(outline) != 1 or not outline[0].closed:
            return
        candidates = {INTERNAL: self.internal, BOUNDARY: inner, **self.other}
        taken = take_sew_line(outline[0].points, candidates)
        if taken is None:
            return
        layer, line = taken
        self.sew = [line]
        for left in [x for x in self.left if x.layer == layer and layer in self.other]:
            del self.left[left]
        self._note(
            f"nothing on layer 14: the line on layer {layer} that runs parallel inside the "
            "outline is taken for the sew line"
        )

    def _outlines(self, boundary: Sequence[Chain], smallest_notch: float) -> tuple[Chain, Chain]:
        """Return cut line and sew line."""
        key = f"piece {self.name}, layer 14"
        closed = len(self.sew) > 0 and all(c.closed for c in self.sew)
        try:
            cut = closed_outline(
                boundary, key=f"piece {self.name}, layer 1", smallest_notch=smallest_notch
            )
        except InputError as error:
            if not closed:
                raise
            sew = closed_outline(self.sew, key=key, smallest_notch=smallest_notch)
            got = error.problems[0].got
            self._note(f"layer 1 has {got}: the sew line is taken, without an allowance")
            return sew, sew
        if not self.sew:
            return cut, cut
        if closed:
            return cut, closed_outline(self.sew, key=key, smallest_notch=smallest_notch)
        return cut, trimmed(cut, [c for c in self.sew if not c.closed], key=key)

    def _grain(self, grain_deg: float | None) -> FloatArray:
        """Return the direction of the longest grain line, else ``grain_deg``, else +y."""
        along = [_longest_chord(line) for line in self.grain]
        longest = max(along, key=lambda a: float(np.hypot(*a))) if along else np.zeros(2)
        if np.hypot(*longest) > 0:
            return np.asarray(longest / np.hypot(*longest))
        if grain_deg is None:
            self._note("no grain line on layer 7: the warp runs along +y; else say grain_deg")
            return np.array([0.0, 1.0])
        return np.array([np.cos(np.radians(grain_deg)), np.sin(np.radians(grain_deg))])

    def _drawn_notches(self, cut: Chain) -> list[Notch]:
        """Return the notches that are drawn as lines instead of points."""
        edge = shapely.LinearRing(cut.points)
        notches = []
        for kind, line in self.notch_lines:
            away = shapely.distance(edge, shapely.points(line))
            place = line[away < away.min() + MEETING_MM].mean(axis=0)
            depth = float(np.hypot(*(line - place).T).max())
            notches.append(Notch(position=1e-3 * place, kind=kind, depth=1e-3 * depth))
        return notches

    def _internal_lines(self) -> dict[str, FloatArray]:
        """Name each line by the text at one of its ends, else ``lineN``."""
        tree = cKDTree([place for _, place in self.line_names]) if self.line_names else None
        lines: dict[str, FloatArray] = {}
        for number, chain in enumerate(self.internal, start=1):
            points = np.vstack([chain.points, chain.points[:1]]) if chain.closed else chain.points
            near: list[int] = []
            if tree is not None:
                for end in points[[0, -1]]:
                    near += tree.query_ball_point(end, _NAMED_WITHIN_MM)
            name = self.line_names[min(near)][0] if near else f"line{number}"
            lines[f"{name} {number}" if name in lines else name] = 1e-3 * points
        return lines


def _notches(drawn: Drawn, layer: str) -> Iterable[Notch]:
    """Return the notches of one layer; without a depth, one on layer 4 is a mark without a cut."""
    for mark in drawn.points:
        if mark.layer == layer:
            kind: NotchKind = "point" if layer == NOTCH and mark.depth == 0 else NOTCH_LAYERS[layer]
            yield Notch(position=1e-3 * mark.place, kind=kind, depth=1e-3 * mark.depth)


def _longest_chord(line: FloatArray) -> FloatArray:
    """Return from end to end of a line, or across it where an arrow brings the end back."""
    along = line[-1] - line[0]
    across = line - line[0]
    farthest = across[int(np.hypot(*across.T).argmax())]
    return np.asarray(along if np.hypot(*along) > 0.5 * np.hypot(*farthest) else farthest)


def _refuse_nan(name: str, layers: dict[str, list[FloatArray]]) -> None:
    for layer, lines in layers.items():
        bad = sum(int((~np.isfinite(line).all(axis=1)).sum()) for line in lines)
        if bad:
            raise InputError.single(
                f"piece {name}, layer {layer}", got=f"{bad} nan or inf", expected="finite points"
            )


def _check_size(name: str, points: FloatArray, notes: list[str]) -> None:
    size = float(np.ptp(points, axis=0).max())
    if not 5 <= size <= 10_000:
        raise InputError.single(
            f"piece {name}", got=f"a size of {size:.4g} mm", expected="5 mm to 10 m",
            hint="check the UNITS text",
        )  # fmt: skip
    if not 20 <= size <= 3000:
        notes.append(f"piece {name}: a size of {size:.4g} mm is unusual")


def _axis(mirror: Sequence[FloatArray], boundary: Sequence[FloatArray]) -> FloatArray | None:
    """Return the fold line of a half piece; a line with outline on both sides folds nothing."""
    if not mirror or not boundary:
        return None
    axis = mirror[0][[0, -1]]
    away = distance_to(np.vstack(boundary), axis)
    return axis if away.min() > -MEETING_MM or away.max() < MEETING_MM else None


def _mirrored(notches: Iterable[Notch], axis: FloatArray) -> list[Notch]:
    mirrored = []
    for notch in notches:
        place = 1e3 * notch.position[None]
        if abs(distance_to(place, axis)[0]) > MEETING_MM:
            position = 1e-3 * reflect(place, axis)[0]
            mirrored.append(Notch(position=position, kind=notch.kind, depth=notch.depth))
    return mirrored
