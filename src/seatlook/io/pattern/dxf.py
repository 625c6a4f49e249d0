"""AAMA / ASTM D6673 pattern files, as garment and trim CAD systems export them (DXF R12).

The practice was withdrawn in 2019 but is what systems still exchange: one style per file, one
BLOCK per piece and size, the meaning of an entity given by its layer, the unit by a text.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from types import MappingProxyType
from typing import Any, Literal

import ezdxf.filemanagement
import numpy as np
from ezdxf.lldxf.const import DXFError

from seatlook.errors import InputError, InputWarning, Problem, did_you_mean
from seatlook.io.pattern.cuts import with_cuts
from seatlook.io.pattern.entities import (
    BOUNDARY,
    CUT_OUT,
    GRAIN,
    INTERNAL,
    MIRROR,
    NOTCH_LAYERS,
    SEW,
    TURN,
    read_line_names,
    read_notches,
    read_points,
    read_polylines,
    read_texts,
)
from seatlook.io.pattern.log import listening, loses_a_piece
from seatlook.io.pattern.outline import (
    MEETING_MM,
    Chain,
    closed_outline,
    corners,
    distance_to,
    join,
    reflect,
    trimmed,
    unfold,
)
from seatlook.io.toml import read_file
from seatlook.model import FloatArray, Notch, Panel

MM_PER_UNIT = {"metric": 1.0, "english": 25.4}

SMALLEST_NOTCH = 0.005  # m

Units = Literal["metric", "english"]


def read_dxf(
    path: Path,
    *,
    size: str | None = None,
    units: Units | None = None,
    smallest_notch: float = SMALLEST_NOTCH,
) -> tuple[Panel, ...]:
    """Read the pieces of a pattern.

    Parameters
    ----------
    size : the size to read; without it the sample size, or the only one there is
    units : for a file without a UNITS text
    smallest_notch : float [m]
        Cuts into an outline that are less deep and less wide are closed and become notches.

    Returns
    -------
    tuple of Panel
        Outlines counter-clockwise, in metres, in the coordinates of the piece's own block. The
        outline is the sew line (layer 14) if there is one, else the boundary (layer 1). Half
        pieces are unfolded at their mirror line (layer 6).

    Raises
    ------
    InputError
        When the file is no DXF or holds no piece or no UNITS text, when a size is unknown, when
        an outline is open, crosses itself or holds nan, or is smaller than 5 mm or larger than
        10 m, when a piece has no grain line. All pieces are reported at once.
    """
    document = _open(path)
    try:
        titles = _titles(document)
        scale = _scale(path, titles, units)
        blocks = _blocks(path, document, titles, size)
        return _panels(path, blocks, scale, 1e3 * smallest_notch)
    # An entity without the values it must have; the library gives None for some.
    except (DXFError, AttributeError, TypeError) as error:
        raise _refusal(path, error) from error


def _panels(
    path: Path, blocks: dict[str, Any], scale: float, smallest_notch: float
) -> tuple[Panel, ...]:
    problems: list[Problem] = []
    panels: list[Panel] = []
    for name, block in blocks.items():
        try:
            panels.append(_Piece.read(name, block, scale).panel(smallest_notch))
        except InputError as error:
            problems += error.problems
    if problems:
        raise InputError(replace(p, file=path) for p in problems)
    return tuple(panels)


def _open(path: Path) -> Any:
    read_file(path)
    with listening() as messages:
        try:
            document = ezdxf.filemanagement.readfile(path)
        except Exception as error:  # on damaged files it raises whatever it stumbles over
            raise _refusal(path, error) from error
    lost = [message for message in messages if loses_a_piece(message)]
    if lost:
        raise InputError.single("file", got=lost[0], expected="a whole DXF file", file=path)
    for message in dict.fromkeys(messages):
        warnings.warn(f"{path}: {message}", InputWarning, 4)
    return document


def _refusal(path: Path, error: Exception) -> InputError:
    got = str(error).rstrip(".") or type(error).__name__
    return InputError.single("file", got=got, expected="a whole DXF file", file=path)


def _titles(document: Any) -> dict[str, str]:
    """Collect the ``Key: value`` texts of the file; those outside the blocks come first."""
    titles: dict[str, str] = {}
    for layout in (*document.blocks, document.modelspace()):
        titles |= read_texts(layout)
    return titles


def _scale(path: Path, titles: dict[str, str], units: Units | None) -> float:
    """Return millimetres per unit of the file."""
    text = titles.get("units") or units
    expected = "METRIC or ENGLISH"
    if text is None:
        raise InputError.single(
            "UNITS", got="no such text", expected=expected, file=path,
            hint="say units = \"metric\" if the file is in millimetres",
        )  # fmt: skip
    if text.casefold() not in MM_PER_UNIT:
        raise InputError.single("UNITS", got=repr(text), expected=expected, file=path)
    return MM_PER_UNIT[text.casefold()]


def _blocks(path: Path, document: Any, titles: dict[str, str], size: str | None) -> dict[str, Any]:
    """Return piece name -> block of the wanted size, in the order of the file."""
    used = [e.dxf.get("name", "") for e in document.modelspace().query("INSERT")]
    names = list(dict.fromkeys(used)) or [b.name for b in document.blocks]
    blocks = [document.blocks.get(n) for n in names]
    pieces = [(b, read_texts(b)) for b in blocks if b is not None and read_polylines(b, BOUNDARY)]
    if not pieces:
        raise InputError.single(
            "pieces", got="none", expected="blocks with an outline on layer 1", file=path
        )
    sizes = list(dict.fromkeys(t["size"] for _, t in pieces if "size" in t))
    if size is None and len(sizes) > 1:
        size = titles.get("sample size")
    if (size is not None or len(sizes) > 1) and size not in sizes:
        raise InputError.single(
            "size", got=repr(size), expected=f"one of {', '.join(sizes)}", file=path,
            hint=did_you_mean(size or "", sizes),
        )  # fmt: skip
    chosen: dict[str, Any] = {}
    for block, titled in pieces:
        name = titled.get("piece name", block.name)
        if size is None or titled.get("size", size) == size:
            if name in chosen:
                raise InputError.single(
                    f"piece {name}", got="two blocks of one name", expected="one", file=path
                )
            chosen[name] = block
    return chosen


@dataclass(frozen=True, slots=True)
class _Piece:
    """One block, in millimetres, unfolded."""

    name: str
    boundary: list[Chain]
    sew: list[Chain]
    internal: list[Chain]
    grain: list[FloatArray]
    marks: FloatArray
    notches: list[Notch]
    line_names: list[tuple[str, FloatArray]]

    @classmethod
    def read(cls, name: str, block: Any, scale: float) -> _Piece:
        layers = {
            layer: [scale * line for line in read_polylines(block, layer)]
            for layer in (BOUNDARY, SEW, INTERNAL, GRAIN, MIRROR, CUT_OUT)
        }
        _refuse_nan(name, layers)
        if layers[CUT_OUT]:
            warnings.warn(f"piece {name}: cut-outs (layer 11) are ignored", InputWarning, 4)
        _warn_of_mirrored(name, read_texts(block).get("quantity", ""))
        marks = read_points(block, TURN, scale)
        notches = [n for layer in NOTCH_LAYERS for n in read_notches(block, layer, scale)]
        axis = _axis(layers[MIRROR], layers[BOUNDARY])
        if axis is not None:
            for layer in (BOUNDARY, SEW, INTERNAL):
                layers[layer] = unfold(layers[layer], axis)
            marks = np.vstack([marks, reflect(marks, axis)])
            notches += _mirrored(notches, axis)
        return cls(
            name=name,
            boundary=join(layers[BOUNDARY]),
            sew=join(layers[SEW]),
            internal=join(layers[INTERNAL]),
            grain=layers[GRAIN],
            marks=marks,
            notches=notches,
            line_names=read_line_names(block, scale),
        )

    def panel(self, smallest_notch: float) -> Panel:
        key = f"piece {self.name}, layer 1"
        cut = closed_outline(self.boundary, key=key, smallest_notch=smallest_notch)
        outline = self._sew_line(cut, smallest_notch)
        _check_size(self.name, cut.points)
        if not self.grain:
            raise InputError.single(
                f"piece {self.name}, layer 7", got="no grain line", expected="one"
            )
        along = self.grain[0][-1] - self.grain[0][0]
        mm = 1e-3
        return Panel(
            name=self.name,
            outline=mm * outline.points,
            corners=corners(outline.points, np.vstack([self.marks, outline.joints])),
            cut_outline=mm * cut.points,
            grain=along / np.hypot(*along),
            notches=with_cuts(self.notches, (*cut.notches, *outline.notches)),
            internal_lines=MappingProxyType(self._internal_lines()),
        )

    def _sew_line(self, cut: Chain, smallest_notch: float) -> Chain:
        key = f"piece {self.name}, layer 14"
        if not self.sew:
            return cut
        if all(c.closed for c in self.sew):
            return closed_outline(self.sew, key=key, smallest_notch=smallest_notch)
        return trimmed(cut, [c for c in self.sew if not c.closed], key=key)

    def _internal_lines(self) -> dict[str, FloatArray]:
        """Name each line by the text at one of its ends, else ``lineN``."""
        lines = {}
        for number, chain in enumerate(self.internal, start=1):
            points = np.vstack([chain.points, chain.points[:1]]) if chain.closed else chain.points
            names = [
                text
                for text, place in self.line_names
                if np.hypot(*(points[[0, -1]] - place).T).min() < 5 * MEETING_MM
            ]
            name = names[0] if names else f"line{number}"
            lines[f"{name} {number}" if name in lines else name] = 1e-3 * points
        return lines


def _warn_of_mirrored(name: str, quantity: str) -> None:
    """Warn where the second number of ``as drawn,mirrored`` asks for pieces nobody drew."""
    mirrored = quantity.partition(",")[2].strip()
    if mirrored.isdigit() and int(mirrored) > 0:
        text = f"piece {name}: quantity {quantity}: the mirrored piece is not made, draw it"
        warnings.warn(text, InputWarning, 5)


def _refuse_nan(name: str, layers: dict[str, list[FloatArray]]) -> None:
    for layer, lines in layers.items():
        bad = sum(int((~np.isfinite(line).all(axis=1)).sum()) for line in lines)
        if bad:
            raise InputError.single(
                f"piece {name}, layer {layer}", got=f"{bad} nan or inf", expected="finite points"
            )


def _check_size(name: str, points: FloatArray) -> None:
    size = float(np.ptp(points, axis=0).max())
    if not 5 <= size <= 10_000:
        raise InputError.single(
            f"piece {name}", got=f"a size of {size:.4g} mm", expected="5 mm to 10 m",
            hint="check the UNITS text",
        )  # fmt: skip
    if not 20 <= size <= 3000:
        warnings.warn(f"piece {name}: a size of {size:.4g} mm is unusual", InputWarning, 4)


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
