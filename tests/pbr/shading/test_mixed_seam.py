"""A seam across space between two unlike panels: other meshes, grains, planes and colours."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from seatlook.model import Appearance, Points, Rig, Stitching, Thread, sun
from seatlook.pbr.shading.studio import Studio
from seatlook.pbr.shading.surface import drawn_surface
from support.reference.lit_sheets import above, flat, grid, sheet

LENGTH, WIDTH, GAP = 0.1, 0.05, 0.0004
STEPS = ((9, 5), (14, 8))  # along and away from the seam
GRAIN = np.radians([35.0, -70.0])
SHIFT = 0.004  # of the second panel's pattern: both lie over each other there
AT = np.array([0.2, -0.1, 0.4])
UP = np.array([0.5, 0.8, 0.2]) / np.linalg.norm([0.5, 0.8, 0.2])


def frames(fold):
    """Unit vectors (2, 3) away from the seam in both panels, and their normals."""
    side = np.cross(UP, [0.0, 0.0, 1.0])
    side /= np.linalg.norm(side)
    normal = np.cross(side, UP)
    turned = np.cos(fold) * side + np.sin(fold) * normal
    return np.array([-side, turned]), np.array([normal, np.cross(turned, UP)])


def sewn(fold, appearances=None):
    """Panels on both sides of a straight line, ``fold`` [rad] to each other and ``GAP`` apart."""
    away, _ = frames(fold)
    solution = sheet(flat, panels=2, steps=2)
    rests, positions, faces, panel, sides = [], [], [], [], []
    count = 0
    for k, (along, across) in enumerate(STEPS):
        low, high = ((-WIDTH, 0.0), (0.0, LENGTH)) if k == 0 else ((0.0, 0.0), (WIDTH, LENGTH))
        flat_points, f = grid(low, high, (across, along))
        u, v = flat_points.T
        # Uneven along the seam, each panel in its own way.
        v = v + (0.008 if k == 0 else -0.004) * np.sin(2 * np.pi * v / LENGTH)
        c, s = np.cos(GRAIN[k]), np.sin(GRAIN[k])
        rests.append(np.column_stack([c * u - s * v, s * u + c * v]) + SHIFT * k)
        gap = 0.5 * GAP * (away[k] if k else away[0])
        positions.append(AT + np.abs(u)[:, None] * away[k] + v[:, None] * UP + gap)
        faces.append(f + count)
        panel.append(np.full(len(f), k))
        on = np.flatnonzero(np.abs(u) < 1e-12)
        sides.append((on[np.argsort(v[on])] + count, np.sort(v[on])))
        count += len(u)
    at = np.linspace(0.0, LENGTH, 41)
    points = []
    for vertices, v in sides:
        j = np.clip(np.searchsorted(v, at, side="right") - 1, 0, len(v) - 2)
        w = (at - v[j]) / (v[j + 1] - v[j])
        points.append(
            Points(
                vertices=np.column_stack([vertices[j], vertices[j + 1]]),
                weights=np.column_stack([1 - w, w]),
            )
        )
    seam = Stitching(name="s", a=points[0], b=points[1], length=np.full(41, 0.0025), stage="sew")
    x, f = np.concatenate(positions), np.concatenate(faces)
    looks = appearances or [material.appearance for material in solution.cover.materials]
    materials = tuple(
        replace(material, appearance=look)
        for material, look in zip(solution.cover.materials, looks, strict=True)
    )
    strain = np.zeros((len(f), 2, 2))
    cover = replace(
        solution.cover, rest=np.concatenate(rests), uv=np.concatenate(rests), positions=x,
        faces=f, panel=np.concatenate(panel), zone=np.zeros(len(f), dtype=int),
        stitchings=(seam,), materials=materials, element_size=0.01,
    )  # fmt: skip
    return replace(
        solution, cover=cover, positions=x, velocities=np.zeros_like(x),
        friction_anchor=np.full_like(x, np.nan), strain_top=strain, strain_mid=strain,
        strain_bottom=strain,
    )  # fmt: skip


def drawn(fold):
    """Surface, and of its panels' vertices: panel, distance from and place along the seam."""
    surface = drawn_surface(sewn(fold), built=False)
    mesh = surface.mesh
    owner = np.zeros(surface.vertices, dtype=int)
    owner[mesh.faces[: surface.faces]] = mesh.panel[: surface.faces, None]
    turn = GRAIN[owner]
    uv = mesh.uv[: surface.vertices] - SHIFT * owner[:, None]
    u = np.abs(np.cos(turn) * uv[:, 0] + np.sin(turn) * uv[:, 1])
    v = np.cos(turn) * uv[:, 1] - np.sin(turn) * uv[:, 0]
    return surface, owner, u, v


@pytest.mark.parametrize("fold", [0.0, 0.9, -0.5])
def test_both_rims_meet_half_way(fold):
    """On the line in the middle of the gap; nothing else has moved."""
    surface, owner, u, v = drawn(fold)
    away, _ = frames(fold)
    x = surface.mesh.vertices[: surface.vertices]
    rim = u < 1e-9
    offset = x - AT - v[:, None] * UP
    middle = 0.25 * GAP * (away[0] + away[1])
    # At the ends the other rim is a little shorter or longer: its foot is its end.
    inner = rim & (v > 0.004) & (v < LENGTH - 0.004)
    for k in (0, 1):
        of_panel = inner & (owner == k)
        assert of_panel.sum() > 60
        sideways = offset[of_panel] - (offset[of_panel] @ UP)[:, None] * UP
        np.testing.assert_allclose(sideways, np.tile(middle, (of_panel.sum(), 1)), atol=2e-6)
        assert np.abs(offset[of_panel] @ UP).max() < 2e-6
        rest = ~rim & (owner == k)
        plane = (u[rest, None] + 0.5 * GAP) * away[k]
        np.testing.assert_allclose(offset[rest], plane, atol=2e-6)


@pytest.mark.parametrize("fold", [0.9, -0.5])
def test_allowance_turns_in_between_both_panels(fold):
    """3 mm long, in the plane across the seam, midway between the two insides."""
    surface, *_ = drawn(fold)
    mesh, n = surface.mesh, surface.vertices
    added = mesh.vertices[n:]
    # A strip's faces are (end, start, below start), then (end, below start, below end).
    strip = np.arange(surface.faces, surface.opaque)
    one, two = np.split(mesh.faces[strip], 2)
    for above_, below in ((one[:, 1], one[:, 2]), (two[:, 0], two[:, 2])):
        length = np.linalg.norm(mesh.vertices[below] - mesh.vertices[above_], axis=1)
        np.testing.assert_allclose(length, 0.003, rtol=1e-9)
        assert below.min() >= n > above_.max()
    _, normals = frames(fold)
    inward = -(normals[0] + normals[1])
    inward /= np.linalg.norm(inward)
    s = (added - AT) @ UP
    inner = (s > 0.005) & (s < LENGTH - 0.005)
    foot = AT + s[inner, None] * UP
    way = added[inner] - foot
    way /= np.linalg.norm(way, axis=1, keepdims=True)
    assert (way @ inward).min() > np.cos(np.radians(14.0))
    assert np.abs(normals[0] @ inward) < np.cos(np.radians(14.0))
    assert np.bincount(mesh.panel[strip]).min() > 0.3 * len(strip)


def test_coordinates_are_each_panels_own():
    """Distance from its own rim and length along its own outline, on the flat, to 14 mm."""
    surface, owner, u, v = drawn(0.9)
    seam = surface.mesh.seam[: surface.vertices]
    near = np.isfinite(seam[:, 0])
    np.testing.assert_array_equal(near, np.isfinite(seam[:, 1]))
    assert (near == (u < 0.014))[np.abs(u - 0.014) > 1e-9].all()
    np.testing.assert_allclose(seam[near, 0], u[near], atol=1e-9)
    # Outlines run counter-clockwise: up on the left panel, down on the right.
    along = np.where(owner == 0, v, LENGTH - v)
    np.testing.assert_allclose(seam[near, 1], along[near], atol=1e-9)
    assert near[owner == 0].any()
    assert near[owner == 1].any()


@pytest.mark.render
def test_thread_of_the_panels_colour_is_that_of_its_own_panel():
    """A red and a blue panel: each stitch is a lighter tone of the cloth it lies on."""
    red = Appearance(albedo=np.array([0.5, 0.06, 0.03]), f0=0.0)
    blue = Appearance(albedo=np.array([0.04, 0.08, 0.45]), f0=0.0)
    studio = Studio(sewn(0.0, (red, blue)), thread=Thread(), built=False)
    away, normals = frames(0.0)
    noon = replace(sun(elevation_deg=80, azimuth_deg=0), colour=np.ones(3))
    rig = Rig(name="noon", lights=(noon,))

    def colour(k, u, v):
        """Mean over 0.2 mm of panel k."""
        target = AT + u * away[k] + v * UP
        camera = replace(
            above(size=(16, 16), fov=1.0), position=target + 0.05 * normals[0], target=target,
            up=UP,
        )  # fmt: skip
        return studio.render(rig=rig, camera=camera).radiance[6:10, 6:10].mean(axis=(0, 1))

    for k, look in enumerate((red, blue)):
        # Stitches are counted along the panel's own outline.
        at = 0.0525 if k == 0 else LENGTH - 0.0525
        stitch, plain = colour(k, 0.005, at), colour(k, 0.03, at)
        np.testing.assert_allclose(plain / plain.sum(), look.albedo / look.albedo.sum(), rtol=0.05)
        lighter = (0.06 + 0.94 * look.albedo) / look.albedo
        ratio = stitch / plain / lighter
        # The thread's relief takes some light from all three colours alike.
        np.testing.assert_allclose(ratio, np.full(3, ratio.mean()), rtol=0.02)
        assert 0.75 < ratio.mean() < 1.0
