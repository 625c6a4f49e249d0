"""Strains and principal values on arrays of 2x2 tensors."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]


def principal_values(tensor: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Eigenvalues of symmetric 2x2 tensors.

    Parameters
    ----------
    tensor : (m, 2, 2) float64
        Only the upper triangle is read.

    Returns
    -------
    major, minor : (m,) float64, major >= minor

    Examples
    --------
    >>> principal_values(np.array([[[1.0, 2.0], [2.0, 1.0]]]))
    (array([3.]), array([-1.]))
    """
    a, d, b = tensor[:, 0, 0], tensor[:, 1, 1], tensor[:, 0, 1]
    middle = 0.5 * (a + d)
    radius = np.hypot(0.5 * (a - d), b)
    return middle + radius, middle - radius


def deformation_gradient(rest: FloatArray, x: FloatArray, faces: IntArray) -> FloatArray:
    """Deformation gradient F of linear triangles.

    Parameters
    ----------
    rest : (n, 2) float64 [m]; x : (n, 3) float64 [m]; faces : (m, 3) int64

    Returns
    -------
    F : (m, 3, 2) float64
    """
    X = rest[faces]
    rest_edges = np.stack([X[:, 1] - X[:, 0], X[:, 2] - X[:, 0]], axis=2)
    y = x[faces]
    edges = np.stack([y[:, 1] - y[:, 0], y[:, 2] - y[:, 0]], axis=2)
    return np.asarray(edges @ np.linalg.inv(rest_edges))


def green_strain(F: FloatArray) -> FloatArray:
    """Green strain ``E = (F^T F - 1) / 2``.

    Parameters
    ----------
    F : (m, 3, 2) float64

    Returns
    -------
    E : (m, 2, 2) float64

    Examples
    --------
    >>> F = np.array([[[1.1, 0.0], [0.0, 1.0], [0.0, 0.0]]])
    >>> green_strain(F)[0].round(4).tolist()
    [[0.105, 0.0], [0.0, 0.0]]
    """
    FtF = np.swapaxes(F, 1, 2) @ F
    return np.asarray(0.5 * (FtF - np.eye(2)))


def logarithmic_strain(green: FloatArray) -> FloatArray:
    """Logarithmic strain ``ln(1 + 2 E) / 2`` of the same stretch, in the same axes.

    Parameters
    ----------
    green : (m, 2, 2) float64, principal values above -1/2

    Returns
    -------
    (m, 2, 2) float64
        nan where a principal value is -1/2 or less, which no stretch has.

    Examples
    --------
    >>> logarithmic_strain(np.array([[[0.105, 0.0], [0.0, 0.0]]]))[0, 0, 0].round(6).item()
    0.09531
    """
    major, minor = principal_values(green)
    with np.errstate(invalid="ignore", divide="ignore"):
        top, low = 0.5 * np.log1p(2.0 * major), 0.5 * np.log1p(2.0 * minor)
        gap = major - minor
        # The slope of ln(1 + 2 E) / 2 is the quotient's limit for equal values.
        slope = np.where(gap > 1e-8, (top - low) / np.maximum(gap, 1e-8), 1.0 / (1.0 + 2 * major))
    middle = 0.5 * (major + minor)
    tensor = slope[:, None, None] * (green - middle[:, None, None] * np.eye(2))
    return np.asarray(tensor + (0.5 * (top + low))[:, None, None] * np.eye(2))


def green_of_logarithmic(logarithmic: FloatArray) -> FloatArray:
    """Green strain ``(exp(2 e) - 1) / 2`` of the same stretch, in the same axes.

    Parameters
    ----------
    logarithmic : (m, 2, 2) float64

    Returns
    -------
    (m, 2, 2) float64

    Examples
    --------
    >>> green_of_logarithmic(np.array([[[0.09531018, 0.0], [0.0, 0.0]]]))[0, 0, 0].round(6).item()
    0.105
    """
    major, minor = principal_values(logarithmic)
    top, low = 0.5 * np.expm1(2.0 * major), 0.5 * np.expm1(2.0 * minor)
    gap = major - minor
    # The slope of the function is the quotient's limit for equal values.
    slope = np.where(gap > 1e-8, (top - low) / np.maximum(gap, 1e-8), np.exp(2.0 * major))
    middle = 0.5 * (major + minor)
    tensor = slope[:, None, None] * (logarithmic - middle[:, None, None] * np.eye(2))
    return np.asarray(tensor + (0.5 * (top + low))[:, None, None] * np.eye(2))


def major_direction(tensor: FloatArray) -> FloatArray:
    """Angle (m,) [rad] in (-pi/2, pi/2] from the first axis to the major principal direction.

    Examples
    --------
    >>> np.degrees(major_direction(np.array([[[1.0, 1.0], [1.0, 1.0]]]))).round(6).tolist()
    [45.0]
    """
    return np.asarray(0.5 * np.arctan2(2.0 * tensor[:, 0, 1], tensor[:, 0, 0] - tensor[:, 1, 1]))
