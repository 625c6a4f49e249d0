"""Light that the facets of a relief reflect, against the BRDF of each and against integrals."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from seatlook.errors import InputError
from seatlook.io.material import read_material
from seatlook.model import Appearance, Rig
from seatlook.pbr.kernels import brdf as kernel
from seatlook.pbr.kernels.light import above_horizon, disc_of
from seatlook.pbr.kernels.relief_light import brdf_facets, look_at_discs
from seatlook.pbr.kernels.relief_samples import (
    DISC_X,
    DISC_Y,
    MOST,
    NOV,
    ROOM,
    SHARE,
    X,
    Y,
    Z,
    _half,
    _upwards,
    layers_to_eye,
)
from seatlook.pbr.kernels.tables import coupling, coupling_at, fibres, layers
from seatlook.pbr.light.rig import pack_lights
from seatlook.pbr.quality import Quality
from seatlook.pbr.reflectance import brdf
from seatlook.pbr.reflectance.tables import load_tables
from seatlook.pbr.shading.studio import NAP_NODES, NODES, pack_materials

COUNT = 16


def unit(v):
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def tilted(rng, deviation):
    """Normals (n, 3) of facets with Gaussian slopes."""
    slopes = deviation * rng.standard_normal((COUNT, 2))
    return unit(np.column_stack([-slopes, np.ones(COUNT)]))


def reflected(appearance: Appearance, normals, v, l):
    """Mean over facets of BRDF times cosine as the renderer has it, under a point far away."""
    tables, materials = load_tables(), pack_materials([appearance])
    means = np.empty((1, len(tables.scale_mean)))
    coupling(tables, materials, means)
    n = unit(normals.mean(axis=0))
    view = kernel.view_of(
        tables, materials[0], appearance.roughness, tuple(appearance.albedo), 0.0, 0.0, n @ v
    )
    facets = np.full(ROOM, np.nan)
    for row, values in ((X, normals[:, 0]), (Y, normals[:, 1]), (Z, normals[:, 2])):
        facets[row : row + COUNT] = values
    facets[NOV : NOV + COUNT], facets[SHARE : SHARE + COUNT] = normals @ v, 1.0
    at, nap = np.empty((1, NODES, 5)), np.empty((1, NAP_NODES))
    layers(tables, materials, at)
    fibres(tables, materials, nap)
    layers_to_eye(at[0], facets, COUNT)
    lights = pack_lights(Rig(name="r", lights=(), ambient=1.0))
    look_at_discs(lights, 0, facets, COUNT)
    disc, out = disc_of(lights, 0.0, tuple(l)), np.empty(3)
    mean = coupling_at(means[0], view.table_roughness)
    up = (0.0, 0.0, 1.0)
    brdf_facets(
        materials[0], at[0], nap[0], mean, view, facets, COUNT, disc, 0.0, up, tuple(v), out
    )
    return out


def expected(appearance: Appearance, normals, v, l):
    """Return the same by the NumPy BRDF in the frame of each facet."""
    total = np.zeros(3)
    for n in normals:
        t = unit(np.array([1.0, 0.0, 0.0]) - n[0] * n)
        axes = np.stack([t, np.cross(n, t), n])
        if (axes @ l)[2] > 0:
            total += (
                brdf.evaluate(appearance, (axes @ v)[None], (axes @ l)[None])[0] * (axes @ l)[2]
            )
    return total / len(normals)


@pytest.mark.parametrize("name", ["black-leather", "suede"])
@pytest.mark.parametrize("deviation", [0.0, 0.1, 0.25])
def test_facets_reflect_the_mean_of_their_brdf(name, deviation):
    rng = np.random.default_rng(3)
    appearance = replace(read_material(name).appearance, texture="none", texture_depth=0.0)
    for _ in range(20):
        v, l = unit(rng.standard_normal((2, 3)) * 0.6 + [0, 0, 1.2])
        v, l = (unit(np.array([*d[:2], abs(d[2]) + 0.4])) for d in (v, l))
        normals = tilted(rng, deviation)
        normals = normals[np.where(normals @ v > 0.05, np.arange(COUNT), 0)]
        want = expected(appearance, normals, v, l)
        got = reflected(appearance, normals, v, l)
        assert got == pytest.approx(want, rel=2e-3 if deviation == 0 else 1e-2)


def points_looked_at(factor, q, count):
    """Points (count, 2) of a light's disc at which the facets of sample q look."""
    lights, facets = (
        pack_lights(Rig(name="r", lights=(), ambient=1.0), factor),
        np.empty(ROOM),
    )
    look_at_discs(lights, q, facets, count)
    return np.column_stack([facets[DISC_X : DISC_X + count], facets[DISC_Y : DISC_Y + count]])


@pytest.mark.parametrize(
    ("factor", "samples", "count"),
    [(2, (-3,), 4), (2, (-3,), 16), (2, (-1, -2), 4), (2, range(4), 1), (4, range(16), 4)],
)
def test_the_facets_of_a_pixel_look_at_all_points_of_a_disc_as_often(factor, samples, count):
    seen = np.concatenate([points_looked_at(factor, q, count) for q in samples])
    points = pack_lights(Rig(name="r", lights=(), ambient=1.0), factor).disc
    often = [np.isclose(seen, p).all(axis=1).sum() for p in points]
    assert sum(often) == len(seen)
    assert len(set(often)) == 1


def test_rows_have_room_for_the_most_facets():
    assert MOST * MOST <= NOV - Z
    with pytest.raises(InputError, match="1 to 8"):
        Quality(factor=1, rays=0, strata=0, facets=MOST + 1, bounces=0, error=1.0)
    Quality(factor=1, rays=0, strata=0, facets=MOST, bounces=0, error=1.0)


def test_relief_is_dark_where_the_light_has_set_behind_the_surface():
    """Mean of the cosine over the part of a band that both surface and facet see."""
    w = 0.866 * 0.1
    x = np.linspace(-w, w, 20001)
    for cosine, smooth in ((0.3, 0.02), (0.05, -0.03), (-0.02, 0.04), (0.4, 0.5), (0.2, -0.2)):
        want = np.where((cosine + x > 0) & (smooth + x > 0), cosine + x, 0.0).mean()
        assert above_horizon(cosine, smooth, 0.1) == pytest.approx(want, abs=1e-5)


def seen_half_vectors(alpha, v, n):
    """Half-vectors (n, 3) of a GGX lobe at (0, 0, 1) as seen along ``v``; Heitz 2018."""
    a, b = np.random.default_rng(0).random((2, n))
    w = unit(np.array([alpha * v[0], 0.0, v[2]]))
    x, y = np.sqrt(a) * np.cos(2 * np.pi * b), np.sqrt(a) * np.sin(2 * np.pi * b)
    s = 0.5 * (1 + w[2])
    y = (1 - s) * np.sqrt(1 - x**2) + s * y
    z = np.sqrt(np.maximum(0, 1 - x**2 - y**2))
    h = np.stack([z * w[0] - y * w[2], x, z * w[2] + y * w[0]], axis=1)
    return unit(h * [alpha, alpha, 1.0])


@pytest.mark.parametrize("alpha", [0.09, 0.16, 0.49, 0.81])
def test_what_tilted_facets_mirror_below_the_surface_is_lost(alpha):
    """Share of a facet's own lobe that goes above the surface, against sampled half-vectors."""
    off = []
    for MoV in (0.1, 0.2, 0.35, 0.6, 0.9):
        v = np.array([np.sqrt(1 - MoV**2), 0.0, MoV])
        h = seen_half_vectors(alpha, v, 20_000)
        l = 2 * (h @ v)[:, None] * h - v
        c = np.maximum(l[:, 2], 1e-9)
        root = [np.sqrt(x**2 + alpha**2 * (1 - x**2)) / x for x in (np.array(MoV), c)]
        fresnel = 0.04 + 0.96 * (1 - h @ v) ** 5
        weight = np.where(l[:, 2] > 0, fresnel * (1 + root[0]) / (root[0] + root[1]), 0.0)
        for tilt in (-0.2, -0.1, 0.0, 0.1, 0.2, 0.3):
            n = np.array([np.sin(tilt), 0.0, np.cos(tilt)])
            if n @ v < 0.05:
                continue
            want = weight[l @ n > 0].sum() / weight.sum()
            up = 2 * MoV * n[2] - n @ v
            off.append(_upwards(_half(up), _half(MoV), alpha**2) - want)
    assert np.abs(off).max() < 0.12
    assert abs(np.mean(off)) < 0.02
