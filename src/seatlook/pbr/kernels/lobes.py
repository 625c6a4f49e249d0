"""Lobes and Fresnel terms on scalars: same names as in ``seatlook.pbr.reflectance.brdf``."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from seatlook.pbr.kernels import leaf


@leaf()
def D_GGX(alpha_x, alpha_y, ToH, BoH, NoH):
    """Burley 2012, eq. 13: anisotropic GGX; Walter et al. 2007 where both alphas agree."""
    d = (ToH / alpha_x) ** 2 + (BoH / alpha_y) ** 2 + NoH * NoH
    return 1.0 / (np.pi * alpha_x * alpha_y * d * d)


@leaf()
def V_SmithGGXCorrelated(alpha_x, alpha_y, ToV, BoV, NoV, ToL, BoL, NoL):
    """Heitz 2014, eq. 99: height-correlated masking over 4 NoL NoV, with the alpha of D."""
    view = NoL * np.sqrt((alpha_x * ToV) ** 2 + (alpha_y * BoV) ** 2 + NoV * NoV)
    light = NoV * np.sqrt((alpha_x * ToL) ** 2 + (alpha_y * BoL) ** 2 + NoL * NoL)
    return 0.5 / (view + light)


@leaf()
def GGX_stretched(ax, ay, view, ToL, BoL, NoL, ToH, BoH, NoH):
    """Product of both terms above, seen along ``view``, with one division."""
    x, y, z = ay * ToH, ax * BoH, ax * ay * NoH
    d = x * x + y * y + z * z
    x, y = ax * view.ToV, ay * view.BoV
    seen = NoL * np.sqrt(x * x + y * y + view.NoV * view.NoV)
    x, y = ax * ToL, ay * BoL
    lit = view.NoV * np.sqrt(x * x + y * y + NoL * NoL)
    both = ax * ay
    return both * both * both / (2.0 * np.pi * d * d * (seen + lit))


class Lobe(NamedTuple):
    """GGX lobe whose half-vectors are spread: squared width, and strength of what that bends.

    See ``lobe_of``.
    """

    squared: float
    bent: float


@leaf()
def lobe_of(alpha, more):
    """Lobe of width ``alpha`` seen over half-vectors that vary by ``more``, per axis ``more / 2``.

    A GGX lobe that is only wider has brighter tails, in proportion to its squared width; those of
    a mean over a small disc or relief sample stay as they are. Exact to first order in ``more``.
    """
    a2 = alpha * alpha
    b2 = a2 + more
    return Lobe(b2, more * a2 / (b2 * b2))


@leaf()
def GGX(lobe, NoV, NoL, NoH):
    """The same for a lobe as wide along as across, by the cosines alone."""
    b2, sine2 = lobe.squared, 1.0 - NoH * NoH
    inverse = 1.0 / (b2 + (1.0 - b2) * sine2)
    # Share of the half-vectors that lie closer to the normal.
    t = sine2 * inverse
    view = NoL * np.sqrt(b2 + (1.0 - b2) * NoV * NoV)
    light = NoV * np.sqrt(b2 + (1.0 - b2) * NoL * NoL)
    bent = 1.0 + lobe.bent * (6.0 * t * (1.0 - t) - 1.0)
    return bent * b2 * inverse * inverse / (2.0 * np.pi * (view + light))


@leaf()
def F_Schlick(f0, f90, LoH):
    """Schlick 1994, eq. 15."""
    m = 1.0 - LoH
    m2 = m * m
    return f0 + (f90 - f0) * m2 * m2 * m


@leaf()
def D_Charlie(alpha, NoH):
    """Estevez and Kulla 2017, eq. 2: inverted Gaussian of fibres that stand up."""
    inverse = 1.0 / alpha
    return (2.0 + inverse) * (1.0 - NoH * NoH) ** (0.5 * inverse) / (2.0 * np.pi)


@leaf()
def D_sheen(fibres, sine):
    """Distribution of the sheen's fibres at the sine of a half-vector, see ``tables.fibres``."""
    x = sine * (len(fibres) - 1)
    j = min(int(x), len(fibres) - 2)
    return fibres[j] + (x - j) * (fibres[j + 1] - fibres[j])


@leaf()
def V_Neubelt(NoV, NoL):
    """Neubelt and Pettineo 2013: no masking, smooth denominator."""
    return 1.0 / (4.0 * (NoL + NoV - NoL * NoV))


@leaf()
def F90(f0):
    """Lagarde and de Rousiers 2014: below 2 % the reflectance is taken for cavities."""
    return min(1.0, 50.0 * f0)


@leaf()
def F_multiple(f0, f90, mean):
    """Hill 2018 after Kulla and Conty 2017: colour of light reflected two times or more."""
    average = f0 + (f90 - f0) / 21.0
    return average * average * mean / (1.0 - average * (1.0 - mean))
