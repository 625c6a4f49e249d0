"""Lines drawn into a triangle mesh, so that edges of it run along them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from seatlook.errors import InputError, Problem
from seatlook.mesh.closest import closest_places
from seatlook.mesh.drawing import Drawing, Edge, tidy

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]


class Imprinted(NamedTuple):
    """A mesh with lines in it.

    Parameters
    ----------
    vertices : (n, 3) [m]     those of the mesh given first, in their order; some without faces
    faces : (m, 3) int64
    source : (m,) int64       the face of the mesh given that each is a part of
    edges : edge, smaller vertex first -> name of the line that it lies on
    """

    vertices: FloatArray
    faces: IntArray
    source: IntArray
    edges: dict[Edge, str]


def imprint(
    vertices: FloatArray, faces: IntArray, lines: Mapping[str, FloatArray], *, border: bool = True
) -> Imprinted:
    """Split the faces of a mesh where lines run over it.

    Each point of a line becomes a vertex at the closest place; between two points the line is the
    cut of the surface with the plane through both and the mean of their normals. Where the line
    passes a vertex within 5 % of an edge, that vertex moves onto it, if the surface stays within
    0.05 mm and the vertex lies on no border and no other line: splitting there would leave slivers.
    What narrow faces are left along the lines are merged, or their edges turned, within the same
    0.05 mm; vertices that are then without faces stay in the list.

    Parameters
    ----------
    vertices : (n, 3) [m]; faces : (m, 3)
    lines : name -> (k, 3) [m]; a closed line repeats its first point
    border : whether vertices of a straight border may be merged too

    Raises
    ------
    InputError
        A line leaves the surface between two of its points, or the surface folds back there.
    """
    drawing = Drawing(vertices, faces)
    problems: list[Problem] = []
    for name, line in lines.items():
        on = closest_places(line, vertices, faces, reach=np.inf)
        try:
            drawing.draw(name, line - on.offset, on.face)
        except InputError as error:
            problems += error.problems
    if problems:
        raise InputError(problems)
    tidy(drawing, border=border)
    numbers = sorted(drawing.faces)
    return Imprinted(
        vertices=np.array(drawing.points),
        faces=np.array([drawing.faces[f] for f in numbers], dtype=np.int64),
        source=np.array([drawing.source[f] for f in numbers], dtype=np.int64),
        edges=drawing.edges,
    )
