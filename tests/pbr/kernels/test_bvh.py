"""Rays against triangles: the hierarchy finds what looking at every triangle finds."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from seatlook.pbr.kernels import bvh


def every_triangle(vertices, faces, origin, direction):
    """Nearest hit by testing all faces: (face or -1, distance)."""
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    e1, e2 = b - a, c - a
    p = np.cross(direction, e2)
    det = (e1 * p).sum(1)
    s = origin - a
    q = np.cross(s, e1)
    with np.errstate(divide="ignore", invalid="ignore"):
        u, v = (s * p).sum(1) / det, (q @ direction) / det
        t = (e2 * q).sum(1) / det
    hit = (u >= 0) & (v >= 0) & (u + v <= 1) & (t > 0)
    t = np.where(hit, t, np.inf)
    return (int(t.argmin()) if hit.any() else -1), t.min()


@settings(max_examples=40, deadline=None)
@given(st.integers(1, 60), st.integers(0, 10**6))
def test_finds_what_every_triangle_finds(m, seed):
    rng = np.random.default_rng(seed)
    vertices = rng.random((3 * m, 3))
    faces = np.arange(3 * m).reshape(m, 3)
    compare(bvh.build(vertices, faces), vertices, faces, rng)


@settings(max_examples=20, deadline=None)
@given(st.integers(1, 60), st.integers(0, 10**6))
def test_finds_the_same_after_all_triangles_have_moved(m, seed):
    rng = np.random.default_rng(seed)
    before, after = rng.random((2, 3 * m, 3))
    faces = np.arange(3 * m).reshape(m, 3)
    compare(bvh.moved(bvh.build(before, faces), after, faces), after, faces, rng)


def compare(tree, vertices, faces, rng):
    """Rays through the hierarchy against all triangles."""
    stack = bvh.new_stack()
    for _ in range(20):
        o, d = rng.random(3), rng.standard_normal(3)
        d /= np.linalg.norm(d)
        face, distance = every_triangle(vertices, faces, o, d)
        leaf, t, _, _ = bvh.nearest(tree, *o, *d, 0.0, stack)
        assert (tree.face[leaf] if leaf >= 0 else -1) == face
        assert bvh.occluded(tree, *o, *d, 0.0, np.inf, stack) == (face >= 0)
        if face >= 0:
            assert abs(t - distance) < 1e-9
            assert not bvh.occluded(tree, *o, *d, 0.0, 0.99 * distance, stack)


def test_axis_parallel_rays_in_the_plane_of_a_box_side():
    vertices = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    tree = bvh.build(vertices, np.array([[0, 1, 2], [0, 2, 3]]))
    stack = bvh.new_stack()
    for x in (0.0, 0.25, 1.0):
        assert bvh.occluded(tree, x, 0.25, 1.0, 0.0, 0.0, -1.0, 0.0, np.inf, stack)
    assert not bvh.occluded(tree, 1.0001, 0.25, 1.0, 0.0, 0.0, -1.0, 0.0, np.inf, stack)


def test_no_ray_slips_through_a_closed_sheet():
    from support.reference.lit_sheets import sheet

    solution = sheet(lambda x, y: 0.01 * np.sin(50 * x), steps=30)
    tree = bvh.build(np.array(solution.positions), np.array(solution.cover.faces))
    rng, stack = np.random.default_rng(1), bvh.new_stack()
    for x, y in rng.uniform(-0.09, 0.09, (2000, 2)):
        assert bvh.occluded(tree, x, y, 1.0, 0.0, 0.0, -1.0, 0.0, np.inf, stack)


def test_many_equal_triangles_make_a_leaf_not_a_loop():
    vertices = np.tile(np.eye(3), (50, 1))
    tree = bvh.build(vertices, np.arange(150).reshape(50, 3))
    hit = bvh.nearest(tree, 0.0, 0.0, 0.0, *(np.ones(3) / np.sqrt(3)), 0.0, bvh.new_stack())
    assert hit[0] >= 0
    assert abs(hit[1] - 1 / np.sqrt(3)) < 1e-12
