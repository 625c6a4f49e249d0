"""One piece per outline, where several are drawn side by side."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import shapely

from seatlook.io.pattern.drawing.entities import Drawn, Left, Mark
from seatlook.io.pattern.drawing.layers import BOUNDARY, TURN
from seatlook.io.pattern.pieces.join import Chain, join_outline
from seatlook.model import FloatArray

_NEAR_MM = 0.5  # outside an outline, of what is drawn on it


def split(drawn: Drawn) -> list[Drawn]:
    """Return one piece for every closed outline that lies in no other.

    Lines, points and texts belong to the outline they lie in. With fewer than two such outlines
    there is nothing to split.
    """
    chains, _ = join_outline(drawn.lines[BOUNDARY])
    outer = _outermost([c for c in chains if c.closed and len(c.points) > 2])
    if len(outer) < 2:
        return [drawn]
    areas = [shapely.Polygon(c.points) for c in outer]
    pieces = [Drawn() for _ in outer]
    tree = shapely.STRtree(areas)
    for layer, lines in drawn.lines.items():
        owners = _owners(tree, areas, [_middle(line) for line in lines])
        for line, owner in zip(lines, owners, strict=True):
            if owner is None:
                drawn.left[Left("line", layer, "outside of all outlines")] += 1
            else:
                pieces[owner].lines[layer].append(line)
    for source, name in ((drawn.points, "points"), (drawn.texts, "texts")):
        owners = _owners(tree, areas, [mark.place for mark in source])
        for mark, owner in zip(source, owners, strict=True):
            if owner is not None:
                getattr(pieces[owner], name).append(mark)
    for piece, chain in zip(pieces, outer, strict=True):
        ring = shapely.LinearRing(chain.points)
        inner = [x for x in piece.lines[BOUNDARY] if ring.distance(_point(x)) > _NEAR_MM]
        piece.lines[BOUNDARY] = [np.vstack([chain.points, chain.points[:1]]), *inner]
        piece.points += [Mark(TURN, joint) for joint in chain.joints]
    return pieces


def name_in(drawn: Drawn) -> str | None:
    """Return the name of a piece that is written in it."""
    texts = [mark.text for mark in drawn.texts if mark.text]
    for text in texts:
        key, colon, value = text.partition(":")
        if colon and key.strip().casefold() in ("piece name", "name", "piece"):
            return value.strip() or None
    plain = [text for text in texts if ":" not in text and "\n" not in text]
    return plain[0] if len(plain) == 1 else None


def _outermost(chains: list[Chain]) -> list[Chain]:
    """Return the chains that lie in no other; of equal ones the first."""
    areas = [shapely.Polygon(chain.points) for chain in chains]
    order = sorted(range(len(chains)), key=lambda k: -areas[k].area)
    kept: list[int] = []
    for k in order:
        inside = areas[k].representative_point() if areas[k].area > 0 else None
        if inside is not None and not any(areas[o].buffer(0).contains(inside) for o in kept):
            kept.append(k)
    return [chains[k] for k in sorted(kept)]


def _middle(line: FloatArray) -> FloatArray:
    k = len(line) // 2
    return np.asarray((line[k - 1] + line[k]) / 2)


def _point(line: FloatArray) -> shapely.Point:
    return shapely.Point(_middle(line))


def _owners(
    tree: shapely.STRtree, areas: list[shapely.Polygon], places: Iterable[FloatArray]
) -> list[int | None]:
    points = shapely.points(np.array(list(places), dtype=np.float64).reshape(-1, 2))
    owners: list[int | None] = [None] * len(points)
    if len(points):
        for point, area in tree.query(points, predicate="dwithin", distance=_NEAR_MM).T:
            inside = owners[point] is None or areas[area].contains(points[point])
            owners[point] = int(area) if inside else owners[point]
    return owners
