"""Sides of an outline: what moves when one of them does."""

from types import MappingProxyType

import numpy as np
import pytest

from seatlook.errors import InputError
from seatlook.improvement.cutting.outline import drawn_outlines, mesh_outlines
from seatlook.model import Edge, Notch, Panel, Pattern

LONG, WIDE = 0.30, 0.20


def rectangle(step=0.01):
    """A rectangle with a point every centimetre and a notch in the middle of its lower side."""
    corners = np.array([[0.0, 0.0], [LONG, 0.0], [LONG, WIDE], [0.0, WIDE]])
    sides = zip(corners, np.roll(corners, -1, axis=0), strict=True)
    parts = [
        np.linspace(a, b, round(np.linalg.norm(b - a) / step), endpoint=False) for a, b in sides
    ]
    outline = np.concatenate(parts)
    at = np.cumsum([0, *map(len, parts)])
    panel = Panel(
        name="P",
        outline=outline,
        corners=at[:4],
        cut_outline=outline,
        grain=np.array([1.0, 0.0]),
        notches=(Notch(position=np.array([LONG / 2, 0.0])),),
    )
    edges = {
        f"P.{k}": Edge(name=f"P.{k}", panel="P", start=int(at[k]), end=int(at[k + 1] % at[4]))
        for k in range(4)
    }
    return Pattern(panels=(panel,), edges=MappingProxyType(edges), seams=())


def area(points):
    x, y = points.T
    return 0.5 * (x * np.roll(y, -1) - y * np.roll(x, -1)).sum()


@pytest.fixture
def pattern():
    return rectangle()


def moved(pattern, way):
    return pattern.panels[0].outline + way


def test_sides_are_the_edges_with_their_lengths_and_notches(pattern):
    (outline,) = drawn_outlines(pattern)
    assert [side.edge for side in outline.sides] == ["P.0", "P.1", "P.2", "P.3"]
    assert np.allclose([side.length for side in outline.sides], [LONG, WIDE, LONG, WIDE])
    assert np.allclose(outline.sides[0].notches, [LONG / 2])
    assert np.allclose(outline.sides[0].normal, [0.0, -1.0])


def test_a_parallel_offset_keeps_corners_sharp_and_neighbours_straight(pattern):
    (outline,) = drawn_outlines(pattern)
    after = moved(pattern, outline.offset(0, lambda arc: np.full_like(arc, 0.004)))
    assert area(after) == pytest.approx(LONG * (WIDE + 0.004), rel=1e-12)
    assert np.ptp(after[:, 0]) == pytest.approx(LONG)
    right = after[outline.sides[1].at]
    assert np.allclose(right[:, 0], LONG)
    assert np.allclose(np.diff(right[:, 1], 2), 0.0)


def test_an_offset_that_ends_before_the_corners_leaves_the_rest(pattern):
    (outline,) = drawn_outlines(pattern)
    way = outline.offset(0, lambda arc: 0.003 * np.sin(np.pi * arc / LONG) ** 2)
    others = np.setdiff1d(np.arange(len(way)), outline.sides[0].at)
    assert np.allclose(way[others], 0.0)
    assert np.allclose(way[:, 0], 0.0)


def test_a_longer_side_keeps_its_form_and_turns_its_neighbours(pattern):
    (outline,) = drawn_outlines(pattern)
    after = moved(pattern, outline.lengthen(0, 0.006))
    low = after[outline.sides[0].at]
    assert np.allclose(low[:, 1], 0.0)
    assert np.ptp(low[:, 0]) == pytest.approx(LONG + 0.006)
    right = after[outline.sides[1].at]
    assert np.allclose(right[-1], [LONG, WIDE])
    turned = (right - right[-1]) @ np.array([[0.0, 1.0], [-1.0, 0.0]])
    assert np.linalg.matrix_rank(turned, tol=1e-12) == 1  # still straight


def test_offsets_are_linear_in_the_amount(pattern):
    (outline,) = drawn_outlines(pattern)
    one = outline.offset(1, lambda arc: arc)
    assert np.allclose(outline.offset(1, lambda arc: -3.0 * arc), -3.0 * one)


def test_a_smooth_joint_moves_along_the_normal():
    """A panel whose edge ends in the middle of a straight side."""
    whole = rectangle()
    panel = whole.panels[0]
    halves = {
        "P.0": Edge(name="P.0", panel="P", start=0, end=15),
        "P.0b": Edge(name="P.0b", panel="P", start=15, end=30),
    }
    split = Pattern(panels=(panel,), edges=MappingProxyType({**whole.edges, **halves}), seams=())
    (outline,) = drawn_outlines(split)
    way = outline.offset(0, np.ones_like)
    assert np.allclose(way[15], [0.0, -1.0])
    beside = way[15:31, 1]
    assert np.allclose(beside, np.linspace(-1.0, 0.0, 16))


def test_a_mesh_of_another_pattern_is_refused(solved, pattern):
    with pytest.raises(InputError, match="panels of the pattern"):
        mesh_outlines(solved.cover, pattern)


def test_all_of_a_mesh_border_lies_on_the_sides(solved, scene):
    for outline in mesh_outlines(solved.cover, scene.pattern):
        seen = np.concatenate([side.at for side in outline.sides])
        assert set(seen) == set(range(len(outline.vertices)))


def ring(count=90, radius=0.1):
    """A round panel with one edge, which ends where it begins."""
    turn = 2 * np.pi * np.arange(count) / count
    outline = radius * np.column_stack([np.cos(turn), np.sin(turn)])
    panel = Panel(
        name="O",
        outline=outline,
        corners=np.array([7]),
        cut_outline=outline,
        grain=np.array([1.0, 0.0]),
    )
    edges = {"O.rim": Edge(name="O.rim", panel="O", start=7, end=7)}
    return Pattern(panels=(panel,), edges=MappingProxyType(edges), seams=())


def test_a_closed_side_moves_out_evenly():
    pattern = ring()
    (outline,) = drawn_outlines(pattern)
    way = outline.offset(0, lambda arc: np.full_like(arc, 3e-3))
    radius = np.linalg.norm(pattern.panels[0].outline + way, axis=1)
    assert radius == pytest.approx(np.full(len(radius), 0.103), abs=1e-5)


def test_a_closed_side_gets_longer_by_what_is_asked():
    pattern = ring()
    (outline,) = drawn_outlines(pattern)
    points = pattern.panels[0].outline + outline.lengthen(0, 5e-3)
    before, after = (
        np.linalg.norm(np.diff(p, axis=0, append=p[:1]), axis=1).sum()
        for p in (pattern.panels[0].outline, points)
    )
    assert after - before == pytest.approx(5e-3, rel=5e-3)
