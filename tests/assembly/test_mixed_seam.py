"""A seam of three fabrics: each panel brings its own to stitches, folds and second layer."""

import numpy as np
import pytest

from seatlook.assembly import assemble
from support import mixed_seam
from support.mixed_seam import ALLOWANCE, DEPTH, FABRIC, LENGTH, PART, SIZE, in_grain

NAMES = ("LEFT", "LOWER", "UPPER")
ACROSS, ALONG = np.array([1.0, 0.0]), np.array([0.0, 1.0])


@pytest.fixture(scope="module")
def cover():
    return assemble(mixed_seam.scene())


def fold(name):
    """Moment per length and angle of one panel's fold [N]: 2 B / (pi t), B across the seam."""
    n = in_grain(ACROSS, name)
    fabric = FABRIC[name]
    v = np.array([n[0] ** 2, n[1] ** 2, 2 * n[0] * n[1]])
    return 2 * (v @ fabric.bending_matrix @ v) / (np.pi * fabric.thickness)


def strip(name):
    """Bending matrix of one panel's allowance, by rotating the tensor of fourth order.

    In axes along and across the seam: mirrored across, free of moment there, and turned back.
    """
    voigt = np.array([[0, 2], [2, 1]])
    D = FABRIC[name].bending_matrix[voigt[:, :, None, None], voigt]
    axes = np.stack([in_grain(ALONG, name), in_grain(ACROSS, name)])
    local = np.einsum("ai,bj,ck,dl,ijkl->abcd", *4 * (axes,), D)
    across = np.indices((2, 2, 2, 2)).sum(axis=0)
    local = np.where(across % 2 == 1, -local, local)
    free = local - np.einsum("ab,cd->abcd", local[:, :, 1, 1], local[1, 1]) / local[1, 1, 1, 1]
    back = np.einsum("ai,bj,ck,dl,abcd->ijkl", *4 * (axes,), free)
    i, j = np.array([0, 1, 0]), np.array([0, 1, 1])
    return back[i[:, None], j[:, None], i, j]


def panel_of(cover, vertices):
    owner = np.zeros(len(cover.rest), dtype=int)
    owner[cover.faces] = cover.panel[:, None]
    return owner[vertices]


def test_no_two_folds_are_alike():
    """And none is that of another direction: the sample tells them apart."""
    least, middle, most = sorted(fold(name) for name in NAMES)
    assert middle > 1.1 * least
    assert most > 1.1 * middle
    for name in NAMES:
        fabric = FABRIC[name]
        for wrong in (in_grain(ALONG, name), ACROSS):
            v = np.array([wrong[0] ** 2, wrong[1] ** 2, 2 * wrong[0] * wrong[1]])
            other = 2 * (v @ fabric.bending_matrix @ v) / (np.pi * fabric.thickness)
            assert abs(other / fold(name) - 1) > 0.01


def test_folds_are_in_series_with_those_they_meet(cover):
    """Row by row of LEFT's edge, the coarser: its own fold, and the mean of those over against it.

    One of its elements lies across the joint of LOWER and UPPER.
    """
    hem = cover.hem
    assert (panel_of(cover, hem.near) == 0).all()
    y = cover.uv[hem.near, 1]
    low, high = y.min(axis=1), y.max(axis=1)
    lower = np.clip((PART - low) / (high - low), 0.0, 1.0)
    assert (lower == 1).any()
    assert (lower == 0).any()
    assert ((lower > 0.1) & (lower < 0.9)).any()
    other = lower * fold("LOWER") + (1 - lower) * fold("UPPER")
    np.testing.assert_allclose(hem.stiffness, 1 / (1 / fold("LEFT") + 1 / other), rtol=1e-9)
    np.testing.assert_allclose(hem.length, high - low)
    assert hem.length.sum() == pytest.approx(LENGTH)
    for k in range(len(hem.near)):
        own = hem.row == k
        share = hem.weight[own] @ (panel_of(cover, hem.far[own, 0]) == 1)
        assert share == pytest.approx(lower[k], abs=1e-9)
        assert hem.weight[own].sum() == pytest.approx(1.0)


def test_every_far_edge_lies_over_against_its_near_one(cover):
    hem, start = cover.hem, np.array([0.0, 0.0, PART])
    near = np.sort(cover.uv[hem.near, 1], axis=1)[hem.row]
    far = np.sort(cover.uv[hem.far, 1] + start[panel_of(cover, hem.far)], axis=1)
    shared = np.minimum(near[:, 1], far[:, 1]) - np.maximum(near[:, 0], far[:, 0])
    np.testing.assert_allclose(hem.weight, shared / (near[:, 1] - near[:, 0]), atol=1e-9)
    assert (shared > 0).all()


@pytest.mark.parametrize("name", NAMES)
def test_second_layer_is_of_the_panels_own_fabric(cover, name):
    number = NAMES.index(name)
    inside = cover.panel == number
    fabric, hem = FABRIC[name], cover.hem
    added = (hem.density * cover.rest_area)[inside].sum()
    assert added == pytest.approx(fabric.density * DEPTH[name] * ALLOWANCE[name], rel=0.03)
    centre = cover.uv[cover.faces[inside]].mean(axis=1)
    away = 0.1 - centre[:, 0] if name == "LEFT" else centre[:, 0]
    margin = SIZE[name]
    below, beyond = away < ALLOWANCE[name] - margin, away > ALLOWANCE[name] + margin
    assert below.sum() > 3
    np.testing.assert_allclose(hem.density[inside][below], fabric.density)
    expected = np.broadcast_to(strip(name), (below.sum(), 3, 3))
    np.testing.assert_allclose(hem.bending[inside][below], expected, atol=1e-9 * expected.max())
    assert not hem.density[inside][beyond].any()
    assert not hem.bending[inside][beyond].any()


@pytest.mark.parametrize("name", NAMES)
def test_lift_is_the_panels_own_thickness(cover, name):
    """Full over its own allowance, gone one of its own elements further."""
    vertices = np.unique(cover.faces[cover.panel == NAMES.index(name)])
    x = cover.uv[vertices, 0]
    away = 0.1 - x if name == "LEFT" else x
    t, h, w = FABRIC[name].thickness, SIZE[name], ALLOWANCE[name]
    exact = t * np.clip((w + 0.5 * h - away) / h, 0.0, 1.0)
    np.testing.assert_allclose(cover.hem.lift[vertices], exact, atol=0.01 * t)


def test_stitches_keep_the_share_of_the_seam(cover):
    """Both sides end together, and no pair straddles the joint."""
    (seam,) = cover.stitchings
    y = seam.a.at(np.pad(cover.uv, ((0, 0), (0, 1))))[:, 1]
    owner = panel_of(cover, seam.b.vertices[:, 0])
    start = np.array([0.0, 0.0, PART])[owner]
    other = seam.b.at(np.pad(cover.uv, ((0, 0), (0, 1))))[:, 1] + start
    np.testing.assert_allclose(other, y, atol=1e-9)
    assert set(owner.tolist()) == {1, 2}
    assert seam.length.sum() == pytest.approx(LENGTH)
    assert seam.length[owner == 1].sum() == pytest.approx(PART)
