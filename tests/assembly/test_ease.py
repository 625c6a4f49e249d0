"""Ease: which side of a seam is longer, by how much, and between which notches."""

import dataclasses
from pathlib import Path

import numpy as np
import pytest

from seatlook import model
from seatlook.assembly import assemble
from seatlook.assembly.ease import seam_ease
from seatlook.io import read_pattern
from seatlook.report.evaluation_page import seam_table
from support import scenes

DATA = Path(__file__).parents[1] / "data"


def notched(left, right, *, depth_b=0.1):
    """The two panels with notches at these heights [m] of the sewn edges."""
    scene = scenes.two_panels(depth_b=depth_b)
    panels = []
    for panel, x, heights in zip(scene.pattern.panels, (0.1, 0.0), (left, right), strict=True):
        marks = tuple(model.Notch(position=np.array([x, y])) for y in heights)
        panels.append(dataclasses.replace(panel, notches=marks))
    pattern = dataclasses.replace(scene.pattern, panels=tuple(panels))
    return dataclasses.replace(scene, pattern=pattern)


def measured(scene):
    return seam_ease(scene.pattern, scene.pattern.seams[0])


def test_ease_is_near_side_minus_far_side():
    result = measured(notched((), (), depth_b=0.104))
    assert result.length_a == pytest.approx(0.1)
    assert result.length_b == pytest.approx(0.104)
    assert result.ease == pytest.approx(-0.004)
    assert result.share == pytest.approx(-0.004 / 0.104)
    assert result.shares == pytest.approx([-0.004 / 0.104])


def test_ease_lies_between_the_notches_that_meet():
    """Up to the notch both sides are as long; all of the 4 mm lie beyond it."""
    result = measured(notched((0.04,), (0.04,), depth_b=0.104))
    assert result.matched
    assert result.notches_a == pytest.approx([0.4])
    assert result.notches_b == pytest.approx([0.04 / 0.104])
    assert result.shares == pytest.approx([0.0, 60 / 64 - 1])


def test_stitches_lie_at_equal_shares_between_notches():
    scene = notched((0.03, 0.07), (0.05, 0.07), depth_b=0.104)
    (seam,) = assemble(scene).stitchings
    cover = assemble(scene)
    a, b = seam.a.at(cover.uv)[:, 1], seam.b.at(cover.uv)[:, 1]
    # Both run up: LEFT's right edge in outline order, RIGHT's left one against it.
    np.testing.assert_allclose(
        a, np.interp(b, [0, 0.05, 0.07, 0.104], [0, 0.03, 0.07, 0.1]), atol=1e-12
    )


def test_unequal_numbers_of_notches_match_nothing():
    scene = notched((0.03,), (0.05, 0.07), depth_b=0.104)
    result = measured(scene)
    assert not result.matched
    cover = assemble(scene)
    (seam,) = cover.stitchings
    a, b = seam.a.at(cover.uv)[:, 1], seam.b.at(cover.uv)[:, 1]
    np.testing.assert_allclose(a / 0.1, b / 0.104, atol=1e-12)


def test_notches_at_equal_shares_change_nothing():
    plain, marked = notched((), ()), notched((0.05,), (0.05,))
    (a,), (b,) = assemble(plain).stitchings, assemble(marked).stitchings
    np.testing.assert_allclose(a.a.weights, b.a.weights, atol=1e-12)
    np.testing.assert_allclose(a.b.weights, b.b.weights, atol=1e-12)


@pytest.mark.parametrize("place", [(0.0, 0.05), (0.1, 0.001), (0.13, 0.05), (0.06, 0.05)])
def test_notches_of_other_edges_of_ends_and_far_away_do_not_count(place):
    """On LEFT's own left edge, at a corner, too far outside; the last is 40 mm inside."""
    scene = notched((), ())
    left, right = scene.pattern.panels
    left = dataclasses.replace(left, notches=(model.Notch(position=np.array(place)),))
    pattern = dataclasses.replace(scene.pattern, panels=(left, right))
    assert not len(seam_ease(pattern, pattern.seams[0]).notches_a)


def test_notch_on_the_cut_line_counts():
    scene = notched((), ())
    left, right = scene.pattern.panels
    left = dataclasses.replace(left, notches=(model.Notch(position=np.array([0.11, 0.03])),))
    pattern = dataclasses.replace(scene.pattern, panels=(left, right))
    assert seam_ease(pattern, pattern.seams[0]).notches_a == pytest.approx([0.3])


def test_sample_pattern():
    """Every edge has its notch; the front is sewn to three edges, whose notches meet one."""
    pattern = read_pattern(
        DATA / "seat_cushion_demo_aama.dxf", DATA / "seat_cushion_demo.seams.toml"
    )
    result = {s.name: seam_ease(pattern, s) for s in pattern.seams}
    assert result["left bolster"].matched
    assert result["left bolster"].notches_a == pytest.approx([0.5], abs=0.01)
    assert len(result["front"].notches_b) == 3
    assert not result["front"].matched
    for one in result.values():
        assert abs(one.ease) < 0.1e-3


def test_table_of_the_page_puts_the_largest_ease_first():
    scene = notched((0.04,), (0.04,), depth_b=0.104)
    seams = (*scene.pattern.seams, dataclasses.replace(scene.pattern.seams[0], name="again"))
    pattern = dataclasses.replace(scene.pattern, seams=seams)
    table = seam_table(dataclasses.replace(scene, pattern=pattern))
    assert [row[0] for row in table.rows] == ["middle", "again"]
    row = dict(zip(table.heads, table.rows[0], strict=True))
    assert row["ease [mm]"] == pytest.approx(-4.0)
    assert row["ease [%]"] == pytest.approx(-100 * 4 / 104)
    assert row["largest between notches [%]"] == pytest.approx(-6.25)
    assert row["notches"] == "1 matched"
    (unmatched,) = seam_table(notched((), (0.04,))).rows
    assert unmatched[-1] == "0 and 1: not matched"
