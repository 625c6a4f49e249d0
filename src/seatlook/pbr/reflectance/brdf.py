"""The BRDF on arrays: the reference that the compiled terms and a path tracer must agree with.

A stack, from the top: clear coat, sheen, a GGX base and the diffuse light that gets through all of
them. Each layer hands on only what it has not reflected, in both directions, so the whole is
reciprocal and never gives back more than it gets. Of a mixture with metal so much of the area is
bare metal. Cosines are ``NoL``, ``NoV``, ``NoH``, ``LoH``; T is the warp and B the weft direction.
"""

from __future__ import annotations

import itertools

import numpy as np

from seatlook.model import Appearance, FloatArray
from seatlook.pbr.kernels.brdf import COAT_F0, MIN_ALPHA
from seatlook.pbr.kernels.lookup import ROUGHNESS_LOW
from seatlook.pbr.reflectance.tables import load_tables


def D_GGX(alpha_x: float, alpha_y: float, h: FloatArray) -> FloatArray:
    """Burley 2012, eq. 13: anisotropic GGX; Walter et al. 2007 where both alphas agree."""
    d = (h[..., 0] / alpha_x) ** 2 + (h[..., 1] / alpha_y) ** 2 + h[..., 2] ** 2
    return np.asarray(1 / (np.pi * alpha_x * alpha_y * d**2))


def V_SmithGGXCorrelated(
    alpha_x: float, alpha_y: float, v: FloatArray, l: FloatArray
) -> FloatArray:
    """Heitz 2014, eq. 99: height-correlated masking over 4 NoL NoV, with the alpha of D."""
    scale = np.array([alpha_x, alpha_y, 1.0])
    view = l[..., 2] * np.linalg.norm(scale * v, axis=-1)
    light = v[..., 2] * np.linalg.norm(scale * l, axis=-1)
    return np.asarray(0.5 / (view + light))


def F_Schlick(f0: FloatArray, f90: FloatArray, LoH: FloatArray) -> FloatArray:
    """Schlick 1994, eq. 15."""
    return f0 + (f90 - f0) * (1 - LoH) ** 5


def F90(f0: FloatArray) -> FloatArray:
    """Lagarde and de Rousiers 2014: below 2 % the reflectance is taken for cavities."""
    return np.minimum(1.0, 50 * f0)


def F_multiple(f0: FloatArray, f90: FloatArray, mean: float) -> FloatArray:
    """Hill 2018 after Kulla and Conty 2017: colour of light reflected two times or more."""
    average = f0 + (f90 - f0) / 21
    return average**2 * mean / (1 - average * (1 - mean))


def D_Charlie(alpha: float, NoH: FloatArray) -> FloatArray:
    """Estevez and Kulla 2017, eq. 2: inverted Gaussian of fibres that stand up."""
    return (2 + 1 / alpha) * (1 - NoH**2) ** (0.5 / alpha) / (2 * np.pi)


def V_Neubelt(NoV: FloatArray, NoL: FloatArray) -> FloatArray:
    """Neubelt and Pettineo 2013: no masking, smooth denominator."""
    return 1 / (4 * (NoL + NoV - NoL * NoV))


def lookup(table: FloatArray, roughness: float, mu: FloatArray) -> FloatArray:
    """Bilinear value of a table at roughness and cosine."""
    i, a = _cell(np.asarray(roughness), ROUGHNESS_LOW, table.shape[0])
    j, b = _cell(np.sqrt(mu), 0.0, table.shape[1])
    below = (1 - b) * table[i, j] + b * table[i, j + 1]
    above = (1 - b) * table[i + 1, j] + b * table[i + 1, j + 1]
    return np.asarray((1 - a) * below + a * above)


def E_mean(roughness: float, anisotropy: float = 0.0) -> float:
    """Hemisphere mean of the albedo of a lobe with F = 1."""
    t = load_tables()
    i, a = _cell(np.asarray(roughness), ROUGHNESS_LOW, len(t.scale_mean))
    mean = t.scale_mean + t.bias_mean
    value = (1 - a) * mean[i] + a * mean[i + 1]
    if anisotropy:
        i, a = _cell(np.asarray(roughness), ROUGHNESS_LOW, t.stretched_mean.shape[0])
        j, b = _cell(np.asarray(abs(anisotropy)), 0.0, t.stretched_mean.shape[1])
        low = (1 - b) * t.stretched_mean[i, j] + b * t.stretched_mean[i, j + 1]
        high = (1 - b) * t.stretched_mean[i + 1, j] + b * t.stretched_mean[i + 1, j + 1]
        value += (1 - a) * low + a * high
    return float(value)


def scale_and_bias(
    roughness: float, anisotropy: float, d: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Albedo of a lobe towards unit directions (..., 3) is ``F0 scale + F90 bias``."""
    t, mu = load_tables(), d[..., 2]
    scale, bias = lookup(t.scale, roughness, mu), lookup(t.bias, roughness, mu)
    if not anisotropy:
        return scale, bias
    both = d[..., 0] ** 2 + d[..., 1] ** 2
    wide = np.abs(d[..., 0 if anisotropy > 0 else 1])
    azimuth = np.where(both < 1e-12, 0.5, wide / np.sqrt(np.maximum(both, 1e-12)))
    places = (np.asarray(roughness), np.asarray(abs(anisotropy)), azimuth, np.sqrt(mu))
    cells = [
        _cell(place, ROUGHNESS_LOW if axis == 0 else 0.0, t.stretched.shape[axis])
        for axis, place in enumerate(places)
    ]
    more = np.zeros((*mu.shape, 2))
    for corner in itertools.product((0, 1), repeat=4):
        weight = np.ones(())
        for (_, a), side in zip(cells, corner, strict=True):
            weight = weight * (a if side else 1 - a)
        node = tuple(i + side for (i, _), side in zip(cells, corner, strict=True))
        more += weight[..., None] * t.stretched[node]
    return scale + more[..., 0], bias + more[..., 1]


def E_lost(roughness: float, anisotropy: float, d: FloatArray) -> FloatArray:
    """Kulla and Conty 2017: share of a lobe with F = 1 that needs more than one bounce."""
    scale, bias = scale_and_bias(roughness, anisotropy, d)
    return 1 - scale - bias


def E_GGX(lobe: tuple[float, float], d: FloatArray, f0: FloatArray, f90: FloatArray) -> FloatArray:
    """Kulla and Conty 2017: reflected share of one GGX lobe with all its bounces.

    ``lobe``: roughness and anisotropy; ``d``: unit directions (..., 3).
    """
    scale, bias = scale_and_bias(*lobe, d)
    return f0 * scale + f90 * bias + F_multiple(f0, f90, E_mean(*lobe)) * (1 - scale - bias)


def alphas(roughness: float, anisotropy: float) -> tuple[float, float]:
    """Kulla and Conty 2017: width of the lobe along and across the warp."""
    a = roughness**2
    return max(a * (1 + anisotropy), MIN_ALPHA), max(a * (1 - anisotropy), MIN_ALPHA)


def passed(appearance: Appearance, d: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Light left in directions (..., 3), of what is no metal.

    Below the coat, below coat and sheen, and for the diffuse base.
    """
    a, one = appearance, np.ones(())
    coat = 1 - a.coat * E_GGX((a.coat_roughness, 0.0), d, COAT_F0 * one, one)
    sheen = lookup(load_tables().sheen, a.sheen_roughness, d[..., 2])
    below = coat * (1 - float(a.sheen.max()) * sheen)
    f0 = np.asarray(a.f0)
    base = below * (1 - E_GGX((a.roughness, a.anisotropy), d, f0, F90(f0)))
    return coat, below, base


def coupling(appearance: Appearance) -> float:
    """Hemisphere mean of what reaches the diffuse base, by the midpoint rule in sqrt(mu)."""
    s = (np.arange(256) + 0.5) / 256
    phi = 0.5 * np.pi * (np.arange(12) + 0.5) / 12
    mu, turn = np.meshgrid(s**2, phi if appearance.anisotropy else phi[:1], indexing="ij")
    side = np.sqrt(1 - mu**2)
    d = np.stack([side * np.cos(turn), side * np.sin(turn), mu], axis=-1)
    return float(4 * (passed(appearance, d)[2] * s[:, None] ** 3).mean())


def specular(
    lobe: tuple[float, float], v: FloatArray, l: FloatArray, f0: FloatArray, f90: FloatArray
) -> FloatArray:
    """GGX lobe with all its bounces [1/sr], (..., 3); ``lobe``: roughness and anisotropy."""
    h = v + l
    h = h / np.linalg.norm(h, axis=-1, keepdims=True)
    ax, ay = alphas(*lobe)
    single = D_GGX(ax, ay, h) * V_SmithGGXCorrelated(ax, ay, v, l)
    LoH = np.minimum(1.0, (l * h).sum(axis=-1))
    mean = E_mean(*lobe)
    again = E_lost(*lobe, v) * E_lost(*lobe, l) / (np.pi * (1 - mean))
    fresnel = F_Schlick(f0, f90, LoH[..., None])
    return fresnel * single[..., None] + F_multiple(f0, f90, mean) * again[..., None]


def evaluate(appearance: Appearance, v: FloatArray, l: FloatArray) -> FloatArray:
    """BRDF [1/sr] of a plain surface.

    Parameters
    ----------
    v, l : (..., 3) float64    unit vectors to eye and light in the frame (warp, weft, normal),
        third component above 0

    Returns
    -------
    (..., 3) float64, linear sRGB

    Examples
    --------
    >>> up = np.array([0.0, 0.0, 1.0])
    >>> grey = Appearance(albedo=np.full(3, 0.18), f0=0.0)
    >>> bool(np.allclose(np.pi * evaluate(grey, up, up), 0.18))
    True
    """
    a, m, one = appearance, appearance.metalness, np.ones(3)
    coat_v, below_v, base_v = passed(a, v)
    coat_l, below_l, base_l = passed(a, l)
    lobe = (a.roughness, a.anisotropy)
    base = specular(lobe, v, l, a.f0 * one, F90(a.f0 * one))
    dielectric = np.minimum(below_v, below_l)[..., None] * base
    dielectric += a.albedo * (base_v * base_l / (np.pi * coupling(a)))[..., None]
    dielectric += np.minimum(coat_v, coat_l)[..., None] * a.sheen * sheen(a, v, l)[..., None]
    dielectric += a.coat * specular((a.coat_roughness, 0.0), v, l, COAT_F0 * one, one)
    metal = specular(lobe, v, l, a.albedo, F90(a.albedo))
    return np.asarray((1 - m) * dielectric + m * metal)


def sheen(appearance: Appearance, v: FloatArray, l: FloatArray) -> FloatArray:
    """Lobe of a white sheen [1/sr], scaled so that its albedo stays below 1."""
    h = v + l
    NoH = np.minimum(1.0, h[..., 2] / np.linalg.norm(h, axis=-1))
    t = load_tables()
    i, a = _cell(np.asarray(appearance.sheen_roughness), ROUGHNESS_LOW, len(t.sheen_norm))
    norm = (1 - a) * t.sheen_norm[i] + a * t.sheen_norm[i + 1]
    lobe = D_Charlie(appearance.sheen_roughness**2, NoH) * V_Neubelt(v[..., 2], l[..., 2])
    return np.asarray(norm * lobe)


def _cell(value: FloatArray, low: float, n: int) -> tuple[FloatArray, FloatArray]:
    """Index and weight for linear interpolation on ``n`` even nodes from ``low`` to 1."""
    x = np.clip((value - low) / (1 - low) * (n - 1), 0.0, n - 1.0)
    i = np.minimum(x.astype(np.int64), n - 2)
    return i, x - i
