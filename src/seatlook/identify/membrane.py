"""Tension, shear and Poisson's ratio of a cloth from all tests that stretch it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from seatlook.identify import bias
from seatlook.identify.findings import Ledger
from seatlook.identify.loops import Loop, identify_shear
from seatlook.identify.numbers import curves_of, printed
from seatlook.identify.tensile import Tension, green, identify_tension
from seatlook.io.laboratory.types import LabTest
from seatlook.model import Curve, Fabric, FloatArray, Hysteresis

_AXES = ("warp", "weft")
_MOST_COUPLING = 0.95  # of what keeps the energy convex
_KES_SPAN = np.radians(4.5)  # from 0.5 to 5 degrees, between the two widths of a KES table
_KES_FIRST = np.radians(0.5)


def identify_membrane(ledger: Ledger, base: Fabric) -> None:
    """Enter warp, weft, shear, their ways back, and Poisson's ratio."""
    strips = _tension(ledger)
    _poisson(ledger, base, strips)
    _release(ledger, base, strips)
    _shear(ledger, base, strips)


def _tension(ledger: Ledger) -> dict[str, tuple[LabTest, Tension]]:
    """Enter what held strips say; return the free ones, which contract."""
    free: dict[str, tuple[LabTest, Tension]] = {}
    for test in ledger.tests("tensile"):
        found = identify_tension(test)
        ledger.residual(test, found.residual, found.worst)
        assert test.direction is not None
        if test.sides == "free" or test.direction == "bias":
            free[test.direction] = test, found
        else:
            _enter(ledger, test, found)
    for test in ledger.tests("numbers"):
        if "lt" in test.numbers:
            loading, unloading = curves_of(printed(test))
            how = f"power law through LT, WT and RT only, {test.title}"
            ledger.enter(f"{test.direction}", loading, test, how=how)
            ledger.enter(f"{test.direction}_unloading", unloading, test, how=how)
    return free


def _enter(ledger: Ledger, test: LabTest, found: Tension, how: str = "") -> None:
    ledger.enter(f"{test.direction}", found.loading, test, found.sigma, how)
    if found.unloading is not None:
        ledger.enter(f"{test.direction}_unloading", found.unloading, test, how=how)


def _poisson(ledger: Ledger, base: Fabric, free: dict[str, tuple[LabTest, Tension]]) -> None:
    """Enter Poisson's ratio from measured contraction, or from a held and a free strip."""
    for axis in reversed(_AXES):  # the warp's counts where both are known
        if axis not in free:
            continue
        test, found = free[axis]
        ratios = [_contraction(one.x, one.across) for one in test.specimens
                  if one.across is not None]  # fmt: skip
        other = _AXES[1 - _AXES.index(axis)]
        stiffness = {a: _first(ledger, base, free, a) for a in _AXES}
        turn = 1.0 if axis == "warp" else stiffness[axis] and stiffness[other] / stiffness[axis]
        if ratios:
            error = np.std(ratios, ddof=1) / np.sqrt(len(ratios)) if len(ratios) > 2 else None
            value = float(np.mean(ratios)) * turn
            ledger.enter("poisson", value, test, None if error is None else error * turn,
                         how=f"contraction of {test.title} strips")  # fmt: skip
        elif axis in ledger.findings:
            held = _mean_stiffness(ledger.findings[axis].value, found.range)
            lost = held - _mean_stiffness(found.loading, found.range)
            if lost > 0.0:
                drop = lost / (base.compression_ratio * stiffness["weft"])
                value = float(np.sqrt(drop) if axis == "warp" else np.sqrt(drop * turn))
                how = f"held less free {axis} strips, compression ratio assumed"
                ledger.enter("poisson", value, test, how=how)


def _contraction(strain: FloatArray, across: FloatArray) -> float:
    """Slope of the Green strain across over that along, through no fixed zero."""
    e = strain * np.sign(strain[int(np.abs(strain).argmax())])
    narrow = -np.abs(across)
    out = slice(0, int(e.argmax()) + 1)
    return float(-np.polyfit(green(e[out]), green(narrow[out]), 1)[0])


def _release(ledger: Ledger, base: Fabric, free: dict[str, tuple[LabTest, Tension]]) -> None:
    """Enter curves of free strips where no held one was tested: contraction took its share."""
    poisson, c = ledger.value("poisson", base), base.compression_ratio
    for axis in _AXES:
        if axis not in free or axis in ledger.findings:
            continue
        test, found = free[axis]
        weft, warp = (_first(ledger, base, free, a) for a in ("weft", "warp"))
        lost = c * poisson**2 * weft * (1.0 if axis == "warp" else weft / warp)
        stiffer = replace(found.loading, stiffness=found.loading.stiffness + lost)
        back = found.unloading
        if back is not None:
            back = replace(back, stiffness=back.stiffness + lost)
        how = f"{test.title}, sides free, contraction of {poisson:.3g} added"
        _enter(ledger, test, replace(found, loading=stiffer, unloading=back), how)


def _first(
    ledger: Ledger, base: Fabric, free: dict[str, tuple[LabTest, Tension]], axis: str
) -> float:
    """First stiffness [N/m] of a direction, by the best that is known of it."""
    if axis in ledger.findings:
        return float(ledger.findings[axis].value.stiffness[0])
    if axis in free:
        return float(free[axis][1].loading.stiffness[0])
    return float(getattr(base, axis).stiffness[0])


def _mean_stiffness(curve: Curve, strain: float) -> float:
    return float(curve.tension(np.array([strain]))[0] / strain)


def _shear(ledger: Ledger, base: Fabric, free: dict[str, tuple[LabTest, Tension]]) -> None:
    """Enter the shear curve: loops at small angles, bias extension beyond."""
    loop: Loop | None = None
    for test in ledger.tests("shear"):
        loop = identify_shear(test)
        ledger.residual(test, loop.residual)
        ledger.enter("shear", loop.curve, test, loop.sigma)
        if loop.friction is not None:
            ledger.enter("shear_hysteresis", loop.friction, test, loop.friction_sigma[0])
    for test in ledger.tests("numbers"):
        if "g_gf_per_cm_deg" in test.numbers:
            _printed_shear(ledger, test)
    for test in ledger.tests("bias-extension"):
        curve, error, residual, _ = bias.identify_bias(test)
        ledger.residual(test, residual)
        joined = curve if loop is None else _joined(loop.curve, loop.reach, curve)
        how = "bias extension, yarns taken as inextensible"
        if loop is not None:
            how = f"shear loops, {how} beyond them"
        ledger.enter("shear", joined, test, error if loop is None else None, how)
        _warn_extensible(ledger, base, joined)
    if "bias" in free and "shear" not in ledger.findings:
        _sheet_shear(ledger, base, *free["bias"])


def _sheet_shear(ledger: Ledger, base: Fabric, test: LabTest, found: Tension) -> None:
    """Enter the shear of a sheet that stretches at 45 degrees, point by point of its slope."""
    warp, weft = ledger.value("warp", base), ledger.value("weft", base)
    poisson, c = ledger.value("poisson", base), base.compression_ratio
    # In the strip's tensor both slacken alike: slopes of free strips along warp and weft.
    first = {name: float(curve.stiffness[0]) for name, curve in (("warp", warp), ("weft", weft))}
    lost = poisson**2 * first["weft"] * c
    free_warp = first["warp"] - lost
    free_weft = first["weft"] - lost * first["weft"] / first["warp"]
    G = bias.shear_modulus(float(found.loading.stiffness[0]), free_warp, free_weft, poisson)
    ledger.enter("shear", Curve.linear(G), test, how="slope of strips at 45 degrees")
    _warn_extensible(ledger, base, Curve.linear(G), sheet=True)


def _warn_extensible(ledger: Ledger, base: Fabric, shear: Curve, *, sheet: bool = False) -> None:
    """Say where the other way to read a strip at 45 degrees is the better one."""
    ratio = float(shear.stiffness[0]) / min(
        float(ledger.value(axis, base).stiffness[0]) for axis in _AXES
    )
    if not sheet and ratio > bias.SWITCH:
        ledger.notes.append(
            f"shear over tension is {ratio:.2g}, above {bias.SWITCH:g}: yarns stretch as they "
            'turn; test it as kind = "tensile", direction = "bias", sides = "free"'
        )
    if sheet and ratio < bias.SWITCH:
        ledger.notes.append(
            f"shear over tension is {ratio:.2g}, below {bias.SWITCH:g}: yarns turn rather than "
            'stretch; test it as kind = "bias-extension"'
        )


def _joined(small: Curve, reach: float, large: Curve) -> Curve:
    """Curve of the loops up to their reach, of the strips from there on."""
    beyond = large.strain > 1.05 * reach
    strain = np.concatenate([small.strain, large.strain[beyond]])
    return Curve(strain=strain, stiffness=np.concatenate([small.stiffness,
                                                          large.stiffness[beyond]]))  # fmt: skip


def _printed_shear(ledger: Ledger, test: LabTest) -> None:
    """Enter G and both widths of a KES table; the widths are full ones, at 0.5 and 5 degrees."""
    given = test.numbers
    first, fifth = given["full_2hg_gf_per_cm"], given["full_2hg5_gf_per_cm"]
    growth = max((fifth - first) / _KES_SPAN, 0.0)
    width = max(first - growth * _KES_FIRST, 0.1 * first)
    how = (
        f"G between {np.degrees(given['g_from']):g} and {np.degrees(given['g_to']):g} degrees, "
        "2HG and 2HG5 only, KES shear"
    )
    # On the way out friction grows with the angle, and G is the slope of the way out.
    slope = given["g_gf_per_cm_deg"] - 0.5 * growth
    stiffness = max(slope, 0.5 * given["g_gf_per_cm_deg"], 0.51 * growth)
    ledger.enter("shear", Curve.linear(stiffness), test, how=how)
    strain = min(0.008, 0.9 * width / growth) if growth > 0.0 else 0.008
    ledger.enter("shear_hysteresis", Hysteresis(width=width, growth=growth, strain=strain), test,
                 how=how)  # fmt: skip


def bounded_poisson(fabric: dict[str, object]) -> tuple[float, bool]:
    """Poisson's ratio within what keeps the stiffness positive definite, and whether it was cut."""
    curves = {
        axis: [c for name in (axis, f"{axis}_unloading")
               if isinstance(c := fabric.get(name), Curve)]
        for axis in _AXES
    }  # fmt: skip
    softest = {axis: min(c.stiffness.min() for c in known) for axis, known in curves.items()}
    poisson = float(fabric["poisson"])  # type: ignore[arg-type]
    limit = _MOST_COUPLING * np.sqrt(softest["warp"] * softest["weft"])
    most = float(limit / curves["weft"][0].stiffness[0])
    return float(np.clip(poisson, -most, most)), abs(poisson) > most
