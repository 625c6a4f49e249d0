"""Measures that stand beside the paper's: signed ratio, tension field, net curvature.

The stretch ratio of eq. (4) calls pure shear balanced, jumps where the major strain passes 0 and
answers to noise. Nothing here replaces it; ``docs/reference/indices.md`` shows both side by side.
"""

from __future__ import annotations

import numpy as np

from seatlook.mesh.kinematics import principal_values
from seatlook.model import FloatArray, IntArray
from seatlook.wrinkle.equations import relative_curvature, wrinkle_index
from seatlook.wrinkle.surface import Surface

DEAD_BAND = 1e-3  # strains below it count as none
SLACK, WRINKLED, TAUT = 0, 1, 2
TENSION_STATES = ("slack", "wrinkled", "taut")


def signed_ratio(strain_mid: FloatArray, dead_band: float = DEAD_BAND) -> FloatArray:
    """Unbalance of the stretch ``(1 - r) / 2`` (m,) in [0, 1], r = minor / major in [-1, 1].

    0 for equal stretch both ways, 1/2 for one-way stretch without contraction, 1 for pure shear
    and beyond; 0 where the major strain is below the dead band, for there is no stretch.

    Examples
    --------
    >>> signed_ratio(np.array([np.diag([0.01, e]) for e in (0.01, 0.0, -0.01)])).tolist()
    [0.0, 0.5, 1.0]
    """
    major, minor = principal_values(strain_mid)
    stretched = major >= dead_band
    small = np.where(np.abs(minor) < dead_band, 0.0, minor)
    ratio = np.clip(np.divide(small, major, out=np.ones_like(major), where=stretched), -1.0, 1.0)
    return np.asarray(0.5 * (1.0 - ratio))


def isotropic_membrane(poisson: float) -> FloatArray:
    """Stiffness (3, 3) of an isotropic sheet of unit E t, for faces without a material."""
    return np.array(
        [[1.0, poisson, 0.0], [poisson, 1.0, 0.0], [0.0, 0.0, 0.5 * (1.0 - poisson)]]
    ) / (1.0 - poisson**2)


def wrinkle_strain(strain_mid: FloatArray, membrane: FloatArray) -> FloatArray:
    """Contraction that the sheet cannot carry, (m,): minor stress over stiffness, negative.

    For an isotropic sheet ``e_minor + nu e_major``; fabric takes the stiffness at zero strain.

    Parameters
    ----------
    membrane : (3, 3) or (m, 3, 3) float64 [N/m]
    """
    e = np.stack([strain_mid[:, 0, 0], strain_mid[:, 1, 1], 2.0 * strain_mid[:, 0, 1]], axis=1)
    matrix = np.broadcast_to(membrane, (len(e), 3, 3))
    s = np.einsum("mij,mj->mi", matrix, e)
    a, d, b = s.T
    middle, radius = 0.5 * (a + d), np.hypot(0.5 * (a - d), b)
    angle = 0.5 * np.arctan2(2.0 * b, a - d) + 0.5 * np.pi
    c, n = np.cos(angle), np.sin(angle)
    along = np.stack([c * c, n * n, 2.0 * c * n], axis=1)
    stiffness = np.einsum("mi,mij,mj->m", along, matrix, along)
    return np.asarray((middle - radius) / stiffness)


def tension_state(
    strain_mid: FloatArray, membrane: FloatArray, dead_band: float = DEAD_BAND
) -> IntArray:
    """Class of the tension field (m,) by the mixed criterion: 0 slack, 1 wrinkled, 2 taut.

    Slack where nothing is stretched, wrinkled where the major strain is tensile and the minor
    stress compressive, taut otherwise (Roddeman et al. 1987); the dead band keeps noise out.
    """
    major, _ = principal_values(strain_mid)
    compressed = wrinkle_strain(strain_mid, membrane) < -dead_band
    return np.where(major < dead_band, SLACK, np.where(compressed, WRINKLED, TAUT)).astype(np.int64)


def w2_net(surface: Surface) -> FloatArray:
    """W2 of the net curvature: what the design does not ask for (m,)."""
    _, valley = principal_values(surface.net)
    return wrinkle_index(relative_curvature(valley, surface.c_threshold))


def excess_strain(surface: Surface) -> FloatArray:
    """Fabric in excess (m,) [1] >= 0: the wrinkle strain, counted positive."""
    return np.asarray(np.maximum(-wrinkle_strain(surface.strain_mid, surface.membrane), 0.0))
