"""Covers that pass through themselves: sewn edges are one line, all else counts, zone by zone."""

import dataclasses
from types import MappingProxyType

import numpy as np
import pytest

from seatlook import model
from seatlook.assembly import assemble
from seatlook.flattening.pattern import cut_outline
from seatlook.mesh import intersecting_pairs
from seatlook.solver.process.crossing import (
    crossing_pairs,
    hem_crossings,
    sewn_vertices,
    visible_crossings,
    zone_crossings,
)
from support import scenes
from support.covers import vertices_as_points

RADIUS = 0.15


def sewn(*, left=0.006, right=0.01):
    """LEFT and RIGHT side by side, with elements of their own."""
    scene = scenes.two_panels(gap=0.0, element_size=0.01)
    sizes = MappingProxyType({"LEFT": left, "RIGHT": right})
    return assemble(dataclasses.replace(scene, element_sizes=sizes))


def of(cover, panel):
    """Which vertices belong to a panel."""
    return np.isin(np.arange(len(cover.uv)), cover.faces[cover.panel == panel])


def roof(cover):
    """Both panels falling away from the seam, which is bent along itself."""
    x = cover.uv[:, 0] - 0.1 * of(cover, 0)
    y = cover.uv[:, 1] / RADIUS
    out = RADIUS - 0.7 * np.abs(x)
    return np.column_stack([0.7 * x + 1e-6 * of(cover, 0), out * np.sin(y), out * np.cos(y)])


@pytest.mark.parametrize(("left", "right"), [(0.01, 0.01), (0.006, 0.01), (0.01, 0.003)])
def test_sewn_edges_of_any_two_meshes_do_not_cross(left, right):
    cover = sewn(left=left, right=right)
    x = roof(cover)
    assert len(intersecting_pairs(x, cover.faces)) > 5
    assert len(crossing_pairs(cover, x)) == 0


def test_vertices_between_the_same_stitches_are_one_place():
    cover = sewn(left=0.01, right=0.005)
    pairs = sewn_vertices(cover)
    y = cover.uv[pairs, 1]
    assert np.abs(np.diff(y)).max() < 0.0151
    panel = of(cover, 1).astype(int)
    assert (np.diff(panel[pairs]) != 0).all()
    # Every vertex of either sewn edge takes part, and no other.
    for side, edge in ((0, 0.1), (1, 0.0)):
        on = np.flatnonzero((panel == side) & (np.abs(cover.uv[:, 0] - edge) < 1e-9))
        assert set(on) == set(pairs[panel[pairs] == side])


def test_panel_turned_over_into_the_other_is_counted_in_its_zones():
    cover = sewn(left=0.01, right=0.01)
    flat = np.column_stack([cover.uv, np.zeros(len(cover.uv))])
    right = of(cover, 1)
    # RIGHT folded back over LEFT, and its middle pressed through it by a millimetre.
    bump = np.exp(-((cover.uv - [0.04, 0.05]) ** 2).sum(axis=1) / 0.012**2)
    flat[right, 0] = 0.1 - cover.uv[right, 0]
    flat[right, 2] = (0.003 - 0.004 * bump + 0.02 * cover.uv[:, 0])[right]
    flat[right & (cover.uv[:, 0] < 1e-9), 2] = 0.0
    pairs = crossing_pairs(cover, flat)
    assert len(pairs) > 5
    assert (cover.panel[pairs] == [0, 1]).all()
    centre = flat[cover.faces[pairs]].mean(axis=2)
    assert np.abs(centre[..., :2] - [0.06, 0.05]).max() < 0.03
    counts = zone_crossings(cover, pairs)
    assert set(counts) == {"LEFT interior", "RIGHT interior"}
    assert counts["LEFT interior"] == counts["RIGHT interior"] == len(pairs)
    assert visible_crossings(cover, pairs) == len(pairs)


def test_crossings_within_the_free_band_do_not_show():
    cover = sewn(left=0.01, right=0.01)
    free = cover.zone_names.index("free edge")
    inside = np.flatnonzero(cover.zone == free)[:2]
    other = np.flatnonzero(cover.zone != free)[:1]
    pairs = np.array([inside, [inside[0], other[0]]])
    assert visible_crossings(cover, pairs) == 1
    assert zone_crossings(cover, pairs)["free edge"] == 2
    assert visible_crossings(cover, pairs[:0]) == 0


def test_corner_of_several_panels_is_one_place():
    """Stitches at A-B and B-C make A and C one place, too."""
    cover = sewn(left=0.02, right=0.02)
    (seam,) = cover.stitchings
    a, b = (int(side.vertices[0, side.weights[0].argmax()]) for side in (seam.a, seam.b))
    third = int(cover.faces[cover.panel == 1].max())
    ends = [vertices_as_points([v]) for v in (b, third)]
    more = model.Stitching(name="more", a=ends[0], b=ends[1], length=np.ones(1), stage="sew")
    pairs = sewn_vertices(dataclasses.replace(cover, stitchings=(seam, more)))
    result = {tuple(p) for p in pairs}
    assert {(a, b), (b, third), (a, third)} <= result


@pytest.mark.parametrize(("angle", "outside"), [(150.0, False), (100.0, False), (40.0, True)])
def test_allowance_below_a_sharp_ridge_comes_through_the_other_panel(angle, outside):
    """One thickness below its panel it lies inside, as long as the foam's side is no sharp edge."""
    scene = scenes.two_panels(gap=0.0, element_size=0.006)
    panels = tuple(
        dataclasses.replace(p, cut_outline=cut_outline(p.outline, 0.012))
        for p in scene.pattern.panels
    )
    thick = MappingProxyType(dict.fromkeys(("LEFT", "RIGHT"), scenes.material(thickness=0.004)))
    pattern = dataclasses.replace(scene.pattern, panels=panels)
    cover = assemble(dataclasses.replace(scene, pattern=pattern, materials=thick, hem=True))
    x, half = cover.uv[:, 0] - 0.1 * of(cover, 0), np.radians(angle / 2)
    positions = np.column_stack([np.sin(half) * x, cover.uv[:, 1], -np.cos(half) * np.abs(x)])
    pairs = hem_crossings(cover, positions)
    assert bool(len(pairs)) == outside
    assert (cover.panel[pairs[:, 0]] != cover.panel[pairs[:, 1]]).all()
    assert (np.abs(x[cover.faces[pairs]]).max(axis=(1, 2)) < 0.02).all()
    assert not len(crossing_pairs(cover, positions))


def test_cover_without_hem_has_no_allowance():
    cover = sewn(left=0.02, right=0.02)
    assert len(hem_crossings(cover, cover.positions)) == 0
