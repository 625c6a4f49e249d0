"""Flattening one patch: least elastic energy by Gauss-Newton steps that turn no face over."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from seatlook.errors import SeatlookError
from seatlook.flattening.fabric_sheet import Gradient, Rows, combined, fabric_rows
from seatlook.flattening.face_map import (
    deformation,
    face_axes,
    gradient_of,
    grown,
    largest_step,
)
from seatlook.flattening.start import unfolded_start
from seatlook.mesh import face_areas
from seatlook.model import Fabric, FloatArray, IntArray

_MAX_STEPS = 400
_CONVERGED = 1e-7  # [m] that the last step moved at most
_SETTLED = 1e-8  # share of the energy that the last step won
_STRAINLESS = 1e-16  # mean squared strain that is none
_SMALLEST_SCALE = 1e-4
# Weight of a held edge length against the faces beside it: 1e4 holds lengths to about 1e-6.
_HOLD = 1e4
# Green's strain gives way far from 0. Faces beyond this stretch, where the form strains the panel
# by a quarter, resist more, the weight times as much.
_BOUND, _RESISTANCE = 0.8, 2.0


@dataclass(frozen=True, slots=True, kw_only=True)
class HeldEdges:
    """Mesh edges (k, 2) whose flat length (k,) [m] is prescribed."""

    vertices: IntArray
    length: FloatArray


@dataclass(frozen=True, slots=True, kw_only=True)
class Openings:
    """Pairs of vertices (k, 2) on both sides of darts, which may not lie over each other.

    Parameters
    ----------
    across : (k, 2)       unit vectors from the first side to the second
    least : (k,) [m]      by which the second is to lie that way
    """

    vertices: IntArray
    across: FloatArray
    least: FloatArray


def flatten_patch(
    vertices: FloatArray,
    faces: IntArray,
    held: HeldEdges | None = None,
    *,
    openings: Openings | None = None,
    growth: FloatArray | None = None,
    start: FloatArray | None = None,
    fabric: Fabric | None = None,
) -> FloatArray:
    """Return flat positions (n, 2) [m] of least strain energy with edges of given length.

    Without a fabric that of an isotropic sheet without Poisson effect, ``sum A |G|^2`` with the
    Green strain ``G = (F^T F - I) / 2`` of the map from space to the plane, and more where the
    form stretches the sheet by over a quarter. With one that of the fabric laid onto the form,
    ``sum A psi(E)`` with the strain E of the map from the plane to space, warp along the second
    axis, and more where there is a quarter too much of it; the patch then keeps the direction of
    ``start``. No face is ever turned over.

    Parameters
    ----------
    vertices : (n, 3) float64 [m]; faces : (m, 3) int64, a disk
    held : edges with a length of their own; None for none
    openings : sides of darts that are kept apart; None for none
    growth : (m, 3, 3)   symmetric stretch that each face is to have in the plane; None for none
    start : (n, 2) [m]   first guess without a turned face; None takes ``unfolded_start``
    fabric : warp, weft and shear curves; compression counts as tension does

    Raises
    ------
    SeatlookError
        The mesh has faces without area, or the steps do not converge; says where.
    """
    held = held or HeldEdges(vertices=np.zeros((0, 2), np.int64), length=np.zeros(0))
    gradient = gradient_of(vertices, faces)
    if growth is not None:
        gradient = grown(gradient, growth, face_axes(vertices, faces))
    x = unfolded_start(vertices, faces) if start is None else start
    area = face_areas(vertices, faces)
    energy = _Energy(gradient, area, held, openings, fabric, _chord(x))
    value, residual, jacobian = energy.at(x)
    for _ in range(_MAX_STEPS):
        step = _step(residual, jacobian)
        scale = largest_step(x, step, gradient)
        while True:
            trial = x + scale * step
            new, residual, jacobian = energy.at(trial)
            if new <= value or scale < _SMALLEST_SCALE:
                break
            scale /= 2
        if new > value:
            return x  # rounding hides what a smaller step would win
        x, won, value = trial, value - new, new
        if scale * np.abs(step).max() < _CONVERGED or won < energy.negligible(value):
            return x
    worst = 1e3 * vertices[np.linalg.norm(step, axis=1).argmax()]
    raise SeatlookError(
        f"flattening does not converge in {_MAX_STEPS} steps and still moves near "
        f"{worst.round(1)} mm"
    )


def _step(residual: FloatArray, jacobian: sp.csc_array) -> FloatArray:
    """Return the Gauss-Newton step (n, 2)."""
    normal = (jacobian.T @ jacobian).tocsc()
    # Rigid motions cost nothing: a trace of damping makes the matrix regular.
    damping = sp.identity(normal.shape[0], format="csc") * (1e-9 * normal.diagonal().mean())
    return np.asarray(-splu(normal + damping).solve(jacobian.T @ residual).reshape(-1, 2))


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

    gradient: Gradient
    area: FloatArray
    held: HeldEdges
    openings: Openings | None
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
        beyond, rows = _bounding_rows(x, self.gradient, root, fabric=self.fabric is not None)
        lengths, held = _held_rows(x, self.held, self.area)
        blocks += [*rows, held]
        residual += [*beyond, lengths]
        if self.openings is not None:
            missing, row = _opening_rows(x, self.openings)
            residual.append(missing)
            blocks.append(row)
        r = np.concatenate(residual)
        by_axis = sp.vstack([sp.hstack(pair) for pair in blocks]).tocsc()
        order = np.arange(2 * len(x)).reshape(2, -1).T.ravel()
        return 0.5 * float(r @ r), r, by_axis[:, order]

    def negligible(self, value: float) -> float:
        """Return what a step may win at most where the energy has come to rest."""
        return _SETTLED * value + _STRAINLESS * float(self.area.sum())

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


def _isotropic_rows(x: FloatArray, gradient: Gradient, root: FloatArray) -> Rows:
    F = deformation(x, gradient)
    gx, gy = gradient
    fx, fy = F[:, :, 0], F[:, :, 1]
    residual = [
        root * ((fx**2).sum(axis=1) - 1) / 2,
        root * ((fy**2).sum(axis=1) - 1) / 2,
        root * (fx * fy).sum(axis=1) / np.sqrt(2),
    ]
    blocks = [
        [sp.csr_array(sp.diags(root * fx[:, k]) @ gx) for k in (0, 1)],
        [sp.csr_array(sp.diags(root * fy[:, k]) @ gy) for k in (0, 1)],
        [
            sp.csr_array(
                sp.diags(root / np.sqrt(2)) @ (sp.diags(fx[:, k]) @ gy + sp.diags(fy[:, k]) @ gx)
            )
            for k in (0, 1)
        ],
    ]
    return residual, blocks


def _bounding_rows(x: FloatArray, gradient: Gradient, root: FloatArray, *, fabric: bool) -> Rows:
    """Residuals ``share / s - 1`` against stretches s of the plane below the share.

    A fabric's strain counts the other way, from the plane to the form: it resists crushed faces
    without bound, and gives way where there is much too much cloth. Therefore ``share s - 1``.
    """
    u, s, vt = np.linalg.svd(deformation(x, gradient))
    weight = _RESISTANCE * root
    blocks, values = [], []
    for k in (0, 1):
        size = s[:, k] if fabric else 1 / s[:, k]
        beyond = np.maximum(_BOUND * size - 1, 0.0)
        values.append(weight * beyond)
        slope = weight * _BOUND * np.where(beyond > 0, 1.0 if fabric else -(size**2), 0.0)
        along = slope[:, None] * vt[:, k]
        blocks.append([combined(gradient, *(u[:, i, k, None] * along).T) for i in (0, 1)])
    return values, blocks


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


def _opening_rows(x: FloatArray, openings: Openings) -> tuple[FloatArray, list[sp.csr_array]]:
    """Residuals that are above 0 where the sides of a dart lie over each other."""
    ends, across = openings.vertices, openings.across
    open_by = ((x[ends[:, 1]] - x[ends[:, 0]]) * across).sum(axis=1)
    weight = np.sqrt(_HOLD)
    missing = np.maximum(openings.least - open_by, 0.0)
    signs = weight * np.where(missing > 0, 1.0, 0.0)[:, None] * [1.0, -1.0]
    rows = np.repeat(np.arange(len(ends)), 2)
    return weight * missing, [
        sp.csr_array(
            ((signs * across[:, k, None]).ravel(), (rows, ends.ravel())), shape=(len(ends), len(x))
        )
        for k in (0, 1)
    ]
