"""The drawing of a pattern: every panel with its edges, corners, notches, grain and seams."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from html import escape
from pathlib import Path

import numpy as np
import numpy.typing as npt
from PIL import Image as Pillow
from PIL import ImageDraw

from seatlook.assembly.seam_guess import Proposal
from seatlook.files import write_bytes, write_text
from seatlook.mesh import arc_length
from seatlook.model import FloatArray, Panel, Pattern
from seatlook.pbr.maps.labels import Colour, font, width_of
from seatlook.pbr.picture import png

CHANGES_SVG, CHANGES_PNG = "changes.svg", "changes.png"
_WIDTH = 1600  # px of the sheet
_EDGE, _GAP = 28, 44  # px around it, and between panels
_LARGEST = 420  # px of the longest panel
_CHANGED = 700  # px of the longest panel that is drawn old and new
_MARGIN = 26  # px round a panel, for the numbers of its edges
_NAME, _TEXT, _NUMBER = 17, 14, 13  # px, size of letters
_ROW = 20  # px of a line of a panel's list
_BADGE = 9.0  # px, radius of an edge's number
_STEP = 9.0  # px by which a number is moved out where another is
_INK: Colour = (30, 30, 30)
_FREE: Colour = (150, 150, 150)
_UNSURE: Colour = (200, 82, 0)
_PAPER: Colour = (255, 255, 255)
_CLOTH: Colour = (246, 243, 238)
# As in the drawing of the start: told apart by people who see no red or no green.
_SEAMS: tuple[Colour, ...] = (
    (0, 92, 171),
    (0, 122, 94),
    (139, 60, 148),
    (112, 88, 24),
    (0, 130, 158),
    (178, 36, 110),
    (72, 72, 160),
)
_FACTOR = 2  # samples per pixel and axis


@dataclass(frozen=True, slots=True)
class _Line:
    points: FloatArray
    colour: Colour
    width: float
    fill: Colour | None = None


@dataclass(frozen=True, slots=True)
class _Disc:
    at: tuple[float, float]
    radius: float
    colour: Colour


@dataclass(frozen=True, slots=True)
class _Text:
    at: tuple[float, float]
    text: str
    size: int
    colour: Colour
    bold: bool = False
    middle: bool = False


_Mark = _Line | _Disc | _Text


@dataclass(slots=True)
class _Cell:
    """One panel drawn at the origin, with its list below."""

    marks: list[_Mark]
    width: float
    height: float


def draw_pattern(proposal: Proposal, folder: Path) -> tuple[Path, Path]:
    """Draw a pattern with its guessed seams into ``pattern.svg`` and ``pattern.png``.

    Edges of one seam have one colour; free edges are grey, those that may be sewn orange. Below
    each panel stands what its numbers mean.
    """
    largest = max(float(np.ptp(p.outline, axis=0).max()) for p in proposal.pattern.panels)
    scale = _LARGEST / largest  # px per m
    sheet = _Sheet(proposal)
    marks, height = _laid_out([sheet.cell(p, scale) for p in proposal.pattern.panels])
    paths = folder / "pattern.svg", folder / "pattern.png"
    write_text(paths[0], _svg(marks, height))
    write_bytes(paths[1], png(_pixels(marks, height)))
    return paths


def draw_changes(
    before: Pattern, after: Pattern, words: Mapping[str, Sequence[str]], folder: Path
) -> tuple[Path, Path]:
    """Draw the panels that changed, old in grey and new in blue, into ``changes.svg`` and ``.png``.

    Parameters
    ----------
    before, after : the same panels and edges
    words : panel -> what was done to it, a line each
    """
    pairs = [
        (old, new)
        for old, new in zip(before.panels, after.panels, strict=True)
        if not np.array_equal(old.outline, new.outline) or old.name in words
    ]
    sizes = [float(np.ptp(panel.outline, axis=0).max()) for pair in pairs for panel in pair]
    scale = _CHANGED / max(sizes, default=1.0)
    marks, height = _laid_out(
        [_changed(*pair, words.get(pair[0].name, ()), scale) for pair in pairs]
    )
    paths = folder / CHANGES_SVG, folder / CHANGES_PNG
    write_text(paths[0], _svg(marks, height))
    write_bytes(paths[1], png(_pixels(marks, height)))
    return paths


def _changed(old: Panel, new: Panel, words: Sequence[str], scale: float) -> _Cell:
    """One panel as it was and as it is now, to one scale, with what was done below."""
    both = np.vstack([old.outline, new.outline])
    low, high = both.min(axis=0), both.max(axis=0)
    top = _NAME + 14.0

    def place(points: FloatArray) -> FloatArray:
        moved = (points - [low[0], high[1]]) * [scale, -scale]
        return np.asarray(moved + np.array([_MARGIN, top + _MARGIN]))

    closed = [place(np.vstack([p.outline, p.outline[:1]])) for p in (old, new)]
    size = (high - low) * scale
    marks: list[_Mark] = [
        _Text((0.0, 0.0), f"{new.name}: old grey, new blue", _NAME, _INK, bold=True),
        _Line(closed[1], _CLOTH, 0.0, _CLOTH),
        _Line(closed[0], _FREE, 1.5),
        _Line(closed[1], _SEAMS[0], 1.5),
        *_grain(new, closed[1], size),
        *_notches(new, place),
    ]
    below = top + 2 * _MARGIN + float(size[1]) + 6.0
    marks += [_Text((0.0, below + _ROW * k), w, _TEXT, _INK) for k, w in enumerate(words)]
    widest = max(
        width_of(f"{new.name}: old grey, new blue", _NAME, bold=True), 2 * _MARGIN + size[0]
    )
    return _Cell(
        marks=marks,
        width=max(float(widest), *(width_of(w, _TEXT) for w in words), 0.0),
        height=below + _ROW * len(words),
    )


class _Sheet:
    """What every edge is called and sewn to."""

    def __init__(self, proposal: Proposal) -> None:
        self._pattern = proposal.pattern
        self._colour: dict[str, Colour] = dict.fromkeys(proposal.pattern.edges, _FREE)
        self._words: dict[str, str] = dict.fromkeys(proposal.pattern.edges, "free")
        for doubt in proposal.doubtful:
            for one, others in ((doubt.a, doubt.b), *((b, (doubt.a,)) for b in doubt.b)):
                for name in one.split(" + "):
                    if self._words[name] == "free":
                        self._colour[name] = _UNSURE
                        with_ = " + ".join(others)
                        self._words[name] = f"not sure: {with_} ({doubt.probability:.2f})"
        for number, seam in enumerate(proposal.pattern.seams):
            for name in (seam.a, *seam.b):
                self._colour[name] = _SEAMS[number % len(_SEAMS)]
                self._words[name] = seam.name

    def cell(self, panel: Panel, scale: float) -> _Cell:
        """Draw one panel and its list."""
        low, high = panel.outline.min(axis=0), panel.outline.max(axis=0)
        size = (high - low) * scale
        top = _NAME + 14.0

        def place(points: FloatArray) -> FloatArray:
            moved = (points - [low[0], high[1]]) * [scale, -scale]
            return np.asarray(moved + np.array([_MARGIN, top + _MARGIN]))

        marks: list[_Mark] = [
            _Text((0.0, 0.0), panel.name, _NAME, _INK, bold=True),
            _Line(place(np.vstack([panel.outline, panel.outline[:1]])), _CLOTH, 0.0, _CLOTH),
        ]
        rings = [np.vstack([hole, hole[:1]]) for hole in panel.holes]
        marks += [_Line(place(ring), _INK, 1.0, _PAPER) for ring in rings]
        marks += _grain(panel, place(panel.outline), size)
        below = top + 2 * _MARGIN + float(size[1]) + 6.0
        lines, badges, rows = self._edges(panel, place, below)
        marks += lines
        for corner in place(panel.outline[panel.corners]):
            marks.append(_Disc((float(corner[0]), float(corner[1])), 3.0, _INK))
        marks += _notches(panel, place)
        widest = max(
            [width_of(panel.name, _NAME, bold=True), *(width_of(r.text, _TEXT) for r in rows)]
        )
        return _Cell(
            marks=[*marks, *badges, *rows],
            width=max(2 * _MARGIN + float(size[0]), widest),
            height=below + _ROW * len(rows),
        )

    def _edges(
        self, panel: Panel, place: Callable[[FloatArray], FloatArray], below: float
    ) -> tuple[list[_Mark], list[_Mark], list[_Text]]:
        """Lines of the edges of a panel, their numbers, and the list of what these mean."""
        edges = [e for e in self._pattern.edges.values() if e.panel == panel.name]
        lines: list[_Mark] = []
        badges: list[_Mark] = []
        taken: list[FloatArray] = []
        rows: list[_Text] = []
        for number, edge in enumerate(edges, start=1):
            line = place(edge.points(panel))
            colour = self._colour[edge.name]
            lines.append(_Line(line, colour, 2.5))
            at = _beside(line, taken)
            taken.append(at)
            spot = (float(at[0]), float(at[1]))
            label = _Text(spot, str(number), _NUMBER, _PAPER, bold=True, middle=True)
            badges += [_Disc(spot, _BADGE, colour), label]
            length = 1e3 * self._pattern.edge_length(edge.name)
            own = edge.name.removeprefix(f"{panel.name}.")
            text = f"{number}  {own}  {length:.1f} mm  {self._words[edge.name]}"
            rows.append(_Text((0.0, below + _ROW * (number - 1)), text, _TEXT, colour))
        return lines, badges, rows


def _beside(line: FloatArray, taken: Sequence[FloatArray]) -> FloatArray:
    """Place for the number of an edge: outside its middle, farther out where another is."""
    arc = arc_length(line)
    middle = np.array([np.interp(arc[-1] / 2, arc, column) for column in line.T])
    ends = np.array([[np.interp(arc[-1] * s, arc, c) for c in line.T] for s in (0.4, 0.6)])
    along = ends[1] - ends[0]
    # The outline runs counter-clockwise on paper, clockwise with y down: outside is on its right.
    out = np.array([-along[1], along[0]]) / max(float(np.hypot(*along)), 1e-9)
    for step in range(12):
        at = middle + (_BADGE + 4.0 + step * _STEP) * out
        if all(np.hypot(*(at - other)) > 2 * _BADGE + 1.0 for other in taken):
            break
    return np.asarray(at)


def _grain(panel: Panel, outline: FloatArray, size: FloatArray) -> list[_Mark]:
    """Arrow along the warp, in the middle of the panel."""
    middle = (outline.min(axis=0) + outline.max(axis=0)) / 2
    along = panel.grain * [1.0, -1.0]
    half = 0.3 * float(np.abs(size @ np.abs(along)))
    ends = np.array([middle - half * along, middle + half * along])
    side = np.array([-along[1], along[0]])
    head = np.array([ends[1] - 9 * along + 4 * side, ends[1], ends[1] - 9 * along - 4 * side])
    return [_Line(ends, _INK, 1.0), _Line(head, _INK, 1.0)]


def _notches(panel: Panel, place: Callable[[FloatArray], FloatArray]) -> list[_Mark]:
    """A tick into the panel at each notch."""
    inside = place(panel.outline).mean(axis=0)
    marks: list[_Mark] = []
    for notch in panel.notches:
        at = place(notch.position[None])[0]
        inward = inside - at
        inward = inward / max(float(np.hypot(*inward)), 1e-9)
        marks.append(_Line(np.array([at, at + 9.0 * inward]), _INK, 2.0))
    return marks


def _laid_out(cells: Sequence[_Cell]) -> tuple[list[_Mark], int]:
    """Put cells in rows, from left to right; all marks, and the height of the sheet."""
    marks: list[_Mark] = []
    x, y, tallest = float(_EDGE), float(_EDGE), 0.0
    for cell in cells:
        if x > _EDGE and x + cell.width > _WIDTH - _EDGE:
            x, y, tallest = float(_EDGE), y + tallest + _GAP, 0.0
        marks += [_moved(mark, x, y) for mark in cell.marks]
        x += cell.width + _GAP
        tallest = max(tallest, cell.height)
    return marks, int(y + tallest + _EDGE)


def _moved(mark: _Mark, x: float, y: float) -> _Mark:
    if isinstance(mark, _Line):
        return _Line(mark.points + np.array([x, y]), mark.colour, mark.width, mark.fill)
    at = (mark.at[0] + x, mark.at[1] + y)
    if isinstance(mark, _Disc):
        return _Disc(at, mark.radius, mark.colour)
    return _Text(at, mark.text, mark.size, mark.colour, mark.bold, mark.middle)


def _pixels(marks: Sequence[_Mark], height: int) -> npt.NDArray[np.uint8]:
    picture = Pillow.new("RGB", (_WIDTH * _FACTOR, height * _FACTOR), _PAPER)
    draw = ImageDraw.Draw(picture)
    for mark in marks:
        if isinstance(mark, _Line):
            points = [tuple(p) for p in (_FACTOR * mark.points).tolist()]
            if mark.fill is not None:
                draw.polygon(points, fill=mark.fill)
            if mark.width:
                draw.line(
                    points, fill=mark.colour, width=round(_FACTOR * mark.width), joint="curve"
                )
        elif isinstance(mark, _Disc):
            x, y, r = (_FACTOR * v for v in (*mark.at, mark.radius))
            draw.ellipse((x - r, y - r, x + r, y + r), fill=mark.colour)
    picture = picture.resize((_WIDTH, height), Pillow.Resampling.BOX)
    draw = ImageDraw.Draw(picture)
    for mark in marks:
        if isinstance(mark, _Text):
            letters = font(mark.size, bold=mark.bold)
            anchor = "mm" if mark.middle else "la"
            draw.text(mark.at, mark.text, font=letters, fill=mark.colour, anchor=anchor)
    return np.asarray(picture)


def _svg(marks: Sequence[_Mark], height: int) -> str:
    rows = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{_WIDTH}" height="{height}" '
        f'viewBox="0 0 {_WIDTH} {height}" font-family="DejaVu Sans, sans-serif">',
        '<rect width="100%" height="100%" fill="#fff"/>',
    ]
    return "\n".join([*rows, *map(_svg_row, marks), "</svg>", ""])


def _svg_row(mark: _Mark) -> str:
    colour = "#{:02x}{:02x}{:02x}".format(*mark.colour)
    if isinstance(mark, _Line):
        points = " ".join(f"{x:.1f},{y:.1f}" for x, y in mark.points)
        if mark.fill is not None:
            return f'<polygon points="{points}" fill="{colour}"/>'
        return (
            f'<polyline points="{points}" fill="none" stroke="{colour}" '
            f'stroke-width="{mark.width:g}" stroke-linejoin="round"/>'
        )
    x, y = mark.at
    if isinstance(mark, _Disc):
        return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{mark.radius:g}" fill="{colour}"/>'
    weight = ' font-weight="bold"' if mark.bold else ""
    anchor = ' text-anchor="middle"' if mark.middle else ""
    base = y + (0.36 if mark.middle else 0.93) * mark.size
    return (
        f'<text x="{x:.1f}" y="{base:.1f}" font-size="{mark.size}" fill="{colour}"'
        f"{weight}{anchor}>{escape(mark.text)}</text>"
    )
