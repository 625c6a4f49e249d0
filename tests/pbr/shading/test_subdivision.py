"""Refinement keeps the solved vertices, the waves and the outline."""

from __future__ import annotations

import numpy as np
import pytest

from seatlook.pbr.shading.subdivision import boundary_edges, sharp_corners, subdivide
from support.reference.lit_sheets import grid

RECTANGLE = ((-0.1, -0.05), (0.1, 0.05))


def refine(points, faces, levels, rest):
    return subdivide(points, faces, levels=levels, corners=sharp_corners(rest, faces))


def test_counts_and_children():
    rest, faces = grid(*RECTANGLE, (4, 2))
    fine = refine(rest, faces, 2, rest)
    assert len(fine.faces) == 16 * len(faces)
    # Euler: vertices - edges + faces = 1 for a disc.
    edges = {tuple(sorted(e)) for f in fine.faces for e in zip(f, np.roll(f, 1), strict=True)}
    assert len(fine.points) - len(edges) + len(fine.faces) == 1
    centre = fine.points[fine.faces].mean(axis=1).reshape(len(faces), 16, 2).mean(axis=1)
    assert np.allclose(centre, rest[faces].mean(axis=1), atol=1e-3)


@pytest.mark.parametrize("levels", [0, 1, 2])
def test_old_vertices_stay(levels):
    rest, faces = grid(*RECTANGLE, (12, 6))
    points = np.column_stack([rest, 0.01 * np.sin(60 * rest[:, 0])])
    fine = refine(points, faces, levels, rest)
    assert (fine.points[: len(rest)] == points).all()


def test_linear_fields_are_kept_and_corners_stay_sharp():
    rest, faces = grid(*RECTANGLE, (12, 6))
    points = np.column_stack([rest, 0.3 * rest[:, 0] - 0.2 * rest[:, 1] + 0.05])
    fine = refine(points, faces, 2, rest).points
    assert np.allclose(fine[:, 2], 0.3 * fine[:, 0] - 0.2 * fine[:, 1] + 0.05, atol=1e-7)
    assert fine[:, :2].min(axis=0) == pytest.approx(RECTANGLE[0], abs=1e-6)
    assert fine[:, :2].max(axis=0) == pytest.approx(RECTANGLE[1], abs=1e-6)


def test_a_wave_of_eight_elements_keeps_its_height():
    """Plain Loop subdivision would lose a tenth; a chord loses 1 - cos(pi/8) = 8 % in between."""
    rest, faces = grid((0.0, 0.0), (0.4, 0.1), (64, 16))
    wave = 2 * np.pi / (8 * 0.4 / 64)
    points = np.column_stack([rest, np.cos(wave * rest[:, 0])])
    fine = refine(points, faces, 2, rest).points
    inside = (np.abs(fine[:, 0] - 0.2) < 0.1) & (np.abs(fine[:, 1] - 0.05) < 0.02)
    error = np.abs(fine[:, 2] - np.cos(wave * fine[:, 0]))[inside]
    assert error.max() < 0.02


def test_spread_is_linear_between_old_vertices():
    rest, faces = grid(*RECTANGLE, (6, 4))
    fine = refine(rest, faces, 2, rest)
    spread = fine.spread(rest[:, :1].copy())
    assert np.allclose(spread, fine.points[:, :1], atol=1e-6)


def test_boundary_is_directed_and_closed():
    rest, faces = grid(*RECTANGLE, (6, 4))
    edges = boundary_edges(faces)
    assert len(edges) == 2 * (6 + 4)
    assert sorted(edges[:, 0]) == sorted(edges[:, 1])
    area = 0.5 * np.sum(
        rest[edges[:, 0], 0] * rest[edges[:, 1], 1] - rest[edges[:, 1], 0] * rest[edges[:, 0], 1]
    )
    assert area == pytest.approx(0.02)
    assert len(sharp_corners(rest, faces)) == 4
