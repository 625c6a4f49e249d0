"""How the normals of triangles turn with their corners."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array

from seatlook.model import FloatArray, IntArray


def normals(x: FloatArray, faces: IntArray) -> tuple[FloatArray, FloatArray]:
    """Unit normals (m, 3) of the triangles and twice their areas (m,) [m2]."""
    a, b, c = x[faces].transpose(1, 0, 2)
    normal = np.cross(b - a, c - a)
    size = np.linalg.norm(normal, axis=1)
    return normal / size[:, None], size


def opposite_sides(x: FloatArray, faces: IntArray) -> FloatArray:
    """The side (m, 3, 3) [m] across from every corner, counter-clockwise.

    A corner that moves by d changes twice the area vector by side x d.
    """
    corners = x[faces]
    return np.roll(corners, 1, axis=1) - np.roll(corners, -1, axis=1)


def normal_rates(x: FloatArray, faces: IntArray) -> FloatArray:
    """Derivative (m, 3, 3, 3) [1/m] of the unit normals: by [corner, axis, axis of the corner]."""
    normal, size = normals(x, faces)
    across = (np.eye(3) - normal[:, :, None] * normal[:, None]) / size[:, None, None]
    return np.asarray(across[:, None] @ cross_matrix(opposite_sides(x, faces)))


def normal_curvatures(x: FloatArray, faces: IntArray, pull: FloatArray) -> FloatArray:
    """Second derivative (m, 9, 9) of ``pull`` (m, 3) times the unit normals, by the corners."""
    normal, size = normals(x, faces)
    size = size[:, None]
    along = (pull * normal).sum(axis=1)[:, None]
    lateral = (pull - along * normal) / size
    both = normal[:, :, None] * lateral[:, None] + lateral[:, :, None] * normal[:, None]
    across = np.eye(3) - normal[:, :, None] * normal[:, None]
    bend = -((along / size)[:, :, None] * across + both) / size[:, :, None]
    sides = cross_matrix(opposite_sides(x, faces))
    blocks = np.einsum("tpki,tkl,tqlj->tpiqj", sides, bend, sides)
    twist = cross_matrix(lateral)
    for corner in range(3):
        blocks[:, corner - 1, :, corner] -= twist
        blocks[:, corner, :, corner - 1] += twist
    return np.asarray(blocks.reshape(-1, 9, 9))


def spread(blocks: FloatArray, faces: IntArray, count: int) -> csr_array:
    """Sparse (r m, 3 count) of blocks (m, r, 9) whose columns are the corners' positions."""
    places = (3 * faces[:, :, None] + np.arange(3)).reshape(-1, 1, 9)
    columns = np.broadcast_to(places, blocks.shape).ravel()
    rows = blocks.shape[0] * blocks.shape[1]
    return csr_array((blocks.ravel(), columns, 9 * np.arange(rows + 1)), shape=(rows, 3 * count))


def cross_matrix(a: FloatArray) -> FloatArray:
    """Matrices [a] with [a] b = a x b, (..., 3, 3)."""
    zero = np.zeros(a.shape[:-1])
    x, y, z = a[..., 0], a[..., 1], a[..., 2]
    rows = [zero, -z, y, z, zero, -x, -y, x, zero]
    return np.stack(rows, axis=-1).reshape(*a.shape, 3)
