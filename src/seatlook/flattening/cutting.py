"""A design surface cut into panels along seam lines that are drawn onto it."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from seatlook import mesh
from seatlook.errors import InputError, Problem
from seatlook.flattening.surface import DesignSurface
from seatlook.mesh.imprint import Imprinted, imprint
from seatlook.mesh.line_ends import lay_on
from seatlook.model import FloatArray, IntArray

LINE_TOLERANCE = 0.002  # [m] between a seam line and the surface, the border, another line
SMALLEST_PANEL = 1e-4  # [m2]


def cut_along(surface: DesignSurface, lines: Mapping[str, FloatArray]) -> DesignSurface:
    """Cut a surface into panels along lines; where its panels met before does not matter.

    A panel is called after the panel of the surface given that most of it was; several of one name
    are numbered from front to rear, then from the occupant's right to the left.

    Parameters
    ----------
    surface : DesignSurface
    lines : name -> (k, 3) [m]   closer than ``LINE_TOLERANCE`` to the surface; each ends on the
                                 border or on another line, or is closed

    Returns
    -------
    DesignSurface
        Its seams have the names of the lines.

    Raises
    ------
    InputError
        A line lies off the surface, ends on it without parting it, or leaves it; a panel has
        a hole or less than 1 cm2.
    """
    laid = lay_on(surface.vertices, surface.faces, lines, tolerance=LINE_TOLERANCE)
    drawing = imprint(surface.vertices, surface.faces, laid)
    label = _parts(drawing)
    panel, names = _named(drawing, label, surface)
    cut = DesignSurface(
        vertices=drawing.vertices,
        faces=drawing.faces,
        panel=panel,
        panel_names=names,
        seam_lines=MappingProxyType(drawing.edges),
    )
    cut.patches()  # refuses panels with holes
    return cut


def _parts(drawing: Imprinted) -> IntArray:
    """Return the part (m,) of each face, refusing lines with one part on both sides."""
    faces = drawing.faces
    half = np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    order = np.lexsort(half.T)
    half, owner = half[order], np.repeat(np.arange(len(faces)), 3)[order]
    index = np.flatnonzero((half[1:] == half[:-1]).all(axis=1))
    pairs = np.column_stack([owner[index], owner[index + 1]])
    names = [drawing.edges.get((a, b)) for a, b in half[index].tolist()]
    links = pairs[[name is None for name in names]]
    graph = sp.coo_array((np.ones(len(links)), links.T), shape=(len(faces), len(faces)))
    label = connected_components(graph, directed=False)[1]
    within = label[pairs[:, 0]] == label[pairs[:, 1]]
    idle_lines = {
        name for name, same in zip(names, within, strict=True) if same and name is not None
    }
    if idle_lines:
        raise InputError(
            Problem(
                key=f"curve.{name}.points_mm",
                got="the same panel on both sides",
                expected="a line that separates two panels from end to end",
            )
            for name in sorted(idle_lines)
        )
    return np.asarray(label, dtype=np.int64)


def _named(
    drawing: Imprinted, label: IntArray, surface: DesignSurface
) -> tuple[IntArray, tuple[str, ...]]:
    """Return the panel of each face and the panels' names, those of one name front to rear."""
    area = mesh.face_areas(drawing.vertices, drawing.faces)
    whole = np.bincount(label, area)
    middle = drawing.vertices[drawing.faces].mean(axis=1)
    x, y, _ = (np.round(np.bincount(label, area * m) / whole, 3) for m in middle.T)
    before = np.zeros((len(whole), len(surface.panel_names)))
    np.add.at(before, (label, surface.panel[drawing.source]), area)
    base = before.argmax(axis=1)
    order = np.lexsort([x, y, base])
    names: list[str] = []
    for part in order:
        stem = surface.panel_names[base[part]]
        alike = np.count_nonzero(base == base[part])
        number = 1 + np.count_nonzero(base[order[: len(names)]] == base[part])
        names.append(stem if alike == 1 else f"{stem}_{number}")
    small = [
        Problem(
            key=f"panel {name}",
            got=f"{1e4 * whole[part]:.2g} cm2 near {(1e3 * middle[label == part][0]).round(1)} mm",
            expected=f"at least {1e4 * SMALLEST_PANEL:g} cm2",
            hint="do two lines cross just before they end?",
        )
        for name, part in zip(names, order, strict=True)
        if whole[part] < SMALLEST_PANEL
    ]
    if small:
        raise InputError(small)
    return np.argsort(order)[label], tuple(names)
