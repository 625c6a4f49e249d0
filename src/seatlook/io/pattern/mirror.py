"""The mirrored piece that a quantity asks for, unless the file holds it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from types import MappingProxyType

import numpy as np

from seatlook.io.pattern.drawing.uses import unique
from seatlook.io.pattern.report import PatternReport
from seatlook.mesh import arc_length
from seatlook.model import FloatArray, Notch, Panel

_SAMPLES = 512
_SAME = 2e-3  # of the extent of a panel, by which a mirror image differs


def add_mirrored(panels: Sequence[Panel], report: PatternReport) -> tuple[Panel, ...]:
    """Add the mirrored pieces that the quantities ask for, ``as drawn,mirrored``."""
    whole = list(panels)
    for panel, piece in zip(panels, report.pieces, strict=True):
        if not _asks_for_mirrored(piece.quantity):
            continue
        twin = next((p for p in whole if p is not panel and is_mirror_image(p, panel)), None)
        if twin is None:
            name = unique(f"{panel.name}_mirrored", [p.name for p in whole])
            whole.append(replace(mirrored(panel), name=name))
            report.notes.append(
                f"piece {panel.name}: quantity {piece.quantity}: the mirrored piece is {name}"
            )
    return tuple(whole)


def mirrored(panel: Panel) -> Panel:
    """Return a panel turned over about the vertical through its middle, counter-clockwise."""
    low, high = panel.cut_outline[:, 0].min(), panel.cut_outline[:, 0].max()

    def over(points: FloatArray) -> FloatArray:
        return np.asarray(np.array([low + high, 0.0]) + np.array([-1.0, 1.0]) * points)

    def round_again(points: FloatArray) -> FloatArray:
        return np.roll(over(points)[::-1], 1, axis=0)

    notches = tuple(
        Notch(position=over(n.position), kind=n.kind, depth=n.depth) for n in panel.notches
    )
    return replace(
        panel,
        outline=round_again(panel.outline),
        corners=np.sort(-panel.corners % len(panel.outline)),
        cut_outline=round_again(panel.cut_outline),
        grain=np.array([-1.0, 1.0]) * panel.grain + 0.0,
        notches=notches,
        internal_lines=MappingProxyType({n: over(x) for n, x in panel.internal_lines.items()}),
        holes=tuple(map(round_again, panel.holes)),
    )


def is_mirror_image(a: Panel, b: Panel) -> bool:
    """Whether one panel is the other turned over, wherever and however it lies."""
    first, second = _samples(a.cut_outline), _samples(mirrored(b).cut_outline)
    size = float(np.abs(first).max())
    # The turn and the start that fit best, of all starts at once.
    fit = np.abs(np.fft.ifft(np.fft.fft(first) * np.conj(np.fft.fft(second)))).max()
    squares = (np.abs(first) ** 2 + np.abs(second) ** 2).sum() - 2 * _SAMPLES * fit / _SAMPLES
    return bool(np.sqrt(max(squares, 0.0) / _SAMPLES) < _SAME * size)


def _samples(outline: FloatArray) -> np.ndarray[tuple[int], np.dtype[np.complex128]]:
    """Return points at equal distances about their middle, as complex numbers."""
    closed = np.vstack([outline, outline[:1]])
    way = arc_length(closed)
    at = np.linspace(0.0, way[-1], _SAMPLES, endpoint=False)
    points = np.interp(at, way, closed[:, 0]) + 1j * np.interp(at, way, closed[:, 1])
    return np.asarray(points - points.mean())


def _asks_for_mirrored(quantity: str) -> bool:
    number = quantity.partition(",")[2].strip()
    return number.isdigit() and int(number) > 0
