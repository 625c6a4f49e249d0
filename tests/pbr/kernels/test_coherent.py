"""Pixels whose samples count as one: flat, equally lit, of one panel, away from seams."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from seatlook.model import Camera, Thread
from seatlook.pbr.kernels import stitch
from seatlook.pbr.kernels.coherent import find_coherent
from seatlook.pbr.shading.eye import eye_of
from seatlook.pbr.shading.seam import pack_thread
from seatlook.pbr.shading.studio import Studio
from support.reference.lit_sheets import sheet

pytestmark = pytest.mark.render
CAMERA = Camera(
    name="top",
    position=np.array([0.0, 0.0, 0.5]),
    target=np.zeros(3),
    up=np.array([0.0, 1.0, 0.0]),
    vertical_fov_deg=30.0,
    size=(96, 96),
)


def coherent_on(solution, visibility=None, seam_at=None):
    """Coherent pixels, and whether all, or none, of a pixel's samples see the surface."""
    studio = Studio(solution)
    ids = studio.faces(CAMERA, 2)
    if visibility is None:
        visibility = np.full((1, *ids.shape), 255, dtype=np.uint8)
    out = np.zeros(CAMERA.size[::-1], dtype=bool)
    mesh, far = studio.surface.mesh, stitch.reach(studio.thread)
    if seam_at is not None:
        away = np.abs(mesh.vertices[:, 0] - seam_at)
        mesh = mesh._replace(seam=np.column_stack([away, mesh.vertices[:, 1]]))
    find_coherent(mesh, eye_of(CAMERA, 2), ids, visibility, far, out)
    seen = (ids >= 0).reshape(96, 2, 96, 2)
    return out, seen.all(axis=(1, 3)), ~seen.any(axis=(1, 3))


def cylinder(radius):
    return lambda x, y: np.sqrt(np.maximum(radius**2 - x**2, 0.0)) - radius


def test_all_of_a_flat_sheet_and_none_of_its_outline():
    same, whole, outside = coherent_on(sheet(lambda x, y: 0 * x))
    assert same[whole].all()
    assert not same[~whole].any()
    assert not same[outside].any()


def test_not_across_the_edge_of_a_shadow():
    visibility = np.full((1, 192, 192), 255, dtype=np.uint8)
    visibility[:, :, :101] = 0
    same, whole, _ = coherent_on(sheet(lambda x, y: 0 * x), visibility)
    assert not same[:, 50].any()
    assert same[:, [49, 51]][whole[:, [49, 51]]].all()


def test_not_beside_a_seam():
    same, whole, _ = coherent_on(sheet(lambda x, y: 0 * x), seam_at=0.0)
    across = np.abs(np.linspace(-1, 1, 96)) * 0.5 * np.tan(np.radians(15))
    reach = stitch.reach(pack_thread(Thread()))
    assert not same[:, across < reach].any()
    # A face that reaches there counts as a whole.
    assert same[whole & (across > reach + 0.2 / 24 * 1.5)].all()


def test_not_where_two_panels_meet():
    """The edge lies in the middle of a column of pixels."""
    shifted = sheet(lambda x, y: 0 * x, panels=2)
    x = shifted.positions + np.array([0.5 * 0.27 / 96, 0, 0])
    same, _, _ = coherent_on(replace(shifted, positions=x))
    assert not same[20:76, 48].any()
    assert same[20:76, [46, 50]].all()


def test_corners_further_apart_than_samples_do_not_part_them():
    """A sample is 1.4 mm wide: 0.3 degrees of this cylinder, whose corners are 4.8 apart."""
    same, whole, _ = coherent_on(sheet(cylinder(0.2), steps=12))
    assert same[whole].mean() > 0.98


def test_not_where_the_surface_bends_between_samples():
    """3 degrees from sample to sample, along most of a narrow roll."""
    radius = 0.026
    same, whole, _ = coherent_on(
        sheet(lambda x, y: np.sqrt(np.maximum(radius**2 - x**2, 1e-6)), size=0.05, steps=96)
    )
    middle = whole.copy()
    middle[:, :40] = middle[:, 56:] = False
    assert middle.sum() > 100
    assert same[middle].mean() < 0.5
