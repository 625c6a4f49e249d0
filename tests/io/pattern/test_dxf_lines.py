"""Lines of a piece as exporters draw them, each with a right value to compare with."""

import itertools
import tracemalloc

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from seatlook.errors import InputError
from seatlook.io import read_dxf, report_dxf
from support.dxf_sheet import L_AREA, L_SHAPE, Sheet, area, sides


@pytest.mark.parametrize("layer", ["8", "1", "SOMETHING"])
def test_parallel_line_inside_is_the_sew_line(sheet, layer):
    """Also where the allowance is not the same along all edges."""
    block = sheet.block("A", L_SHAPE)
    inner = [(10, 15), (290, 15), (290, 90), (110, 90), (110, 188), (10, 188)]
    sheet.line(block, inner, layer)
    sheet.insert("A")
    panels, said = sheet.read()
    assert 1e3 * panels["A"].outline == pytest.approx(np.array(inner, dtype=float))
    assert area(panels["A"].cut_outline) == pytest.approx(L_AREA)
    assert len(panels["A"].internal_lines) == 0
    (text,) = said
    assert f"layer {layer} that runs parallel inside the outline" in text


@pytest.mark.parametrize(
    "inner",
    [
        [(5, 5), (25, 5), (25, 25), (5, 25)],  # near a corner
        [(140, 40), (160, 40), (160, 60), (140, 60)],  # in the middle
        [(50, 60), (250, 20), (90, 90)],  # across
    ],
)
def test_other_closed_lines_are_no_sew_line(sheet, inner):
    sheet.line(sheet.block("A", L_SHAPE), inner, "8")
    sheet.insert("A")
    panels, said = sheet.read()
    assert area(panels["A"].outline) == pytest.approx(L_AREA)
    assert len(panels["A"].internal_lines) == 1
    assert said == []


def test_sew_line_drawn_edge_by_edge_among_other_lines(sheet):
    """Some exporters put the sewn edges on layer 8, where other lines begin at their corners."""
    block = sheet.block("A", [(0, 0), (400, 0), (400, 300), (0, 300)])
    ring = [(10, 10), (390, 10), (390, 290), (10, 290), (10, 10)]
    for a, b in itertools.pairwise(ring):
        sheet.line(block, [a, b], "8", closed=False)
    sheet.line(block, [(10, 10), (200, 150)], "8", closed=False)
    sheet.line(block, [(10, 150), (390, 150)], "8", closed=False)
    sheet.insert("A")
    panels, said = sheet.read()
    assert area(panels["A"].outline) == pytest.approx(380 * 280)
    assert len(panels["A"].corners) == 4
    assert len(panels["A"].internal_lines) == 2
    assert said == [
        "piece A: nothing on layer 14: the line on layer 8 that runs parallel inside the outline "
        "is taken for the sew line"
    ]


def test_hole_is_a_cut_out(sheet):
    block = sheet.block("A", L_SHAPE)
    block.add_circle((60, 60), 20, dxfattribs={"layer": "1"})
    sheet.insert("A")
    panels, said = sheet.read()
    assert area(panels["A"].outline) == pytest.approx(L_AREA)
    (hole,) = panels["A"].holes
    assert area(hole) == pytest.approx(np.pi * 20**2, rel=1e-3)
    assert 1e6 * panels["A"].area == pytest.approx(L_AREA - np.pi * 20**2, rel=1e-3)
    assert said == []


@pytest.mark.parametrize("layer", ["1", "11"])
def test_cut_outs_on_either_layer_go_with_their_piece(sheet, layer):
    """Mirrored, turned, drawn twice, side by side: the hole keeps its place in the panel."""
    block = sheet.block("A", L_SHAPE, texts=("Quantity: 1,1",))
    sheet.line(block, [(40, 40), (80, 40), (80, 70)], layer)
    sheet.line(block, [(40, 40), (80, 40), (80, 70)], "11")
    sheet.insert("A", rotation=90)
    panels, _ = sheet.read()
    assert list(panels) == ["A", "A_mirrored"]
    for panel in panels.values():
        (hole,) = panel.holes
        assert area(hole) == pytest.approx(0.5 * 40 * 30)
        assert shapely.Polygon(panel.outline).contains(shapely.Polygon(hole))


CUT_OUT = [(100, 30), (160, 30), (160, 70), (100, 70)]
ROUND_IT = [(93, 23), (167, 23), (167, 77), (93, 77)]


@pytest.mark.parametrize("layer", ["1", "11"])
@pytest.mark.parametrize("sewn", [True, False])
def test_a_cut_out_ends_at_its_own_sew_line(sheet, layer, sewn):
    """The sew line round a cut-out is none of the outline, also where the outline has none."""
    block = sheet.block("A", L_SHAPE)
    sheet.line(block, CUT_OUT, layer)
    sheet.line(block, CUT_OUT, "11")  # on both layers it is one
    sheet.line(block, ROUND_IT, "14")
    inner = [(10, 10), (290, 10), (290, 90), (110, 90), (110, 190), (10, 190)]
    if sewn:
        sheet.line(block, inner, "14")
    sheet.insert("A")
    panels, said = sheet.read()
    (hole,) = panels["A"].holes
    assert area(hole) == pytest.approx(74 * 54)
    assert area(panels["A"].outline) == pytest.approx(280 * 80 + 100 * 100 if sewn else L_AREA)
    assert said == []


def test_in_a_narrow_ring_each_sew_line_goes_to_the_line_that_is_nearer(sheet):
    block = sheet.block("A")
    for layer, edge in (("1", 0), ("14", 4), ("14", 22), ("11", 26)):
        ring = np.array([(0, 0), (300, 0), (300, 200), (0, 200)])
        sheet.line(block, (ring + edge * np.sign([150, 100] - ring)).tolist(), layer)
    sheet.insert("A")
    panels, _ = sheet.read()
    assert area(panels["A"].outline) == pytest.approx(292 * 192)
    assert [area(hole) for hole in panels["A"].holes] == [pytest.approx(256 * 156)]


def test_half_a_cut_out_is_unfolded_with_its_piece(sheet):
    block = sheet.block("A")
    sheet.line(block, [(0, 0), (200, 0), (200, 150), (0, 150)], closed=False)
    sheet.line(block, [(0, 0), (0, 150)], "6", closed=False)
    sheet.line(block, [(0, 50), (30, 50), (30, 90), (0, 90)], "11", closed=False)
    sheet.insert("A")
    panels, said = sheet.read()
    (hole,) = panels["A"].holes
    assert area(hole) == pytest.approx(60 * 40)
    assert said == []


@pytest.mark.parametrize(
    ("points", "closed", "message"),
    [
        ([(150, 80), (150, 150), (90, 80)], True, "a cut-out that crosses an outline"),
        ([(40, 40), (80, 40), (80, 70)], False, "an open outline"),
        ([(40, 40), (80, 70), (80, 40), (40, 70)], True, "crosses itself"),
    ],
)
def test_cut_outs_that_cannot_be_cut(sheet, points, closed, message):
    sheet.line(sheet.block("A", L_SHAPE), points, "11", closed=closed)
    sheet.insert("A")
    with pytest.raises(InputError, match=message):
        sheet.read()


@pytest.mark.parametrize(
    "cut",
    [
        [(-10, -10), (310, 210), (310, -10), (-10, 210)],
        [(-10, -10), (310, -10), (310, 110), (5, 110)],
    ],
)
def test_sew_line_stands_for_a_cut_line_with_faults(sheet, cut):
    block = sheet.block("A")
    sheet.line(block, cut, closed=cut[1] != (310, -10))
    sheet.line(block, [(0, 0), (300, 0), (300, 100), (0, 100)], "14")
    sheet.insert("A")
    panels, said = sheet.read()
    assert area(panels["A"].outline) == pytest.approx(30000)
    (text,) = said
    assert text.startswith("piece A: layer 1 has an o")
    assert text.endswith("the sew line is taken, without an allowance")


def test_layers_by_name(sheet):
    block = sheet.block("A", grain=False)
    sheet.line(block, [(-10, -10), (310, -10), (310, 210), (-10, 210)], "CUT_LINE")
    sheet.line(block, [(0, 0), (300, 0), (300, 200), (0, 200)], "Sew")
    block.add_line((20, 20), (120, 20), dxfattribs={"layer": "GRAIN LINE"})
    block.add_point((150, -10), dxfattribs={"layer": "NOTCH"})
    sheet.insert("A")
    panels, said = sheet.read()
    assert area(panels["A"].outline) == pytest.approx(60000)
    assert area(panels["A"].cut_outline) == pytest.approx(320 * 220)
    assert panels["A"].grain.tolist() == [1.0, 0.0]
    assert len(panels["A"].notches) == 1
    assert said == []


def test_notches_drawn_as_lines(sheet):
    block = sheet.block("A", L_SHAPE)
    block.add_line((150, 6), (150, 0), dxfattribs={"layer": "4"})
    sheet.line(block, [(200, 0), (203, 5), (206, 0)], "4", closed=False)
    sheet.insert("A")
    notches = sheet.read()[0]["A"].notches
    assert [n.kind for n in notches] == ["v", "v"]
    assert 1e3 * np.array([n.position for n in notches]) == pytest.approx(
        np.array([[150, 0], [203, 0]])
    )
    assert [n.depth for n in notches] == pytest.approx([6e-3, np.hypot(3, 5) * 1e-3], rel=0.2)


def test_entities_that_are_not_read_are_counted(sheet):
    block = sheet.block("A", L_SHAPE)
    block.add_solid([(1, 1), (2, 1), (1, 2)], dxfattribs={"layer": "8"})
    for x in (20, 40):
        block.add_line((x, 20), (x, 60), dxfattribs={"layer": "13"})
        block.add_line((x, 20), (x, 60), dxfattribs={"layer": "CHALK"})
    sheet.insert("A")
    _, said = sheet.read()
    assert said == [
        "not read: 1 SOLID on layer 8 (neither line, point nor text)",
        "not read: 2 LINE on layer CHALK (a layer without a meaning)",
    ]
    assert sum(report_dxf(sheet.path).left.values()) == 5


# Gaps and slits


@settings(max_examples=30, deadline=None)
@given(gap=st.floats(0.0, 0.49), angle=st.floats(0, 6.28), order=st.permutations(range(6)))
def test_gaps_up_to_half_a_millimetre_are_joined(tmp_path_factory, gap, angle, order):
    sheet = Sheet(tmp_path_factory.mktemp("gap") / "a.dxf")
    block = sheet.block("A")
    off = gap * np.array([np.cos(angle), np.sin(angle)])
    edges = list(zip(np.array(L_SHAPE, float), np.roll(L_SHAPE, -1, axis=0), strict=True))
    for k in order:
        a, b = edges[k]
        a, b = (b, a + off) if k % 2 else (a + off, b)
        block.add_line(a, b, dxfattribs={"layer": "1"})
    sheet.insert("A")
    panels, _ = sheet.read()
    assert area(panels["A"].outline) == pytest.approx(L_AREA, abs=0.5 * 1000)
    assert len(sides(panels["A"].outline)) <= 12


def test_wider_gaps_are_refused(sheet):
    block = sheet.block("A")
    sheet.line(block, [*L_SHAPE, (0, 0.6)], closed=False)
    sheet.insert("A")
    with pytest.raises(InputError, match=r"0\.60 mm apart"):
        sheet.read()


@pytest.mark.parametrize(
    "slit",
    [
        [
            [(0, 0), (150, 0)],
            [(150, 0), (150, 6)],
            [(150, 6), (150, 0)],
            [(150, 0), *L_SHAPE[1:], (0, 0)],
        ],
        [[*L_SHAPE, (0, 0)], [(150, 0), (150, 6)]],
        [[(0, 0), (150, 0), (150, 6), (150.2, 0), *L_SHAPE[1:], (0, 0)]],
    ],
    ids=["there and back", "a line of its own", "in the outline"],
)  # fmt: skip
def test_slits_are_notches(sheet, slit):
    block = sheet.block("A")
    for points in slit:
        sheet.line(block, points, closed=False)
    sheet.insert("A")
    panels, said = sheet.read()
    assert area(panels["A"].outline) == pytest.approx(L_AREA, abs=1)
    (notch,) = panels["A"].notches
    assert 1e3 * notch.position == pytest.approx([150, 0], abs=0.2)
    assert notch.depth == pytest.approx(6e-3, abs=1e-4)
    assert said == []


def test_many_internal_lines_take_little_memory(sheet):
    block = sheet.block("A", [(0, 0), (2000, 0), (2000, 2000), (0, 2000)])
    for k in range(8000):
        x, y = 20 + 20 * (k % 90), 20 + 20 * (k // 90)
        block.add_line((x, y), (x + 5, y), dxfattribs={"layer": "8"})
    sheet.insert("A")
    sheet.document.saveas(sheet.path)
    tracemalloc.start()
    try:
        (panel,) = read_dxf(sheet.path)
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert len(panel.internal_lines) == 8000
    assert peak < 200e6
