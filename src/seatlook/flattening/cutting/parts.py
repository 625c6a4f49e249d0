"""The connected parts of a surface that lines divide, each a panel with a name."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from seatlook import mesh
from seatlook.errors import InputError, Problem
from seatlook.flattening.surface import DesignSurface
from seatlook.model import IntArray

SMALLEST_PANEL = 1e-4  # [m2]


def parted(surface: DesignSurface, *, rejoined: bool = False) -> DesignSurface:
    """Make every connected part a panel; seam lines and borders between panels divide.

    A part is called after the panel that most of it was; several of one name are numbered from
    front to rear, then from the occupant's right to the left.

    Parameters
    ----------
    surface : DesignSurface
    rejoined : where panels met before does not matter, lines alone divide; parts below
        ``SMALLEST_PANEL`` are refused

    Raises
    ------
    InputError
        A part is too small to be a panel.
    """
    label = _labels(surface, rejoined=rejoined)
    if not rejoined and label.max(initial=-1) + 1 == len(np.unique(surface.panel)):
        return surface
    panel, names = _named(surface, label)
    result = replace(surface, panel=panel, panel_names=names)
    if rejoined:
        _check_areas(result)
    return result


def _labels(surface: DesignSurface, *, rejoined: bool) -> IntArray:
    """Return the part (m,) of each face; lines that end in a part do not divide it."""
    faces = surface.faces
    pairs = mesh.inner_sides(faces)
    half = np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)[pairs[:, 0]], axis=1)
    link = np.array([(a, b) not in surface.seam_lines for a, b in half.tolist()], dtype=bool)
    owner = surface.panel[pairs // 3]
    if not rejoined:
        link &= owner[:, 0] == owner[:, 1]
    links = pairs[link] // 3
    graph = sp.coo_array((np.ones(len(links)), links.T), shape=(len(faces), len(faces)))
    return np.asarray(connected_components(graph, directed=False)[1], dtype=np.int64)


def _named(surface: DesignSurface, label: IntArray) -> tuple[IntArray, tuple[str, ...]]:
    """Return the panel of each face and the panels' names, those of one name front to rear."""
    area = mesh.face_areas(surface.vertices, surface.faces)
    whole = np.bincount(label, area)
    middle = surface.vertices[surface.faces].mean(axis=1)
    x, y, _ = (np.round(np.bincount(label, area * m) / whole, 3) for m in middle.T)
    before = np.zeros((len(whole), len(surface.panel_names)))
    np.add.at(before, (label, surface.panel), area)
    base = before.argmax(axis=1)
    order = np.lexsort([x, y, base])
    names: list[str] = []
    for part in order:
        stem = surface.panel_names[base[part]]
        alike = np.count_nonzero(base == base[part])
        number = 1 + np.count_nonzero(base[order[: len(names)]] == base[part])
        names.append(stem if alike == 1 else f"{stem}_{number}")
    return np.argsort(order)[label], tuple(names)


def _check_areas(surface: DesignSurface) -> None:
    """Refuse parts that are too small to be panels."""
    face = mesh.face_areas(surface.vertices, surface.faces)
    small = [
        Problem(
            key=f"panel {name}",
            got=f"{1e4 * whole:.2g} cm2 near {1e3 * corner.round(4)} mm",
            expected=f"at least {1e4 * SMALLEST_PANEL:g} cm2",
            hint="do two lines cross just before they end?",
        )
        for i, name in enumerate(surface.panel_names)
        if (whole := face[surface.panel == i].sum()) < SMALLEST_PANEL
        for corner in surface.vertices[surface.faces[surface.panel == i][:1]].mean(axis=1)
    ]
    if small:
        raise InputError(small)
