"""What a folded allowance adds to the cover, from widths and fabric alone."""

import dataclasses

import numpy as np
import pytest

from seatlook.assembly import assemble
from seatlook.assembly.hem import allowance, fold_stiffness, strip_bending
from seatlook.flattening.pattern import cut_outline
from support import fabrics, scenes

ALLOWANCE = 0.012


def sewn(**change):
    """LEFT and RIGHT with an allowance all round, sewn along 100 mm."""
    scene = scenes.two_panels(element_size=0.005)
    panels = tuple(
        dataclasses.replace(p, cut_outline=cut_outline(p.outline, ALLOWANCE))
        for p in scene.pattern.panels
    )
    pattern = dataclasses.replace(scene.pattern, panels=panels)
    return dataclasses.replace(scene, pattern=pattern, hem=True, **change)


def test_allowance_is_the_way_to_the_cut_line():
    panel = sewn().pattern.panels[0]
    np.testing.assert_allclose(allowance(panel, np.array([[0.1, 0.05], [0.05, 0.0]])), ALLOWANCE)


def test_fold_of_a_half_circle():
    fabric = fabrics.isotropic(bend=6e-3, thickness=3e-3)
    angle = np.linspace(0, np.pi, 5)
    normal = np.column_stack([np.cos(angle), np.sin(angle)])
    np.testing.assert_allclose(fold_stiffness(fabric, normal), 2 * 6e-3 / (np.pi * 3e-3))
    # Across the warp of an orthotropic fabric only its own stiffness counts.
    woven = fabrics.woven()
    across = fold_stiffness(woven, np.eye(2))
    np.testing.assert_allclose(across, 2 * np.array([6e-5, 2e-5]) / (np.pi * 8e-4))


@pytest.mark.parametrize("angle", [0.0, 0.4, np.pi / 2])
def test_allowance_bends_as_a_strip(angle):
    """B (1 - nu^2) along the seam; no moment across it, whatever the curvature."""
    fabric = fabrics.isotropic(bend=1.0, poisson=0.3)
    t = np.array([np.cos(angle), np.sin(angle)])
    n = np.array([-t[1], t[0]])
    (matrix,) = strip_bending(fabric, t[None])
    along, across = (np.array([v[0] ** 2, v[1] ** 2, 2 * v[0] * v[1]]) for v in (t, n))
    assert along @ matrix @ along == pytest.approx(1 - 0.3**2)
    np.testing.assert_allclose(matrix @ across, 0.0, atol=1e-12)
    assert np.linalg.eigvalsh(matrix).min() > -1e-12


def test_mirror_image_turns_the_coupling_round():
    """Two plies, panel and mirrored allowance, do not twist when bent along the seam."""
    fabric = fabrics.woven()
    t = np.array([np.cos(0.5), np.sin(0.5)])
    n = np.array([-t[1], t[0]])
    (matrix,) = strip_bending(fabric, t[None])
    along = np.array([t[0] ** 2, t[1] ** 2, 2 * t[0] * t[1]])
    twist = np.array([t[0] * n[0], t[1] * n[1], t[0] * n[1] + t[1] * n[0]])
    across = np.array([n[0] ** 2, n[1] ** 2, 2 * n[0] * n[1]])
    D = fabric.bending_matrix
    free = D - np.outer(D @ across, across @ D) / (across @ D @ across)
    assert along @ matrix @ along == pytest.approx(along @ free @ along)
    assert along @ matrix @ twist == pytest.approx(-(along @ free @ twist))
    assert abs(along @ free @ twist) > 1e-7


def test_second_layer_lies_below_the_seam_and_nowhere_else():
    cover = assemble(sewn())
    hem, fabric = cover.hem, cover.materials[0].fabric
    extra = (hem.density * cover.rest_area)[:, None] * (cover.panel[:, None] == [0, 1])
    # 100 x 12 mm on each side.
    np.testing.assert_allclose(extra.sum(axis=0), fabric.density * 0.1 * ALLOWANCE, rtol=0.02)
    middle = cover.uv[cover.faces].mean(axis=1)
    away = np.where(cover.panel == 0, 0.1 - middle[:, 0], middle[:, 0])
    assert (hem.density[away > ALLOWANCE + 0.005] == 0).all()
    assert (hem.bending[away > ALLOWANCE + 0.005] == 0).all()
    np.testing.assert_allclose(hem.density[away < ALLOWANCE - 0.005], fabric.density)
    np.testing.assert_allclose(hem.lift[np.unique(hem.near)], fabric.thickness)


def test_every_edge_of_the_seam_is_folded_once():
    hem = assemble(sewn()).hem
    k = len(hem.near)
    np.testing.assert_allclose(np.bincount(hem.row, hem.weight, minlength=k), 1.0)
    assert hem.length.sum() == pytest.approx(0.1)
    # All of the far rim takes part, each edge with its own length.
    far = np.unique(np.sort(hem.far, axis=1), axis=0)
    assert len(far) >= k
    # The warp of LEFT runs along the seam, that of RIGHT across it.
    cloth = scenes.fabric()
    left, right = (
        2 * b / (np.pi * cloth.thickness) for b in (cloth.bending_weft, cloth.bending_warp)
    )
    np.testing.assert_allclose(hem.stiffness, 1 / (1 / left + 1 / right))


def test_without_the_switch_there_is_none():
    assert assemble(dataclasses.replace(sewn(), hem=False)).hem is None
