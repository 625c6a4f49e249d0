"""Bending stiffness of a cloth: loops of a bending tester, cantilevers, hanging strips."""

from __future__ import annotations

import numpy as np

from seatlook.identify.elastica import load_of_angle, load_of_outline
from seatlook.identify.findings import Ledger
from seatlook.identify.loops import identify_bending
from seatlook.io.laboratory.types import LabTest
from seatlook.io.laboratory.units import STANDARD_GRAVITY
from seatlook.model import Fabric, FloatArray

_AXES = ("warp", "weft")
_ROUNDS = 50


def identify_stiffness(ledger: Ledger, base: Fabric) -> None:
    """Enter D11, D22, D66 and what bending loses.

    A bending tester holds the sides of its wide, short specimen flat and reads D; a narrow strip
    that hangs bends freely and reads ``D11 - D12^2 / D22``.
    """
    diagonal: tuple[LabTest, float] | None = None
    for test in ledger.tests("bending"):
        found = identify_bending(test)
        ledger.residual(test, found.residual)
        if test.direction == "bias":
            diagonal = test, float(found.curve.stiffness[0])
            continue
        ledger.enter(f"bending_{test.direction}", float(found.curve.stiffness[0]), test,
                     found.sigma)  # fmt: skip
        if found.friction is not None:
            ledger.enter(f"bending_{test.direction}_hysteresis", found.friction.width, test,
                         found.friction_sigma[0])  # fmt: skip
    for test in ledger.tests("numbers"):
        if "b_gf_cm2_per_cm" in test.numbers:
            _printed(ledger, test)
    hung = _hung(ledger, base)
    if "bias" in hung:
        diagonal = hung.pop("bias")
    _enter_free(ledger, base, hung)
    _twist(ledger, base, diagonal)


def _printed(ledger: Ledger, test: LabTest) -> None:
    at = test.numbers["hb_at_per_cm"] / 100.0
    how = f"B and 2HB at {at:g} per cm only, KES bending {test.direction}"
    name = f"bending_{test.direction}"
    ledger.enter(name, test.numbers["b_gf_cm2_per_cm"], test, how=how)
    ledger.enter(f"{name}_hysteresis", test.numbers["full_2hb_gf_cm_per_cm"], test, how=how)


def _hung(ledger: Ledger, base: Fabric) -> dict[str, tuple[LabTest, float]]:
    """Stiffness [N m] of strips that bend freely under their own weight, by direction."""
    weight = STANDARD_GRAVITY * float(ledger.value("density", base))
    hung: dict[str, tuple[LabTest, float]] = {}
    for kind in ("cantilever", "hanging-strip"):
        for test in ledger.tests(kind):
            values = [
                weight * value
                for one in test.specimens
                for value in (
                    _cantilevers(one.x, one.y) if kind == "cantilever" else [_outline(one.x, one.y)]
                )
            ]
            assert test.direction is not None
            hung[test.direction] = test, float(np.mean(values))
            spread = np.std(values, ddof=1) / np.sqrt(len(values)) if len(values) > 1 else None
            if test.direction != "bias":
                ledger.enter(f"bending_{test.direction}", float(np.mean(values)), test, spread)
    return hung


def _cantilevers(overhang: FloatArray, angle: FloatArray) -> list[float]:
    """B over weight per area [m3] of every overhang, by the exact elastica."""
    return [float(value) for value in overhang**3 / load_of_angle(angle)]


def _outline(along: FloatArray, down: FloatArray) -> float:
    points = np.column_stack([np.abs(along - along[0]), np.abs(down - down[0])])
    if np.linalg.norm(points[0]) > np.linalg.norm(points[-1]):
        points = points[::-1]
    load, length, _ = load_of_outline(points)
    return length**3 / load


def _enter_free(ledger: Ledger, base: Fabric, hung: dict[str, tuple[LabTest, float]]) -> None:
    """Give back to narrow strips what their anticlastic curvature took."""
    if not hung:
        return
    nu = float(ledger.value("bending_poisson", base))
    D = {axis: float(ledger.value(f"bending_{axis}", base)) for axis in _AXES}
    for _ in range(_ROUNDS):
        taken = {"warp": nu**2 * D["weft"], "weft": nu**2 * D["weft"] ** 2 / D["warp"]}
        D |= {axis: hung[axis][1] + taken[axis] for axis in hung}
    for axis, (test, _) in hung.items():
        sigma = ledger.findings[f"bending_{axis}"].sigma
        how = f"{test.title}, exact elastica, free sides"
        ledger.enter(f"bending_{axis}", D[axis], test, sigma, how)


def _twist(ledger: Ledger, base: Fabric, diagonal: tuple[LabTest, float] | None) -> None:
    """Enter D66 from bending at 45 degrees: B45 = (D11 + D22 + 2 D12 + 4 D66) / 4."""
    if diagonal is None:
        return
    test, B45 = diagonal
    D11, D22 = (float(ledger.value(f"bending_{axis}", base)) for axis in _AXES)
    D12 = float(ledger.value("bending_poisson", base)) * D22
    twist = B45 - 0.25 * (D11 + D22 + 2.0 * D12)
    least = 0.02 * np.sqrt(D11 * D22)
    if twist < least:
        ledger.notes.append(
            f"bending at 45 degrees gives a twist of {twist:.3g} N m; {least:.3g} was taken, the "
            "least that keeps the stiffness positive"
        )
    ledger.enter("bending_twist", float(max(twist, least)), test,
                 how=f"{test.title}, less D11, D22 and D12")  # fmt: skip


def assumed_twist(D11: float, D22: float, poisson: float) -> float:
    """Twist [N m] where no test at 45 degrees was done: that of an isotropic sheet."""
    return float(0.5 * (1.0 - poisson) * np.sqrt(D11 * D22))
