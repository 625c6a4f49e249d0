"""The sew line of patterns of which only the cut line is drawn."""

import numpy as np
import pytest
import shapely

from seatlook.assembly.ease import notches_on
from seatlook.errors import InputError
from seatlook.io import read_pattern
from support.dxf_sheet import L_AREA, L_SHAPE, Sheet, area, sides

SEAMS = """
[edge.bottom]
panel = "P"
from_mm = [{d}, {d}]
to_mm = [{e}, {d}]
{own}
[edge.right]
panel = "P"
from_mm = [{e}, {d}]
to_mm = [{e}, {f}]
"""


@pytest.fixture
def sheet(tmp_path):
    sheet = Sheet(tmp_path / "a.dxf")
    block = sheet.block("P", L_SHAPE)
    block.add_point((150, 0), dxfattribs={"layer": "4", "thickness": 5})
    sheet.insert("P")
    return sheet


def test_corners_and_sides_go_inward_with_the_line(sheet):
    panels, said = sheet.read(allowance=0.010)
    (panel,) = panels.values()
    assert said == []
    assert area(panel.cut_outline) == pytest.approx(L_AREA)
    expected = [(10, 10), (290, 10), (290, 90), (110, 90), (110, 190), (10, 190)]
    assert 1e3 * panel.outline[panel.corners] == pytest.approx(np.array(expected, dtype=float))
    inside = shapely.Polygon(L_SHAPE).buffer(-10, join_style="mitre")
    assert area(panel.outline) == pytest.approx(inside.area)


@pytest.mark.parametrize("width", [0.004, 0.012, 0.02])
@pytest.mark.parametrize("seed", range(4))
def test_the_line_lies_as_far_inside_as_the_allowance_is_wide(tmp_path, width, seed):
    """Rounded outlines of any shape, with corners rounder than the allowance as well."""
    rng = np.random.default_rng(seed)
    t = np.linspace(0, 2 * np.pi, 90, endpoint=False)
    radius = 150 + sum(rng.uniform(-9, 9) * np.cos(k * t + rng.uniform(0, 6)) for k in (2, 3, 5))
    outline = np.column_stack([radius * np.cos(t), radius * np.sin(t)])
    outline[[20, 50]] *= [[1.04], [0.96]]
    sheet = Sheet(tmp_path / "a.dxf")
    sheet.block("P", outline.tolist())
    sheet.insert("P")
    panels, _ = sheet.read(allowance=width)
    (panel,) = panels.values()
    polygon, ring = shapely.Polygon(panel.outline), shapely.LinearRing(panel.cut_outline)
    assert polygon.is_valid
    assert polygon.within(shapely.Polygon(panel.cut_outline))
    away = shapely.distance(ring, shapely.points(panel.outline))
    assert away.min() > 0.97 * width
    assert np.median(away) == pytest.approx(width, rel=1e-3)


def test_a_drawn_sew_line_stays(sheet):
    sheet.line(sheet.document.blocks.get("P"), [(8, 8), (292, 8), (292, 92), (8, 92)], layer="14")
    panels, said = sheet.read(allowance=0.010)
    assert sides(panels["P"].outline) == pytest.approx([284, 84, 284, 84])
    assert said == ["allowance_mm is not used where a sew line is drawn: P"]


def test_an_allowance_wider_than_the_panel_is_named(sheet):
    with pytest.raises(InputError, match="60 mm on P, which is narrower than two of them"):
        sheet.read(allowance=0.060)


def seams(tmp_path, width, own=""):
    path = tmp_path / "seams.toml"
    path.write_text(SEAMS.format(d=width, e=300 - width, f=100 - width, own=own))
    return path


def test_edges_have_allowances_of_their_own(sheet, tmp_path):
    sheet.read()
    path = seams(tmp_path, 10, own="allowance_mm = 25")
    pattern = read_pattern(sheet.path, path, allowance=0.010)
    assert 1e3 * pattern.edge_points("bottom") == pytest.approx(
        np.array([(10.0, 25.0), (290.0, 25.0)])
    )
    assert pattern.edge_length("right") == pytest.approx(0.065)
    assert notches_on(pattern, "bottom") == pytest.approx([0.140])
    alone = read_pattern(sheet.path, seams(tmp_path, 0, own="allowance_mm = 25"))
    assert 1e3 * alone.edge_points("bottom") == pytest.approx(
        np.array([(0.0, 25.0), (300.0, 25.0)])
    )


def test_an_edge_of_a_drawn_sew_line_takes_no_allowance(sheet, tmp_path):
    inside = [(10, 10), (290, 10), (290, 90), (110, 90), (110, 190), (10, 190)]
    sheet.line(sheet.document.blocks.get("P"), inside, layer="14")
    sheet.read()
    with pytest.raises(InputError, match="got 25, expected none, as the sew line of P is drawn"):
        read_pattern(sheet.path, seams(tmp_path, 10, own="allowance_mm = 25"))
