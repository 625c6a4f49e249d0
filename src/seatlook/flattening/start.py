"""Where flattening starts: a map of the patch to the plane that turns no face over."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from seatlook.errors import SeatlookError
from seatlook.flattening.face_map import Gradient, area_ratios, gradient_of
from seatlook.flattening.newton import Separable, minimise
from seatlook.mesh import angles, boundary_loops, face_areas, segment_lengths
from seatlook.model import FloatArray, IntArray

# Area ratio below which a face of the conformal map is too small to start from: steps of the
# fabric's energy would crush it rather than let it grow.
_CRUSHED = 0.5
_MAX_STEPS = 60
_CONVERGED = 1e-4  # share of the energy that the last step won; it is a start only


def unfolded_start(vertices: FloatArray, faces: IntArray) -> FloatArray:
    """Return flat positions (n, 2) [m] of a disk without a turned face.

    The conformal map where it is one and crushes no face; else Tutte's map to a circle, or the
    conformal one, relaxed by the symmetric Dirichlet energy.

    Raises
    ------
    SeatlookError
        The mesh has faces without area.
    """
    x = conformal_map(vertices, faces)
    gradient = gradient_of(vertices, faces)
    smallest = area_ratios(x, gradient).min()
    if smallest > _CRUSHED:
        return x
    if not smallest > 0:
        x = tutte_map(vertices, faces)
    ratio = area_ratios(x, gradient)
    if not (ratio > 0).all():
        worst = vertices[faces[int(np.nanargmin(ratio))]].mean(axis=0)
        raise SeatlookError(f"no flat map near {(1e3 * worst).round(1)} mm: a face has no area")
    return dirichlet_map(x, gradient, face_areas(vertices, faces))


def dirichlet_map(x: FloatArray, gradient: Gradient, area: FloatArray) -> FloatArray:
    """Return the flat positions (n, 2) of least ``sum A (|F|^2 + |F^-1|^2) / 2``.

    The energy is without bound where a face loses its area.

    Parameters
    ----------
    x : (n, 2) [m]   a start without a turned face
    gradient : derivatives along two axes of each face; area : (m,) [m2]
    """
    F = gradient.at(x)
    square = (F**2).sum(axis=(1, 2))
    inverse = square / np.linalg.det(F) ** 2
    x = x * float((area @ inverse) / (area @ square)) ** 0.25  # the size of least energy
    law = Separable(lambda s: ((s**2 + s**-2) / 2, s - s**-3, 1 + 3 * s**-4))
    return minimise(
        x, gradient, area, [law], steps=_MAX_STEPS,
        enough=lambda won, value, _: won < _CONVERGED * value,
    )[0]  # fmt: skip


def conformal_map(vertices: FloatArray, faces: IntArray) -> FloatArray:
    """Return the least-squares conformal map (n, 2) of a disk, in true size.

    Lévy, Petitjean, Ray, Maillot 2002, with the two vertices farthest apart pinned.
    """
    gx, gy = gradient_of(vertices, faces).operators(len(vertices))
    weight = sp.diags(np.sqrt(face_areas(vertices, faces)))
    # Cauchy-Riemann: grad v is grad u turned by 90 degrees.
    rows = sp.csc_array(
        sp.vstack([sp.hstack([weight @ gx, -(weight @ gy)]), sp.hstack([weight @ gy, weight @ gx])])
    )
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


def tutte_map(vertices: FloatArray, faces: IntArray) -> FloatArray:
    """Return the map (n, 2) of a disk with its border on a circle; no face of it is turned.

    Each inner vertex is a mean of its neighbours with weights above 0 (Tutte 1963), here Floater's
    mean values (2003), which keep the shape of faces; with equal weights where these are so uneven
    that a face turns by rounding.
    """
    border = boundary_loops(faces)[0]
    ring = vertices[np.append(border, border[0])]
    step = segment_lengths(ring)
    turn = 2 * np.pi * np.append(0.0, np.cumsum(step)[:-1]) / step.sum()
    circle = np.column_stack([np.cos(turn), np.sin(turn)]) * step.sum() / (2 * np.pi)
    gradient = gradient_of(vertices, faces)
    x = _averaged(len(vertices), border, circle, _mean_values(vertices, faces))
    if (area_ratios(x, gradient) > 0).all():
        return x
    pairs = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    return _averaged(len(vertices), border, circle, (pairs, np.ones(len(pairs))))


def _mean_values(vertices: FloatArray, faces: IntArray) -> tuple[IntArray, FloatArray]:
    """Return pairs (6 m, 2) of neighbours and the weight of the second for the first."""
    half = np.tan(angles(vertices, faces) / 2)
    pairs, weights = [], []
    for k in range(3):
        here = faces[:, k]
        for other in (faces[:, (k + 1) % 3], faces[:, (k + 2) % 3]):
            pairs.append(np.column_stack([here, other]))
            weights.append(half[:, k] / np.linalg.norm(vertices[here] - vertices[other], axis=1))
    return np.concatenate(pairs), np.concatenate(weights)


def _averaged(
    n: int, border: IntArray, place: FloatArray, weights: tuple[IntArray, FloatArray]
) -> FloatArray:
    """Return positions (n, 2) with each inner vertex at the weighted mean of its neighbours."""
    pairs, weight = weights
    inner = np.setdiff1d(np.arange(n), border)
    x = np.zeros((n, 2))
    x[border] = place
    if len(inner) == 0:
        return x
    matrix = sp.csr_array((weight, pairs.T), shape=(n, n))
    whole = np.asarray(np.bincount(pairs[:, 0], weight, minlength=n), dtype=np.float64)
    balance = sp.csr_array(sp.diags(whole) - matrix)[inner]
    x[inner] = splu(balance[:, inner].tocsc()).solve(-(balance[:, border] @ place))
    return x
