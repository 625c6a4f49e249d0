"""AAMA / ASTM D6673 pattern files, as garment and trim CAD systems export them (DXF R12).

The practice was withdrawn in 2019 but is what systems still exchange: one style per file, one
BLOCK per piece and size, the meaning of an entity given by its layer, the unit by a text.
"""

from __future__ import annotations

import warnings
from collections import Counter
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, TypedDict, Unpack

import numpy as np
from ezdxf.lldxf.const import DXFError
from shapely.errors import ShapelyError

from seatlook.errors import InputError, InputWarning, Problem
from seatlook.files import kept, reader
from seatlook.io.pattern.allowance import only_cut, with_allowance
from seatlook.io.pattern.drawing.drawing import Drawing, assign_layers, open_drawing, refusal
from seatlook.io.pattern.drawing.entities import Drawn, has_line, read_entities, read_texts
from seatlook.io.pattern.drawing.layers import BOUNDARY
from seatlook.io.pattern.drawing.uses import find_uses, layers_of, unique, unique_names
from seatlook.io.pattern.flat import name_in, split
from seatlook.io.pattern.mirror import add_mirrored
from seatlook.io.pattern.pieces.piece import Piece
from seatlook.io.pattern.report import PatternReport, PieceReport
from seatlook.io.pattern.units import Units, millimetres_per_unit, other_unit
from seatlook.model import Panel

SMALLEST_NOTCH = 0.005  # m
_SMALLEST_PATTERN_MM, _LARGEST_PATTERN_MM = 80.0, 3000.0


class Reading(TypedDict, total=False):
    """How a pattern file is read; see ``read_dxf``."""

    size: str | None
    units: Units | None
    smallest_notch: float
    encoding: str | None
    grain_deg: float | None
    allowance: float | None
    layers: Mapping[str, str]


@reader("a pattern (DXF)")
def read_dxf(path: Path, **reading: Unpack[Reading]) -> tuple[Panel, ...]:
    """Read the pieces of a pattern.

    What is unusual, mended, guessed or left out comes as an ``InputWarning``.

    Parameters
    ----------
    reading : all may be left out

    size : the size to read; without it the sample size, or the only one there is
    units : for a file without a UNITS text
    smallest_notch : float [m]
        Cuts into an outline that are less deep and less wide are closed and become notches, and
        slits up to three times as deep.
    encoding : of the names, as ``gb18030``; else by the file's code page, or guessed
    grain_deg : float [deg]
        Warp of the pieces without a grain line, from the x axis; +y if not given.
    allowance : float [m]
        Width of the allowance of pieces of which only the cut line is drawn: their sew line lies
        that much inside.
    layers : name of a layer in the file -> what it means, as ``CUT``, ``SEW`` or ``14``

    Returns
    -------
    tuple of Panel
        Outlines counter-clockwise, in metres, in the coordinates of the piece's own block, turned,
        scaled and mirrored as its INSERT says. The outline is the sew line (layer 14, else a closed
        line parallel inside the boundary) if there is one, else the boundary (layer 1). Half pieces
        are unfolded at their mirror line (layer 6). A quantity ``1,1`` adds the mirrored piece,
        unless the file holds it.

    Raises
    ------
    InputError
        When the file is no DXF or holds no piece or no unit, when a size is unknown, when
        an outline is open, crosses itself or holds nan, or is smaller than 5 mm or larger than
        10 m. All pieces are reported at once.
    """
    panels, report = read_drawing(path, **reading)
    for text in report.warnings():
        warnings.warn(f"{path}: {text}", InputWarning, 2)
    return panels


def _sewn_inside(
    path: Path, panels: tuple[Panel, ...], allowance: float | None, report: PatternReport
) -> tuple[Panel, ...]:
    """Give panels without a sew line one by the width of their allowance."""
    if allowance is None:
        return panels
    drawn = [panel.name for panel in panels if not only_cut(panel)]
    if drawn:
        names = ", ".join(drawn)
        report.notes.append(f"allowance_mm is not used where a sew line is drawn: {names}")
    try:
        return tuple(with_allowance(p, allowance) if only_cut(p) else p for p in panels)
    except InputError as error:
        raise InputError(replace(p, file=path) for p in error.problems) from error


@reader("a pattern (DXF)")
def report_dxf(path: Path, **reading: Unpack[Reading]) -> PatternReport:
    """Return what is read of a pattern file and what is not; ``reading`` as in ``read_dxf``."""
    return read_drawing(path, **reading)[1]


@reader("a pattern (DXF)")
def read_drawing(path: Path, **reading: Unpack[Reading]) -> tuple[tuple[Panel, ...], PatternReport]:
    """Read the pieces of a pattern, and what is to say of them; see ``read_dxf``."""
    panels, report = _read_drawing(path, **reading)
    # What is said may be added to by who reads it.
    return panels, replace(
        report, pieces=list(report.pieces), left=report.left.copy(), notes=list(report.notes)
    )


@kept
def _read_drawing(
    path: Path, **reading: Unpack[Reading]
) -> tuple[tuple[Panel, ...], PatternReport]:
    drawing = open_drawing(path, reading.get("encoding"))
    assign_layers(path, drawing.document, reading.get("layers", {}))
    notch = 1e3 * reading.get("smallest_notch", SMALLEST_NOTCH)
    report = PatternReport(notes=list(drawing.notes))
    try:
        titles = _titles(drawing.document)
        report.mm_per_unit = millimetres_per_unit(
            path,
            titles.get("units"),
            reading.get("units"),
            drawing.header,
            report.notes,
            lambda: _longest(drawing.document),
        )
        pieces = _pieces(drawing, titles, reading.get("size"), report)
        panels = _panels(path, pieces, report, notch, reading.get("grain_deg"))
        _check_scale(panels, drawing, report)
        panels = _sewn_inside(path, panels, reading.get("allowance"), report)
        return add_mirrored(panels, report), report
    except InputError:
        raise
    # An entity without the values it must have; the library gives None for some.
    except (
        DXFError,
        ShapelyError,
        AttributeError,
        TypeError,
        ValueError,
        ArithmeticError,
    ) as error:
        raise refusal(path, error) from error


def _panels(
    path: Path,
    pieces: dict[str, Drawn],
    report: PatternReport,
    smallest_notch: float,
    grain_deg: float | None,
) -> tuple[Panel, ...]:
    problems: list[Problem] = []
    panels: list[Panel] = []
    for name, drawn in pieces.items():
        try:
            piece = Piece.read(name, drawn, report.notes)
            panels.append(piece.panel(smallest_notch, grain_deg))
        except InputError as error:
            problems += error.problems
        report.left += drawn.left
    if problems:
        raise InputError(replace(p, file=path) for p in problems)
    return tuple(panels)


def _titles(document: Any) -> dict[str, str]:
    """Collect the ``Key: value`` texts of the file; those outside the blocks come first."""
    titles: dict[str, str] = {}
    for layout in (*document.blocks, document.modelspace()):
        titles |= read_texts(layout)
    return titles


def _longest(document: Any) -> float:
    """Longest extent of a line of the file, in its own units; 0 where there is none."""
    layouts = (read_entities(block, 1.0) for block in (*document.blocks, document.modelspace()))
    lines = [line for drawn in layouts for rows in drawn.lines.values() for line in rows]
    return max((float(np.ptp(line, axis=0).max()) for line in lines), default=0.0)


def _pieces(
    drawing: Drawing, titles: dict[str, str], size: str | None, report: PatternReport
) -> dict[str, Drawn]:
    """Return piece name -> its entities, in the order of the file."""
    pieces: dict[str, Drawn] = {}
    uses = find_uses(drawing, titles, size, report.notes)
    for name, use in zip(unique_names(uses, report.notes), uses, strict=True):
        drawn = read_entities(use.block, report.mm_per_unit, use.matrix, use.block.name, use.layer)
        parts = split(drawn)
        for part in parts:
            own = name if len(parts) == 1 else name_in(part) or f"{name}_{len(pieces) + 1}"
            own = unique(own, tuple(pieces))
            pieces[own] = part
            _report_piece(report, own, use.name, use.texts.get("quantity", ""), part)
        if len(parts) > 1:
            report.left += drawn.left
            report.notes.append(f"piece {name}: {len(parts)} outlines in one block: each a piece")
    if drawing.document.modelspace() and has_line(drawing.document.modelspace(), BOUNDARY):
        _add_loose(drawing, pieces, report)
    if not pieces:
        layers = layers_of(drawing.document)
        raise InputError.single(
            "pieces", got="none", expected="blocks with an outline on layer 1", file=drawing.path,
            hint=f"layers with entities: {', '.join(layers) or 'none'}; export as AAMA or ASTM "
            "D6673, or say which layer holds the outlines: --layer NAME=CUT, in a scene "
            '[pattern.layers] NAME = "CUT"',
        )  # fmt: skip
    return pieces


def _add_loose(drawing: Drawing, pieces: dict[str, Drawn], report: PatternReport) -> None:
    """Add the outlines that are in no block, one piece each, where no block holds any."""
    loose = read_entities(_Loose(drawing.document.modelspace()), report.mm_per_unit)
    if pieces:
        report.notes.append(
            f"{len(loose.lines[BOUNDARY])} lines on layer 1 outside of the blocks are not read"
        )
        return
    parts = split(loose)
    report.left += loose.left if len(parts) > 1 else Counter()
    for number, part in enumerate(parts, start=1):
        name = unique(name_in(part) or f"piece{number}", tuple(pieces))
        pieces[name] = part
        quantity = {k: v for m in part.texts for k, v in _title(m.text).items()}.get("quantity", "")
        _report_piece(report, name, "", quantity, part)
    report.notes.append(f"no blocks: {len(parts)} closed outlines are read, each as a piece")


class _Loose(list[Any]):
    """The entities of the sheet that are in no block."""

    def __init__(self, modelspace: Any) -> None:
        super().__init__(e for e in modelspace if e.dxftype() != "INSERT")


def _title(text: str) -> dict[str, str]:
    key, colon, value = text.partition(":")
    return {key.strip().casefold(): value.strip()} if colon else {}


def _report_piece(
    report: PatternReport, name: str, block: str, quantity: str, drawn: Drawn
) -> None:
    layers = Counter({layer: len(lines) for layer, lines in drawn.lines.items() if lines})
    layers.update(mark.layer for mark in (*drawn.points, *drawn.texts))
    report.pieces.append(PieceReport(name=name, block=block, quantity=quantity, layers=layers))


def _check_scale(panels: tuple[Panel, ...], drawing: Drawing, report: PatternReport) -> None:
    """Name a whole pattern that is too small for a cover, or too large."""
    largest = 1e3 * max(float(np.ptp(panel.cut_outline, axis=0).max()) for panel in panels)
    if not _SMALLEST_PATTERN_MM <= largest <= _LARGEST_PATTERN_MM:
        other = other_unit(report.mm_per_unit, largest, drawing.header)
        report.notes.append(
            f"the largest piece is {largest:.4g} mm: is the pattern out of scale? ({other})"
        )
