"""Flattening one patch: conformal start, then least elastic energy by Gauss-Newton steps."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from seatlook.errors import SeatlookError
from seatlook.flattening.fabric_sheet import Rows, fabric_rows, grain_strain
from seatlook.mesh import face_areas, face_normals
from seatlook.model import Fabric, FloatArray, IntArray

_MAX_STEPS = 100
_CONVERGED = 1e-7  # [m]; near the end steps shrink by 7 % at worst, so 2e-6 m are left
# Weight of a held edge length against the faces beside it: 1e4 holds lengths to about 1e-6.
_HOLD = 1e4


@dataclass(frozen=True, slots=True, kw_only=True)
class HeldEdges:
    """Mesh edges (k, 2) whose flat length (k,) [m] is prescribed."""

    vertices: IntArray
    length: FloatArray


def flatten_patch(
    vertices: FloatArray,
    faces: IntArray,
    held: HeldEdges | None = None,
    *,
    growth: FloatArray | None = None,
    start: FloatArray | None = None,
    fabric: Fabric | None = None,
) -> FloatArray:
    """Return flat positions (n, 2) [m] of least strain energy with edges of given length.

    Without a fabric that of an isotropic sheet without Poisson effect, ``sum A |G|^2`` with the
    Green strain ``G = (F^T F - I) / 2`` of the map from space to the plane. With one that of the
    fabric laid onto the form, ``sum A psi(E)`` with the strain E of the map from the plane to
    space, warp along the second axis; the patch then keeps the direction of ``start``.

    Parameters
    ----------
    vertices : (n, 3) float64 [m]; faces : (m, 3) int64, a disk
    held : edges with a length of their own; None for none
    growth : (m, 3, 3)   symmetric stretch that each face is to have in the plane; None for none
    start : (n, 2) [m]   first guess; None takes the conformal map
    fabric : warp, weft and shear curves; compression counts as tension does

    Raises
    ------
    SeatlookError
        The steps do not converge, or the flat patch folds over.
    """
    held = held or HeldEdges(vertices=np.zeros((0, 2), np.int64), length=np.zeros(0))
    gradient = _gradient(vertices, faces)
    if growth is not None:
        gradient = _grown(gradient, growth, _axes(vertices, faces))
    area = face_areas(vertices, faces)
    x = conformal_map(vertices, faces) if start is None else start
    energy = _Energy(gradient, area, held, fabric, _chord(x))
    value, residual, jacobian = energy.at(x)
    for _ in range(_MAX_STEPS):
        normal = (jacobian.T @ jacobian).tocsc()
        # Rigid motions cost nothing: a trace of damping makes the matrix regular.
        damping = sp.identity(normal.shape[0], format="csc") * (1e-9 * normal.diagonal().mean())
        step = -splu(normal + damping).solve(jacobian.T @ residual).reshape(-1, 2)
        scale = 1.0
        while True:
            trial = x + scale * step
            new, residual, jacobian = energy.at(trial)
            if new <= value or scale < 1e-4:
                break
            scale /= 2
        x = trial
        converged = scale * np.abs(step).max() < _CONVERGED
        value = new
        if converged:
            return _unfolded(x, gradient)
    raise SeatlookError(f"flattening does not converge in {_MAX_STEPS} steps")


def conformal_map(vertices: FloatArray, faces: IntArray) -> FloatArray:
    """Return the least-squares conformal map (n, 2) of a disk, in true size.

    Lévy, Petitjean, Ray, Maillot 2002, with the two vertices farthest apart pinned.
    """
    gx, gy = _gradient(vertices, faces)
    weight = sp.diags(np.sqrt(face_areas(vertices, faces)))
    # Cauchy-Riemann: grad v is grad u turned by 90 degrees.
    rows = sp.vstack(
        [sp.hstack([weight @ gx, -(weight @ gy)]), sp.hstack([weight @ gy, weight @ gx])]
    ).tocsc()
    n = len(vertices)
    first = int(np.linalg.norm(vertices - vertices.mean(axis=0), axis=1).argmax())
    second = int(np.linalg.norm(vertices - vertices[first], axis=1).argmax())
    pinned = np.array([first, second, n + first, n + second])
    value = np.array([0.0, np.linalg.norm(vertices[second] - vertices[first]), 0.0, 0.0])
    free = np.setdiff1d(np.arange(2 * n), pinned)
    pinned_part = rows[:, pinned] @ value
    matrix = rows[:, free]
    flat = np.empty(2 * n)
    flat[pinned] = value
    flat[free] = splu((matrix.T @ matrix).tocsc()).solve(-(matrix.T @ pinned_part))
    x = flat.reshape(2, n).T
    ratio = face_areas(vertices, faces).sum() / face_areas(x, faces).sum()
    return np.ascontiguousarray(x * np.sqrt(ratio))


def stretches(vertices: FloatArray, faces: IntArray, flat: FloatArray) -> FloatArray:
    """Return the principal stretches (m, 2), small one first, of the map from flat to space."""
    F = _deformation(flat, _gradient(vertices, faces))
    return np.asarray(1 / np.linalg.svd(F, compute_uv=False))


def strains_by_grain(vertices: FloatArray, faces: IntArray, flat: FloatArray) -> FloatArray:
    """Return Green strains (m, 3) of the map from flat to space: warp, weft, angle 2 E12."""
    return grain_strain(flat, _gradient(vertices, faces))


def _gradient(vertices: FloatArray, faces: IntArray) -> tuple[sp.csr_array, sp.csr_array]:
    """Operators (m, n) for the derivative along each face's own two axes."""
    p = vertices[faces]
    u, v = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    axes = _axes(vertices, faces)
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


def _axes(vertices: FloatArray, faces: IntArray) -> FloatArray:
    """Unit vectors (2, m, 3) along each face's first edge and across it."""
    along = vertices[faces[:, 1]] - vertices[faces[:, 0]]
    along = along / np.linalg.norm(along, axis=1, keepdims=True)
    return np.stack([along, np.cross(face_normals(vertices, faces), along)])


def _grown(
    gradient: tuple[sp.csr_array, sp.csr_array], growth: FloatArray, axes: FloatArray
) -> tuple[sp.csr_array, sp.csr_array]:
    """Derivatives with respect to lengths after growth: strain counts from the grown shape."""
    inverse = np.linalg.inv(np.einsum("amd,mde,bme->mab", axes, growth, axes))
    gx, gy = gradient
    return tuple(
        (sp.diags(inverse[:, 0, k]) @ gx + sp.diags(inverse[:, 1, k]) @ gy).tocsr() for k in (0, 1)
    )


def _deformation(x: FloatArray, gradient: tuple[sp.csr_array, sp.csr_array]) -> FloatArray:
    """Return F (m, 2, 2) of the map from space to the plane."""
    return np.stack([g @ x for g in gradient], axis=2)


@dataclass(frozen=True, slots=True)
class _Chord:
    """Two vertices far apart and the unit vector across the line between them."""

    ends: IntArray
    across: FloatArray
    length: float


def _chord(x: FloatArray) -> _Chord:
    first = int(np.linalg.norm(x - x.mean(axis=0), axis=1).argmax())
    second = int(np.linalg.norm(x - x[first], axis=1).argmax())
    along = x[second] - x[first]
    length = float(np.linalg.norm(along))
    return _Chord(np.array([first, second]), np.array([-along[1], along[0]]) / length, length)


@dataclass(frozen=True, slots=True)
class _Energy:
    """What is minimised: the sheet's strain energy, held lengths, a fabric's direction."""

    gradient: tuple[sp.csr_array, sp.csr_array]
    area: FloatArray
    held: HeldEdges
    fabric: Fabric | None
    chord: _Chord

    def at(self, x: FloatArray) -> tuple[float, FloatArray, sp.csc_array]:
        """Return energy, residual and Jacobian with unknowns in the order x0 y0 x1 y1 ..."""
        root = np.sqrt(self.area)
        if self.fabric is None:
            residual, blocks = _isotropic_rows(x, self.gradient, root)
        else:
            residual, blocks = fabric_rows(x, self.gradient, root, self.fabric)
            turned, row = self._turned(x)
            residual.append(turned)
            blocks.append(row)
        lengths, rows = _held_rows(x, self.held, self.area)
        r = np.concatenate([*residual, lengths])
        by_axis = sp.vstack([sp.hstack(pair) for pair in [*blocks, rows]]).tocsc()
        order = np.arange(2 * len(x)).reshape(2, -1).T.ravel()
        return 0.5 * float(r @ r), r, by_axis[:, order]

    def _turned(self, x: FloatArray) -> tuple[FloatArray, list[sp.csr_array]]:
        """How far the chord has turned; the grain would turn with it."""
        chord, shape = self.chord, (1, len(x))
        weight = np.sqrt(_HOLD * self.area.sum()) / chord.length
        signs = weight * np.array([-1.0, 1.0])
        row = [
            sp.csr_array((signs * c, (np.zeros(2, dtype=int), chord.ends)), shape=shape)
            for c in chord.across
        ]
        return weight * np.diff(x[chord.ends], axis=0) @ chord.across, row


def _isotropic_rows(
    x: FloatArray, gradient: tuple[sp.csr_array, sp.csr_array], root: FloatArray
) -> Rows:
    F = _deformation(x, gradient)
    gx, gy = gradient
    fx, fy = F[:, :, 0], F[:, :, 1]
    residual = [
        root * ((fx**2).sum(axis=1) - 1) / 2,
        root * ((fy**2).sum(axis=1) - 1) / 2,
        root * (fx * fy).sum(axis=1) / np.sqrt(2),
    ]
    blocks = [
        [sp.diags(root * fx[:, k]) @ gx for k in (0, 1)],
        [sp.diags(root * fy[:, k]) @ gy for k in (0, 1)],
        [
            sp.diags(root / np.sqrt(2)) @ (sp.diags(fx[:, k]) @ gy + sp.diags(fy[:, k]) @ gx)
            for k in (0, 1)
        ],
    ]
    return residual, blocks


def _held_rows(
    x: FloatArray, held: HeldEdges, area: FloatArray
) -> tuple[FloatArray, list[sp.csr_array]]:
    span = x[held.vertices[:, 1]] - x[held.vertices[:, 0]]
    root = np.sqrt(_HOLD * area.mean()) / held.length**2
    rows = np.repeat(np.arange(len(span)), 2)
    ends = held.vertices.ravel()
    signs = np.tile([-1.0, 1.0], len(span))
    return root * ((span**2).sum(axis=1) - held.length**2) / 2, [
        sp.csr_array(
            (signs * np.repeat(root * span[:, k], 2), (rows, ends)), shape=(len(span), len(x))
        )
        for k in (0, 1)
    ]


def _unfolded(x: FloatArray, gradient: tuple[sp.csr_array, sp.csr_array]) -> FloatArray:
    """Return ``x`` unless a face is turned over in it."""
    turned = int((np.linalg.det(_deformation(x, gradient)) <= 0).sum())
    if turned:
        raise SeatlookError(f"flattening folds {turned} faces over: cut the panel along a dart")
    return x
