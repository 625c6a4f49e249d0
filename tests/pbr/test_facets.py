"""Light that the facets of a relief reflect, against the BRDF of each and against integrals."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from seatlook.io.material import read_material
from seatlook.model import Appearance
from seatlook.pbr import brdf
from seatlook.pbr.kernels import brdf as kernel
from seatlook.pbr.kernels.facets import (
    NOV,
    ROWS,
    SHARE,
    X,
    Y,
    Z,
    brdf_facets,
    curves_to_eye,
)
from seatlook.pbr.kernels.light import above_horizon
from seatlook.pbr.kernels.tables import coupling, coupling_at
from seatlook.pbr.studio import pack_materials
from seatlook.pbr.tables import load_tables

COUNT = 16


def unit(v):
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def tilted(rng, deviation):
    """Normals (n, 3) of facets with Gaussian slopes."""
    slopes = deviation * rng.standard_normal((COUNT, 2))
    return unit(np.column_stack([-slopes, np.ones(COUNT)]))


def reflected(appearance: Appearance, normals, v, l, parts):
    """Mean over facets of BRDF times cosine as the renderer has it, each at one of some parts."""
    tables, materials = load_tables(), pack_materials([appearance])
    means = np.empty((1, len(tables.scale_mean)))
    coupling(tables, materials, means)
    n = unit(normals.mean(axis=0))
    view = kernel.view_of(
        tables, materials[0], appearance.roughness, tuple(appearance.albedo), 0.0, 0.0, n @ v
    )
    facets = np.empty((ROWS, COUNT))
    facets[[X, Y, Z]], facets[NOV], facets[SHARE] = normals.T, normals @ v, 1.0
    curves = curves_to_eye(tables, materials[0], view, facets, COUNT)
    mean = coupling_at(means[0], view.table_roughness)
    total, out = np.zeros(3), np.empty(3)
    for turn in range(parts):
        part = (tuple(l), 0.0, float(l[2]), 0.0, turn, parts)
        brdf_facets(tables, materials[0], mean, view, curves, facets, COUNT, part, tuple(v), out)
        total += out / parts
    return total


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
        for parts in (1, 4):
            got = reflected(appearance, normals, v, l, parts)
            assert got == pytest.approx(want, rel=2e-3 if deviation == 0 else 1e-2)


def test_relief_is_dark_where_the_light_has_set_behind_the_surface():
    """Mean of the cosine over the part of a band that both surface and facet see."""
    w = 0.866 * 0.1
    x = np.linspace(-w, w, 20001)
    for cosine, smooth in ((0.3, 0.02), (0.05, -0.03), (-0.02, 0.04), (0.4, 0.5), (0.2, -0.2)):
        want = np.where((cosine + x > 0) & (smooth + x > 0), cosine + x, 0.0).mean()
        assert above_horizon(cosine, smooth, 0.1) == pytest.approx(want, abs=1e-5)
