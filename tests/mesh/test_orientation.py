"""Normals that agree: turned elements, separate pieces, T-joints, a Moebius strip."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from seatlook.mesh.orientation import agree
from support.meshes import rectangle


def quads(n=5, m=4):
    i, j = (a.ravel() for a in np.meshgrid(np.arange(n), np.arange(m), indexing="ij"))
    a = i * (m + 1) + j
    return np.stack([a, a + m + 1, a + m + 2, a + 1], axis=1)


@given(st.sets(st.integers(0, 19), max_size=9))
def test_turned_quadrilaterals_are_found(turned):
    corners = quads()
    rows = sorted(turned)
    corners[rows] = corners[rows][:, ::-1]
    sign = agree(corners, np.ones(len(corners))).sign
    assert np.flatnonzero(sign < 0).tolist() == rows


def test_mixed_triangles_and_quadrilaterals():
    corners = np.array([[0, 1, 2, 3], [1, 4, 2, 2], [5, 2, 4, 4], [3, 5, 2, 2]])
    side = agree(corners, np.ones(4))
    assert side.sign.tolist() == [1, 1, 1, -1]
    assert side.piece.tolist() == [0, 0, 0, 0]


def test_the_larger_area_keeps_its_side():
    corners = quads()
    corners[:3] = corners[:3][:, ::-1]
    area = np.where(np.arange(20) < 3, 100.0, 1.0)
    assert (agree(corners, area).sign < 0).tolist() == [False] * 3 + [True] * 17


def test_pieces_are_independent_and_a_joint_of_three_does_not_connect():
    _, T = rectangle("right", 1.0, 1.0, 0.25)
    one = np.column_stack([T, T[:, 2]])
    other = one[:, ::-1] + one.max() + 1
    side = agree(np.concatenate([one, other]), np.ones(2 * len(one)))
    assert (side.sign == 1).all()
    assert len(np.unique(side.piece)) == 2
    fin = np.array([[0, 1, 2, 2], [1, 0, 3, 3], [0, 1, 4, 4]])
    assert len(np.unique(agree(fin, np.ones(3)).piece)) == 3


def test_a_moebius_strip_is_told():
    n = 8
    ring = [[2 * k, 2 * k + 2, 2 * k + 3, 2 * k + 1] for k in range(n - 1)]
    strip = np.array([*ring, [2 * n - 2, 1, 0, 2 * n - 1]])
    side = agree(strip, np.ones(n))
    assert side.one_sided == 1
    assert (side.sign == 1).all()
    closed = np.array([*ring, [2 * n - 2, 0, 1, 2 * n - 1]])
    assert agree(closed, np.ones(n)).one_sided == 0


@pytest.mark.parametrize("first", [0, 1])
def test_a_tie_keeps_the_first_element(first):
    corners = np.array([[0, 1, 2, 2], [1, 2, 3, 3]])[[first, 1 - first]]
    assert agree(corners, np.ones(2)).sign.tolist() == [1.0, -1.0]
