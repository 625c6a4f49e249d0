"""The BRDF of the viewer, read from a picture of floats in Chromium, against the kernel's."""

from __future__ import annotations

import numpy as np
import pytest

from seatlook.model import Appearance
from seatlook.pbr.kernels import brdf as kernel
from seatlook.pbr.kernels.tables import coupling_at
from seatlook.pbr.reflectance.tables import load_tables
from seatlook.pbr.shading.look import pack_materials, tabulated
from seatlook.report.viewer.looks import add_tables, record_of
from seatlook.report.viewer.pack import Buffers
from support.probe import probe_page

pytestmark = pytest.mark.browser

SIDE = 100
MATERIALS = 200


def appearances(rng: np.random.Generator) -> list[Appearance]:
    """Random ones, a half of them without coat, without sheen, without metal, not stretched."""
    share = lambda: float(rng.random() * (rng.random() < 0.5))  # noqa: E731
    return [
        Appearance(
            albedo=rng.random(3),
            metalness=share(),
            roughness=rng.uniform(0.08, 1.0),
            f0=rng.uniform(0.0, 0.2),
            sheen=rng.random(3) * (rng.random() < 0.5),
            sheen_roughness=rng.uniform(0.4, 1.0),
            coat=share(),
            coat_roughness=rng.uniform(0.08, 1.0),
            anisotropy=share() * rng.choice([-1.0, 1.0]),
        )
        for _ in range(MATERIALS)
    ]


def directions(rng: np.random.Generator, count: int) -> np.ndarray:
    """Unit vectors (n, 3) in float32, even over the half-space down to a cosine of 0.02."""
    mu, phi = rng.uniform(0.02, 1.0, count), rng.uniform(0.0, 2 * np.pi, count)
    side = np.sqrt(1 - mu**2)
    return np.column_stack([side * np.cos(phi), side * np.sin(phi), mu]).astype(np.float32)


def by_kernel(
    materials: np.ndarray, row: np.ndarray, v: np.ndarray, l: np.ndarray, wider: np.ndarray
) -> np.ndarray:
    couplings, layers, fibres = tabulated(materials)
    out, tables = np.empty((len(row), 3)), load_tables()
    for k, i in enumerate(row):
        m, roughness = materials[i], float(materials[i]["roughness"])
        x, y, z = map(float, v[k])
        view = kernel.view_of(tables, m, roughness, tuple(m["albedo"].tolist()), x, y, z)
        mean = coupling_at(couplings[i], roughness)
        reflector = kernel.Reflector(m, layers[i], fibres[i], mean, view)
        a, b, c = map(float, l[k])
        if m["anisotropy"] == 0.0:
            half = v[k].astype(float) + l[k]
            half /= np.linalg.norm(half)
            cosines = (c, min(1.0, half[2]), min(1.0, float(half @ l[k])))
            kernel.brdf_isotropic(tables, reflector, float(wider[k]), *cosines, out[k])
        else:
            kernel.brdf(tables, reflector, float(wider[k]), a, b, c, out[k])
    return out


def test_ten_thousand_directions_agree_with_the_kernel(browser, tmp_path):
    rng = np.random.default_rng(26)
    materials = pack_materials(appearances(rng))
    count = SIDE * SIDE
    row = rng.integers(0, MATERIALS, count)
    v, l = directions(rng, count), directions(rng, count)
    # A third near the mirror direction, where lobes are steepest.
    near = np.arange(count) % 3 == 0
    l[near] = v[near] * np.float32([-1, -1, 1]) + rng.normal(0, 0.1, (near.sum(), 3))
    l[:, 2] = np.maximum(l[:, 2], 0.02)
    l /= np.linalg.norm(l, axis=1, keepdims=True)
    wider = (rng.uniform(0, 1e-3, count) * (rng.random(count) < 0.5)).astype(np.float32)
    buffers = Buffers()
    add_tables(buffers, stretched=True)
    buffers.add("sight", np.column_stack([v, wider]).astype(np.float32))
    buffers.add("light", np.column_stack([l, row]).astype(np.float32))
    content = {
        "materials": [record_of(record) for record in materials],
        "side": SIDE,
        "buffers": buffers.packed(),
    }
    page = probe_page(browser, "brdf", content, tmp_path)
    got = np.array(page.evaluate("() => window.probed")).reshape(-1, 4)
    page.close()
    expected = by_kernel(materials, row, v, l, wider)
    error = np.abs(got[:, :3] - expected) / expected
    worst = np.unravel_index(int(error.argmax()), error.shape)
    print(f"relative error at most {error.max():.1e}, mean {error.mean():.1e}, at {worst}")
    assert expected.min() > 0
    assert error.max() <= 1e-3
