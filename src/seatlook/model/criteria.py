"""When a valley counts as a wrinkle: how curvature is read, in which strains, from what on."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Literal, get_args

import numpy as np

from seatlook.errors import InputError
from seatlook.model._check import FloatArray, IntArray
from seatlook.model.material import Material

CurvatureMode = Literal["paper", "tensor"]
StrainMeasure = Literal["green", "logarithmic"]
# A radius of 50 mm [1/m]. Literal eq. (1) halves the curvature of a free fold, so its threshold is
# half as well.
DEFAULT_THRESHOLD: Mapping[CurvatureMode, float] = MappingProxyType({"tensor": 20.0, "paper": 10.0})


@dataclass(frozen=True, slots=True, kw_only=True)
class Criteria:
    """How a result is assessed.

    Parameters
    ----------
    curvature : "paper" (eq. 1 as printed) or "tensor" (the whole curvature)
    thresholds : C_threshold [1/m], one for each panel, or one for all
    strain_measure : "green" or "logarithmic", in which the equations are evaluated

    Raises
    ------
    InputError
        An unknown mode or measure, a threshold that is not above 0.

    Examples
    --------
    >>> Criteria(curvature="paper").thresholds
    (10.0,)
    """

    curvature: CurvatureMode = "tensor"
    thresholds: tuple[float, ...] = ()
    strain_measure: StrainMeasure = "green"

    def __post_init__(self) -> None:
        for name, value, known in (
            ("curvature", self.curvature, get_args(CurvatureMode)),
            ("strain_measure", self.strain_measure, get_args(StrainMeasure)),
        ):
            if value not in known:
                expected = " or ".join(map(repr, known))
                raise InputError.single(name, got=repr(value), expected=expected)
        if not self.thresholds:
            object.__setattr__(self, "thresholds", (DEFAULT_THRESHOLD[self.curvature],))
        if not all(np.isfinite(v) and v > 0 for v in self.thresholds):
            raise InputError.single("c_threshold", got=self.thresholds, expected="above 0")

    def per_face(self, panel: IntArray) -> FloatArray:
        """C_threshold (m,) [1/m] of faces on these panels (m,).

        Raises
        ------
        InputError
            Thresholds for another number of panels.
        """
        count = int(panel.max(initial=-1)) + 1
        if len(self.thresholds) == 1:
            return np.full(len(panel), self.thresholds[0])
        if count > len(self.thresholds):
            raise InputError.single(
                "c_threshold",
                got=f"{len(self.thresholds)} thresholds",
                expected=f"one, or one for each of {count} panels",
            )
        return np.array(self.thresholds)[panel]

    def words(self, panel: IntArray | None = None) -> str:
        """Mode and threshold as every table of W2 states them, of some faces or of all panels.

        Examples
        --------
        >>> Criteria(curvature="tensor", thresholds=(20.0, 50.0 / 3)).words()
        'tensor, 0.0167 to 0.02 per mm'
        """
        values = self.thresholds if panel is None else self.per_face(panel)
        low, high = 1e-3 * float(np.min(values)), 1e-3 * float(np.max(values))
        span = f"{low:.3g}" if low == high else f"{low:.3g} to {high:.3g}"
        log = "" if self.strain_measure == "green" else " of logarithmic strain"
        return f"{self.curvature}{log}, {span} per mm"


def criteria_of(
    materials: Sequence[Material],
    curvature: CurvatureMode,
    *,
    default: float | None = None,
    threshold: float | None = None,
    strain_measure: StrainMeasure = "green",
) -> Criteria:
    """Criteria for panels of these materials.

    Parameters
    ----------
    default : float [1/m]     for materials without a threshold of their own; None: that of the mode
    threshold : float [1/m]   for all panels, whatever their materials say
    """
    if threshold is not None:
        return Criteria(curvature=curvature, thresholds=(threshold,), strain_measure=strain_measure)
    base = DEFAULT_THRESHOLD[curvature] if default is None else default
    return Criteria(
        curvature=curvature,
        thresholds=tuple(_own_threshold(material, curvature, base) for material in materials),
        strain_measure=strain_measure,
    )


def _own_threshold(material: Material, curvature: CurvatureMode, default: float) -> float:
    if material.first_wrinkle_radius is not None:
        return float(threshold_of_radius(material.first_wrinkle_radius, curvature))
    return material.c_threshold or default


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
