"""What a surface looks like, from a colour meter and a gloss meter, or from a goniometer."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.optimize import least_squares

from seatlook.errors import InputError
from seatlook.io.laboratory.types import Look
from seatlook.model import Appearance, FloatArray
from seatlook.pbr.reflectance import brdf
from seatlook.pbr.reflectance.instrument import appearance_of

_LOW = np.array([0.0, 0.0, 0.0, 0.08, 0.0])
_HIGH = np.array([1.0, 1.0, 1.0, 1.0, 0.2])
_STARTS = (0.2, 0.5, 0.8)  # of roughness: lobes have more than one best place


def identify_look(look: Look, like: Appearance) -> tuple[Appearance, float | None]:
    """Return the appearance that instruments would measure so, and the residual of a goniometer.

    Raises
    ------
    InputError
        A colour or gloss that no surface like ``like`` has.
    """
    plain = replace(like, measured=None, gloss_60=None)
    if look.angles is not None:
        return fit_lobes(look.angles, plain)
    assert look.lab is not None
    assert look.gloss_60 is not None
    return appearance_of(look.lab, look.gloss_60, geometry=look.geometry, like=plain), None


def fit_lobes(table: FloatArray, like: Appearance) -> tuple[Appearance, float]:
    """Fit albedo, roughness and f0 to reflectance factors by least squares.

    Parameters
    ----------
    table : (k, 6)   angles of the light and of the eye from the normal, azimuth between them [rad]
        in the order theta_i, phi, theta_o, then the reflectance factor pi f in linear R, G, B;
        phi = pi looks into the mirrored light

    Returns
    -------
    the appearance, and the RMS of the residual over the RMS of the readings
    """
    incident, phi, seen = table[:, :3].T
    light = np.column_stack([np.sin(incident), np.zeros_like(incident), np.cos(incident)])
    eye = np.column_stack([np.sin(seen) * np.cos(phi), np.sin(seen) * np.sin(phi), np.cos(seen)])
    if (light[:, 2] <= 0.0).any() or (eye[:, 2] <= 0.0).any():
        raise InputError.single("goniometer", got="an angle of 90 degrees or more from the normal",
                                expected="light and eye above the surface")  # fmt: skip
    wanted = table[:, 3:]
    # As much as it stands out, so that a mirrored peak does not drown the rest.
    weight = 1.0 / (np.abs(wanted) + 0.1 * wanted.mean())

    def made(values: FloatArray) -> Appearance:
        v = np.clip(values, _LOW, _HIGH)
        return replace(like, albedo=v[:3], roughness=float(v[3]), f0=float(v[4]))

    def misfit(values: FloatArray) -> FloatArray:
        got = np.pi * brdf.evaluate(made(values), eye, light)
        return np.asarray((weight * (got - wanted)).ravel())

    start = np.clip(np.median(wanted, axis=0), 0.01, 0.99)
    solved = [
        least_squares(misfit, [*start, roughness, 0.04], bounds=(_LOW, _HIGH), x_scale=0.1)
        for roughness in _STARTS
    ]
    best = min(solved, key=lambda one: float(one.cost))
    found = made(best.x)
    rest = np.pi * brdf.evaluate(found, eye, light) - wanted
    return found, float(np.sqrt(np.mean(rest**2) / np.mean(wanted**2)))
