"""Writing AAMA / ASTM D6673 pattern files.

The text is written here rather than by a DXF library: pattern systems expect a bare R12 file (an
empty header, no tables, no blocks but the pieces, ASCII only), and the same pattern gives the same
bytes.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from pathlib import Path

import numpy as np

from seatlook.files import write_bytes
from seatlook.io.pattern.drawing.layers import (
    BOUNDARY,
    CURVE,
    CUT_OUT,
    GRAIN,
    INTERNAL,
    NOTCH,
    NOTCH_LAYERS,
    SEW,
    TURN,
)
from seatlook.model import FloatArray, Notch, Panel, Pattern

_LAYER_OF_NOTCH = {kind: layer for layer, kind in NOTCH_LAYERS.items()} | {"point": NOTCH}
_TEXT_HEIGHT_MM = 4.0
_GAP_MM = 50.0

Tag = tuple[int, object]


def write_dxf(pattern: Pattern, path: Path, *, style: str = "") -> None:
    """Write the panels as an AAMA DXF (R12, millimetres, one size).

    Layer 1 holds the cut line, 14 the sew line where it differs, 2 the corners, 3 the other
    vertices, 4 and 80 to 83 the notches, 7 the grain, 8 the internal lines with their names, 11 the
    cut-outs.
    Numbers keep all their digits. Seams are not part of the format: see ``write_seams``.

    Parameters
    ----------
    style : name of the style; by default that of the file
    """
    # R12 block names know few characters; the text in the block carries the real name.
    names = [
        f"{re.sub(r'[^A-Za-z0-9_-]', '_', panel.name)}_{number}"
        for number, panel in enumerate(pattern.panels, start=1)
    ]
    tags: list[Tag] = [*_section("HEADER", [])]
    blocks = zip(names, pattern.panels, strict=True)
    tags += _section("BLOCKS", (tag for name, panel in blocks for tag in _block(name, panel)))
    tags += _section("ENTITIES", _sheet(names, pattern, style or path.stem))
    tags.append((0, "EOF"))
    text = "".join(f"{code:3d}\n{_spelled(value)}\n" for code, value in tags)
    write_bytes(path, text.encode("ascii"))


def _section(name: str, tags: Iterable[Tag]) -> Iterator[Tag]:
    yield from ((0, "SECTION"), (2, name))
    yield from tags
    yield (0, "ENDSEC")


def _sheet(names: list[str], pattern: Pattern, style: str) -> Iterator[Tag]:
    """Place the blocks side by side, with the texts of the style below."""
    right = 0.0
    for name, panel in zip(names, pattern.panels, strict=True):
        low, high = 1e3 * panel.cut_outline[:, 0].min(), 1e3 * panel.cut_outline[:, 0].max()
        yield from ((0, "INSERT"), (8, BOUNDARY), (2, name), (10, right - low), (20, 0.0))
        right += high - low + _GAP_MM
    titles = (
        f"Style Name: {style}",
        "Version: ANSI/AAMA-292",
        "Sample Size: ONE",
        "Units: METRIC",
    )
    yield from _texts(titles, np.array([0.0, -2 * _GAP_MM]))


def _block(name: str, panel: Panel) -> Iterator[Tag]:
    outline, cut = 1e3 * panel.outline, 1e3 * panel.cut_outline
    centre = outline.mean(axis=0)
    yield from ((0, "BLOCK"), (8, "0"), (2, name), (70, 0), (10, 0.0), (20, 0.0))
    yield from _texts((f"Piece Name: {panel.name}", "Size: ONE", "Quantity: 1"), centre)
    yield from _polyline(cut, BOUNDARY, closed=True)
    if not np.array_equal(outline, cut):
        yield from _polyline(outline, SEW, closed=True)
    for hole in panel.holes:
        yield from _polyline(1e3 * hole, CUT_OUT, closed=True)
    corner = np.isin(np.arange(len(outline)), panel.corners)
    for layer, points in ((TURN, outline[corner]), (CURVE, outline[~corner])):
        for x, y in points:
            yield from ((0, "POINT"), (8, layer), (10, x), (20, y))
    for notch in panel.notches:
        yield from _notch(notch, cut)
    half = 0.25 * float(np.ptp(outline @ panel.grain)) * panel.grain
    (x0, y0), (x1, y1) = centre - half, centre + half
    yield from ((0, "LINE"), (8, GRAIN), (10, x0), (20, y0), (11, x1), (21, y1))
    for line_name, line in panel.internal_lines.items():
        yield from _polyline(1e3 * line, INTERNAL, closed=False)
        yield from _texts((line_name,), 1e3 * line[0], layer=INTERNAL)
    yield (0, "ENDBLK")


def _polyline(points: FloatArray, layer: str, *, closed: bool) -> Iterator[Tag]:
    yield from ((0, "POLYLINE"), (8, layer), (66, 1), (70, int(closed)))
    for x, y in points:
        yield from ((0, "VERTEX"), (8, layer), (10, x), (20, y))
    yield from ((0, "SEQEND"), (8, layer))


def _notch(notch: Notch, cut: FloatArray) -> Iterator[Tag]:
    """Write a notch with the direction [deg] that leads from the cut line into the panel."""
    x, y = 1e3 * notch.position
    ends = np.roll(cut, -1, axis=0)
    nearest = int(np.hypot(*((cut + ends) / 2 - (x, y)).T).argmin())
    along = ends[nearest] - cut[nearest]
    inward = np.degrees(np.arctan2(along[0], -along[1])) % 360
    layer = _LAYER_OF_NOTCH[notch.kind]
    yield from ((0, "POINT"), (8, layer), (10, x), (20, y), (30, 1e3 * notch.depth), (50, inward))


def _texts(texts: Iterable[str], at: FloatArray, *, layer: str = BOUNDARY) -> Iterator[Tag]:
    for row, text in enumerate(texts):
        yield from ((0, "TEXT"), (8, layer), (10, at[0]), (20, at[1] - 1.5 * _TEXT_HEIGHT_MM * row))
        yield from ((40, _TEXT_HEIGHT_MM), (1, text))


def _spelled(value: object) -> str:
    if isinstance(value, float):
        return repr(float(value))
    # Characters beyond ASCII are written as AutoCAD spells them, by their halves where they are
    # wide; so are those that would end a line, and the backslash with which such spellings begin.
    return "".join(
        c if c.isascii() and c.isprintable() and c != "\\" else _escaped(c) for c in str(value)
    )


def _escaped(character: str) -> str:
    units = character.encode("utf-16-be", "surrogatepass")
    return "".join(f"\\U+{units[k]:02X}{units[k + 1]:02X}" for k in range(0, len(units), 2))
