"""Measures that stand beside the paper's: signed ratio, tension field, net curvature.

The stretch ratio of eq. (4) calls pure shear balanced, jumps where the major strain passes 0 and
answers to noise. Nothing here replaces it; ``docs/reference/indices.md`` shows both side by side.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from seatlook.errors import InputError
from seatlook.mesh.kinematics import principal_values
from seatlook.model import Cover, FloatArray, IntArray, Solution, WrinkleMap
from seatlook.model.scene import CurvatureMode
from seatlook.wrinkle.equations import relative_curvature, wrinkle_index
from seatlook.wrinkle.recovery import low_passed, shape_curvature

DEAD_BAND = 1e-3  # strains below it count as none
SLACK, WRINKLED, TAUT = 0, 1, 2
TENSION_STATES = ("slack", "wrinkled", "taut")


@dataclass(frozen=True, slots=True, kw_only=True)
class Surface:
    """What measures look at, per face.

    Parameters
    ----------
    strain_mid : (m, 2, 2)         Green strain in warp/weft axes
    net : (m, 2, 2) [1/m]          curvature of the shape minus that of the shape that was meant
    membrane : (m, 3, 3) [N/m]     (S11, S22, S12) = D (E11, E22, 2 E12)
    indices : WrinkleMap           the paper's
    c_threshold : float or (m,) [1/m]
    """

    strain_mid: FloatArray
    net: FloatArray
    membrane: FloatArray
    indices: WrinkleMap
    c_threshold: float | FloatArray


def surface_of(
    solution: Solution,
    indices: WrinkleMap,
    c_threshold: float | FloatArray,
    *,
    design: FloatArray | None = None,
) -> Surface:
    """Collect what ``MEASURES`` need from a solved cover.

    Parameters
    ----------
    design : (n, 3) float64 [m]    the shape that was meant; without it the solved one with waves
        below 45 mm removed between seams and hooks

    Notes
    -----
    Both curvatures of ``net`` are fitted to the shapes, so that their errors at panel edges cancel;
    against the strains' curvature they would add wrinkles there.
    """
    cover = solution.cover
    shape = low_passed(cover, solution.positions) if design is None else design
    return Surface(
        strain_mid=solution.strain_mid,
        net=shape_curvature(cover, solution.positions) - shape_curvature(cover, shape),
        membrane=np.stack([m.fabric.membrane_matrix for m in cover.materials])[cover.panel],
        indices=indices,
        c_threshold=c_threshold,
    )


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


def threshold_of_radius(radius: float | FloatArray, curvature: CurvatureMode) -> FloatArray:
    """C_threshold [1/m] for the bending radius [m] at which a material shows its first wrinkle.

    The radius is that of a half-pipe test as in VDA 230-205. ``"tensor"`` sees the fold's whole
    curvature 1/R, ``"paper"`` half of it.

    Raises
    ------
    InputError
        A radius of 0 or less.

    Examples
    --------
    >>> [float(threshold_of_radius(0.05, mode)) for mode in ("tensor", "paper")]
    [20.0, 10.0]
    """
    r = np.asarray(radius, dtype=float)
    if not bool(((r > 0) & np.isfinite(r)).all()):
        raise InputError.single("radius", got=radius, expected="above 0")
    return np.asarray((1.0 if curvature == "tensor" else 0.5) / r)


def thresholds(cover: Cover, curvature: CurvatureMode, default: float) -> FloatArray:
    """C_threshold per face, (m,) [1/m]: the material's own, by its radius, else the default."""
    own = [m.c_threshold or default for m in cover.materials]
    for k, m in enumerate(cover.materials):
        if m.first_wrinkle_radius is not None:
            own[k] = float(threshold_of_radius(m.first_wrinkle_radius, curvature))
    return np.array(own)[cover.panel]


def w2_net(surface: Surface) -> FloatArray:
    """W2 of the net curvature: what the design does not ask for (m,)."""
    _, valley = principal_values(surface.net)
    return wrinkle_index(relative_curvature(valley, surface.c_threshold))


def excess_strain(surface: Surface) -> FloatArray:
    """Fabric in excess (m,) [1] >= 0: the wrinkle strain, counted positive."""
    return np.asarray(np.maximum(-wrinkle_strain(surface.strain_mid, surface.membrane), 0.0))


# name -> function of a Surface; the paper's six, then those that stand beside them
INDICES: dict[str, Callable[[Surface], FloatArray]] = {
    "c": lambda s: s.indices.c,
    "w1": lambda s: s.indices.w1,
    "w2": lambda s: s.indices.w2,
    "r_stretch": lambda s: s.indices.r_stretch,
    "w_stretch": lambda s: s.indices.w_stretch,
    "w_compression": lambda s: s.indices.w_compression,
}
MEASURES: dict[str, Callable[[Surface], FloatArray]] = {
    "signed_ratio": lambda s: signed_ratio(s.strain_mid),
    "excess_strain": excess_strain,
    "tension_state": lambda s: tension_state(s.strain_mid, s.membrane).astype(float),
    "w2_net": w2_net,
    "w2_net_stretch": lambda s: w2_net(s) * signed_ratio(s.strain_mid),
    "w2_net_compression": lambda s: w2_net(s) * (1.0 - signed_ratio(s.strain_mid)),
}
