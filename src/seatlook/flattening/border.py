"""The free borders of a design surface: one closed curve each, and the edges that lie on it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from seatlook import mesh
from seatlook.flattening.surface import FREE, DesignSurface, Side, sides
from seatlook.mesh.places import place_words
from seatlook.model import FloatArray

BORDER = "border"


@dataclass(frozen=True, slots=True, kw_only=True)
class Border:
    """One loop of the border.

    Parameters
    ----------
    name : ``border``, or ``border.PLACE`` where a surface has several
    edges : names of the panels' free edges, one after the other
    curve : (k, 3) float64 [m]     closed, the first point repeated
    junctions : float [m], one more than edges    where along the curve the edges begin and end
    """

    name: str
    edges: tuple[str, ...]
    curve: FloatArray
    junctions: tuple[float, ...]


def borders(form: DesignSurface) -> tuple[Border, ...]:
    """Return the free borders, each from the first panel that lies on it.

    Examples
    --------
    A square of two triangles and two panels:

    >>> square = DesignSurface(
    ...     vertices=np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]),
    ...     faces=np.array([[0, 1, 2], [0, 2, 3]]),
    ...     panel=np.array([0, 1]),
    ...     panel_names=("A", "B"),
    ... )
    >>> (border,) = borders(square)
    >>> border.name, border.edges, border.junctions
    ('border', ('A.free', 'B.free'), (0.0, 2.0, 4.0))
    """
    loops = _loops([side for side in sides(form.patches()) if side.neighbour == FREE])
    curves = [form.vertices[_run(loop)] for loop in loops]
    words = place_words(curves)
    result = []
    for loop, curve, word in zip(loops, curves, words, strict=True):
        arc = mesh.arc_length(curve)
        count = np.cumsum([0, *(side.count for side in loop)])
        result.append(
            Border(
                name=f"{BORDER}.{word}" if word else BORDER,
                edges=tuple(side.name for side in loop),
                curve=curve,
                junctions=tuple(arc[count].tolist()),
            )
        )
    return tuple(result)


def _loops(free: list[Side]) -> list[list[Side]]:
    """Chain sides whose ends meet; the first of each loop is the first of all that are left."""
    starting = {int(side.vertices[0]): side for side in free}
    loops: list[list[Side]] = []
    while starting:
        loop = [starting.pop(next(iter(starting)))]
        while (end := int(loop[-1].vertices[-1])) != loop[0].vertices[0]:
            loop.append(starting.pop(end))
        loops.append(loop)
    return loops


def _run(loop: list[Side]) -> list[int]:
    """Vertices of a loop, the first one repeated at its end."""
    return [int(v) for side in loop for v in side.vertices[:-1]] + [int(loop[0].vertices[0])]
