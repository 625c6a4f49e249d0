"""The free borders of a design surface: one closed curve each, and the edges that lie on it."""

from __future__ import annotations

import numpy as np

from seatlook import mesh
from seatlook.flattening.surface import FREE, DesignSurface, Side, sides
from seatlook.mesh.places import border_names
from seatlook.model import Border


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
    result = []
    for loop, curve, name in zip(loops, curves, border_names(curves), strict=True):
        arc = mesh.arc_length(curve)
        count = np.cumsum([0, *(side.count for side in loop)])
        result.append(
            Border(
                name=name,
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
