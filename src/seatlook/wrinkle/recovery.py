"""From faces to vertices and back: recovered curvature, its error, and the smooth design shape."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.sparse import coo_array, csc_array, csr_array, diags_array
from scipy.sparse.linalg import splu

from seatlook.errors import InputError
from seatlook.mesh import angles, boundary_sides, face_areas
from seatlook.mesh.kinematics import deformation_gradient, principal_values
from seatlook.model import Cover, FloatArray, IntArray
from seatlook.wrinkle.jet import vertex_curvature

_REGULAR = 0.02  # determinant of a patch's fit over that of orthogonal axes; below, it is a guess
DESIGN_WAVELENGTH = 0.045  # [m] shorter waves are wrinkles, longer ones the shape that was drawn


def recover(rest: FloatArray, faces: IntArray, values: FloatArray) -> FloatArray:
    """Carry values of faces to the vertices.

    At each vertex a linear field is fitted to the faces around it, weighted by area
    (superconvergent patch recovery, Zienkiewicz and Zhu 1992), and once more to what the first fit
    misses: fitting over a patch lowers a peak, and the second pass gives back what the first took.
    A plain mean would take the centre of a lopsided patch for the vertex. Panels share no vertices,
    so nothing is carried across a seam.

    Parameters
    ----------
    rest : (n, 2) float64 [m]; faces : (m, 3) int64
    values : (m, ...) float64     scalars or tensors, in axes that are the same for all faces

    Returns
    -------
    (n, ...) float64; a vertex without a face has zeros
    """
    flat = values.reshape(len(values), -1)
    patches = _Patches.of(rest, faces)
    first = patches.at_vertices(flat)
    full = first + patches.at_vertices(flat - first[faces].mean(axis=1))
    return np.asarray(full.reshape(len(rest), *values.shape[1:]))


def recovery_error(rest: FloatArray, faces: IntArray, values: FloatArray) -> FloatArray:
    """Difference (m,) between a scalar per face and its mean over the patch around the face.

    An estimate of the error of discretisation (Zienkiewicz and Zhu 1987) on the safe side: on a
    sine resolved by 8 to 24 elements its rms is 1.0 to 1.7 times the true one. The fit is made once
    only; the second pass of ``recover`` would follow the error itself.
    """
    at_vertices = _Patches.of(rest, faces).at_vertices(values[:, None])
    return np.asarray(values - at_vertices[faces].mean(axis=1)[:, 0])


@dataclass(frozen=True, slots=True)
class _Patches:
    """Which faces each vertex looks at, and with which weight: rows of a matrix (n, m)."""

    weights: csr_array

    @classmethod
    def of(cls, rest: FloatArray, faces: IntArray) -> _Patches:
        """Fit a linear field around each vertex; with too few faces to the next ring as well."""
        n, m = len(rest), len(faces)
        touch = csr_array(
            (np.ones(3 * m), (faces.ravel(), np.repeat(np.arange(m), 3))), shape=(n, m)
        )
        near = touch.tocoo()
        vertex, face = near.row.astype(np.int64), near.col.astype(np.int64)
        weight, good = _fit_weights(rest, faces, vertex, face)
        lone = np.flatnonzero(~good & (np.diff(touch.indptr) > 0))
        wide = (touch[lone] @ touch.T @ touch).tocoo()
        keep = good[vertex]
        vertex = np.concatenate([vertex[keep], lone[wide.row]])
        face = np.concatenate([face[keep], wide.col.astype(np.int64)])
        weight, _ = _fit_weights(rest, faces, vertex, face)
        return cls(csr_array((weight, (vertex, face)), shape=(n, m)))

    def at_vertices(self, values: FloatArray) -> FloatArray:
        """Values (n, c) at the vertices from those (m, c) of the faces."""
        return np.asarray(self.weights @ values)


def _fit_weights(
    rest: FloatArray, faces: IntArray, vertex: IntArray, face: IntArray
) -> tuple[FloatArray, np.ndarray]:
    """Weight of each pair in the value at the vertex; whether the patch fixes a linear field (n,).

    Where it does not, the weights are those of the mean.
    """
    n, area = len(rest), face_areas(rest, faces)
    w = area[face]
    step = rest[faces].mean(axis=1)[face] - rest[vertex]
    total = np.maximum(np.bincount(vertex, w, n), 1e-300)
    size = np.sqrt(np.bincount(vertex, w * (step**2).sum(axis=1), n) / total)
    u = step / np.maximum(size, 1e-300)[vertex, None]
    basis = np.column_stack([np.ones(len(u)), u])
    matrix = np.empty((n, 3, 3))
    for i in range(3):
        for j in range(i + 1):
            matrix[:, i, j] = matrix[:, j, i] = (
                np.bincount(vertex, w * basis[:, i] * basis[:, j], n) / total
            )
    diagonal = np.prod(np.diagonal(matrix, axis1=1, axis2=2), axis=1)
    good = (np.linalg.det(matrix) > _REGULAR * diagonal) & (np.bincount(vertex, minlength=n) > 3)
    first = np.zeros((n, 3))
    first[:, 0] = 1.0
    first[good] = np.linalg.inv(matrix[good])[:, 0]
    return np.asarray(w / total[vertex] * np.einsum("pi,pi->p", first[vertex], basis)), good


def low_passed(
    cover: Cover,
    positions: FloatArray,
    *,
    wavelength: float | FloatArray = DESIGN_WAVELENGTH,
    within: npt.NDArray[np.bool_] | None = None,
) -> FloatArray:
    """Smooth shape (n, 3) [m]: waves shorter than ``wavelength`` removed, sewn lines held.

    Outlines of panels and all hooked or framed points keep their place, so an intended trench or
    bolster root stays. Half of a wave of the cut-off length passes; of a third of it, one part in
    eighty.

    Parameters
    ----------
    wavelength : [m], or (m, 2, 2) [m] in rest axes where it differs by place and direction: a wave
        along an eigenvector goes where it is shorter than the eigenvalue
    within : (n,) bool    vertices to be moved, to save time on large covers; at one and a half
        wavelengths from those that are not, the shape is that of the whole to one part in 700

    Raises
    ------
    InputError
        A wavelength of 0 or less.
    """
    field = np.asarray(wavelength)
    least = float(principal_values(field)[1].min() if field.ndim else field)
    if not least > 0:
        raise InputError.single("wavelength", got=f"{least:g}", expected="above 0")
    smooth, moved = np.array(positions), ~_held(cover)
    if within is not None:
        moved &= within
    if not moved.any():
        return smooth
    node, faces, near = _two_rings(moved, cover.faces)
    stiffness, mass = laplacian(cover.rest[node], faces, len(node))
    length4 = float((1.0 if field.ndim else field / (2 * np.pi)) ** 4)
    if field.ndim:
        length = field[near] / (2 * np.pi)
        stiffness = _diffusion(cover.rest[node], faces, length @ length, len(node))
    matrix = diags_array(mass) + length4 * stiffness @ diags_array(1.0 / mass) @ stiffness
    free = np.flatnonzero(moved[node])
    # Smoothing what lies beside a held point: its known part goes to the right-hand side.
    rows = csc_array(matrix)[free]
    known = smooth[node]
    right = (mass[:, None] * known)[free]
    known[free] = 0.0
    smooth[node[free]] = splu(csc_array(rows[:, free])).solve(right - rows @ known)
    return smooth


def _two_rings(
    moved: npt.NDArray[np.bool_], faces: IntArray
) -> tuple[IntArray, IntArray, npt.NDArray[np.bool_]]:
    """Vertices (k,) up to two rings around those moved; their faces, numbered among them; which.

    As far as the fourth-order operator looks.
    """
    near = np.array(moved)
    for _ in range(2):
        touched = near[faces].any(axis=1)
        near[faces[touched]] = True
    number = np.cumsum(near) - 1
    return np.flatnonzero(near), number[faces[touched]], np.asarray(touched)


def shape_curvature(cover: Cover, positions: FloatArray) -> FloatArray:
    """Curvature (m, 2, 2) [1/m] of a shape of the cover in warp/weft axes, positive on a crown."""
    at_vertices = vertex_curvature(positions, cover.faces)
    F = deformation_gradient(cover.rest, positions, cover.faces)
    mean = at_vertices[cover.faces].mean(axis=1)
    return np.asarray(np.swapaxes(F, 1, 2) @ mean @ F)


def _held(cover: Cover) -> np.ndarray:
    """Vertices on outlines, hooks and frames."""
    held = np.zeros(len(cover.rest), dtype=bool)
    held[cover.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)[boundary_sides(cover.faces)]] = True
    for anchor in cover.anchors:
        held[anchor.points.vertices[anchor.points.weights > 0]] = True
    return held


def laplacian(rest: FloatArray, faces: IntArray, n: int) -> tuple[csc_array, FloatArray]:
    """Cotangent stiffness (n, n) and lumped mass (n,) [m2] of the flat panels."""
    corner = angles(rest, faces)
    cotangent = 1.0 / np.tan(corner)
    i, j = faces[:, [1, 2, 0]].ravel(), faces[:, [2, 0, 1]].ravel()
    w = 0.5 * cotangent.ravel()
    index = np.concatenate([i, j, i, j]), np.concatenate([j, i, i, j])
    stiffness = coo_array((np.concatenate([-w, -w, w, w]), index), shape=(n, n))
    p = rest[faces]
    u, v = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    area = 0.5 * np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
    mass = np.bincount(faces.ravel(), np.repeat(area / 3.0, 3), n)
    return csc_array(stiffness), np.where(mass > 0, mass, 1.0)


def _diffusion(rest: FloatArray, faces: IntArray, tensor: FloatArray, n: int) -> csc_array:
    """Stiffness (n, n) of the flat panels under a diffusion tensor (m, 2, 2), linear triangles."""
    p = rest[faces]
    inverse = np.linalg.inv(np.stack([p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]], axis=2))
    slope = np.concatenate([-inverse.sum(axis=1, keepdims=True), inverse], axis=1)
    pair = slope @ tensor @ np.swapaxes(slope, 1, 2) * face_areas(rest, faces)[:, None, None]
    index = np.repeat(faces, 3, axis=1).ravel(), np.tile(faces, (1, 3)).ravel()
    return csc_array(coo_array((pair.ravel(), index), shape=(n, n)))
