"""Shares of a light that samples see, against as many hard shadows as the lamp has points."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from seatlook.model import Camera, Rig, bulb, sun
from seatlook.pbr.kernels import shadow
from seatlook.pbr.light.rig import pack_lights
from seatlook.pbr.quality import quality_named
from seatlook.pbr.shading.eye import eye_of
from seatlook.pbr.shading.studio import Studio
from support.reference.lit_sheets import sheet

pytestmark = pytest.mark.render
SIZE = (320, 180)


def camera(size=SIZE, fov=20.0):
    return Camera(
        name="oblique",
        position=np.array([0.05, -0.35, 0.3]),
        target=np.array([0.02, 0.0, 0.0]),
        up=np.array([0.0, 0.0, 1.0]),
        vertical_fov_deg=fov,
        size=size,
    )


def shares(studio, light, view, *, factor, rays):
    """Share of a light per pixel (h, w) and whether all its samples see the surface."""
    ids = studio.faces(view, factor)
    out = np.full(ids.shape, 255, dtype=np.uint8)
    lights = pack_lights(Rig(name="one", lights=(light,)))
    mesh, eye = studio.surface.mesh, eye_of(view, factor)
    shadow.shadows(studio._bvh, mesh, eye, ids, lights, 0, factor, rays, out)
    w, h = view.size
    pixels = (out / 255).reshape(h, factor, w, factor).mean(axis=(1, 3))
    return pixels, (ids >= 0).reshape(h, factor, w, factor).all(axis=(1, 3))


def by_quality(studio, light, view, name):
    level = quality_named(name)
    return shares(studio, light, view, factor=level.factor, rays=level.rays)


def hard_lights(light, count):
    """The points of a lamp as lights without size, each for an equal part of its disc."""
    middle = light.vector / np.linalg.norm(light.vector)
    across = np.cross(middle, [0.3, 0.2, 0.9])
    across /= np.linalg.norm(across)
    half = light.size if light.near else np.tan(light.size / 2)
    for q in range(count):
        r, phi = np.sqrt((q + 0.5) / count), np.pi * (3 - np.sqrt(5)) * q
        to = np.cos(phi) * across + np.sin(phi) * np.cross(middle, across)
        vector = light.vector + half * r * to
        yield replace(
            light, size=0.0, vector=vector if light.near else vector / np.linalg.norm(vector)
        )


@pytest.fixture(scope="module")
def ridge():
    """An oblique step with a sharp shoulder and a bump, on a fine mesh."""

    def height(x, y):
        step = 0.02 / (1 + np.exp((0.8 * x + 0.6 * y) / 0.0006))
        return step + 0.012 * np.exp(-((x - 0.03) ** 2 + (y + 0.02) ** 2) / (2 * 0.006**2))

    return Studio(sheet(height, steps=160, size=0.2, element_size=0.001))


@pytest.mark.parametrize(("quality", "bar"), [("standard", 0.12), ("high", 0.06)])
@pytest.mark.parametrize("fov", [8.0, 20.0])
def test_the_edge_of_a_sun_is_no_staircase(ridge, quality, bar, fov):
    """Its penumbra is narrower than a pixel: where the edge runs is seen by the samples alone."""
    light, (w, h) = sun(elevation_deg=28, azimuth_deg=250), SIZE
    fine, _ = shares(ridge, light, camera((4 * w, 4 * h), fov), factor=1, rays=64)
    truth = fine.reshape(h, 4, w, 4).mean(axis=(1, 3))
    got, whole = by_quality(ridge, light, camera(fov=fov), quality)
    edge = (truth > 0.02) & (truth < 0.98) & whole
    assert edge.sum() > 100
    assert np.sqrt(np.mean((got - truth)[edge] ** 2)) <= bar


@pytest.fixture(scope="module")
def wall():
    """A wall of 120 mm across an even floor."""
    return Studio(
        sheet(
            lambda x, y: 0.12 * (np.abs(0.8 * x + 0.6 * y) < 0.008),
            steps=160,
            size=0.4,
            element_size=0.0025,
        )
    )


@pytest.mark.parametrize(
    "light",
    [
        sun(elevation_deg=40, azimuth_deg=250, angular_diameter_deg=12.0),
        bulb(position_mm=(-400, 150, 300), radius_mm=60),
    ],
    ids=["wide sun", "near bulb"],
)
def test_a_soft_edge_is_as_wide_as_what_throws_it_is_far(wall, light):
    """The wall stands far from the end of its shadow: what is far softens more."""
    view = replace(camera(fov=25.0), position=np.array([0.1, -0.5, 0.5]))
    truth = np.mean(
        [shares(wall, one, view, factor=1, rays=1)[0] for one in hard_lights(light, 100)], axis=0
    )
    mesh = wall.surface.mesh
    level = np.abs(mesh.vertices[mesh.faces][:, :, 2]).max(axis=1) < 1e-5
    got, _ = by_quality(wall, light, view, "high")
    ids = wall.faces(view, 4)
    floor = ((ids >= 0) & level[ids]).reshape(SIZE[1], 4, SIZE[0], 4).all(axis=(1, 3))
    soft = (truth > 0.02) & (truth < 0.98) & floor
    assert soft.sum() > 2000
    assert np.percentile(np.abs(got - truth)[floor], 99) <= 0.08


def test_the_shadows_of_wrinkles_in_raking_light():
    """Waves lit at 8 degrees: where each shadow ends is right to a tenth of the light."""

    def waves(x, y):
        return 0.0015 * np.cos(2 * np.pi * (0.9 * x + 0.4 * y) / 0.012)

    studio = Studio(sheet(waves, steps=200, size=0.1, element_size=0.0005))
    light, view = sun(elevation_deg=8, azimuth_deg=250), camera(fov=8.0)
    w, h = SIZE
    fine, _ = shares(studio, light, camera((4 * w, 4 * h), 8.0), factor=1, rays=64)
    truth = fine.reshape(h, 4, w, 4).mean(axis=(1, 3))
    got, whole = by_quality(studio, light, view, "standard")
    edge = (truth > 0.02) & (truth < 0.98) & whole
    assert edge.mean() > 0.05
    assert np.sqrt(np.mean((got - truth)[edge] ** 2)) <= 0.12
