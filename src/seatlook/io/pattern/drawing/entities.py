"""The entities of a piece, sorted by layer; nested blocks are put in their place."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import ezdxf.path
import numpy as np
from scipy.interpolate import BSpline

from seatlook.io.pattern.drawing.encoding import spelled_out
from seatlook.io.pattern.drawing.layers import CURVE, LINE_LAYERS, UNREAD, meaning
from seatlook.model import FloatArray

_LINES = ("LINE", "POLYLINE", "LWPOLYLINE", "ARC", "CIRCLE", "ELLIPSE", "SPLINE")
_TEXTS = ("TEXT", "MTEXT", "ATTDEF", "ATTRIB")
_SHORT = {"piece": "piece name", "qty": "quantity"}  # as some exporters write
_TAGS = {  # of attributes
    "piecename": "piece name",
    "piece": "piece name",
    "quantity": "quantity",
    "qty": "quantity",
    "size": "size",
}
_CHORD_MM = 0.001  # by which a chord may leave its curve
_CUBICS = 16  # in an arc
_MOST_CHORDS = 1024  # between two knots of a spline
_FRAME = 16  # flag of a vertex of the frame of a fitted polyline, which is no part of the line
_DEEPEST = 16  # blocks in blocks


class Mark(NamedTuple):
    """A point or a text: on a layer, at a place (2,) [mm]; a point has a depth [mm]."""

    layer: str
    place: FloatArray
    depth: float = 0.0
    text: str = ""


class Left(NamedTuple):
    """What was not read, and why."""

    kind: str
    layer: str
    reason: str


@dataclass(slots=True)
class Drawn:
    """What is drawn of one piece, in millimetres.

    Parameters
    ----------
    lines : layer -> polylines (k, 2); closed ones repeat their first point
    left : how many entities were not read, by kind, layer and reason
    """

    lines: dict[str, list[FloatArray]] = field(default_factory=lambda: defaultdict(list))
    points: list[Mark] = field(default_factory=list)
    texts: list[Mark] = field(default_factory=list)
    left: Counter[Left] = field(default_factory=Counter)


def read_entities(
    layout: Any,
    scale: float,
    matrix: FloatArray | None = None,
    name: str = "",
    layer_0: str = "0",
) -> Drawn:
    """Read the entities of a block.

    Parameters
    ----------
    scale : millimetres per unit of the file
    matrix : (4, 4) by which the block is placed; row vectors, None leaves it where it is
    name : of the block
    layer_0 : the layer that its layer 0 stands for
    """
    drawn = Drawn()
    for entity, at, layer in _placed(layout, matrix, drawn.left, layer_0, (name,)):
        kind = entity.dxftype()
        if kind in _LINES:
            _add_line(drawn, entity, layer, scale, at)
        elif kind == "POINT":
            (place, depth) = _moved_point(entity.dxf.location, scale, at)
            drawn.points.append(Mark(layer, place, depth=depth))
        elif kind in _TEXTS:
            place, _ = _moved_point(entity.dxf.insert, scale, at)
            drawn.texts.append(Mark(layer, place, text=_text(entity)))
        else:
            drawn.left[Left(kind, layer, "neither line, point nor text")] += 1
    return drawn


def read_texts(layout: Any) -> dict[str, str]:
    """Return the texts of the form ``Key: value``; keys without their case."""
    texts = {}
    for entity in layout:
        if entity.dxftype() in _TEXTS:
            for row in _text(entity).splitlines():
                key, colon, value = row.partition(":")
                if colon:
                    word = key.strip().casefold()
                    texts[_SHORT.get(word, word)] = value.strip()
    return texts


def read_attributes(insert: Any) -> dict[str, str]:
    """Return what the attributes of an INSERT say of its piece, as ``read_texts`` does.

    An attribute holds ``Key: value``, or the value alone and the key as its tag, ``PIECE_NAME``.
    """
    texts = read_texts(insert.attribs)
    for attribute in insert.attribs:
        tag = "".join(filter(str.isalpha, attribute.dxf.get("tag", ""))).casefold()
        value = _text(attribute)
        if tag in _TAGS and value and ":" not in value:
            texts.setdefault(_TAGS[tag], value)
    return texts


def has_line(layout: Any, layer: str) -> bool:
    """Whether a block has a line on a layer."""
    return any(e.dxftype() in _LINES and meaning(e.dxf.layer) == layer for e in layout)


def line_layers(layout: Any) -> set[str]:
    """Return the layers on which a block has lines."""
    return {e.dxf.layer for e in layout if e.dxftype() in _LINES}


def matrix_of(insert: Any) -> Iterator[FloatArray]:
    """Return the (4, 4) matrices of an INSERT, one for every row and column of it."""
    single = insert.multi_insert() if insert.mcount > 1 else (insert,)
    for one in single:
        yield np.array(list(one.matrix44()), dtype=np.float64).reshape(4, 4)


def _placed(
    layout: Any, matrix: FloatArray | None, left: Counter[Left], layer: str, around: tuple[str, ...]
) -> Iterator[tuple[Any, FloatArray | None, str]]:
    """Return every entity with its matrix and layer; layer 0 of a block is that of its INSERT."""
    for entity in layout:
        own = meaning(entity.dxf.layer)
        own = layer if own == "0" else own
        if entity.dxftype() != "INSERT":
            yield entity, matrix, own
            continue
        block, name = entity.block(), entity.dxf.get("name", "")
        if block is None or name in around or len(around) >= _DEEPEST:
            reason = "no such block" if block is None else "a block in itself"
            left[Left("INSERT", own, reason)] += 1
            continue
        for inner in matrix_of(entity):
            whole = inner if matrix is None else inner @ matrix
            yield from _placed(block, whole, left, own, (*around, name))


def _add_line(
    drawn: Drawn, entity: Any, layer: str, scale: float, matrix: FloatArray | None
) -> None:
    if layer not in LINE_LAYERS:
        reason = UNREAD.get(layer, "a layer without a meaning")
        reason = "a line among the curve points" if layer == CURVE else reason
        drawn.left[Left(entity.dxftype(), layer, reason)] += 1
        if layer in UNREAD:
            return
    stretch = 1.0 if matrix is None else max(float(np.linalg.norm(matrix[:2, :2], 2)), 1e-9)
    points = _points(entity, _CHORD_MM / max(scale * stretch, 1e-9))
    if len(points) < 2:
        drawn.left[Left(entity.dxftype(), layer, "a single point")] += 1
        return
    if matrix is not None:
        points = points @ matrix[:3, :2] + matrix[3, :2]
    drawn.lines[layer].append(scale * points[:, :2])


def _points(entity: Any, chord: float) -> FloatArray:
    """Return a line as (k, 3) in file units."""
    kind = entity.dxftype()
    if kind == "LINE":
        points = [entity.dxf.start, entity.dxf.end]
    elif kind == "POLYLINE" and not entity.has_arc and entity.dxf.extrusion.z > 0:
        points = [v.dxf.location for v in entity.vertices if not v.dxf.flags & _FRAME]
        points += points[:1] if entity.is_closed else []
    elif kind in ("ARC", "CIRCLE", "ELLIPSE"):
        # Of as few cubics as the library would take, a circle is 0.03 % too large.
        points = list(ezdxf.path.make_path(entity, segments=_CUBICS).flattening(chord))
    elif kind == "SPLINE" and not (curve := entity.construction_tool()).is_clamped:
        return _unclamped(curve, chord)
    else:
        points = list(ezdxf.path.make_path(entity).flattening(chord))
    return np.array([(p.x, p.y, p.z) for p in points], dtype=np.float64).reshape(-1, 3)


def _unclamped(curve: Any, chord: float) -> FloatArray:
    """Return a spline as (k, 3) whose end knots are single, as those of periodic ones are.

    Only between the knots of its degree from either end does it lie in its control points; the
    library goes on to the last knots.
    """
    degree, knots = curve.degree, np.array(curve.knots())
    weights = np.array(curve.weights() or np.ones(curve.count))[:, None]
    control = np.array([tuple(p) for p in curve.control_points])
    spline = BSpline(knots, np.hstack([weights * control, weights]), degree)
    ends = np.unique(knots[degree : curve.count + 1])
    count = 4
    while True:
        share = np.linspace(0.0, 1.0, count, endpoint=False)
        t = (ends[:-1, None] + share * np.diff(ends)[:, None]).ravel()
        rows = spline(np.append(t, ends[-1]))
        points = np.asarray(rows[:, :3] / rows[:, 3:])
        off = points[1:-1:2] - 0.5 * (points[:-2:2] + points[2::2])
        # Half the step leaves a quarter of this.
        if np.linalg.norm(off, axis=1).max() < 4.0 * chord or count >= _MOST_CHORDS:
            return points
        count *= 2


def _moved_point(place: Any, scale: float, matrix: FloatArray | None) -> tuple[FloatArray, float]:
    """Return the place (2,) and the height, which is the depth of a notch, in millimetres."""
    x, y, depth = place
    point, depth = np.array([x, y], dtype=np.float64), abs(depth)
    if matrix is not None:
        point = point @ matrix[:2, :2] + matrix[3, :2]
        depth *= float(np.sqrt(abs(np.linalg.det(matrix[:2, :2]))))
    return scale * point, scale * depth


def _text(entity: Any) -> str:
    text = entity.plain_text() if entity.dxftype() == "MTEXT" else entity.dxf.text
    return spelled_out(text).strip()
