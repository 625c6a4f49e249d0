"""The entities of a pattern file, layer by layer."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import ezdxf.path
import numpy as np
from ezdxf.lldxf.encoding import decode_dxf_unicode

from seatlook.model import FloatArray, Notch
from seatlook.model.pattern import NotchKind

BOUNDARY, TURN, CURVE, NOTCH, MIRROR, GRAIN, INTERNAL, CUT_OUT, SEW = (
    "1", "2", "3", "4", "6", "7", "8", "11", "14",
)  # fmt: skip
# Layers 84 to 87 repeat the outlines for quality checks and are not read. A notch on layer 4 is
# a mark without a cut when it has no depth.
NOTCH_LAYERS: dict[str, NotchKind] = {
    NOTCH: "v", "80": "t", "81": "castle", "82": "check", "83": "u",
}  # fmt: skip


def read_texts(layout: Any) -> dict[str, str]:
    """Return the texts of the form ``Key: value``; keys without their case."""
    texts = {}
    for entity in layout.query("TEXT"):
        key, colon, value = decode_dxf_unicode(entity.dxf.text).partition(":")
        if colon:
            texts[key.strip().casefold()] = value.strip()
    return texts


def read_polylines(block: Any, layer: str) -> list[FloatArray]:
    """Return the lines of one layer, (k, 2) each in file units; closed ones repeat a point."""
    lines = []
    for entity in block.query(f'LINE POLYLINE LWPOLYLINE ARC SPLINE[layer=="{layer}"]'):
        kind = entity.dxftype()
        if kind == "LINE":
            points = [entity.dxf.start, entity.dxf.end]
        elif kind == "POLYLINE" and not entity.has_arc:
            points = [v.dxf.location for v in entity.vertices]
            points += points[:1] if entity.is_closed else []
        else:
            points = list(ezdxf.path.make_path(entity).flattening(0.001))
        if len(points) > 1:
            lines.append(np.array([(p.x, p.y) for p in points], dtype=np.float64))
    return lines


def read_points(block: Any, layer: str, scale: float) -> FloatArray:
    """Return the points of one layer, (k, 2) [mm]."""
    places = [e.dxf.location for e in block.query(f'POINT[layer=="{layer}"]')]
    return scale * np.array([(p.x, p.y) for p in places]).reshape(-1, 2)


def read_notches(block: Any, layer: str, scale: float) -> Iterator[Notch]:
    """Return the notches of one layer; the height of the point is the depth of the cut."""
    for entity in block.query(f'POINT[layer=="{layer}"]'):
        x, y, depth = entity.dxf.location
        kind: NotchKind = "point" if layer == NOTCH and depth == 0 else NOTCH_LAYERS[layer]
        mm = 1e-3 * scale
        yield Notch(position=np.array([mm * x, mm * y]), kind=kind, depth=mm * abs(depth))


def read_line_names(block: Any, scale: float) -> list[tuple[str, FloatArray]]:
    """Return the texts that name internal lines and where they stand [mm]."""
    texts = block.query(f'TEXT[layer=="{INTERNAL}"]')
    return [
        (decode_dxf_unicode(t.dxf.text).strip(), scale * np.array([t.dxf.insert.x, t.dxf.insert.y]))
        for t in texts
    ]
