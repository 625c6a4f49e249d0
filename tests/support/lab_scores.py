"""How far an identified fabric is from the one that was tested."""

from __future__ import annotations

import numpy as np

from seatlook.identify.tensile import force, force_back
from seatlook.model import Curve, Hysteresis
from support.laboratory import bending_law


def tension_errors(true, made, peak):
    """Largest deviations out and back of both directions [% of the peak], and of the work lost."""
    e, curves, losses = np.linspace(0, peak, 200), [], []
    for axis in ("warp", "weft"):
        pairs = []
        for fabric in (true, made):
            out, back = getattr(fabric, axis), getattr(fabric, f"{axis}_unloading")
            pairs.append((force(out, e), force_back(out, back, e, peak)))
        top = pairs[0][0].max()
        curves += [100 * np.abs(a - b).max() / top for a, b in zip(*pairs, strict=True)]
        lost = [1 - np.trapezoid(back, e) / np.trapezoid(out, e) for out, back in pairs]
        losses.append(100 * (lost[1] / lost[0] - 1))
    return curves, losses


def loop_errors(true, made):
    """The same of bending and shear; losses are widths."""
    curves, losses = [], []
    for axis in ("warp", "weft"):
        (K, H), (k, h) = bending_law(true, axis), bending_law(made, axis)
        curves.append(100 * abs(k.stiffness[0] / K.stiffness[0] - 1))
        losses.append(100 * (h.width / H.width - 1))
    x = np.linspace(0, np.tan(np.radians(8)), 50)
    T, t = (fabric.shear.tension(x) for fabric in (true, made))
    curves.append(100 * np.abs(t - T).max() / T.max())
    for at in (0.0087, 0.0875):
        H, h = (fabric.shear_hysteresis.width_at(at) for fabric in (true, made))
        losses.append(100 * (h / H - 1))
    return curves, losses


def scores(true, findings):
    """Deviation of every parameter over its standard error, of curves with the same knots."""
    out = []
    for one in findings:
        given, value = getattr(true, one.field), one.value
        if one.sigma is None:
            continue
        if isinstance(value, Curve):
            if value.strain.shape == given.strain.shape and np.allclose(
                value.strain, given.strain, rtol=0.02
            ):
                out += ((value.stiffness - given.stiffness) / one.sigma).tolist()
        elif isinstance(value, Hysteresis):
            out.append((value.width - given.width) / one.sigma[0])
        else:
            out.append((value - given) / one.sigma[0])
    return out
