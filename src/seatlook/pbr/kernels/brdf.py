"""The BRDF on scalars: same terms, names and order as ``seatlook.pbr.brdf``."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from seatlook.pbr.kernels import leaf

ROUGHNESS_LOW = 0.08
MIN_ALPHA = ROUGHNESS_LOW**2
COAT_F0 = 0.04

MATERIAL = np.dtype(
    [
        ("albedo", np.float64, 3),
        ("metalness", np.float64),
        ("roughness", np.float64),
        ("f0", np.float64),
        ("sheen", np.float64, 3),
        ("sheen_roughness", np.float64),
        ("coat", np.float64),
        ("coat_roughness", np.float64),
        ("anisotropy", np.float64),
        ("texture", np.int64),
        ("texture_scale", np.float64),
        ("texture_depth", np.float64),
    ]
)


class Tables(NamedTuple):
    """Directional albedos over roughness (rows) and sqrt(mu) (columns), and their averages.

    ``scale, bias`` (k, n): GGX for F = F0 scale + F90 bias; ``sheen`` (k, n): Charlie, multiplied
    by ``sheen_norm`` (k,) so that it stays below 1; ``*_mean`` (k,): the same averaged over the
    cosine-weighted hemisphere.
    """

    scale: npt.NDArray[np.float64]
    bias: npt.NDArray[np.float64]
    sheen: npt.NDArray[np.float64]
    scale_mean: npt.NDArray[np.float64]
    bias_mean: npt.NDArray[np.float64]
    sheen_norm: npt.NDArray[np.float64]


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


@leaf()
def cell(value, low, high, n):
    """Index and weight for linear interpolation on ``n`` even nodes."""
    x = (value - low) / (high - low) * (n - 1)
    x = min(max(x, 0.0), n - 1.0)
    i = min(int(x), n - 2)
    return i, x - i


@leaf()
def _bilinear(table, i, a, j, b):
    below = table[i, j] + b * (table[i, j + 1] - table[i, j])
    above = table[i + 1, j] + b * (table[i + 1, j + 1] - table[i + 1, j])
    return below + a * (above - below)


@leaf()
def lookup(table, roughness, mu):
    """Bilinear value of a table at roughness and cosine."""
    i, a = cell(roughness, ROUGHNESS_LOW, 1.0, table.shape[0])
    j, b = cell(np.sqrt(mu), 0.0, 1.0, table.shape[1])
    return _bilinear(table, i, a, j, b)


@leaf()
def lookup_mean(table, roughness):
    """Linear value of a table over roughness alone."""
    i, a = cell(roughness, ROUGHNESS_LOW, 1.0, table.shape[0])
    return table[i] + a * (table[i + 1] - table[i])


@leaf()
def E_parts(tables, roughness, mu):
    """Karis 2013: scale and bias (A, B) of the GGX albedo F0 A + F90 B."""
    i, a = cell(roughness, ROUGHNESS_LOW, 1.0, tables.scale.shape[0])
    j, b = cell(np.sqrt(mu), 0.0, 1.0, tables.scale.shape[1])
    return _bilinear(tables.scale, i, a, j, b), _bilinear(tables.bias, i, a, j, b)


@leaf()
def E_mean(tables, roughness):
    """Hemisphere mean of the albedo of a lobe with F = 1."""
    return lookup_mean(tables.scale_mean, roughness) + lookup_mean(tables.bias_mean, roughness)


@leaf()
def E_GGX(parts, mean, f0, f90):
    """Kulla and Conty 2017: reflected share of one GGX lobe with all its bounces."""
    a, b = parts
    return f0 * a + f90 * b + F_multiple(f0, f90, mean) * (1.0 - a - b)


@leaf()
def coat_share(material):
    """How much of a surface is lacquered: no metal is."""
    return material.coat * max(0.0, 1.0 - 2.0 * material.metalness)


@leaf()
def sheen_share(material):
    """Strength of the nap's strongest colour; metal has no nap."""
    strongest = max(material.sheen[0], material.sheen[1], material.sheen[2])
    return strongest * (1.0 - material.metalness)


@leaf()
def passed(tables, material, parts, mean, mu):
    """Light left at one direction: (below the coat, below coat and nap, to the diffuse base).

    ``parts, mean``: of the base's own lobe at this direction.
    """
    coat = nap = 1.0
    share = coat_share(material)
    if share > 0.0:
        r = material.coat_roughness
        coat -= share * E_GGX(E_parts(tables, r, mu), E_mean(tables, r), COAT_F0, 1.0)
    share = sheen_share(material)
    if share > 0.0:
        nap -= share * lookup(tables.sheen, material.sheen_roughness, mu)
    nap *= coat
    return coat, nap, nap * (1.0 - E_GGX(parts, mean, material.f0, F90(material.f0)))


@leaf()
def alphas(roughness, anisotropy):
    """Kulla and Conty 2017: width of the lobe along and across the warp."""
    a = roughness * roughness
    return max(a * (1.0 + anisotropy), MIN_ALPHA), max(a * (1.0 - anisotropy), MIN_ALPHA)


class View(NamedTuple):
    """What the BRDF needs of one surface point and view, whatever the light.

    ``table_roughness``: of the narrower axis, so that energy added back is never too much.
    """

    ToV: float
    BoV: float
    NoV: float
    alpha_x: float
    alpha_y: float
    table_roughness: float
    mean: float
    lost: float
    coat: float
    nap: float
    base: float
    colour: tuple[float, float, float]


@leaf()
def view_of(tables, material, roughness, share, lighter, ToV, BoV, NoV):
    """View of a point: ``share`` scales the base colour, ``lighter`` then takes it to white."""
    ax, ay = alphas(roughness, material.anisotropy)
    narrow = np.sqrt(min(ax, ay))
    mean = E_mean(tables, narrow)
    parts = E_parts(tables, narrow, NoV)
    coat, nap, base = passed(tables, material, parts, mean, NoV)
    a = material.albedo
    rest = (1.0 - lighter) * share
    colour = (a[0] * rest + lighter, a[1] * rest + lighter, a[2] * rest + lighter)
    lost = 1.0 - parts[0] - parts[1]
    return View(ToV, BoV, NoV, ax, ay, narrow, mean, lost, coat, nap, base, colour)


@leaf()
def _reflectance(material, colour):
    """F0 and F90 of the base: dielectric and metal in linear mixture, so energy mixes too."""
    m = material.metalness
    f0 = (1.0 - m) * material.f0 + m * colour
    return f0, (1.0 - m) * F90(material.f0) + m * F90(colour)


@leaf()
def brdf(tables, material, coupling, view, ToL, BoL, NoL, out):
    """BRDF [1/sr] into ``out`` (3,); both cosines above 0.

    ``coupling``: mean of what reaches the diffuse base at this roughness.
    """
    x, y, z = view.ToV + ToL, view.BoV + BoL, view.NoV + NoL
    inverse = 1.0 / np.sqrt(x * x + y * y + z * z)
    ToH, BoH, NoH = x * inverse, y * inverse, z * inverse
    LoH = min(1.0, ToL * ToH + BoL * BoH + NoL * NoH)
    lobe = D_GGX(view.alpha_x, view.alpha_y, ToH, BoH, NoH)
    lobe *= V_SmithGGXCorrelated(
        view.alpha_x, view.alpha_y, view.ToV, view.BoV, view.NoV, ToL, BoL, NoL
    )
    parts = E_parts(tables, view.table_roughness, NoL)
    coat, nap, base = passed(tables, material, parts, view.mean, NoL)
    again = view.lost * (1.0 - parts[0] - parts[1]) / (np.pi * (1.0 - view.mean))
    diffuse = (1.0 - material.metalness) * view.base * base / (np.pi * coupling)
    nap = min(view.nap, nap)
    for c in range(3):
        f0, f90 = _reflectance(material, view.colour[c])
        specular = F_Schlick(f0, f90, LoH) * lobe + F_multiple(f0, f90, view.mean) * again
        out[c] = nap * specular + view.colour[c] * diffuse
    if sheen_share(material) > 0.0:
        _add_sheen(tables, material, min(view.coat, coat), view.NoV, NoL, NoH, out)
    if coat_share(material) > 0.0:
        _add_coat(tables, material, view, ToL, BoL, NoL, NoH, LoH, out)


@leaf()
def _add_sheen(tables, material, share, NoV, NoL, NoH, out):
    lobe = D_Charlie(material.sheen_roughness**2, NoH) * V_Neubelt(NoV, NoL)
    lobe *= lookup_mean(tables.sheen_norm, material.sheen_roughness)
    for c in range(3):
        out[c] += share * (1.0 - material.metalness) * material.sheen[c] * lobe


@leaf()
def _add_coat(tables, material, view, ToL, BoL, NoL, NoH, LoH, out):
    r = material.coat_roughness
    a, mean = r * r, E_mean(tables, r)
    lobe = D_GGX(a, a, np.sqrt(max(0.0, 1.0 - NoH * NoH)), 0.0, NoH)
    lobe *= V_SmithGGXCorrelated(a, a, view.ToV, view.BoV, view.NoV, ToL, BoL, NoL)
    av, bv = E_parts(tables, r, view.NoV)
    al, bl = E_parts(tables, r, NoL)
    again = (1.0 - av - bv) * (1.0 - al - bl) / (np.pi * (1.0 - mean))
    again *= F_multiple(COAT_F0, 1.0, mean)
    for c in range(3):
        out[c] += coat_share(material) * (F_Schlick(COAT_F0, 1.0, LoH) * lobe + again)


@leaf()
def albedo_towards(tables, material, view, out):
    """Share of a light equal from everywhere that leaves towards the view, into ``out`` (3,)."""
    parts = E_parts(tables, view.table_roughness, view.NoV)
    metal, sheen = material.metalness, 0.0
    if sheen_share(material) > 0.0:
        sheen = view.coat * (1.0 - metal)
        sheen *= lookup(tables.sheen, material.sheen_roughness, view.NoV)
    for c in range(3):
        f0, f90 = _reflectance(material, view.colour[c])
        out[c] = view.nap * E_GGX(parts, view.mean, f0, f90)
        out[c] += (1.0 - metal) * view.colour[c] * view.base
        out[c] += sheen * material.sheen[c] + (1.0 - view.coat)
