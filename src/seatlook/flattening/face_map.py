"""The map of a patch's faces to the plane: its derivative, its stretches, its turned faces."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from seatlook.flattening.fabric_sheet import Gradient, grain_strain
from seatlook.mesh import face_normals
from seatlook.model import FloatArray, IntArray

_MARGIN = 0.8  # of the way to the first face without area, that a step may go


def gradient_of(vertices: FloatArray, faces: IntArray) -> Gradient:
    """Operators (m, n) for the derivative along each face's own two axes."""
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
    rows = np.repeat(np.arange(len(faces)), 3)
    shape = (len(faces), len(vertices))
    return tuple(  # type: ignore[return-value]
        sp.csr_array((d.ravel(), (rows, faces.ravel())), shape=shape) for d in (dx, dy)
    )


def face_axes(vertices: FloatArray, faces: IntArray) -> FloatArray:
    """Unit vectors (2, m, 3) along each face's first edge and across it."""
    along = vertices[faces[:, 1]] - vertices[faces[:, 0]]
    along = along / np.linalg.norm(along, axis=1, keepdims=True)
    return np.stack([along, np.cross(face_normals(vertices, faces), along)])


def grown(gradient: Gradient, growth: FloatArray, axes: FloatArray) -> Gradient:
    """Derivatives with respect to lengths after growth: strain counts from the grown shape."""
    inverse = np.linalg.inv(np.einsum("amd,mde,bme->mab", axes, growth, axes))
    gx, gy = gradient
    return tuple(
        (sp.diags(inverse[:, 0, k]) @ gx + sp.diags(inverse[:, 1, k]) @ gy).tocsr() for k in (0, 1)
    )


def deformation(x: FloatArray, gradient: Gradient) -> FloatArray:
    """Return F (m, 2, 2) of the map from space to the plane."""
    return np.stack([g @ x for g in gradient], axis=2)


def stretches(vertices: FloatArray, faces: IntArray, flat: FloatArray) -> FloatArray:
    """Return the principal stretches (m, 2), small one first, of the map from flat to space."""
    F = deformation(flat, gradient_of(vertices, faces))
    return np.asarray(1 / np.linalg.svd(F, compute_uv=False))


def strains_by_grain(vertices: FloatArray, faces: IntArray, flat: FloatArray) -> FloatArray:
    """Return Green strains (m, 3) of the map from flat to space: warp, weft, angle 2 E12."""
    return grain_strain(flat, gradient_of(vertices, faces))


def area_ratios(x: FloatArray, gradient: Gradient) -> FloatArray:
    """Return each face's area (m,) in the plane over that in space, below 0 where it is turned."""
    F = deformation(x, gradient)
    return np.asarray(F[:, 0, 0] * F[:, 1, 1] - F[:, 0, 1] * F[:, 1, 0])


def largest_step(x: FloatArray, step: FloatArray, gradient: Gradient) -> float:
    """Return the largest fraction up to 1 of a step (n, 2) that turns no face over.

    The area of a face is quadratic in the fraction; its smallest root above 0 is where the face
    has no area. A margin is kept from it.
    """
    at, change = deformation(x, gradient), deformation(step, gradient)
    a, c = np.linalg.det(change), np.linalg.det(at)
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
