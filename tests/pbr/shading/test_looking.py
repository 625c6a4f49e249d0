"""Vertices that gather light: few of a fine mesh, and what lies between them."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import KDTree

from seatlook.mesh import boundary_sides
from seatlook.pbr.shading.coarsening import coarsened
from seatlook.pbr.shading.looking import Lookout
from seatlook.pbr.shading.surface import drawn_surface
from support.reference.lit_sheets import flat, grid, sheet


def spread(coarse, values):
    """Values of all vertices from those of the first ones."""
    out = np.full(values.shape, np.nan)
    out[coarse.first] = values[coarse.first]
    for level in coarse.between:
        out[level.vertices] = level.mean(out)
    return out


def panels():
    """Two panels side by side, 60 x 120 mm, meshed at 0.6 mm: places, panel, whether on an edge."""
    places, panel, edge = [], [], []
    for k in range(2):
        points, faces = grid((0.06 * k, 0.0), (0.06 * (k + 1), 0.12), (100, 200))
        sides = faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)[boundary_sides(faces)]
        places.append(points)
        panel.append(np.full(len(points), k))
        edge.append(np.isin(np.arange(len(points)), sides))
    return np.vstack(places), np.concatenate(panel), np.concatenate(edge)


@pytest.fixture(scope="module")
def fine():
    return Lookout(drawn_surface(sheet(flat, size=0.3, steps=260, panels=2)))


def test_every_vertex_has_one_that_looks_nearby(fine):
    uv, n = fine.surface.mesh.uv, fine.surface.solved
    assert 10_000 < len(fine.first) < 16_000 < 0.25 * n
    far, _ = KDTree(uv[fine.first]).query(uv[:n])
    assert far.max() <= np.sqrt(2 * 0.3**2 / 12_000)


def test_a_mesh_that_is_not_finer_keeps_its_own_vertices():
    usual = Lookout(drawn_surface(sheet(flat, size=0.3, steps=60)))
    np.testing.assert_array_equal(usual.first, np.arange(usual.surface.solved))


def test_all_vertices_get_a_value_and_neighbours_are_near(fine):
    every = fine.spread(fine.first, np.ones((len(fine.first), 1)))
    np.testing.assert_allclose(every, 1.0)
    a, b = fine.surface.mesh.uv[fine.first][fine.pairs(fine.first)].transpose(1, 0, 2)
    assert np.linalg.norm(a - b, axis=1).max() < 0.01


def test_values_stay_in_their_panel():
    places, panel, edge = panels()
    values = panel[:, None].astype(float)
    np.testing.assert_allclose(spread(coarsened(places, panel, edge, [0.008]), values), values)


def test_a_plane_is_met_exactly_away_from_the_outline_and_a_wave_by_order_two():
    places, panel, edge = panels()
    inside = (np.abs(places[:, 0] % 0.06 - 0.03) < 0.02) & (np.abs(places[:, 1] - 0.06) < 0.05)
    plane, wave = places @ [[3.0], [7.0]], np.sin(2 * np.pi * places[:, :1] / 0.1)
    errors = []
    for width in (0.016, 0.008, 0.004):
        coarse = coarsened(places, panel, edge, [width])
        np.testing.assert_allclose(spread(coarse, plane)[inside], plane[inside], atol=1e-12)
        errors.append(np.abs(spread(coarse, wave) - wave)[inside].mean())
    assert np.log2(errors[0] / errors[2]) / 2 > 1.6


def test_finer_squares_keep_what_was_chosen():
    places, panel, edge = panels()
    coarse = coarsened(places, panel, edge, [0.016, 0.008, 0.004])
    known = coarse.first
    for level in coarse.between:
        assert np.isin(level.ends, known).all()
        assert not np.isin(level.vertices, known).any()
        known = np.concatenate([known, level.vertices])
    assert len(known) == len(places)


@pytest.mark.parametrize("width", [0.0012, 0.004])
def test_a_strip_narrower_than_a_square(width):
    points, faces = grid((0.0, 0.0), (width, 0.2), (3, 500))
    sides = faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)[boundary_sides(faces)]
    edge = np.isin(np.arange(len(points)), sides)
    coarse = coarsened(points, np.zeros(len(points), dtype=int), edge, [0.0085])
    np.testing.assert_allclose(spread(coarse, points[:, 1:]), points[:, 1:], atol=0.005)
    assert len(coarse.first) < 0.1 * len(points)


def test_vertices_without_a_face_are_left_out():
    places, panel, edge = panels()
    panel[7], edge[7] = -1, False
    coarse = coarsened(places, panel, edge, [0.008])
    assert 7 not in coarse.first
    assert all(7 not in level.vertices for level in coarse.between)
