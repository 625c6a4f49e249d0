"""Small pictures kept in the tree: a change in how covers look must be seen and meant.

``SEATLOOK_REGENERATE_GOLDEN=1 pytest tests/pbr/shading/test_golden.py`` writes them anew; look at
them.
"""

from __future__ import annotations

import io
import os
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image as Pillow

from seatlook.model import Appearance, Points, Rig, Stitching, bulb, named_view, sun
from seatlook.pbr import Studio, render_map
from support.reference.lit_sheets import sheet

pytestmark = pytest.mark.render
GOLDEN = Path(__file__).parents[2] / "golden"
LEATHER = Appearance(
    albedo=np.array([0.45, 0.36, 0.27]),
    roughness=0.45,
    coat=0.2,
    coat_roughness=0.35,
    texture="leather",
    texture_scale=0.0012,
    texture_depth=6e-5,
)
SUEDE = Appearance(
    albedo=np.full(3, 0.15),
    roughness=0.9,
    f0=0.02,
    sheen=np.full(3, 0.3),
    sheen_roughness=0.5,
    texture="suede",
    texture_scale=0.0007,
    texture_depth=1.2e-4,
)
SUN = Rig(name="sun", lights=(sun(elevation_deg=45, azimuth_deg=300),), ambient=2500.0)
BULB = Rig(name="bulb", lights=(bulb(position_mm=(-250, -100, 250)),), ambient=2.0)
CAMERA = named_view("front_34", target=np.zeros(3), size=(192, 108), distance=0.45)


def pillow(x, y):
    """Two cushions with a seam valley between them and three wrinkles across one."""
    crown = 0.03 * np.sqrt(np.maximum(0.02, 1 - (np.abs(x) / 0.05 - 1) ** 2))
    wrinkle = 0.0025 * np.cos(2 * np.pi * y / 0.035) * np.exp(-((y / 0.05) ** 2))
    return crown + np.where(x > 0, wrinkle, 0.0)


@pytest.fixture(scope="module")
def solution():
    bare = sheet(pillow, panels=2, steps=40)
    x, panel = bare.positions, bare.cover.panel[np.argsort(bare.cover.faces[:, 0])]
    half = len(x) // 2
    sides = [
        np.flatnonzero((np.abs(x[:, 0]) < 1e-9) & (np.arange(len(x)) // half == k)) for k in (0, 1)
    ]
    a, b = (
        Points(vertices=np.column_stack([v, v]), weights=np.tile([1.0, 0.0], (len(v), 1)))
        for v in sides
    )
    seam = Stitching(name="s", a=a, b=b, length=np.full(len(a), 0.005), stage="sew")
    assert panel.max() == 1
    return replace(bare, cover=replace(bare.cover, stitchings=(seam,)))


def compare(name, content):
    path = GOLDEN / f"{name}.png"
    if os.environ.get("SEATLOOK_REGENERATE_GOLDEN"):
        path.write_bytes(content)
    picture, golden = (np.asarray(Pillow.open(f)).astype(int) for f in (io.BytesIO(content), path))
    assert picture.shape == golden.shape
    difference = np.abs(picture - golden).max(axis=2)
    # Another processor may round a ray at an edge to its other side: few pixels, not the mean.
    assert difference.mean() < 0.2, f"mean difference {difference.mean():.3f} of 255"
    assert (difference > 3).mean() < 0.005, f"{(difference > 3).sum()} pixels differ"


@pytest.mark.parametrize(
    ("name", "look", "rig"),
    [
        ("leather-sun", LEATHER, SUN),
        ("leather-bulb", LEATHER, BULB),
        ("suede-sun", SUEDE, SUN),
        ("suede-and-leather-bulb", {"panel0": SUEDE, "panel1": LEATHER}, BULB),
    ],
)
def test_picture(solution, name, look, rig):
    compare(name, Studio(solution).render(look, rig=rig, camera=CAMERA).to_png())


def test_map(solution):
    x = solution.positions[solution.cover.faces].mean(axis=1)
    picture = render_map(
        solution, np.sin(80 * x[:, 1]), camera=CAMERA, title="W1", unit="1", value_range=(-1.0, 1.0)
    )
    compare("map", picture.to_png())
