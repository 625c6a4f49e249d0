"""*MAT_FABRIC with FORM = -14: what of a cloth goes onto the card, and back.

Units of the card: mm, s, t, N, MPa.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from seatlook.errors import InputError
from seatlook.model import Curve, Fabric, FloatArray

COAT_POISSON = 0.3  # of the coat, which is isotropic
_COAT_MM = 0.1
_CLOSE = 2e-7  # of the peak: how closely points in straight lines follow a curve
_MOST_POINTS = 2000  # of a curve
_FAR = (1.0, 2.0)  # strains of the last points: two, so that the end is known to be straight
_STRAIGHT = 1e-6  # of the largest stiffness, within which points make one line


@dataclass(frozen=True, slots=True, kw_only=True)
class FabricCard:
    """The fields of one *MAT_FABRIC card in the units of the deck.

    Parameters
    ----------
    thickness : [mm]; density [t/mm3]; ea, eb, gab [MPa]; prba, prab
    curves : name of the field -> (k, 2) strain and stress [MPa], without what the coat carries
    hysteresis : H, share of the work of shear that does not come back
    coat_young [MPa], coat_thickness [mm] : ECOAT and TCOAT; 0 for none
    """

    title: str
    number: int
    thickness: float
    density: float
    ea: float
    eb: float
    gab: float
    prba: float
    prab: float
    curves: dict[str, FloatArray]
    hysteresis: float
    coat_young: float
    coat_thickness: float

    @property
    def coat_tension(self) -> float:
        """Stiffness [N/mm] that both coats add to a uniaxial strain."""
        return 2.0 * self.coat_young * self.coat_thickness / (1.0 - COAT_POISSON**2)

    @property
    def bending(self) -> float:
        """Bending stiffness [N mm] of the coats at their distance, the same in every direction."""
        outer = (self.thickness + 2.0 * self.coat_thickness) ** 3 - self.thickness**3
        return self.coat_young * outer / (12.0 * (1.0 - COAT_POISSON**2))

    def stress(self, strain: FloatArray) -> FloatArray:
        """Return stresses (k, 3) [N/m] at (E11, E22, 2 E12) of 0 and more: curves and coat."""
        E = np.asarray(strain, dtype=np.float64)
        own = np.column_stack(
            [np.interp(E[:, i], *self.curves[name].T) for i, name in enumerate(("LCA", "LCB",
                                                                              "LCAB"))]
        )  # fmt: skip
        nu, A = COAT_POISSON, self.coat_tension
        coat = A * np.column_stack(
            [E[:, 0] + nu * E[:, 1], E[:, 1] + nu * E[:, 0], 0.5 * (1.0 - nu) * E[:, 2]]
        )
        return np.asarray(1e3 * (self.thickness * own + coat))


def card_of(
    fabric: Fabric, *, title: str = "cover", number: int = 1, coat: bool = True
) -> FabricCard:
    """Put a cloth onto a card.

    The default measure of the card is second Piola-Kirchhoff stress over Green strain, which is
    what the curves of a cloth are; they need no conversion.

    Parameters
    ----------
    coat : bend by two elastic coats, whose tension is taken from the curves; without them the
        membrane has no bending

    Raises
    ------
    InputError
        The coats would carry more than half of the tension somewhere: the curves must stay firm.
    """
    t = 1e3 * fabric.thickness
    young = 0.0
    if coat:
        B = 1e3 * float(np.sqrt(fabric.bending_warp * fabric.bending_weft))
        young = 12.0 * B * (1.0 - COAT_POISSON**2) / ((t + 2.0 * _COAT_MM) ** 3 - t**3)
    bare = FabricCard(
        title=title, number=number, thickness=t, density=1e-9 * fabric.density / t,
        ea=_first(fabric.warp, t), eb=_first(fabric.weft, t), gab=_first(fabric.shear, t),
        prab=fabric.poisson,
        prba=fabric.poisson * float(fabric.weft.stiffness[0] / fabric.warp.stiffness[0]),
        curves={}, hysteresis=_lost_in_shear(fabric), coat_young=young,
        coat_thickness=_COAT_MM if coat else 0.0,
    )  # fmt: skip
    shares = {"LCA": 1.0, "LCB": 1.0, "LCAB": 0.5 * (1.0 - COAT_POISSON), "LCUA": 1.0, "LCUB": 1.0}
    given = {
        "LCA": fabric.warp, "LCB": fabric.weft, "LCAB": fabric.shear,
        "LCUA": fabric.warp_unloading or fabric.warp, "LCUB": fabric.weft_unloading or fabric.weft,
    }  # fmt: skip
    curves = {
        name: _points(_without_coat(curve, name, shares[name] * bare.coat_tension), t)
        for name, curve in given.items()
    }
    curves["LCUAB"] = curves["LCAB"]
    return replace(bare, curves=curves)


def fabric_of(card: FabricCard, base: Fabric) -> Fabric:
    """Take a cloth from a card; what no card holds is that of the base.

    Bending is that of the coats, the same in every direction; without coats that of the base.
    """
    t, A = card.thickness, 1e3 * card.coat_tension
    shares = {"LCA": 1.0, "LCB": 1.0, "LCAB": 0.5 * (1.0 - COAT_POISSON), "LCUA": 1.0, "LCUB": 1.0}
    read = {
        name: _with_coat(_curve(card.curves[name], t), shares[name] * A)
        for name in shares
        if name in card.curves
    }
    back = {axis: read.get(f"LCU{letter}") for axis, letter in (("warp", "A"), ("weft", "B"))}
    own = {
        axis: None if curve is None or _same(curve, read[f"LC{letter}"]) else curve
        for (axis, curve), letter in zip(back.items(), "AB", strict=True)
    }
    values: dict[str, Any] = {
        "thickness": 1e-3 * t, "density": 1e9 * card.density * t, "poisson": card.prab,
        "warp": read["LCA"], "weft": read["LCB"], "shear": read["LCAB"],
        "warp_unloading": own["warp"], "weft_unloading": own["weft"],
        "shear_hysteresis": None, "bending_warp_hysteresis": None, "bending_weft_hysteresis": None,
    }  # fmt: skip
    if card.coat_young > 0.0:
        B = 1e-3 * card.bending
        values |= {
            "bending_warp": B, "bending_weft": B, "bending_poisson": COAT_POISSON,
            "bending_twist": 0.5 * (1.0 - COAT_POISSON) * B,
        }  # fmt: skip
    return replace(base, **values)


def _first(curve: Curve, thickness: float) -> float:
    return 1e-3 * float(curve.stiffness[0]) / thickness


def _lost_in_shear(fabric: Fabric) -> float:
    """Share of the work of a shear to 8 degrees that does not come back."""
    if fabric.shear_hysteresis is None:
        return 0.0
    top = 0.14
    e = np.linspace(0.0, top, 200)
    half = 0.5 * np.array([fabric.shear_hysteresis.width_at(float(x)) for x in e])
    elastic = float(np.trapezoid(fabric.shear.tension(e), e))
    rubbed = float(np.trapezoid(half, e))
    return float(np.clip(2.0 * rubbed / (elastic + rubbed), 0.0, 0.99))


def _without_coat(curve: Curve, name: str, tension: float) -> Curve:
    """The curve less what the coats carry [N/mm]."""
    coat = 1e3 * tension
    if coat > 0.5 * curve.stiffness.min():
        raise InputError.single(
            name,
            got=f"coats that carry {coat:.4g} of {curve.stiffness.min():.4g} N/m",
            expected="at most half of the least stiffness",
            hint="without coats the card has no bending; give the part a second layer for it",
        )
    return Curve(strain=curve.strain, stiffness=curve.stiffness - coat)


def _with_coat(curve: Curve, coat: float) -> Curve:
    return Curve(strain=curve.strain, stiffness=curve.stiffness + coat)


def _points(curve: Curve, thickness: float) -> FloatArray:
    """Points (k, 2) of strain and stress [MPa], so close that straight lines do."""
    ends = curve.strain
    peak = float(curve.tension(ends[-1:])[0]) or 1.0
    strain = [np.zeros(1)]
    rises = np.abs(np.diff(curve.stiffness) / np.diff(ends)) if len(ends) > 1 else np.zeros(0)
    for low, high, rise in zip(ends[:-1], ends[1:], rises, strict=True):
        step = np.sqrt(8.0 * _CLOSE * peak / max(rise, 1e-12))
        count = int(np.clip(np.ceil((high - low) / step), 4, _MOST_POINTS))
        strain.append(np.linspace(low, high, count + 1)[1:])
    far = [end for end in _FAR if end > ends[-1]]
    E = np.concatenate([*strain, [float(ends[-1]) + f for f in _FAR] if len(far) < 2 else far])
    return np.column_stack([E, 1e-3 * curve.tension(E) / thickness])


def _curve(points: FloatArray, thickness: float) -> Curve:
    """The curve whose points these are: stiffness is known midway between them."""
    E, S = points[:, 0], 1e3 * thickness * points[:, 1]
    if len(E) < 2 or E[0] != 0.0 or S[0] != 0.0:
        raise InputError.single("curve", got=f"{len(E)} points from {E[:1]}",
                                expected="two or more, from (0, 0)")  # fmt: skip
    middle, stiffness = 0.5 * (E[1:] + E[:-1]), np.diff(S) / np.diff(E)
    corners = _corners(middle, stiffness, _STRAIGHT * float(stiffness.max()))
    lines = [
        np.polyfit(middle[a : b + 1], stiffness[a : b + 1], 1) if b > a else (0.0, stiffness[a])
        for a, b in corners
    ]
    knots, values = [0.0], [float(np.polyval(lines[0], 0.0))]
    for (one, other), (_, b) in zip(itertools.pairwise(lines), corners, strict=False):
        fall = one[0] - other[0]
        at = (other[1] - one[1]) / fall if abs(fall) > 0.0 else np.nan
        inside = middle[b] <= at <= middle[min(b + 1, len(middle) - 1)]
        at = float(at) if inside else float(0.5 * (middle[b] + middle[min(b + 1, len(middle) - 1)]))
        knots.append(at)
        values.append(float(np.polyval(one, at)))
    if len(lines) == 1 and abs(lines[0][0]) * float(middle[-1]) > _STRAIGHT * values[0]:
        knots.append(float(middle[-1]))
        values.append(float(stiffness[-1]))
    return Curve(strain=np.array(knots), stiffness=np.maximum(values, 1e-3))


def _corners(x: FloatArray, y: FloatArray, within: float) -> list[tuple[int, int]]:
    """Runs of points, first and last of each, that lie on one straight line."""
    runs, start = [], 0
    while start < len(x):
        end = min(start + 1, len(x) - 1)
        while end + 1 < len(x):
            slope = (y[end + 1] - y[start]) / (x[end + 1] - x[start])
            line = y[start] + slope * (x[start : end + 2] - x[start])
            if np.abs(line - y[start : end + 2]).max() > within:
                break
            end += 1
        runs.append((start, end))
        start = end + 1
    return runs


def _same(one: Curve, other: Curve) -> bool:
    return one.strain.shape == other.strain.shape and bool(
        np.allclose(one.strain, other.strain) and np.allclose(one.stiffness, other.stiffness)
    )
