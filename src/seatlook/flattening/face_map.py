"""The map of a patch's faces to the plane: its derivative, its stretches, its turned faces."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from seatlook.mesh import face_normals
from seatlook.model import FloatArray, IntArray

_MARGIN = 0.8  # of the way to the first face without area, that a step may go


@dataclass(frozen=True, slots=True)
class Gradient:
    """Derivatives of what is linear in each face, along two axes of the face.

    Parameters
    ----------
    faces : (m, 3) int64
    slopes : (m, 3, 2) [1/m]   of the function that is 1 at one corner and 0 at the others
    """

    faces: IntArray
    slopes: FloatArray

    def at(self, x: FloatArray) -> FloatArray:
        """Return F (m, 2, 2) of the map of vertices to positions (n, 2) in the plane."""
        corners = x[self.faces].transpose(0, 2, 1)
        return np.asarray(corners @ self.slopes)

    def operators(self, n: int) -> tuple[sp.csr_array, sp.csr_array]:
        """Return the derivatives as matrices (m, n)."""
        rows = np.repeat(np.arange(len(self.faces)), 3)
        shape = (len(self.faces), n)
        x, y = (
            sp.csr_array((self.slopes[:, :, k].ravel(), (rows, self.faces.ravel())), shape=shape)
            for k in (0, 1)
        )
        return x, y


def gradient_of(vertices: FloatArray, faces: IntArray) -> Gradient:
    """Derivatives along each face's own two axes: its first edge, and across it."""
    p = vertices[faces]
    u, v = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    axes = face_axes(vertices, faces)
    length = np.linalg.norm(u, axis=1)
    vx, vy = np.einsum("kmd,md->km", axes, v)
    zero = np.zeros_like(vx)
    # Rows of the inverse edge matrix give the hat functions' gradients of corners 1 and 2.
    dx = np.column_stack([zero, 1 / length, zero])
    dy = np.column_stack([zero, -vx / (length * vy), 1 / vy])
    dx[:, 0], dy[:, 0] = -dx.sum(axis=1), -dy.sum(axis=1)
    return Gradient(faces, np.stack([dx, dy], axis=2))


def face_axes(vertices: FloatArray, faces: IntArray) -> FloatArray:
    """Unit vectors (2, m, 3) along each face's first edge and across it."""
    along = vertices[faces[:, 1]] - vertices[faces[:, 0]]
    along = along / np.linalg.norm(along, axis=1, keepdims=True)
    return np.stack([along, np.cross(face_normals(vertices, faces), along)])


def grown(gradient: Gradient, growth: FloatArray, axes: FloatArray) -> Gradient:
    """Derivatives with respect to lengths after growth: strain counts from the grown shape."""
    inverse = np.linalg.inv(np.einsum("amd,mde,bme->mab", axes, growth, axes))
    return Gradient(gradient.faces, gradient.slopes @ inverse)


def stretches(vertices: FloatArray, faces: IntArray, flat: FloatArray) -> FloatArray:
    """Return the principal stretches (m, 2), small one first, of the map from flat to space."""
    F = gradient_of(vertices, faces).at(flat)
    return np.asarray(1 / np.linalg.svd(F, compute_uv=False))


def area_ratios(x: FloatArray, gradient: Gradient) -> FloatArray:
    """Return each face's area (m,) in the plane over that in space, below 0 where it is turned."""
    return determinants(gradient.at(x))


def determinants(F: FloatArray) -> FloatArray:
    """Return the determinant (m,) of matrices (m, 2, 2)."""
    return np.asarray(F[:, 0, 0] * F[:, 1, 1] - F[:, 0, 1] * F[:, 1, 0])


def largest_step(x: FloatArray, step: FloatArray, gradient: Gradient) -> float:
    """Return the largest fraction up to 1 of a step (n, 2) that turns no face over.

    The area of a face is quadratic in the fraction; its smallest root above 0 is where the face
    has no area. A margin is kept from it.
    """
    at, change = gradient.at(x), gradient.at(step)
    a, c = determinants(change), determinants(at)
    b = (
        at[:, 0, 0] * change[:, 1, 1]
        + change[:, 0, 0] * at[:, 1, 1]
        - at[:, 0, 1] * change[:, 1, 0]
        - change[:, 0, 1] * at[:, 1, 0]
    )
    inner = b * b - 4 * a * c
    root = np.sqrt(np.maximum(inner, 0.0))
    # c > 0, so this form loses no digits and its sign is that of the smallest root above 0.
    with np.errstate(divide="ignore", invalid="ignore"):
        first = np.where(b < root, 2 * c / (root - b), np.inf)
    first = first[(inner >= 0) & (first > 0)]
    return min(1.0, _MARGIN * float(first.min(initial=np.inf)))
