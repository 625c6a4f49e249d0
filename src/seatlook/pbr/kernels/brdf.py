"""The BRDF on scalars: same terms, names and order as ``seatlook.pbr.reflectance.brdf``."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from seatlook.pbr.kernels import leaf
from seatlook.pbr.kernels.lobes import (
    F90,
    GGX,
    D_sheen,
    F_multiple,
    GGX_stretched,
    V_Neubelt,
    lobe_of,
)
from seatlook.pbr.kernels.lookup import (
    ROUGHNESS_LOW,
    bilinear,
    cell,
    lookup,
    lookup_mean,
    stretched_at,
)

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
        ("perforation_pitch", np.float64),
        ("perforation_diameter", np.float64),
        ("maps", np.int64),
    ]
)


class Tables(NamedTuple):
    """Directional albedos over roughness (rows) and sqrt(mu) (columns), and their averages.

    ``scale, bias`` (k, n): GGX for F = F0 scale + F90 bias; ``sheen`` (k, n): Charlie, multiplied
    by ``sheen_norm`` (k,) so that it stays below 1; ``*_mean`` (k,): the same averaged over the
    cosine-weighted hemisphere. ``stretched`` (r, a, t, m, 2): what anisotropy adds to scale and
    bias, over roughness, anisotropy, cosine of the azimuth and sqrt(mu);
    ``stretched_mean`` (r, a): to the average with F = 1.
    """

    scale: npt.NDArray[np.float64]
    bias: npt.NDArray[np.float64]
    sheen: npt.NDArray[np.float64]
    scale_mean: npt.NDArray[np.float64]
    bias_mean: npt.NDArray[np.float64]
    sheen_norm: npt.NDArray[np.float64]
    stretched: npt.NDArray[np.float64]
    stretched_mean: npt.NDArray[np.float64]


@leaf()
def E_mean(tables, roughness):
    """Hemisphere mean of the albedo of a lobe with F = 1."""
    return lookup_mean(tables.scale_mean, roughness) + lookup_mean(tables.bias_mean, roughness)


@leaf()
def stretch_of(tables, roughness, anisotropy):
    """Cells of roughness and anisotropy in ``stretched``."""
    rows, steps = tables.stretched_mean.shape
    return cell(roughness, ROUGHNESS_LOW, 1.0, rows), cell(abs(anisotropy), 0.0, 1.0, steps)


@leaf()
def sheen_share(material):
    """Strength of the sheen's strongest colour."""
    return max(material.sheen[0], material.sheen[1], material.sheen[2])


class Means(NamedTuple):
    """Hemisphere means of base and coat, and the share that their repeated bounces keep."""

    base: float
    again: float
    coat: float
    coat_again: float


@leaf()
def means_of(tables, material, roughness):
    """Means at the base's roughness."""
    base, coat, coat_again = E_mean(tables, roughness), 1.0, 0.0
    if material.anisotropy != 0.0:
        (i, a), (k, b) = stretch_of(tables, roughness, material.anisotropy)
        base += bilinear(tables.stretched_mean, i, a, k, b)
    if material.coat > 0.0:
        coat = E_mean(tables, material.coat_roughness)
        coat_again = F_multiple(COAT_F0, 1.0, coat)
    return Means(base, F_multiple(material.f0, F90(material.f0), base), coat, coat_again)


class Layers(NamedTuple):
    """What happens to light at one direction.

    ``scale, bias``: albedo of the base's lobe; ``coat_lost``: share that the coat's lobe reflects
    more than once; ``coat, sheen, base``: light left below the coat, below coat and sheen, and for
    the diffuse base.
    """

    scale: float
    bias: float
    coat_lost: float
    coat: float
    sheen: float
    base: float


class Rows(NamedTuple):
    """Where a surface point lies on the tables' axes: index and weight, per lobe.

    ``stretch``: of roughness and anisotropy.
    """

    base: tuple[int, float]
    coat: tuple[int, float]
    sheen: tuple[int, float]
    stretch: tuple[tuple[int, float], tuple[int, float]]


@leaf()
def rows_of(tables, material, roughness):
    """Rows for the base's roughness and the material's coat and sheen."""
    n = tables.scale.shape[0]
    return Rows(
        cell(roughness, ROUGHNESS_LOW, 1.0, n),
        cell(material.coat_roughness, ROUGHNESS_LOW, 1.0, n),
        cell(material.sheen_roughness, ROUGHNESS_LOW, 1.0, n),
        stretch_of(tables, roughness, material.anisotropy),
    )


@leaf()
def _azimuth(material, x, y):
    """Cosine of the azimuth of (x, y) from the wider axis of a material's lobe, 0 to 1."""
    both = x * x + y * y
    if both < 1e-12:
        return 0.5
    return abs(x if material.anisotropy > 0.0 else y) / np.sqrt(both)


@leaf()
def layers_at(tables, material, rows, means, azimuth, mu):
    """Layers of the dielectric at cosine ``mu``; ``azimuth``: see ``_azimuth``."""
    root = np.sqrt(mu)
    j, b = cell(root, 0.0, 1.0, tables.scale.shape[1])
    i, a = rows.base
    scale, bias = bilinear(tables.scale, i, a, j, b), bilinear(tables.bias, i, a, j, b)
    if material.anisotropy != 0.0:
        more, more_bias = stretched_at(tables.stretched, rows.stretch, azimuth, root)
        scale, bias = scale + more, bias + more_bias
    coat, sheen, lost = 1.0, 1.0, 0.0
    share = material.coat
    if share > 0.0:
        i, a = rows.coat
        low, high = bilinear(tables.scale, i, a, j, b), bilinear(tables.bias, i, a, j, b)
        lost = 1.0 - low - high
        coat -= share * (COAT_F0 * low + high + means.coat_again * lost)
    share = sheen_share(material)
    if share > 0.0:
        i, a = rows.sheen
        sheen -= share * bilinear(tables.sheen, i, a, j, b)
    sheen *= coat
    f0 = material.f0
    reflected = f0 * scale + F90(f0) * bias + means.again * (1.0 - scale - bias)
    return Layers(scale, bias, lost, coat, sheen, sheen * (1.0 - reflected))


@leaf()
def alphas(roughness, anisotropy):
    """Kulla and Conty 2017: width of the lobe along and across the warp."""
    a = roughness * roughness
    return max(a * (1.0 + anisotropy), MIN_ALPHA), max(a * (1.0 - anisotropy), MIN_ALPHA)


class View(NamedTuple):
    """What the BRDF needs of one surface point and view, whatever the light.

    ``roughness``: mean of both axes; ``f0, f90, again``: of the metal's lobe, per channel,
    for as much of the surface as is metal.
    """

    ToV: float
    BoV: float
    NoV: float
    alpha_x: float
    alpha_y: float
    roughness: float
    rows: Rows
    means: Means
    layers: Layers
    colour: tuple[float, float, float]
    f0: tuple[float, float, float]
    f90: tuple[float, float, float]
    again: tuple[float, float, float]


@leaf()
def view_of(tables, material, roughness, colour, ToV, BoV, NoV):
    """View of a point with a base colour."""
    ax, ay = alphas(roughness, material.anisotropy)
    means = means_of(tables, material, roughness)
    rows = rows_of(tables, material, roughness)
    layers = layers_at(tables, material, rows, means, _azimuth(material, ToV, BoV), NoV)
    m, mean, none = material.metalness, means.base, (0.0, 0.0, 0.0)
    if m == 0.0:
        return View(ToV, BoV, NoV, ax, ay, roughness, rows, means, layers, colour, none, none, none)
    r, g, b = colour
    low, high = (m * r, m * g, m * b), (m * F90(r), m * F90(g), m * F90(b))
    again = (
        m * F_multiple(r, F90(r), mean),
        m * F_multiple(g, F90(g), mean),
        m * F_multiple(b, F90(b), mean),
    )
    return View(ToV, BoV, NoV, ax, ay, roughness, rows, means, layers, colour, low, high, again)


@leaf()
def widened(alpha, more):
    """Width of a lobe whose slopes vary by ``more`` in addition."""
    return np.sqrt(alpha * alpha + more) if more > 1e-3 * alpha * alpha else alpha


class Reflector(NamedTuple):
    """A surface point: record and tables of its material, and the sight of it.

    ``layers`` (n, 5), ``fibres`` (n,): see ``tables``; ``coupling``: mean of what reaches the
    diffuse base at this roughness.
    """

    material: np.void
    layers: npt.NDArray[np.float64]
    fibres: npt.NDArray[np.float64]
    coupling: float
    sight: View


@leaf()
def brdf(tables, reflector, wider, ToL, BoL, NoL, out):
    """BRDF [1/sr] into ``out`` (3,); both cosines above 0.

    ``wider``: added to the squared width of the lobes, for a light that is not a point.
    """
    view = reflector.sight
    x, y, z = view.ToV + ToL, view.BoV + BoL, view.NoV + NoL
    inverse = 1.0 / np.sqrt(x * x + y * y + z * z)
    ToH, BoH, NoH = x * inverse, y * inverse, z * inverse
    LoH = min(1.0, ToL * ToH + BoL * BoH + NoL * NoH)
    ax, ay = widened(view.alpha_x, wider), widened(view.alpha_y, wider)
    lobe = GGX_stretched(ax, ay, view, ToL, BoL, NoL, ToH, BoH, NoH)
    lobes = (lobe, _top(reflector, wider, NoL, NoH))
    layered(tables, reflector, lobes, (ToL, BoL, NoL, NoH, LoH), out)


@leaf()
def brdf_isotropic(tables, reflector, wider, NoL, NoH, LoH, out):
    """Same where the lobe is as wide along as across, by the cosines alone."""
    view = reflector.sight
    lobe = GGX(lobe_of(view.alpha_x, wider), view.NoV, NoL, NoH)
    lobes = (lobe, _top(reflector, wider, NoL, NoH))
    layered(tables, reflector, lobes, (0.0, 0.0, NoL, NoH, LoH), out)


@leaf()
def _top(reflector, wider, NoL, NoH):
    """Lobe D V of the coat, 0 where there is none."""
    material = reflector.material
    if material.coat == 0.0:
        return 0.0
    return GGX(lobe_of(material.coat_roughness**2, wider), reflector.sight.NoV, NoL, NoH)


@leaf()
def layered(tables, reflector, lobes, cosines, out):
    """All layers, with the lobes D V of base and coat at hand, into ``out`` (3,).

    ``cosines``: of the light to warp, weft and normal, of the half-vector to normal and light.
    Of a mixture so much of the area is bare metal, the rest dielectric under sheen and coat.
    """
    (ToL, BoL, NoL, NoH, LoH), (lobe, top) = cosines, lobes
    material, view = reflector.material, reflector.sight
    azimuth, here = _azimuth(material, ToL, BoL), view.layers
    there = layers_at(tables, material, view.rows, view.means, azimuth, NoL)
    lost = (1.0 - here.scale - here.bias) * (1.0 - there.scale - there.bias)
    lost /= np.pi * (1.0 - view.means.base)
    dielectric, f0 = 1.0 - material.metalness, material.f0
    diffuse = dielectric * here.base * there.base / (np.pi * reflector.coupling)
    m = 1.0 - LoH
    m *= m * m * m * m
    grey = (f0 + (F90(f0) - f0) * m) * lobe + view.means.again * lost
    grey *= dielectric * min(here.sheen, there.sheen)
    if material.coat > 0.0:
        again = here.coat_lost * there.coat_lost / (np.pi * (1.0 - view.means.coat))
        top = (COAT_F0 + (1.0 - COAT_F0) * m) * top + view.means.coat_again * again
        grey += dielectric * material.coat * top
    for c in range(3):
        out[c] = grey + view.colour[c] * diffuse
    if material.metalness > 0.0:
        for c in range(3):
            fresnel = view.f0[c] + (view.f90[c] - view.f0[c]) * m
            out[c] += fresnel * lobe + view.again[c] * lost
    if sheen_share(material) > 0.0:
        _add_sheen(reflector, min(here.coat, there.coat), NoL, NoH, out)


@leaf()
def _add_sheen(reflector, share, NoL, NoH, out):
    material, sine = reflector.material, np.sqrt(max(0.0, 1.0 - NoH * NoH))
    lobe = D_sheen(reflector.fibres, sine) * V_Neubelt(reflector.sight.NoV, NoL)
    lobe *= share * (1.0 - material.metalness)
    for c in range(3):
        out[c] += material.sheen[c] * lobe


@leaf()
def albedo_towards(tables, material, view, specular, diffuse):
    """Share of a light equal from everywhere that leaves towards the view.

    Into ``specular`` (3,): by the base's lobe; into ``diffuse`` (3,): by sheen and diffuse base.
    Returns the coat's share.
    """
    here, metal, sheen = view.layers, material.metalness, 0.0
    if sheen_share(material) > 0.0:
        sheen = here.coat * (1.0 - metal)
        sheen *= lookup(tables.sheen, material.sheen_roughness, view.NoV)
    lost, f0 = 1.0 - here.scale - here.bias, material.f0
    grey = f0 * here.scale + F90(f0) * here.bias + view.means.again * lost
    grey *= (1.0 - metal) * here.sheen
    for c in range(3):
        lobe = view.f0[c] * here.scale + view.f90[c] * here.bias + view.again[c] * lost
        specular[c] = grey + lobe
        diffuse[c] = (1.0 - metal) * view.colour[c] * here.base + sheen * material.sheen[c]
    return (1.0 - metal) * (1.0 - here.coat)
