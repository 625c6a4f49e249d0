import numpy as np
import pytest
import shapely

from seatlook import mesh
from seatlook.errors import InputError
from seatlook.flattening.pattern import cut_outline, notch_fractions


def test_allowance_lies_all_round_at_its_distance(flattened):
    for panel in flattened.pattern.panels:
        sewn, cut = shapely.Polygon(panel.outline), shapely.Polygon(panel.cut_outline)
        assert cut.contains(sewn)
        distance = shapely.distance(shapely.points(panel.cut_outline), sewn)
        assert distance.min() == pytest.approx(0.010, abs=1e-6)
        assert distance.max() < 0.0201


def test_corners_of_the_allowance_are_mitred_or_cut_square():
    """A right angle keeps its corner, a sharp tip does not grow a spike."""
    square = cut_outline(np.array([[0, 0], [1, 0], [1, 1], [0, 1]]) * 0.1, 0.01)
    assert {tuple(p) for p in square.round(9).tolist()} == {
        (-0.01, -0.01),
        (0.11, -0.01),
        (0.11, 0.11),
        (-0.01, 0.11),
    }
    tip = cut_outline(np.array([[0, 0], [0.2, 0], [0, 0.03]]), 0.01)
    assert tip[:, 0].max() < 0.2 + 0.021  # a full mitre would reach 0.2 + 0.13


def test_no_allowance_is_the_sew_line():
    line = np.array([[0, 0], [0.1, 0], [0, 0.1]])
    assert (cut_outline(line, 0.0) == line).all()


def test_bad_allowances_are_named():
    pocket = [[0, 0], [1, 0], [1, 1], [0.54, 1], [0.8, 0.5], [0.2, 0.5], [0.46, 1], [0, 1]]
    with pytest.raises(
        InputError, match="allowance: got 10 mm, expected a cutting line that does not meet"
    ):
        cut_outline(0.1 * np.array(pocket), 0.01)
    with pytest.raises(InputError, match=r"allowance: got -0\.01, expected at least 0"):
        cut_outline(np.array(pocket), -0.01)


@pytest.mark.parametrize(("length", "count"), [(0.05, 1), (0.29, 1), (0.31, 3), (0.7, 5)])
def test_notches_are_odd_in_number_and_hold_the_middle(length, count):
    result = notch_fractions(length)
    assert len(result) == count
    assert result[count // 2] == 0.5
    assert np.allclose(result, 1 - result[::-1])


def test_notches_of_both_panels_meet(flattened):
    """Measured along either sewing line from its common end, the marks are equally far."""
    pattern = flattened.pattern
    for seam in pattern.seams:
        marks = []
        for name in (seam.a, seam.b[0]):
            line = pattern.edge_points(name)
            edge = pattern.edges[name]
            ring = shapely.LineString(line)
            positions = [n.position for n in pattern.panel(edge.panel).notches]
            on = [p for p in positions if ring.distance(shapely.Point(p)) < 1e-9]
            marks.append(sorted(ring.project(shapely.Point(p)) for p in on))
        total = pattern.edge_length(seam.b[0])
        assert len(marks[0]) == len(marks[1]) >= 1
        assert np.allclose(marks[0], sorted(total - np.array(marks[1])), atol=2e-4)


def test_edges_cover_each_outline_once(flattened):
    pattern = flattened.pattern
    for panel in pattern.panels:
        own = [e for e in pattern.edges.values() if e.panel == panel.name]
        assert sorted(e.start for e in own) == sorted(panel.corners.tolist())
        total = sum(pattern.edge_length(e.name) for e in own)
        ring = np.vstack([panel.outline, panel.outline[:1]])
        assert total == pytest.approx(mesh.arc_length(ring)[-1])


def test_panels_lie_apart(flattened):
    pieces = [shapely.Polygon(panel.cut_outline) for panel in flattened.pattern.panels]
    for i, piece in enumerate(pieces):
        assert all(piece.distance(other) > 0.02 for other in pieces[:i])


def test_seams_name_both_panels_once(flattened):
    names = [seam.name for seam in flattened.pattern.seams]
    assert len(set(names)) == len(names) == 14
    assert "INSERT-BOLSTER_L" in names
    assert all(seam.reverse for seam in flattened.pattern.seams)
