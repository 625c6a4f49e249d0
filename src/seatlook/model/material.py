"""What a panel is made of (Fabric), what it looks like (Appearance), what lies below (Foam)."""

from __future__ import annotations

from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Literal

import numpy as np

from seatlook.errors import InputError
from seatlook.model._check import FARTHEST, FloatArray, IntArray, floats, in_range, ints, positive
from seatlook.model.texture import TextureMaps

Texture = Literal["none", "leather", "suede", "weave"]
Geometry = Literal["45/0", "d/8 SCI", "d/8 SCE"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Curve:
    """Stiffness, piecewise linear in strain and constant beyond the last knot.

    Parameters
    ----------
    strain : (k,) float64 [1]      Green strain at the knots, rising, the first 0
    stiffness : (k,) float64 [N/m]  slope of the tension curve there, all above 0
    """

    strain: FloatArray
    stiffness: FloatArray

    def __post_init__(self) -> None:
        floats(self, "strain", None)
        floats(self, "stiffness", len(self.strain))
        if self.strain.size == 0 or self.strain[0] != 0 or (np.diff(self.strain) <= 0).any():
            raise InputError.single(
                "Curve.strain", got=self.strain.tolist(), expected="rising knots from 0"
            )
        if (self.stiffness <= 0).any():
            raise InputError.single(
                "Curve.stiffness", got=self.stiffness.tolist(), expected="numbers above 0"
            )

    @classmethod
    def linear(cls, stiffness: float) -> Curve:
        """Make a curve of one constant stiffness [N/m]."""
        return cls(strain=np.zeros(1), stiffness=np.array([stiffness]))

    def tension(self, strain: FloatArray) -> FloatArray:
        """Return the tension [N/m] at Green strains of 0 and more, in closed form.

        Examples
        --------
        >>> Curve(strain=[0.0, 0.1], stiffness=[100.0, 300.0]).tension(np.array([0.1, 0.2]))
        array([20., 50.])
        """
        knots = np.append(self.strain, np.inf)
        reach = np.clip(np.asarray(strain)[..., None] - knots[:-1], 0.0, np.diff(knots))
        rise = np.append(np.diff(self.stiffness) / np.diff(self.strain), 0.0)
        return np.asarray((reach * (self.stiffness + 0.5 * rise * reach)).sum(axis=-1))


@dataclass(frozen=True, slots=True, kw_only=True)
class Hysteresis:
    """Friction that adds to an elastic curve, half of ``width`` on the way out and back.

    The stress that it adds rises over ``strain`` after every turn, then stays at half the width.

    Parameters
    ----------
    width : float [N/m]    between the way out and the way back where the strain is 0 (KES: 2HG)
    growth : float [N/m]   what is added to the width per unit of strain, either way
    strain : float [1]     over which friction builds up to half the width

    Examples
    --------
    >>> Hysteresis(width=12.0, growth=20.0).width_at(0.1)
    14.0
    """

    width: float
    growth: float = 0.0
    strain: float = 0.01

    def __post_init__(self) -> None:
        positive(self, "width", "strain")
        in_range(self, "growth", 0.0, 1e9)
        # Friction must build up faster than it grows, or it never slips.
        if self.growth * self.strain >= self.width:
            raise InputError.single(
                "Hysteresis.growth",
                got=f"{self.growth:.4g} N/m over a strain of {self.strain:.4g}",
                expected=f"below {self.width / self.strain:.4g} N/m, width over strain",
            )

    def width_at(self, strain: float) -> float:
        """Return the full width [N/m] of the loop at a strain of either sign."""
        return self.width + self.growth * abs(strain)


@dataclass(frozen=True, slots=True, kw_only=True)
class Fabric:
    """Mechanics of a sheet; bending does not follow from the membrane but stands for itself.

    Parameters
    ----------
    thickness : float [m]
    density : float [kg/m2]
    warp, weft : Curve             tension along and across the grain
    shear : Curve                  over the shear angle 2 E12
    poisson : float                contraction in weft per stretch along warp, may exceed 0.5
    warp_unloading, weft_unloading : Curve, optional
        tension on the way back, over the strain from where it is gone; the same as on the way out
        if not given, and never below it
    shear_hysteresis : Hysteresis, optional   friction on top of ``shear``, which is the mean then
    compression_ratio : float      compressive stiffness over the first stiffness of the curve
    bending_warp, bending_weft, bending_twist : float [N m]
        D11 (curvature along warp), D22 and D66 of ``m = D kappa`` with kappa = (k11, k22, 2 k12)
    bending_poisson : float        D12 = bending_poisson * D22
    bending_warp_hysteresis, bending_weft_hysteresis : float [N], optional
        moment per width between bending and unbending (KES: 2HB); the solver bends elastically
    """

    thickness: float
    density: float
    warp: Curve
    weft: Curve
    shear: Curve
    warp_unloading: Curve | None = None
    weft_unloading: Curve | None = None
    shear_hysteresis: Hysteresis | None = None
    poisson: float = 0.0
    compression_ratio: float = 1.0
    bending_warp: float
    bending_weft: float
    bending_twist: float
    bending_poisson: float = 0.0
    bending_warp_hysteresis: float | None = None
    bending_weft_hysteresis: float | None = None

    def __post_init__(self) -> None:
        positive(self, "thickness", "density", "bending_warp", "bending_weft", "bending_twist")
        in_range(self, "compression_ratio", 1e-6, 1.0)
        for name in ("bending_warp_hysteresis", "bending_weft_hysteresis"):
            if getattr(self, name) is not None:
                in_range(self, name, 0.0, 1e3)
        _check_friction(self.shear, self.shear_hysteresis)
        for name in ("warp", "weft"):
            _check_unloading(name, getattr(self, name), getattr(self, f"{name}_unloading"))
        for name, matrix in (("membrane", self.membrane_matrix), ("bending", self.bending_matrix)):
            lowest = float(np.linalg.eigvalsh(matrix)[0])
            if not lowest > 0:
                raise InputError.single(
                    f"Fabric.{name}",
                    got=f"smallest eigenvalue {lowest:.4g}",
                    expected="a positive definite stiffness matrix",
                    hint="lower the Poisson ratio",
                )

    @property
    def membrane_matrix(self) -> FloatArray:
        """Stiffness (3, 3) [N/m] at zero strain: (S11, S22, S12) = D (E11, E22, 2 E12)."""
        d11, d22 = self.warp.stiffness[0], self.weft.stiffness[0]
        d12 = self.poisson * d22
        return np.array([[d11, d12, 0.0], [d12, d22, 0.0], [0.0, 0.0, self.shear.stiffness[0]]])

    @property
    def bending_matrix(self) -> FloatArray:
        """Stiffness (3, 3) [N m]: (m11, m22, m12) = D (k11, k22, 2 k12)."""
        d12 = self.bending_poisson * self.bending_weft
        return np.array(
            [
                [self.bending_warp, d12, 0.0],
                [d12, self.bending_weft, 0.0],
                [0.0, 0.0, self.bending_twist],
            ]
        )


def _check_friction(shear: Curve, hysteresis: Hysteresis | None) -> None:
    """Refuse friction that falls faster on the way back than the elastic part rises."""
    if hysteresis is None or 0.5 * hysteresis.growth < shear.stiffness.min():
        return
    raise InputError.single(
        "Fabric.shear_hysteresis",
        got=f"a growth of {hysteresis.growth:.4g} N/m",
        expected=f"below {2.0 * shear.stiffness.min():.4g} N/m, twice the least shear stiffness",
    )


def _check_unloading(name: str, loading: Curve, unloading: Curve | None) -> None:
    """Refuse an unloading curve below the loading curve: it would return more than was stored."""
    if unloading is None:
        return
    knots = np.union1d(loading.strain, unloading.strain)
    # Between knots stiffness is linear, so tensions are closest at a knot or where stiffness meets.
    at = np.interp(knots, unloading.strain, unloading.stiffness)
    lead = at - np.interp(knots, loading.strain, loading.stiffness)
    meet = np.flatnonzero(lead[:-1] * lead[1:] < 0.0)
    share = lead[meet] / (lead[meet] - lead[meet + 1])
    strain = np.concatenate([knots, knots[meet] + share * np.diff(knots)[meet]])
    back, out = unloading.tension(strain), loading.tension(strain)
    worst = int(np.argmin(back - out))
    if back[worst] < out[worst] * (1.0 - 1e-9):
        raise InputError.single(
            f"Fabric.{name}_unloading",
            got=f"{back[worst]:.4g} N/m at strain {strain[worst]:.4g}",
            expected=f"at least the {out[worst]:.4g} N/m of {name}",
            hint="its strain counts from zero tension, so it is the steeper curve",
        )
    if lead[-1] < 0.0:
        raise InputError.single(
            f"Fabric.{name}_unloading",
            got=f"a last stiffness of {unloading.stiffness[-1]:.4g} N/m",
            expected=f"at least the {loading.stiffness[-1]:.4g} N/m of {name}",
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Appearance:
    """How a surface answers light, plus the relief of its grain.

    Parameters
    ----------
    albedo : (3,) float64 in [0, 1]       linear sRGB; base colour
    metalness : float in [0, 1]
    roughness : float in [0.08, 1]        alpha = roughness squared
    f0 : float in [0, 0.2]                reflectance of the dielectric part facing
    sheen : (3,) float64 in [0, 1]        colour of the sheen lobe
    sheen_roughness : float in [0.4, 1]
    coat : float in [0, 1]                share covered by a clear finish
    coat_roughness : float in [0.08, 1]
    anisotropy : float in [-1, 1]         highlight stretched along (+) or across (-) the warp
    texture : relief of the grain; scale is the size of one cell [m], depth its height [m]
    perforation_pitch, perforation_diameter : float [m]
        punched holes in staggered rows along the warp; diameter 0 for none
    maps : measured maps; albedo, metalness and roughness above multiply theirs
    measured : how an instrument measured the colour that ``albedo`` then is: ``45/0``, ``d/8 SCI``
        or ``d/8 SCE``; None: it is that of the base
    gloss_60 : gloss units at 60 degrees (ISO 2813) that stand for the roughness, or None
    """

    albedo: FloatArray
    metalness: float = 0.0
    roughness: float = 0.5
    f0: float = 0.04
    sheen: FloatArray = field(default_factory=lambda: np.zeros(3))
    sheen_roughness: float = 0.5
    coat: float = 0.0
    coat_roughness: float = 0.3
    anisotropy: float = 0.0
    texture: Texture = "none"
    texture_scale: float = 0.001
    texture_depth: float = 0.0
    perforation_pitch: float = 0.006
    perforation_diameter: float = 0.0
    maps: TextureMaps | None = None
    measured: Geometry | None = None
    gloss_60: float | None = None

    def __post_init__(self) -> None:
        floats(self, "albedo", 3)
        if self.gloss_60 is not None:
            in_range(self, "gloss_60", 0.0, 100.0)
            if self.maps is not None and "roughness" in self.maps.given:
                raise InputError.single(
                    "Appearance.gloss_60", got="a roughness map as well", expected="one of them"
                )
        floats(self, "sheen", 3)
        for name in ("albedo", "metalness", "sheen", "coat"):
            in_range(self, name, 0.0, 1.0)
        in_range(self, "f0", 0.0, 0.2)
        in_range(self, "roughness", 0.08, 1.0)
        in_range(self, "coat_roughness", 0.08, 1.0)
        in_range(self, "sheen_roughness", 0.4, 1.0)
        in_range(self, "anisotropy", -1.0, 1.0)
        positive(self, "texture_scale", "perforation_pitch")
        in_range(self, "texture_depth", 0.0, 0.01)
        in_range(self, "perforation_diameter", 0.0, 0.8 * self.perforation_pitch)
        layered = self.coat > 0 or bool(self.sheen.any())
        if layered and self.maps is not None and self.maps.metalness is not None:
            raise InputError.single(
                "Appearance.maps",
                got="a metalness map below a coat or a sheen",
                expected="one of them: metal has neither",
            )


@dataclass(frozen=True, slots=True, kw_only=True)
class Material:
    """A named cover material.

    Parameters
    ----------
    c_threshold : float [1/m]   curvature at which a wrinkle counts; None takes the scene's
    first_wrinkle_radius : float [m]   radius to which the material is bent, visible side inwards,
        when its first wrinkle shows (half pipe, as in VDA 230-205); another way to give c_threshold
    source : key -> where the number comes from, or "judgement"
    """

    name: str
    fabric: Fabric
    appearance: Appearance
    c_threshold: float | None = None
    first_wrinkle_radius: float | None = None
    source: MappingProxyType[str, str] = field(default_factory=lambda: MappingProxyType({}))


@dataclass(frozen=True, slots=True, kw_only=True)
class FoamMaterial:
    """Mechanics of the cushion below the cover.

    Parameters
    ----------
    strain, stress : (k,) float64 [1], [Pa]   compression curve of a column, from (0, 0), rising
    young : float [Pa]; poisson : float        small-strain elasticity, for short waves
    friction : float                           cover on foam
    unloading_stress : (k,) float64 [Pa], optional
        stress on the way back, at most ``stress``; kept, the solver presses elastically
    """

    name: str
    strain: FloatArray
    stress: FloatArray
    young: float
    poisson: float
    friction: float
    unloading_stress: FloatArray | None = None
    source: MappingProxyType[str, str] = field(default_factory=lambda: MappingProxyType({}))

    def __post_init__(self) -> None:
        floats(self, "strain", None)
        floats(self, "stress", len(self.strain))
        curve = np.column_stack([self.strain, self.stress])
        if len(curve) < 2 or curve[0].any() or (np.diff(curve, axis=0) <= 0).any():
            raise InputError.single(
                "FoamMaterial.stress", got=curve.tolist(), expected="rising curve from (0, 0)"
            )
        positive(self, "young")
        in_range(self, "poisson", -0.99, 0.499)
        in_range(self, "friction", 0.0, 2.0)
        if self.unloading_stress is not None:
            floats(self, "unloading_stress", len(self.strain))
            back = self.unloading_stress
            if (back < 0).any() or (back > self.stress).any() or (np.diff(back) < 0).any():
                raise InputError.single(
                    "FoamMaterial.unloading_stress",
                    got=back.tolist(),
                    expected="a rising curve from 0 that is nowhere above stress",
                )


@dataclass(frozen=True, slots=True, kw_only=True)
class Foam:
    """A closed cushion surface, outward normals, with the named curves attached to it.

    Parameters
    ----------
    vertices : (n, 3) float64 [m]; faces : (m, 3) int64
    curves : name -> (k, 3) float64 [m]   wires in the trenches, frame curves below
    """

    vertices: FloatArray
    faces: IntArray
    material: FoamMaterial
    curves: MappingProxyType[str, FloatArray] = field(default_factory=lambda: MappingProxyType({}))

    def __post_init__(self) -> None:
        floats(self, "vertices", None, 3, most=FARTHEST)
        ints(self, "faces", None, 3, below=len(self.vertices))
