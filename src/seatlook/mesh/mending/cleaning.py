"""Faces that are no part of a surface: duplicates, slivers, specks, cracks between neighbours."""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from seatlook.mesh.mending.skin import SLIVER_M, Skin, sides
from seatlook.mesh.surface import IntArray, boundary_sides, edges, face_areas

CRACK_M = 3e-4  # between borders that are one line
_SPECK = 0.01  # of the area of the largest piece


def drop_duplicates(skin: Skin) -> None:
    """Drop faces of the same corners as one before."""
    turn = skin.faces.argmin(axis=1)
    rows = np.arange(len(skin.faces))[:, None]
    turned = skin.faces[rows, (turn[:, None] + np.arange(3)) % 3]
    _, first = np.unique(turned, axis=0, return_index=True)
    again = np.ones(len(skin.faces), dtype=bool)
    again[first] = False
    if again.any():
        skin.note("faces that lay on the same again dropped", again.sum(),
                  skin.middle(int(np.flatnonzero(again)[0])))  # fmt: skip
        skin.keep(~again)


def slivers(skin: Skin) -> IntArray:
    """Return the faces (k,) that are lower than SLIVER_M."""
    longest = skin.side_lengths().max(axis=1)
    area = face_areas(skin.vertices, skin.faces)
    return np.flatnonzero(2 * area <= SLIVER_M * longest)


def mend_slivers(skin: Skin, *, asked: bool = False) -> None:
    """Collapse short sides, and flip the long side of flat faces to their neighbour."""
    flat = slivers(skin)
    if not len(flat):
        return
    count, place = len(flat), skin.middle(int(flat[0]))
    gone: set[int] = set()
    for _ in range(count):
        _collapse(skin, flat)
        flat = slivers(skin)
        if not len(flat) or not _flip(skin, flat, gone):
            break
        flat = slivers(skin)
    skin.note("slivers collapsed or flipped", count - len(slivers(skin)), place, asked=asked)


def _collapse(skin: Skin, flat: IntArray) -> None:
    """Make one vertex of the ends of sides as short as flat faces are low."""
    corners = skin.faces[flat]
    pairs = np.stack([corners, np.roll(corners, -1, axis=1)], axis=2).reshape(-1, 2)
    span = np.linalg.norm(skin.vertices[pairs[:, 0]] - skin.vertices[pairs[:, 1]], axis=1)
    skin.merge(_groups(pairs[span <= 2 * SLIVER_M], len(skin.vertices)))


def _flip(skin: Skin, flat: IntArray, gone: set[int]) -> bool:
    """Give the long side of flat faces to the two others; False where none could be.

    A side once given away does not come back: flat faces beside flat ones would be turned back
    and forth for ever. ``gone`` collects these sides.
    """
    table, n = sides(skin.faces), len(skin.vertices)
    lengths = skin.side_lengths()[flat]
    long = 3 * flat + lengths.argmax(axis=1)
    order = np.argsort(table.edge, kind="stable")
    start = np.searchsorted(table.edge[order], table.edge[long])
    touched: set[int] = set()
    shut = gone | set(_codes(edges(skin.faces), n).tolist())
    for side, first in zip(long.tolist(), start.tolist(), strict=True):
        if table.members[table.edge[side]] != 2:
            continue
        one, two = order[first], order[first + 1]
        other = int(two if one == side else one)
        f, g = side // 3, other // 3
        if f in touched or g in touched or table.forward[side] == table.forward[other]:
            continue
        a, b = skin.faces[f, side % 3], skin.faces[f, (side + 1) % 3]
        tip, far = skin.faces[f, (side + 2) % 3], skin.faces[g, (other + 2) % 3]
        before, after = _codes(np.array([[a, b], [tip, far]]), n).tolist()
        if tip == far or after in shut:
            continue
        skin.faces[f], skin.faces[g] = (a, far, tip), (far, b, tip)
        touched |= {f, g}
        shut.add(after)
        gone.add(before)
    return bool(touched)


def _codes(pairs: IntArray, n: int) -> IntArray:
    """Return one number (k,) for each pair (k, 2) of n vertices, in either order."""
    return np.asarray(pairs.min(axis=1) * n + pairs.max(axis=1))


def sew_cracks(skin: Skin) -> None:
    """Merge open borders that lie closer than CRACK_M to each other."""
    open_sides = boundary_sides(skin.faces)
    start, end = skin.faces.ravel(), np.roll(skin.faces, -1, axis=1).ravel()
    border = np.unique(np.concatenate([start[open_sides], end[open_sides]]))
    if not len(border):
        return
    tree = cKDTree(skin.vertices[border])
    pairs = border[tree.query_pairs(CRACK_M, output_type="ndarray").reshape(-1, 2)]
    # Ends of one short side are no crack.
    low, high = pairs.min(axis=1), pairs.max(axis=1)
    n = len(skin.vertices)
    pairs = pairs[~np.isin(low * n + high, np.minimum(start, end) * n + np.maximum(start, end))]
    if len(pairs):
        skin.note("vertices along cracks joined", len(pairs), skin.vertices[pairs[0, 0]])
        skin.merge(_groups(pairs, n))


def drop_specks(skin: Skin, piece: IntArray) -> IntArray:
    """Drop pieces far smaller than the largest; return the piece of each face that is left."""
    area = np.bincount(piece, face_areas(skin.vertices, skin.faces))
    small = area < _SPECK * area.max()
    gone = small[piece]
    if gone.any():
        what = f"loose specks dropped, of {gone.sum()} faces"
        skin.note(what, small.sum(), skin.middle(int(np.flatnonzero(gone)[0])))
        skin.keep(~gone)
    return np.asarray(np.unique(piece[~gone], return_inverse=True)[1])


def _groups(pairs: IntArray, n: int) -> IntArray:
    """Return the first vertex (n,) of the group that pairs (k, 2) join each vertex to."""
    ones = np.ones(len(pairs), dtype=np.int8)
    label = connected_components(coo_array((ones, tuple(pairs.T)), shape=(n, n)), directed=False)[1]
    first = np.full(int(label.max(initial=-1)) + 1, n)
    np.minimum.at(first, label, np.arange(n))
    return np.asarray(first[label])
