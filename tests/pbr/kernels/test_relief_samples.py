"""Light that the samples of a relief reflect, against the BRDF of each and against integrals."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from seatlook.errors import InputError
from seatlook.io.material import read_material
from seatlook.model import Appearance, Rig
from seatlook.pbr.kernels.coherent import FIRST_HALF, SECOND_HALF, WHOLE
from seatlook.pbr.kernels.light import above_horizon, disc_of
from seatlook.pbr.kernels.relief_light import brdf_of_relief, look_at_discs
from seatlook.pbr.kernels.relief_samples import (
    MOST,
    RELIEF,
    Relief,
    _half,
    _upwards,
    layers_towards,
)
from seatlook.pbr.light.rig import pack_lights
from seatlook.pbr.quality import Quality
from seatlook.pbr.reflectance import brdf
from support.reference.furnace import reflector_of

COUNT = 16


def unit(v):
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def tilted(rng, deviation):
    """Normals (n, 3) of relief samples with Gaussian slopes."""
    slopes = deviation * rng.standard_normal((COUNT, 2))
    return unit(np.column_stack([-slopes, np.ones(COUNT)]))


def empty_relief(size):
    """Return rows that hold no number yet."""
    rows = np.zeros(1, RELIEF)
    rows.view(float)[:] = np.nan
    return Relief(rows[0], size)


def reflected(appearance: Appearance, normals, v, l):
    """Mean over a relief of BRDF times cosine as the renderer has it, under a point far away."""
    reflector = reflector_of(appearance, (0.0, 0.0, unit(normals.mean(axis=0)) @ v))
    relief = empty_relief(COUNT)
    for axis, name in enumerate("xyz"):
        relief.rows[name][:COUNT] = normals[:, axis]
    relief.rows["NoV"][:COUNT], relief.rows["share"][:COUNT] = normals @ v, 1.0
    layers_towards(reflector.layers, relief.rows["NoV"], COUNT, relief.rows["layers"])
    lights = pack_lights(Rig(name="r", lights=(), ambient=1.0))
    look_at_discs(lights, 0, relief)
    disc, out = disc_of(lights, 0.0, tuple(l)), np.empty(3)
    brdf_of_relief(reflector, relief, disc, 0.0, (0.0, 0.0, 1.0), tuple(v), out)
    return out


def expected(appearance: Appearance, normals, v, l):
    """Return the same by the NumPy BRDF in the frame of each relief sample."""
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
def test_a_relief_reflects_the_mean_of_its_brdf(name, deviation):
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


def points_looked_at(factor, code, size):
    """Points (size, 2) of a light's disc at which the relief samples of a sample look."""
    lights = pack_lights(Rig(name="r", lights=(), ambient=1.0), factor)
    relief = empty_relief(size)
    look_at_discs(lights, code, relief)
    return np.column_stack([relief.rows[name][:size] for name in ("disc_x", "disc_y")])


@pytest.mark.parametrize(
    ("factor", "codes", "size"),
    [
        (2, (WHOLE,), 4),
        (2, (WHOLE,), 16),
        (2, (FIRST_HALF, SECOND_HALF), 4),
        (2, range(4), 1),
        (4, range(16), 4),
    ],
)
def test_the_relief_of_a_pixel_looks_at_all_points_of_a_disc_as_often(factor, codes, size):
    seen = np.concatenate([points_looked_at(factor, code, size) for code in codes])
    points = pack_lights(Rig(name="r", lights=(), ambient=1.0), factor).disc
    often = [np.isclose(seen, p).all(axis=1).sum() for p in points]
    assert sum(often) == len(seen)
    assert len(set(often)) == 1


def test_rows_have_room_for_the_most_relief_samples():
    assert empty_relief(0).rows["NoV"].size >= MOST * MOST
    with pytest.raises(InputError, match="1 to 8"):
        Quality(factor=1, rays=0, strata=0, relief=MOST + 1, bounces=0, error=1.0)
    Quality(factor=1, rays=0, strata=0, relief=MOST, bounces=0, error=1.0)


def test_relief_is_dark_where_the_light_has_set_behind_the_surface():
    """Mean of the cosine over the part of a band that both surface and relief see."""
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
def test_what_a_tilted_relief_mirrors_below_the_surface_is_lost(alpha):
    """Share of a tilted lobe that goes above the surface, against sampled half-vectors."""
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
