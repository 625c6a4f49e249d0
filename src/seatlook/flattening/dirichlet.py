"""Least symmetric Dirichlet energy: a flat map that neither turns nor crushes a face."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from seatlook.flattening.fabric_sheet import Gradient, combined
from seatlook.flattening.face_map import area_ratios, deformation, largest_step
from seatlook.model import FloatArray

_MAX_STEPS = 60
_CONVERGED = 1e-4  # share of the energy that the last step won; it is a start only
_DAMPING = 1e-9  # rigid motions cost nothing
_SMALLEST_SCALE = 1e-10


def dirichlet_map(x: FloatArray, gradient: Gradient, area: FloatArray) -> FloatArray:
    """Return the flat positions (n, 2) of least ``sum A (|F|^2 + |F^-1|^2) / 2``.

    Projected Newton steps from a map without a turned face; the energy is without bound where a
    face loses its area, and no step goes so far.

    Parameters
    ----------
    x : (n, 2) [m]   a start without a turned face
    gradient : derivatives along two axes of each face; area : (m,) [m2]
    """
    x = _true_size(x, gradient, area)
    value = _energy(x, gradient, area)
    for _ in range(_MAX_STEPS):
        slope, hessian = _derivatives(x, gradient, area)
        damping = sp.identity(hessian.shape[0], format="csc") * (
            _DAMPING * hessian.diagonal().mean()
        )
        step = -splu(hessian + damping).solve(slope)
        descent = float(slope @ step)
        direction = step.reshape(2, -1).T
        scale = largest_step(x, direction, gradient)
        while (new := _energy(x + scale * direction, gradient, area)) > (
            value + 1e-4 * scale * descent
        ):
            scale /= 2
            if scale < _SMALLEST_SCALE:
                return x
        x = x + scale * direction
        if value - new < _CONVERGED * value:
            return x
        value = new
    return x


def _true_size(x: FloatArray, gradient: Gradient, area: FloatArray) -> FloatArray:
    """Scale a map to the size of least energy."""
    F = deformation(x, gradient)
    square = (F**2).sum(axis=(1, 2))
    inverse = square / np.linalg.det(F) ** 2
    return np.asarray(x * float((area @ inverse) / (area @ square)) ** 0.25)


def _energy(x: FloatArray, gradient: Gradient, area: FloatArray) -> float:
    ratio = area_ratios(x, gradient)
    if (ratio <= 0).any():
        return np.inf
    square = (deformation(x, gradient) ** 2).sum(axis=(1, 2))
    return float(0.5 * area @ (square * (1 + 1 / ratio**2)))


def _derivatives(
    x: FloatArray, gradient: Gradient, area: FloatArray
) -> tuple[FloatArray, sp.csc_array]:
    """Return gradient (2 n,) and Hessian without its negative parts; unknowns x first, then y.

    In the axes of the singular values s the Hessian of each face is diagonal: two stretches, a
    turn and a flip (Smith, De Goes, Kim 2019).
    """
    u, s, vt = np.linalg.svd(deformation(x, gradient))
    a, b = s.T
    pull = s - s**-3
    bend = np.column_stack(
        [
            1 + 3 * a**-4,
            1 + 3 * b**-4,
            np.maximum(pull.sum(axis=1) / (a + b), 0.0),
            1 + (a * a + a * b + b * b) / (a * b) ** 3,
        ]
    )
    half = np.sqrt(0.5)
    modes = np.array(
        [[[1, 0], [0, 0]], [[0, 0], [0, 1]], [[0, -half], [half, 0]], [[0, half], [half, 0]]]
    )
    axes = np.einsum("mij,kjl,mln->kmin", u, modes, vt)
    pushed = np.einsum("mij,mj,mjn->min", u, area[:, None] * pull, vt)
    operator = sp.csr_array(sp.vstack([_along(axis, gradient) for axis in axes]))
    gx, gy = gradient
    slope = np.concatenate([gx.T @ pushed[:, i, 0] + gy.T @ pushed[:, i, 1] for i in (0, 1)])
    weighted = sp.csr_array(sp.diags((area[:, None] * bend).T.ravel()) @ operator)
    return slope, sp.csc_array(operator.T @ weighted)


def _along(axis: FloatArray, gradient: Gradient) -> sp.csr_array:
    """Operator (m, 2 n): how much the deformation changes along an axis (m, 2, 2) of its space."""
    return sp.csr_array(sp.hstack([combined(gradient, *axis[:, i].T) for i in (0, 1)]))
