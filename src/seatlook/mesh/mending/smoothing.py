"""Noise of a scan taken out of its surface."""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_array, csr_array
from scipy.sparse.linalg import LinearOperator, cg

from seatlook.mesh.mending.skin import Skin
from seatlook.mesh.surface import FloatArray, IntArray, angles, face_areas

_LEAST_ANGLE = 0.05  # rad; the cotangent of a smaller one would rule all others


def smooth(skin: Skin, wavelength: float) -> None:
    """Take waves shorter than ``wavelength`` [m] out of a surface."""
    before = skin.vertices
    skin.vertices = smoothed(before, skin.faces, wavelength)
    step = np.linalg.norm(skin.vertices - before, axis=1)
    worst = int(step.argmax())
    mean = 1e3 * float(np.sqrt((step**2).mean()))
    skin.note(
        f"vertices smoothed over {1e3 * wavelength:g} mm, moved {mean:.2g} mm (rms) and "
        f"{1e3 * step[worst]:.2g} mm at the most, here",
        len(before),
        before[worst],
        asked=True,
    )


def smoothed(vertices: FloatArray, faces: IntArray, wavelength: float) -> FloatArray:
    """Return vertices (n, 3) without waves shorter than ``wavelength`` [m]; borders move as well.

    Least (displacement)^2 + t^2 (Laplacian)^2, t = (wavelength / 2 pi)^2: a wave of that length is
    halved, one of half the length is left to a seventeenth, one of twice the length to 94 %.
    """
    stiffness, mass = _laplacian(vertices, faces)
    t2 = (wavelength / (2 * np.pi)) ** 4
    n = len(vertices)
    mass = np.maximum(mass, 1e-12)  # m2; of a vertex whose faces have all but no area

    def apply(x: FloatArray) -> FloatArray:
        return np.asarray(mass * x + t2 * (stiffness @ ((stiffness @ x) / mass)))

    squares = stiffness.multiply(stiffness)
    diagonal = mass + t2 * np.asarray(squares @ (1.0 / mass))
    operator = LinearOperator((n, n), matvec=apply, dtype=np.float64)
    start = LinearOperator((n, n), matvec=lambda x: x / diagonal, dtype=np.float64)
    origin = vertices.mean(axis=0)
    columns = [
        cg(operator, mass * column, x0=column, rtol=1e-6, maxiter=5000, M=start)[0]
        for column in (vertices - origin).T
    ]
    return np.asarray(np.column_stack(columns) + origin)


def _laplacian(vertices: FloatArray, faces: IntArray) -> tuple[csr_array, FloatArray]:
    """Return the cotangent stiffness (n, n) and the area (n,) [m2] of vertices."""
    n = len(vertices)
    angle = np.clip(angles(vertices, faces), _LEAST_ANGLE, np.pi - _LEAST_ANGLE)
    weight = 0.5 / np.tan(angle)
    one, two = np.roll(faces, -1, axis=1).ravel(), np.roll(faces, -2, axis=1).ravel()
    w = weight.ravel()
    rows, columns = np.concatenate([one, two, one, two]), np.concatenate([two, one, one, two])
    values = np.concatenate([-w, -w, w, w])
    stiffness: csr_array = coo_array((values, (rows, columns)), shape=(n, n)).tocsr()
    third = np.repeat(face_areas(vertices, faces) / 3.0, 3)
    return stiffness, np.asarray(np.bincount(faces.ravel(), third, minlength=n), dtype=np.float64)
