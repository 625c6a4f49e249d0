"""Floor and valance as triangles."""

from __future__ import annotations

import numpy as np
import pytest

from seatlook.mesh import face_normals
from seatlook.pbr.shading.ground import ground_of, hem_loops

NOTHING = np.zeros((0, 3))


def ring(count=60, radius=0.2, height=0.03, wave=0.0):
    """Lower edge of an upright tube: places, outward normals, edges with the tube to their left."""
    angle = 2 * np.pi * np.arange(count) / count
    out = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(count)])
    low = [0.0, 0.0, 1.0] * (height + wave * np.sin(9 * angle))[:, None]
    k = np.arange(count)
    return radius * out + low, out, np.column_stack([k, (k + 1) % count])


def block(height=0.0):
    """Corners of the foam inside the tube."""
    return np.array([[x, y, height] for x in (-0.1, 0.1) for y in (-0.1, 0.1)])


def walls(ground):
    return face_normals(ground.vertices, ground.faces)[ground.floor :]


def test_the_hem_of_two_panels_is_one_line():
    x, _, edges = ring()
    x = np.vstack([x, x[[0, 30]] + 0.001])  # each panel has corners of its own
    edges[edges == 30] = 30
    edges[29, 1], edges[59, 1] = 61, 60
    (loop,) = hem_loops(x, edges)
    assert sorted(loop.tolist()) == list(range(62))


def test_two_hems_are_two_lines():
    (a, _, e), (b, _, f) = ring(), ring(radius=0.1, count=40)
    loops = hem_loops(np.vstack([a, b]), np.vstack([e, f + len(a)]))
    assert sorted(map(len, loops)) == [40, 60]


def test_the_floor_faces_up_lies_at_the_lowest_point_and_reaches_the_horizon():
    x, n, edges = ring()
    ground = ground_of(x, n, edges, block())
    flat = ground.faces[: ground.floor]
    area = np.cross(*(ground.vertices[flat[:, k]] - ground.vertices[flat[:, 0]] for k in (1, 2)))
    assert (area[:, 2] > 0).all()
    assert np.abs(ground.vertices[flat][..., 2]).max() == 0.0
    assert np.linalg.norm(ground.vertices[ground.rim], axis=1).min() > 39
    # Rings do not overlap: together they are as large as the outermost one.
    rim = ground.vertices[ground.rim]
    outer = 0.5 * np.abs((rim * np.roll(rim[:, [1, 0, 2]], -1, axis=0) * [1, -1, 0]).sum())
    assert 0.5 * area[:, 2].sum() == pytest.approx(outer, rel=1e-9)


def test_a_valance_hides_the_hem_down_to_the_floor_and_faces_outward():
    x, n, edges = ring(wave=0.001)
    ground = ground_of(x, n, edges, block())
    wall = ground.vertices[np.unique(ground.faces[ground.floor :])]
    radius = np.linalg.norm(wall[:, :2], axis=1)
    assert wall[:, 2].min() == 0.0
    assert wall[:, 2].max() > x[:, 2].max() + 0.005
    assert radius.max() == pytest.approx(0.205, abs=1e-3)
    middle = ground.vertices[ground.faces[ground.floor :]].mean(axis=1)
    outward = (walls(ground)[:, :2] * middle[:, :2]).sum(axis=1)
    level = np.abs(walls(ground)[:, 2]) > 0.9
    assert (outward[~level] > 0).all()
    # Its edge faces up, its back shell down.
    up = walls(ground)[level, 2] > 0
    assert (middle[level][up, 2] > x[:, 2].max()).all()
    assert np.abs(middle[level][~up, 2]).max() < 1e-7


def test_a_shape_without_a_hem_has_a_floor_only():
    x, n, _ = ring()
    ground = ground_of(x, n, np.zeros((0, 2), dtype=int), NOTHING)
    assert ground.floor == len(ground.faces)


def test_a_valance_stays_short_where_the_foam_is_far():
    x, n, edges = ring(height=0.5)
    ground = ground_of(x, n, edges, block(0.0))
    wall = ground.vertices[np.unique(ground.faces[ground.floor :])]
    assert wall[:, 2].min() >= 0.5 - 0.0801
