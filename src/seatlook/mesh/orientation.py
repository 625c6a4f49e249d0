"""Which side of a shell is which: normals made to agree across shared edges."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from seatlook.mesh.surface import FloatArray, IntArray


@dataclass(frozen=True, slots=True)
class Orientation:
    """How elements must be turned so that neighbours agree.

    Parameters
    ----------
    sign : (e,) float64     -1 for elements to be turned over
    piece : (e,) int64      connected piece of each element; edges of three elements do not connect
    one_sided : pieces that cannot be oriented, such as a Moebius strip; their elements keep +1
    """

    sign: FloatArray
    piece: IntArray
    one_sided: int


def agree(corners: IntArray, area: FloatArray) -> Orientation:
    """Make the normals of each connected piece agree, turning the smaller area over.

    Every element stands in a graph twice, as it is and turned over; neighbours are linked the way
    they agree. An orientable piece then falls into two halves, of which one is taken.

    Parameters
    ----------
    corners : (e, 4) int64      triangles repeat a corner
    area : (e,) float64 [m2]

    Examples
    --------
    >>> two = np.array([[0, 1, 2, 2], [1, 2, 3, 3], [2, 3, 4, 4]])
    >>> agree(two, np.array([1.0, 1.0, 1.0])).sign.tolist()
    [1.0, -1.0, 1.0]
    """
    e = len(corners)
    a, b, same = _neighbours(corners)
    turned = np.where(same, 0, e)
    left = np.concatenate([a, a + e])
    right = np.concatenate([b + turned, b + e - turned])
    graph = coo_array((np.ones(len(left), dtype=np.int8), (left, right)), shape=(2 * e, 2 * e))
    count, sheet = connected_components(graph, directed=False)
    upright, flipped = sheet[:e], sheet[e:]
    one_sided = upright == flipped
    # The sheet that turns less area over wins; of equals the one that keeps the first element.
    upright_area = np.bincount(upright, area, count)
    first = np.full(count, e)
    np.minimum.at(first, upright, np.arange(e))
    stays = upright_area[upright] - upright_area[flipped]
    scale = 1e-9 * (upright_area[upright] + upright_area[flipped])
    tie = np.abs(stays) <= scale
    good = np.where(tie, first[upright] < first[flipped], stays > 0) | one_sided
    piece = np.unique(np.minimum(upright, flipped), return_inverse=True)[1]
    return Orientation(
        sign=np.where(good, 1.0, -1.0),
        piece=piece.astype(np.int64),
        one_sided=len(np.unique(upright[one_sided])),
    )


def _neighbours(corners: IntArray) -> tuple[IntArray, IntArray, np.ndarray]:
    """Return pairs of elements on an edge of exactly two, and whether their normals agree."""
    start, end = corners.ravel(), np.roll(corners, -1, axis=1).ravel()
    owner = np.repeat(np.arange(len(corners)), 4)
    real = start != end
    start, end, owner = start[real], end[real], owner[real]
    key = np.minimum(start, end) * (int(corners.max(initial=0)) + 1) + np.maximum(start, end)
    order = np.argsort(key, kind="stable")
    key, forward, owner = key[order], (start < end)[order], owner[order]
    first = np.flatnonzero(np.concatenate([[True], key[1:] != key[:-1]]))
    pairs = first[np.diff(np.append(first, len(key))) == 2]
    return owner[pairs], owner[pairs + 1], forward[pairs] != forward[pairs + 1]
