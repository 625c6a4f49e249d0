"""Panels meshed and posed; seams, hooks and frames paired up."""

import dataclasses

import numpy as np
import pytest

from seatlook import model
from seatlook.assembly import assemble
from seatlook.errors import AssemblyError, InputError
from seatlook.solver.element.elastic import ElasticSheet
from support import scenes


@pytest.fixture(scope="module")
def cover() -> model.Cover:
    return assemble(scenes.two_panels())


def test_area_is_kept_and_faces_point_up(cover):
    assert cover.rest_area.min() > 0
    assert cover.rest_area.sum() == pytest.approx(0.01 + 0.008)
    p = cover.positions[cover.faces]
    assert (np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])[:, 2] > 0).all()


def test_rest_runs_along_the_warp(cover):
    """LEFT's grain is +v, so its warp coordinate is v and its weft coordinate -u."""
    left = np.unique(cover.faces[cover.panel == 0])
    assert cover.rest[left] == pytest.approx(
        np.column_stack([cover.uv[left, 1], -cover.uv[left, 0]])
    )
    right = np.unique(cover.faces[cover.panel == 1])
    assert cover.rest[right] == pytest.approx(cover.uv[right])


def test_imperfection_is_small_and_repeats(cover):
    again = assemble(scenes.two_panels())
    assert (again.positions == cover.positions).all()
    seeds = [assemble(scenes.two_panels(), seed=seed) for seed in range(8)]
    bump = np.concatenate([c.positions[:, 2] - 0.005 for c in seeds])
    assert np.sqrt((bump**2).mean()) == pytest.approx(0.3 * 0.001, rel=0.4)
    other = seeds[1]
    assert (
        len(other.positions) != len(cover.positions) or (other.positions != cover.positions).any()
    )


def test_imperfection_belongs_to_the_panel_not_to_the_mesh():
    corners = np.array([[0.0, 0.0], [0.1, 0.0], [0.1, 0.1], [0.08, 0.1], [0.0, 0.1]])
    coarse, fine = (
        [cover.positions[np.isclose(cover.uv, corner).all(axis=1), 2].mean() for corner in corners]
        for cover in (assemble(scenes.two_panels(), element_size=h) for h in (0.01, 0.004))
    )
    assert np.std(coarse) > 5e-5
    np.testing.assert_allclose(coarse, fine, atol=1e-12)


def test_imperfection_stores_the_same_little_on_any_mesh():
    """A panel lies uneven on the table, not crumpled: its waves are 30 mm long and more."""
    stored = []
    for size in (0.008, 0.004):
        cover = assemble(scenes.two_panels(), element_size=size)
        sheet = ElasticSheet(
            cover.rest, cover.faces, cover.panel, [m.fabric for m in cover.materials]
        )
        work = np.zeros_like(cover.positions)
        stored.append(sum(energy.value(cover.positions, work) for energy in sheet.energies))
    # Laid flat over a rod of 0.5 m the two panels, 0.018 m2 of 9e-4 N m, would store 3e-5 J.
    assert 0.0 < stored[1] < 3e-5
    assert stored[0] == pytest.approx(stored[1], rel=0.1)


@pytest.mark.parametrize("depth_b", [0.1, 0.104])
def test_seam_pairs_meet_at_equal_shares_head_to_tail(depth_b):
    cover = assemble(scenes.two_panels(depth_b=depth_b))
    (seam,) = cover.stitchings
    a, b = seam.a.at(cover.uv), seam.b.at(cover.uv)
    assert a[:, 0] == pytest.approx(np.full(len(a), 0.1))
    assert b[:, 0] == pytest.approx(np.zeros(len(b)))
    assert a[:, 1] / 0.1 == pytest.approx(b[:, 1] / depth_b)
    assert seam.length.sum() == pytest.approx(0.1)


def test_no_more_pairs_than_segments_of_the_coarser_side():
    """Pairs at the vertices of both sides would lock the seam against bending."""
    scene = scenes.two_panels()
    fine = dataclasses.replace(scene.pattern.seams[0], pitch=0.0005)
    pattern = dataclasses.replace(scene.pattern, seams=(fine,))
    cover = assemble(dataclasses.replace(scene, pattern=pattern))
    assert len(cover.stitchings[0].a) <= 0.1 / 0.01 + 2
    coarse = dataclasses.replace(scene.pattern.seams[0], pitch=0.025)
    pattern = dataclasses.replace(scene.pattern, seams=(coarse,))
    cover2 = assemble(dataclasses.replace(scene, pattern=pattern))
    assert len(cover2.stitchings[0].a) == 4 + 2
    assert (cover2.rest == cover.rest).all(), "the pitch must not change the mesh"


def test_hook_and_frame_run_the_same_way_as_their_curve(cover):
    hook, rail = cover.anchors
    assert hook.kind == "hook"
    assert hook.target[:, 1] == pytest.approx(hook.points.at(cover.uv)[:, 1])
    assert rail.kind == "frame"
    assert rail.target[:, 1] == pytest.approx(rail.points.at(cover.uv)[:, 1])
    assert rail.length.sum() == pytest.approx(0.1)


def test_zones_seam_band_free_edge_interior(cover):
    centre = cover.uv[cover.faces].mean(axis=1)
    for name, panel, inside in (
        ("LEFT interior", 0, (centre[:, 0] < 0.085) & (centre[:, 0] > 0.015)),
        ("seam middle", 1, centre[:, 0] < 0.015),
    ):
        i = cover.zone_names.index(name)
        away = (centre[:, 1] > 0.016) & (centre[:, 1] < 0.084) & inside & (cover.panel == panel)
        assert away.any()
        assert (cover.zone[away] == i).all()
    free = cover.zone == cover.zone_names.index("free edge")
    assert free[(centre[:, 1] < 0.014)].all()


def test_a_users_box_comes_first():
    box = model.ZoneBox(name="seat A", panel="LEFT", low=np.zeros(2), high=np.full(2, 0.05))
    cover = assemble(dataclasses.replace(scenes.two_panels(), boxes=(box,)))
    centre = cover.uv[cover.faces].mean(axis=1)
    inside = (centre < 0.05).all(axis=1) & (cover.panel == 0)
    assert (cover.zone == cover.zone_names.index("seat A")).tolist() == inside.tolist()


def test_panels_without_material_or_pose_are_all_named():
    scene = scenes.two_panels()
    bare = dataclasses.replace(
        scene, materials=type(scene.materials)({}), placement=scene.placement
    )
    with pytest.raises(AssemblyError) as caught:
        assemble(bare)
    assert [p.key for p in caught.value.problems] == ["panel.LEFT", "panel.RIGHT"]


def test_a_panel_that_cannot_be_meshed_is_named():
    scene = scenes.two_panels()
    first = scene.pattern.panels[0]
    thin = dataclasses.replace(first, outline=first.outline * [1.0, 0.02])
    panels = (thin, *scene.pattern.panels[1:])
    scene = dataclasses.replace(scene, pattern=dataclasses.replace(scene.pattern, panels=panels))
    with pytest.raises(InputError, match=rf"panel\.{first.name}, (mesh angles|outline): got"):
        assemble(scene)
