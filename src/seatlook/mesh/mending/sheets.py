"""Surfaces taken apart where more than two faces meet, and put together as solids have it."""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from seatlook.mesh.mending.skin import Sides, Skin, sides
from seatlook.mesh.surface import FloatArray, IntArray, face_areas, face_vectors, winding

_FIN = 0.1  # of the area; a smaller sheet that ends in the air is no part of a body


def mend_crowded_edges(skin: Skin) -> None:
    """Make a surface in which each edge has one or two faces, and each vertex one fan of them.

    Where more meet, sheets that end in the air and walls with the same on both sides are dropped;
    what is left is joined in pairs that enclose the solid between them.
    """
    crowded = np.flatnonzero(sides(skin.faces).crowd() > 2)
    if len(crowded):
        count = np.unique(sides(skin.faces).edge[crowded]).size
        place = skin.middle(int(crowded[0]) // 3)
        faces = len(skin.faces)
        _drop_fins(skin)
        _drop_walls(skin)
        what = "edges of more than two faces taken apart"
        if len(skin.faces) < faces:
            what += f", {faces - len(skin.faces)} faces of fins and inner walls dropped"
        skin.note(what, count, place)
    _separate(skin)


def _pairs(table: Sides, sides_kept: IntArray) -> IntArray:
    """Return pairs (k, 2) of sides that lie alone on an edge."""
    order = sides_kept[np.argsort(table.edge[sides_kept], kind="stable")]
    edge = table.edge[order]
    return np.asarray(np.column_stack([order[:-1], order[1:]])[edge[:-1] == edge[1:]])


def _patches(skin: Skin, table: Sides) -> IntArray:
    """Number the patches (m,) that edges of two faces connect."""
    pairs = _pairs(table, np.flatnonzero(table.crowd() == 2)) // 3
    m = len(skin.faces)
    graph = coo_array((np.ones(len(pairs), dtype=np.int8), tuple(pairs.T)), shape=(m, m))
    return np.asarray(connected_components(graph, directed=False)[1])


def _drop_fins(skin: Skin) -> None:
    """Drop small patches with an open side that hang on a crowded edge, one after the other."""
    while True:
        table = sides(skin.faces)
        crowd, patch = table.crowd().reshape(-1, 3), _patches(skin, table)
        area = np.bincount(patch, face_areas(skin.vertices, skin.faces))
        fin = area < _FIN * area.sum()
        for some in ((crowd == 1).any(axis=1), (crowd > 2).any(axis=1)):
            fin &= np.bincount(patch, some) > 0
        if not fin.any():
            return
        skin.keep(~fin[patch])


def _drop_walls(skin: Skin) -> None:
    """Drop patches with solid on both sides, or on none."""
    table = sides(skin.faces)
    crowd, patch = table.crowd().reshape(-1, 3), _patches(skin, table)
    bordering = np.flatnonzero(np.bincount(patch, (crowd > 2).any(axis=1)) > 0)
    area = face_areas(skin.vertices, skin.faces)
    across = face_vectors(skin.vertices, skin.faces)  # twice as long as their areas
    wall = np.zeros(int(patch.max()) + 1, dtype=bool)
    triangles = skin.vertices[skin.faces]
    for number in bordering:
        face = int(np.where(patch == number, area, -1.0).argmax())
        step = 1e-3 * across[face] / np.sqrt(max(area[face], 1e-12))
        inside, outside = (
            winding(triangles[face].mean(axis=0) + sign * step, triangles) for sign in (-1, 1)
        )
        wall[number] = (inside > 0.5) == (outside > 0.5)
    if not wall.all():
        skin.keep(~wall[patch])


def _separate(skin: Skin) -> None:
    """Give each fan of faces a vertex of its own, and each pair of faces an edge of its own."""
    table = sides(skin.faces)
    crowd = table.crowd()
    pairs = np.concatenate([_pairs(table, np.flatnonzero(crowd == 2)), _solid_pairs(skin, table)])
    # Side k of a face runs from corner k to corner k + 1: which corners of a pair are one place.
    start, end = pairs, pairs - pairs % 3 + (pairs + 1) % 3
    along = skin.faces.ravel()[start[:, 0]] == skin.faces.ravel()[start[:, 1]]
    first = np.concatenate([start[:, 0], end[:, 0]])
    second = np.concatenate(
        [np.where(along, start[:, 1], end[:, 1]), np.where(along, end[:, 1], start[:, 1])]
    )
    n = skin.faces.size
    graph = coo_array((np.ones(len(first), dtype=np.int8), (first, second)), shape=(n, n))
    fan = connected_components(graph, directed=False)[1]
    corner = skin.faces.ravel()
    vertex = np.full(int(fan.max()) + 1, -1)
    vertex[fan] = corner
    if len(vertex) == len(np.unique(corner)):
        return  # each vertex has one fan
    used, place = np.unique(vertex, return_index=True)
    shared = len(vertex) - len(used)
    if len(_solid_pairs(skin, table)) == 0 and not (crowd > 2).any():
        twice = np.setdiff1d(np.arange(len(vertex)), place)
        what = "vertices in which parts only touch taken apart"
        skin.note(what, shared, skin.vertices[vertex[twice[0]]])
    skin.vertices, skin.faces = skin.vertices[vertex], fan.reshape(-1, 3).astype(np.int64)


def _solid_pairs(skin: Skin, table: Sides) -> IntArray:
    """Pair the sides (k, 2) at crowded edges that have solid between them."""
    crowded = np.flatnonzero(table.crowd() > 2)
    found = []
    for edge in np.unique(table.edge[crowded]):
        group = crowded[table.edge[crowded] == edge]
        angle = _angles(skin, group, table)
        ordered = group[np.argsort(angle, kind="stable")]
        following = np.roll(ordered, -1)
        # Turning about the edge, solid begins at a face that runs against it.
        good = ~table.forward[ordered] & table.forward[following]
        found.append(np.column_stack([ordered, following])[good])
    return np.concatenate([np.zeros((0, 2), dtype=np.int64), *found])


def _angles(skin: Skin, group: IntArray, table: Sides) -> FloatArray:
    """Return the angles (g,) of faces about the edge that their sides ``group`` lie on."""
    corner = skin.faces.ravel()
    start, end = corner[group[0]], corner[group[0] - group[0] % 3 + (group[0] + 1) % 3]
    low, high = skin.vertices[min(start, end)], skin.vertices[max(start, end)]
    axis = (high - low) / np.linalg.norm(high - low)
    tip = skin.vertices[corner[group - group % 3 + (group + 2) % 3]] - low
    tip = tip - (tip @ axis)[:, None] * axis
    u = tip[0] / np.linalg.norm(tip[0])
    return np.asarray(np.arctan2(tip @ np.cross(axis, u), tip @ u))
