"""Outlines and blocks as exporters draw them, each with a right value to compare with."""

import numpy as np
import pytest

from support.dxf_sheet import L_AREA, L_SHAPE, area, sides


def add_ellipse(sheet, block):
    block.add_ellipse((200, 150), major_axis=(150, 40), ratio=0.6, dxfattribs={"layer": "1"})
    return np.pi * (150**2 + 40**2) * 0.6


def add_circle(sheet, block):
    block.add_circle((0, 0), 140, dxfattribs={"layer": "1"})
    return np.pi * 140**2


def add_spline(sheet, block):
    """Draw a closed cubic through points of a circle, and of it the area by its own formula."""
    angles = np.linspace(0, 2 * np.pi, 33)
    points = [(100 * np.cos(t), 100 * np.sin(t), 0) for t in angles]
    spline = block.add_spline(points, dxfattribs={"layer": "1"})
    return np.pi * 100**2 if spline else 0


def add_arcs(sheet, block):
    """Draw a stadium: two half circles and two lines, each a separate entity."""
    block.add_arc((0, 0), 50, 90, 270, dxfattribs={"layer": "1"})
    block.add_line((200, 50), (0, 50), dxfattribs={"layer": "1"})
    block.add_arc((200, 0), 50, 270, 90, dxfattribs={"layer": "1"})
    block.add_line((0, -50), (200, -50), dxfattribs={"layer": "1"})
    return np.pi * 50**2 + 200 * 100


def add_turned_arcs(sheet, block):
    """Draw the same seen from below: the arcs' own axes are turned over."""
    down = {"layer": "1", "extrusion": (0, 0, -1)}
    block.add_arc((0, 0), 50, -90, 90, dxfattribs=down)
    block.add_line((200, 50), (0, 50), dxfattribs={"layer": "1"})
    block.add_arc((-200, 0), 50, 90, 270, dxfattribs=down)
    block.add_line((0, -50), (200, -50), dxfattribs={"layer": "1"})
    return np.pi * 50**2 + 200 * 100


def add_bulges(sheet, block):
    points = [(0, 0, 0), (200, 0, 1), (200, 100, 0), (0, 100, 0)]
    block.add_lwpolyline(points, format="xyb", close=True, dxfattribs={"layer": "1"})
    return 200 * 100 + np.pi * 50**2 / 2


def add_fitted(sheet, block):
    """Draw a fitted polyline, which holds the vertices of its frame beside those of the line."""
    frame = [(-300, -200), (300, -200), (300, 200), (-300, 200)]
    t = np.linspace(0, 2 * np.pi, 200, endpoint=False)
    line = np.column_stack([200 * np.cos(t), 100 * np.sin(t)]).tolist()
    polyline = block.add_polyline2d([*frame, *line], close=True, dxfattribs={"layer": "1"})
    polyline.dxf.flags |= 4
    for number, vertex in enumerate(polyline.vertices):
        vertex.dxf.flags = 16 if number < len(frame) else 8
    return np.pi * 200 * 100


SQUARE = np.array([(-200.0, -200.0, 0.0), (200, -200, 0), (200, 200, 0), (-200, 200, 0)])


def add_periodic_spline(sheet, block):
    """Draw a closed cubic with single end knots."""
    block.add_spline(dxfattribs={"layer": "1"}).set_closed(SQUARE.tolist())
    return closed_cubic_area()


def add_rational_periodic_spline(sheet, block):
    """Draw the same with equal weights, which change nothing."""
    spline = block.add_spline(dxfattribs={"layer": "1"})
    spline.set_closed_rational(SQUARE.tolist(), [2.0] * 4)
    return closed_cubic_area()


def closed_cubic_area():
    """Area [mm2] inside the cubics that the points of the square control."""
    t = np.linspace(0.0, 1.0, 1001)
    cubics = [(1 - t) ** 3, 3 * t**3 - 6 * t**2 + 4, -3 * t**3 + 3 * t**2 + 3 * t + 1, t**3]
    pieces = [np.column_stack(cubics) @ np.roll(SQUARE, -k, axis=0) / 6 for k in range(4)]
    return area(1e-3 * np.concatenate([piece[:-1, :2] for piece in pieces]))


@pytest.mark.parametrize(
    "draw",
    [
        add_circle,
        add_ellipse,
        add_spline,
        add_periodic_spline,
        add_rational_periodic_spline,
        add_arcs,
        add_turned_arcs,
        add_bulges,
        add_fitted,
    ],
)
def test_curved_outlines(sheet, draw):
    expected = draw(sheet, sheet.block("A"))
    sheet.insert("A")
    panels, said = sheet.read()
    assert area(panels["A"].outline) == pytest.approx(expected, rel=1e-3)
    assert said == []
    assert len(panels["A"].corners)


# Blocks

TRANSFORMS = {
    "turned": ({"rotation": 30}, L_AREA, False),
    "mirrored": ({"xscale": -1}, L_AREA, True),
    "turned over": ({"yscale": -1, "rotation": 77}, L_AREA, True),
    "larger": ({"xscale": 2, "yscale": 2}, 4 * L_AREA, False),
    "stretched": ({"xscale": 2, "yscale": -0.5}, L_AREA, True),
    "seen from below": ({"extrusion": (0, 0, -1)}, L_AREA, True),
}


@pytest.mark.parametrize("kind", TRANSFORMS)
def test_insert_with_its_whole_transform(sheet, kind):
    attributes, expected, is_mirrored = TRANSFORMS[kind]
    sheet.block("A", L_SHAPE)
    sheet.insert("A", **attributes)
    panels, said = sheet.read()
    outline = panels["A"].outline
    assert area(outline) == pytest.approx(expected)
    # Counter-clockwise, the L has its short sides before or after the notch.
    inner = int(np.argmin(turns(outline)))
    before, after = sides(outline)[inner - 1], sides(outline)[inner]
    stretch = (attributes.get("xscale", 1), attributes.get("yscale", 1))
    long, short = 180 * abs(stretch[0]), 100 * abs(stretch[1])
    assert [before, after] == pytest.approx([short, long] if is_mirrored else [long, short])
    assert said == []


def turns(points):
    before, after = points - np.roll(points, 1, axis=0), np.roll(points, -1, axis=0) - points
    return before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]


def test_grain_turns_with_its_block(sheet):
    sheet.block("A", L_SHAPE)
    sheet.insert("A", rotation=90)
    panels, _ = sheet.read()
    assert panels["A"].grain == pytest.approx([-1, 0], abs=1e-12)


def test_blocks_in_blocks(sheet):
    inner = sheet.document.blocks.new("INNER", base_point=(10, 10))
    sheet.line(inner, [(10, 10), (110, 10), (110, 60), (10, 60)], "8", closed=False)
    outer = sheet.block("OUTER", L_SHAPE)
    sheet.insert("INNER", outer, at=(20, 30), xscale=0.5, yscale=0.5)
    sheet.insert("OUTER")
    panels, said = sheet.read()
    (line,) = panels["OUTER"].internal_lines.values()
    assert 1e3 * line == pytest.approx(np.array([[20, 30], [70, 30], [70, 55], [20, 55]]))
    assert said == []


def test_sheet_of_pieces_in_a_block(sheet):
    for name in "AB":
        sheet.block(name, L_SHAPE)
    whole = sheet.document.blocks.new("SHEET")
    sheet.insert("A", whole)
    sheet.insert("B", whole, xscale=-1, at=(0, 0))
    sheet.insert("SHEET", xscale=-1)
    panels, said = sheet.read()
    assert list(panels) == ["A", "B"]
    assert [area(p.outline) for p in panels.values()] == pytest.approx([L_AREA, L_AREA])
    assert panels["B"].outline == pytest.approx(1e-3 * np.array(L_SHAPE))
    assert said == []


def test_block_that_holds_itself_is_left_out_with_a_word(sheet):
    block = sheet.block("A", L_SHAPE)
    sheet.insert("A", block)
    sheet.insert("A")
    panels, said = sheet.read()
    assert list(panels) == ["A"]
    assert said == ["not read: 1 INSERT on layer 1 (a block in itself)"]


def test_pieces_used_again_are_numbered(sheet):
    sheet.block("A", L_SHAPE)
    for x, attributes in enumerate(({}, {"rotation": 90}, {"xscale": -1}, {})):
        sheet.insert("A", at=(500 * x, 0), **attributes)
    sheet.insert("A", at=(0, 0))  # in the place of the first
    panels, said = sheet.read()
    assert list(panels) == ["A", "A_2", "A_mirrored", "A_3"]
    assert said == [f"piece A: it is used again: read as {n}" for n in list(panels)[1:]]


def test_rows_and_columns_of_an_insert(sheet):
    sheet.block("A", L_SHAPE)
    sheet.insert("A", row_count=2, column_count=3, row_spacing=400, column_spacing=400)
    panels, _ = sheet.read()
    assert list(panels) == ["A", *(f"A_{n}" for n in range(2, 7))]


@pytest.mark.parametrize("rotation", [0, 35])
def test_quantity_makes_no_piece_that_the_file_holds(sheet, rotation):
    sheet.block("LH", L_SHAPE, texts=["Quantity: 1,1"])
    sheet.block("RH", [(-x, y) for x, y in L_SHAPE])
    sheet.insert("LH")
    sheet.insert("RH", rotation=rotation)
    panels, said = sheet.read()
    assert list(panels) == ["LH", "RH"]
    assert said == []


def test_piece_that_is_no_mirror_image_does_not_stand_for_one(sheet):
    sheet.block("LH", L_SHAPE, texts=["Quantity: 1,1"])
    sheet.block("COPY", L_SHAPE)
    sheet.insert("LH")
    sheet.insert("COPY")
    panels, _ = sheet.read()
    assert list(panels) == ["LH", "COPY", "LH_mirrored"]
    made = panels["LH_mirrored"]
    assert made.outline[:, 0].min() == pytest.approx(panels["LH"].outline[:, 0].min())
    assert made.outline == pytest.approx(
        1e-3 * np.array([(300 - x, y) for x, y in [L_SHAPE[0], *L_SHAPE[:0:-1]]])
    )
    assert made.corners.tolist() == [0, 1, 2, 3, 4, 5]


def test_two_outlines_in_a_block_are_two_pieces(sheet):
    block = sheet.block("A", L_SHAPE)
    sheet.line(block, [(400, 0), (500, 0), (500, 80), (400, 80)])
    block.add_line((450, 20), (450, 60), dxfattribs={"layer": "7"})
    sheet.insert("A")
    panels, said = sheet.read()
    assert [area(p.outline) for p in panels.values()] == pytest.approx([L_AREA, 8000])
    assert said == ["piece A: 2 outlines in one block: each a piece"]


def test_sizes_in_any_case(sheet):
    for size in ("m", "L"):
        scale = 1.0 if size == "m" else 1.5
        outline = [(scale * x, scale * y) for x, y in L_SHAPE]
        sheet.block(f"A_{size}", outline, texts=["Piece Name: A", f"SIZE: {size}"])
        sheet.insert(f"A_{size}")
    sheet.text(sheet.space, "Sample Size: M")
    assert area(sheet.read()[0]["A"].outline) == pytest.approx(L_AREA)
    assert area(sheet.read(size="l")[0]["A"].outline) == pytest.approx(2.25 * L_AREA)


def test_layer_0_is_that_of_the_insert(sheet):
    """As DXF has it: a piece drawn on layer 0 and put on layer 1 is a piece."""
    block = sheet.document.blocks.new("A")
    sheet.line(block, L_SHAPE, "0")
    sheet.line(block, [(50, 20), (50, 80)], "7", closed=False)
    around = sheet.document.blocks.new("B")
    sheet.insert("A", around)
    sheet.insert("A", around, at=(500, 0), xscale=-1)
    sheet.insert("B")
    panels, said = sheet.read()
    assert list(panels) == ["A", "A_mirrored"]
    assert [area(p.outline) for p in panels.values()] == pytest.approx([L_AREA, L_AREA])
    assert said == ["piece A: it is used again: read as A_mirrored"]


def test_blocks_that_are_no_pieces_are_named(sheet):
    sheet.insert(sheet.block("A", L_SHAPE).name)
    sheet.line(sheet.block("B", grain=False), L_SHAPE, "side")
    sheet.insert("B")
    sheet.insert("C")
    _, said = sheet.read()
    assert said == [
        "block B has no outline on layer 1: not read (its layers: side)",
        "block C is put on the sheet, but the file does not hold it: not read",
    ]


def test_blocks_are_pieces_where_the_sheet_puts_none_of_them(sheet):
    """An exporter that puts blocks of other names than it writes."""
    sheet.block("A", L_SHAPE, texts=("PIECE: Wange", "QTY: 1,1"))
    sheet.insert("-M")
    panels, said = sheet.read()
    assert list(panels) == ["Wange", "Wange_mirrored"]
    assert said[0] == "block -M is put on the sheet, but the file does not hold it: not read"


def test_a_block_that_is_put_nowhere_is_named(sheet):
    sheet.insert(sheet.block("A", L_SHAPE).name)
    sheet.block("B", L_SHAPE)
    panels, said = sheet.read()
    assert list(panels) == ["A"]
    assert said == ["block B has an outline, but is put nowhere on the sheet: not read"]


def test_attributes_of_an_insert_name_its_piece(sheet):
    """CAD systems that keep one block for a shape, and say at each use what it is."""
    sheet.block("SHAPE", L_SHAPE)
    uses = [
        {"PIECE_NAME": "Lehne 'links'", "QTY": "1", "COLOUR": "red"},
        {"Piece Name": "Lehne rechts", "SIZE": ""},
        {"INFO": "Piece Name: Kissen"},
        {},
    ]
    for number, attributes in enumerate(uses):
        insert = sheet.insert("SHAPE", at=(500 * number, 0))
        for tag, value in attributes.items():
            insert.add_attrib(tag, value, insert=(500 * number, 50))
    panels, said = sheet.read()
    assert list(panels) == ["Lehne 'links'", "Lehne rechts", "Kissen", "SHAPE"]
    assert [area(p.outline) for p in panels.values()] == pytest.approx([L_AREA] * 4)
    assert not said


def test_attributes_in_a_sheet_of_pieces_belong_to_their_own(sheet):
    sheet.block("SHAPE", L_SHAPE, texts=("Piece Name: general",))
    around = sheet.document.blocks.new("SHEET")
    for number, name in enumerate(("A", "B")):
        inner = sheet.insert("SHAPE", around, at=(500 * number, 0), rotation=90 * number)
        inner.add_attrib("PIECENAME", name)
    sheet.insert("SHEET").add_attrib("TITLE", "all")
    panels, _ = sheet.read()
    assert list(panels) == ["A", "B"]
