"""The six equations of the method, one function each.

Signs: n is the outward normal, so it points to the visible top; ``kappa > 0`` on a convex crown,
whose top is stretched; a valley has ``kappa < 0``.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from seatlook.errors import InputError
from seatlook.mesh.kinematics import logarithmic_strain, principal_values
from seatlook.model import CurvatureMode, FloatArray, Solution, StrainMeasure, WrinkleMap

STRAIN_MEASURES: dict[StrainMeasure, Callable[[FloatArray], FloatArray]] = {
    "green": lambda green: green,
    "logarithmic": logarithmic_strain,
}


def surface_strains(solution: Solution) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Green strain on the top, mid and bottom surface, each (m, 2, 2), in warp/weft axes."""
    return solution.strain_top, solution.strain_mid, solution.strain_bottom


def curvature_index(
    strain_top: FloatArray, strain_bottom: FloatArray, thickness: FloatArray
) -> FloatArray:
    """Curvature index C (m,) [1/m], eq. (1): difference of the minor in-plane strains over t.

    Taken literally it gives half the curvature of a free cylindrical fold: on the stretched side
    the minor direction is the straight one.
    """
    _, minor_top = principal_values(strain_top)
    _, minor_bottom = principal_values(strain_bottom)
    return np.asarray((minor_top - minor_bottom) / thickness)


def curvature_tensor(
    strain_top: FloatArray, strain_bottom: FloatArray, thickness: FloatArray
) -> FloatArray:
    """Curvature tensor ``K = (eps_top - eps_bottom) / t``, (m, 2, 2) [1/m]."""
    return np.asarray((strain_top - strain_bottom) / np.asarray(thickness)[..., None, None])


def relative_curvature(c: FloatArray, c_threshold: float | FloatArray) -> FloatArray:
    """W1 (m,) [1], eq. (2): C over the curvature at which a wrinkle counts."""
    return np.asarray(c / c_threshold)


def wrinkle_index(w1: FloatArray) -> FloatArray:
    """W2 (m,) [1] >= 0, eq. (3): the valley side of W1."""
    # Adding 0 turns -0 into 0.
    return -np.minimum(w1, 0.0) + 0.0


def stretch_ratio(strain_mid: FloatArray) -> FloatArray:
    """R_stretch (m,) in [0, 1], eq. (4): 1 for one-way stretch, 0 for balanced or no stretch.

    Literal, so pure shear (minor = -major) counts as balanced.
    """
    major, minor = principal_values(strain_mid)
    a, b = np.abs(major), np.abs(minor)
    largest = np.maximum(a, b)
    ratio = np.divide(np.minimum(a, b), largest, out=np.ones_like(a), where=largest > 0)
    return np.asarray(np.where(major > 0, 1.0 - ratio, 0.0))


def stretch_wrinkle(w2: FloatArray, r_stretch: FloatArray) -> FloatArray:
    """W_stretch (m,), eq. (5): the part of W2 that unbalanced stretch causes."""
    return w2 * r_stretch


def compression_wrinkle(w2: FloatArray, r_stretch: FloatArray) -> FloatArray:
    """W_compression (m,), eq. (6): the rest of W2, where fabric is in excess."""
    return w2 * (1.0 - r_stretch)


def wrinkle_indices(
    strain_top: FloatArray,
    strain_mid: FloatArray,
    strain_bottom: FloatArray,
    thickness: float | FloatArray,
    c_threshold: float | FloatArray,
    curvature: CurvatureMode = "paper",
    *,
    strain_measure: StrainMeasure = "green",
) -> WrinkleMap:
    """Evaluate eqs. (1) to (6).

    Parameters
    ----------
    strain_top, strain_mid, strain_bottom : (m, 2, 2) float64
        In-plane strains. Global 3x3 strains must be brought into the element plane before: the
        thickness strain would win eq. (1).
    thickness : float or (m,) [m]
    c_threshold : float or (m,) [1/m]
    curvature : "paper" or "tensor"
        "paper" is eq. (1) as printed. "tensor" takes the eigenvalue of largest magnitude of
        ``K = (eps_top - eps_bottom) / t`` as C (a tie counts as valley), and its smallest
        eigenvalue for W2, so that a saddle's valley direction is not hidden by its crown.
    strain_measure : "green" or "logarithmic"
        The measure in which the equations are evaluated; the strains given are Green's.

    Returns
    -------
    WrinkleMap
        Fields (m,); W_stretch + W_compression = W2 to 2 ulp.

    Raises
    ------
    InputError
        Strains that are not finite, thickness or threshold not above 0, unknown ``curvature``
        or ``strain_measure``.

    Examples
    --------
    >>> fold = np.array([[[-0.012, 0.0], [0.0, 0.0]]])
    >>> for mode in ("paper", "tensor"):
    ...     w = wrinkle_indices(fold, 0 * fold, -fold, 0.0012, 20.0, curvature=mode)
    ...     print(mode, w.c.round(6), w.w2.round(6))
    paper [-10.] [0.5]
    tensor [-20.] [1.]
    """
    if strain_measure not in STRAIN_MEASURES:
        raise InputError.single(
            "strain_measure", got=repr(strain_measure), expected="'green' or 'logarithmic'"
        )
    measure = STRAIN_MEASURES[strain_measure]
    strain_top, strain_mid, strain_bottom = map(measure, (strain_top, strain_mid, strain_bottom))
    _check(strain_top, strain_mid, strain_bottom, thickness, c_threshold)
    t = np.broadcast_to(np.asarray(thickness, dtype=float), len(strain_mid))
    if curvature == "paper":
        c = curvature_index(strain_top, strain_bottom, t)
        valley = c
    elif curvature == "tensor":
        crest, valley = principal_values(curvature_tensor(strain_top, strain_bottom, t))
        c = np.where(np.abs(crest) > np.abs(valley), crest, valley)
    else:
        raise InputError.single("curvature", got=repr(curvature), expected="'paper' or 'tensor'")
    w2 = wrinkle_index(relative_curvature(valley, c_threshold))
    r_stretch = stretch_ratio(strain_mid)
    return WrinkleMap(
        c=c,
        w1=relative_curvature(c, c_threshold),
        w2=w2,
        r_stretch=r_stretch,
        w_stretch=stretch_wrinkle(w2, r_stretch),
        w_compression=compression_wrinkle(w2, r_stretch),
    )


def _check(
    top: FloatArray,
    mid: FloatArray,
    bottom: FloatArray,
    thickness: float | FloatArray,
    c_threshold: float | FloatArray,
) -> None:
    """Refuse what would give a wrong index without a word."""
    for name, strain in (("strain_top", top), ("strain_mid", mid), ("strain_bottom", bottom)):
        if strain.shape != (len(mid), 2, 2):
            raise InputError.single(name, got=f"shape {strain.shape}", expected="(m, 2, 2)")
        if not np.isfinite(strain).all():
            raise InputError.single(name, got="nan or inf", expected="finite strains")
    for name, value in (("thickness", thickness), ("c_threshold", c_threshold)):
        if not bool((np.asarray(value) > 0).all() and np.isfinite(value).all()):
            raise InputError.single(name, got=value, expected="above 0")
