"""What the samples of a relief reflect of one light: the mean of the BRDF over all of them."""

from __future__ import annotations

import numpy as np

from seatlook.pbr.kernels import leaf
from seatlook.pbr.kernels.brdf import COAT_F0, sheen_share
from seatlook.pbr.kernels.light import above_horizon, parts_of, point_of, towards_point
from seatlook.pbr.kernels.lobes import F90, GGX, D_sheen, V_Neubelt, lobe_of
from seatlook.pbr.kernels.relief_samples import layers_towards, mean_of
from seatlook.pbr.kernels.surface import along, dot, unit


@leaf()
def look_at_discs(lights, code, relief):
    """Point of the lights' discs at which each relief sample looks, into ``relief``.

    ``code``: what the sample of the picture stands for.
    """
    rows, size = relief
    points = len(lights.disc)
    parts = parts_of(code, size, points)
    for i in range(size):
        part = (i + 2 * (i >> 2) + (i >> 3)) & (parts - 1)
        point = point_of(code, part, parts, points)
        rows.disc_x[i], rows.disc_y[i] = lights.disc[point, 0], lights.disc[point, 1]


@leaf()
def _cosines(relief, disc, n, v):
    """Share of the light's part at which each relief sample looks, and cosines towards it."""
    rows, size = relief
    for q in range(size):
        l, rows.part[q] = towards_point(disc, rows.disc_x[q], rows.disc_y[q])
        h = unit(along(v, 1.0, l))
        m = (rows.x[q], rows.y[q], rows.z[q])
        rows.NoL[q] = min(1.0, above_horizon(dot(m, l), dot(n, l), disc.radius))
        rows.NoH[q] = min(1.0, dot(m, h))
        grazing = 1.0 - min(1.0, dot(l, h))
        square = grazing * grazing
        rows.grazing[q] = square * square * grazing


@leaf()
def brdf_of_relief(reflector, relief, disc, within, n, v, out):
    """Mean over a relief of BRDF times cosine, into ``out`` (3,).

    ``disc``: of the light; ``within``: what the slopes within a relief sample add to the squared
    width of a lobe; ``n``: normal without the relief.
    """
    rows, size = relief
    _cosines(relief, disc, n, v)
    layers_towards(reflector.layers, rows.NoL, size, rows.light)
    wider = disc.wider + within
    _lobe(lobe_of(reflector.sight.alpha_x, wider), relief, rows.low)
    if reflector.material.coat > 0.0:
        _lobe(lobe_of(reflector.material.coat_roughness**2, wider), relief, rows.top)
    reflected_by(reflector, relief, out)


@leaf()
def _lobe(lobe, relief, out):
    """D V of a lobe at every sample, into a row."""
    rows, size = relief
    for q in range(size):
        out[q] = GGX(lobe, rows.NoV[q], rows.NoL[q], rows.NoH[q])


@leaf()
def reflected_by(reflector, relief, out):
    """The same, where cosines, layers and the lobes D V of base and coat are at hand."""
    material, view, (rows, size) = reflector.material, reflector.sight, relief
    _base(relief)
    dielectric, f0 = 1.0 - material.metalness, material.f0
    diffuse = dielectric * mean_of(rows.diffuse, size) / (np.pi * reflector.coupling)
    bounced = 1.0 / (np.pi * (1.0 - view.means.base))
    grey = f0 * mean_of(rows.lobe, size) + (F90(f0) - f0) * mean_of(rows.lobe_grazing, size)
    grey += view.means.again * bounced * mean_of(rows.again, size)
    sheen = dielectric * _sheen(reflector.fibres, relief) if sheen_share(material) > 0.0 else 0.0
    if material.coat > 0.0:
        grey += material.coat * _coat(view, relief)
    for k in range(3):
        out[k] = dielectric * grey + view.colour[k] * diffuse + sheen * material.sheen[k]
    if material.metalness > 0.0:
        _bare(relief)
        again = bounced * mean_of(rows.again, size)
        lobe, grazing = mean_of(rows.lobe, size), mean_of(rows.lobe_grazing, size)
        for k in range(3):
            out[k] += view.f0[k] * lobe + (view.f90[k] - view.f0[k]) * grazing
            out[k] += view.again[k] * again


@leaf()
def _base(relief):
    """What diffuse base, lobe and bounces in it reflect below sheen and coat, but for colours."""
    rows, size = relief
    here, there = rows.layers, rows.light
    for q in range(size):
        NoL = rows.NoL[q]
        c = NoL * rows.part[q]
        rows.diffuse[q] = c * rows.share[q] * here.base[q] * there.base[q]
        c *= min(here.sheen[q], there.sheen[q])
        rows.again[q] = c * here.lost[q] * there.lost[q]
        c *= rows.low[q]
        rows.lobe[q] = c
        rows.lobe_grazing[q] = c * rows.grazing[q]


@leaf()
def _bare(relief):
    """What a lobe and bounces in it reflect that nothing covers, but for colours."""
    rows, size = relief
    here, there = rows.layers, rows.light
    for q in range(size):
        NoL = rows.NoL[q]
        c = NoL * rows.part[q]
        rows.again[q] = c * here.lost[q] * there.lost[q]
        c *= rows.low[q]
        rows.lobe[q] = c
        rows.lobe_grazing[q] = c * rows.grazing[q]


@leaf()
def _sheen(fibres, relief):
    """Mean of what the sheen reflects."""
    rows, size = relief
    for q in range(size):
        rows.fibres[q] = np.sqrt(1.0 - rows.NoH[q] * rows.NoH[q])
    for q in range(size):
        rows.fibres[q] = D_sheen(fibres, rows.fibres[q])
    for q in range(size):
        NoV, NoL = rows.NoV[q], rows.NoL[q]
        c = NoL * rows.part[q] * min(rows.layers.coat[q], rows.light.coat[q])
        rows.sheen[q] = c * rows.fibres[q] * V_Neubelt(NoV, NoL)
    return mean_of(rows.sheen, size)


@leaf()
def _coat(view, relief):
    """Mean of what a whole coat reflects."""
    rows, size = relief
    here, there = rows.layers, rows.light
    for q in range(size):
        NoL = rows.NoL[q]
        c = NoL * rows.part[q]
        fresnel = COAT_F0 + (1.0 - COAT_F0) * rows.grazing[q]
        rows.coat[q] = c * fresnel * rows.top[q]
        rows.coat_again[q] = c * here.coat_lost[q] * there.coat_lost[q]
    again = mean_of(rows.coat_again, size) / (np.pi * (1.0 - view.means.coat))
    return mean_of(rows.coat, size) + view.means.coat_again * again
