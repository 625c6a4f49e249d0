"""What the facets of a relief reflect of one light: the mean of the BRDF over all of them."""

from __future__ import annotations

import numpy as np

from seatlook.pbr.kernels import leaf
from seatlook.pbr.kernels.brdf import (
    COAT_F0,
    GGX,
    D_nap,
    V_Neubelt,
    coat_share,
    lobe_of,
    sheen_share,
)
from seatlook.pbr.kernels.light import above_horizon, parts_of, point_of, towards_point
from seatlook.pbr.kernels.relief_samples import (
    AGAIN,
    BASE,
    BASE_L,
    COAT,
    COAT_AGAIN,
    COAT_L,
    COAT_LOBE,
    COAT_LOST,
    COAT_LOST_L,
    DIFFUSE,
    DISC_X,
    DISC_Y,
    FIBRES,
    GRAZING,
    LOBE,
    LOBE_GRAZING,
    LOST,
    LOST_L,
    NAP,
    NAP_L,
    NAP_LOBE,
    NOH,
    NOL,
    NOV,
    PART,
    SHARE,
    X,
    Y,
    Z,
    layers_of,
    mean_of,
)
from seatlook.pbr.kernels.surface import along, dot, unit


@leaf()
def look_at_discs(lights, q, facets, count):
    """Point of the lights' discs at which each facet of sample q looks, into ``facets``."""
    points = len(lights.disc)
    parts = parts_of(q, count, points)
    for i in range(count):
        part = (i + 2 * (i >> 2) + (i >> 3)) & (parts - 1)
        point = point_of(q, part, parts, points)
        facets[DISC_X + i], facets[DISC_Y + i] = lights.disc[point, 0], lights.disc[point, 1]


@leaf()
def _cosines(facets, count, disc, n, v):
    """Share of the light's part at which each facet looks, and cosines towards it."""
    for q in range(count):
        l, facets[PART + q] = towards_point(disc, facets[DISC_X + q], facets[DISC_Y + q])
        h = unit(along(v, 1.0, l))
        m = (facets[X + q], facets[Y + q], facets[Z + q])
        facets[NOL + q] = min(1.0, above_horizon(dot(m, l), dot(n, l), disc.radius))
        facets[NOH + q] = min(1.0, dot(m, h))
        grazing = 1.0 - min(1.0, dot(l, h))
        square = grazing * grazing
        facets[GRAZING + q] = square * square * grazing


@leaf()
def _layers_to_light(layers, facets, count):
    for q in range(count):
        here = layers_of(layers, facets[NOL + q])
        facets[BASE_L + q], facets[NAP_L + q], facets[LOST_L + q] = here[0], here[1], here[2]
        facets[COAT_L + q], facets[COAT_LOST_L + q] = here[3], here[4]


@leaf()
def brdf_facets(material, layers, fibres, coupling, view, facets, count, disc, within, n, v, out):
    """Mean over ``count`` facets of BRDF times cosine, into ``out`` (3,).

    ``layers, fibres``: the material's, see ``tables``; ``disc``: of the light; ``within``: what the
    slopes within a facet add to the squared width of a lobe; ``n``: normal without the relief. The
    other arguments as for ``brdf``.
    """
    _cosines(facets, count, disc, n, v)
    _layers_to_light(layers, facets, count)
    wider = disc.wider + within
    _base(lobe_of(view.alpha_x, wider), facets, count)
    dielectric = 1.0 - material.metalness
    diffuse = dielectric * mean_of(facets, DIFFUSE, count) / (np.pi * coupling)
    again = mean_of(facets, AGAIN, count) / (np.pi * (1.0 - view.means.base))
    lobe, grazing = mean_of(facets, LOBE, count), mean_of(facets, LOBE_GRAZING, count)
    nap = dielectric * _nap(fibres, facets, count) if sheen_share(material) > 0.0 else 0.0
    top = coat_share(material)
    if top > 0.0:
        top *= _coat(lobe_of(material.coat_roughness**2, wider), view, facets, count)
    for k in range(3):
        out[k] = view.f0[k] * lobe + (view.f90[k] - view.f0[k]) * grazing
        out[k] += view.again[k] * again + view.colour[k] * diffuse
        out[k] += nap * material.sheen[k] + top


@leaf()
def _base(lobe, facets, count):
    """What diffuse base, lobe and bounces in it reflect, but for colours."""
    for q in range(count):
        NoL = facets[NOL + q]
        c = NoL * facets[PART + q]
        facets[DIFFUSE + q] = c * facets[SHARE + q] * facets[BASE + q] * facets[BASE_L + q]
        c *= min(facets[NAP + q], facets[NAP_L + q])
        facets[AGAIN + q] = c * facets[LOST + q] * facets[LOST_L + q]
        c *= GGX(lobe, facets[NOV + q], NoL, facets[NOH + q])
        facets[LOBE + q] = c
        facets[LOBE_GRAZING + q] = c * facets[GRAZING + q]


@leaf()
def _nap(fibres, facets, count):
    """Mean of what the nap reflects."""
    for q in range(count):
        facets[FIBRES + q] = np.sqrt(1.0 - facets[NOH + q] * facets[NOH + q])
    for q in range(count):
        facets[FIBRES + q] = D_nap(fibres, facets[FIBRES + q])
    for q in range(count):
        NoV, NoL = facets[NOV + q], facets[NOL + q]
        c = NoL * facets[PART + q] * min(facets[COAT + q], facets[COAT_L + q])
        facets[NAP_LOBE + q] = c * facets[FIBRES + q] * V_Neubelt(NoV, NoL)
    return mean_of(facets, NAP_LOBE, count)


@leaf()
def _coat(lobe, view, facets, count):
    """Mean of what a whole coat reflects."""
    for q in range(count):
        NoL = facets[NOL + q]
        c = NoL * facets[PART + q]
        fresnel = COAT_F0 + (1.0 - COAT_F0) * facets[GRAZING + q]
        facets[COAT_LOBE + q] = c * fresnel * GGX(lobe, facets[NOV + q], NoL, facets[NOH + q])
        facets[COAT_AGAIN + q] = c * facets[COAT_LOST + q] * facets[COAT_LOST_L + q]
    again = mean_of(facets, COAT_AGAIN, count) / (np.pi * (1.0 - view.means.coat))
    return mean_of(facets, COAT_LOBE, count) + view.means.coat_again * again
