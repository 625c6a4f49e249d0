from pathlib import Path

import numpy as np
import pytest

from seatlook.errors import InputWarning
from seatlook.io.pattern.dxf import read_dxf

DATA = Path(__file__).parents[2] / "data"
SQUARE = [(0, 0), (100, 0), (100, 80), (0, 80)]


def text(layer, words):
    return ["0", "TEXT", "8", layer, "10", "0", "20", "0", "40", "1", "1", words]


def polyline(layer, points, *, closed=True):
    rows = ["0", "POLYLINE", "8", layer, "66", "1", "70", str(int(closed))]
    for x, y in points:
        rows += ["0", "VERTEX", "8", layer, "10", str(x), "20", str(y)]
    return [*rows, "0", "SEQEND", "8", layer]


def line(layer, a, b):
    return ["0", "LINE", "8", layer, "10", str(a[0]), "20", str(a[1]),
            "11", str(b[0]), "21", str(b[1])]  # fmt: skip


def point(layer, p, z=0):
    return ["0", "POINT", "8", layer, "10", str(p[0]), "20", str(p[1]), "30", str(z)]


GRAIN = line("7", (50, 20), (50, 60))


def dxf(blocks, titles=("Units: METRIC",), *, inserted=True):
    """Spell a minimal R12 file; ``blocks`` maps block name -> entities."""
    rows = ["0", "SECTION", "2", "HEADER", "9", "$ACADVER", "1", "AC1009", "0", "ENDSEC"]
    rows += ["0", "SECTION", "2", "BLOCKS"]
    for name, entities in blocks.items():
        rows += ["0", "BLOCK", "8", "0", "2", name, "70", "0", "10", "0", "20", "0"]
        rows += [row for entity in entities for row in entity] + ["0", "ENDBLK"]
    rows += ["0", "ENDSEC", "0", "SECTION", "2", "ENTITIES"]
    for name in blocks if inserted else ():
        rows += ["0", "INSERT", "8", "1", "2", name, "10", "0", "20", "0"]
    rows += [row for title in titles for row in text("1", title)]
    return "\n".join([*rows, "0", "ENDSEC", "0", "EOF"]) + "\n"


@pytest.fixture
def panel(write):
    """Read a file of one piece made of these entities."""

    def panel(*entities, titles=("Units: METRIC",), **options):
        path = write("a.dxf", dxf({"A": entities}, titles))
        (read,) = read_dxf(path, **options)
        return read

    return panel


def area(points):
    x, y = points.T
    return 0.5 * np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)


def test_sample_pattern_has_the_areas_it_was_drawn_with():
    panels = {p.name: p for p in read_dxf(DATA / "seat_cushion_demo_aama.dxf")}
    # Outlines are polylines of arcs: the chord areas fall short by some 1e-5.
    for name, sew, cut in (
        ("CENTER", 145278.63, 160868.89),
        ("BOLSTER_R", 43588.15, 55213.21),
        ("BOLSTER_L", 43588.15, 55213.21),
        ("FRONT", 65866.20, 79019.36),
    ):
        panel = panels[name]
        assert area(panel.outline) * 1e6 == pytest.approx(sew, rel=2e-4)
        assert area(panel.cut_outline) * 1e6 == pytest.approx(cut, rel=2e-4)
        assert len(panel.corners) == 4
        assert len(panel.notches) == 4
        assert panel.grain.tolist() == [0.0, 1.0]
    assert list(panels["CENTER"].internal_lines) == ["line1", "line2", "line3"]
    tie_down = panels["CENTER"].internal_lines["line1"]
    assert np.allclose(tie_down, [[0.025, 0.150], [0.275, 0.150]], atol=1e-9)


@pytest.mark.parametrize("title", ["UNITS: ENGLISH", "units: english", "Units:English"])
def test_inches_in_any_case(panel, title):
    read = panel(polyline("1", [(0, 0), (4, 0), (4, 2), (0, 2)]), GRAIN, titles=(title,))
    assert np.ptp(read.outline, axis=0) == pytest.approx([0.1016, 0.0508])


def test_units_text_inside_a_block_counts(write):
    path = write(
        "a.dxf", dxf({"A": [polyline("1", SQUARE), GRAIN, text("1", "UNITS: METRIC")]}, ())
    )
    assert len(read_dxf(path)) == 1


def test_missing_units(write, problems):
    path = write("a.dxf", dxf({"A": [polyline("1", SQUARE), GRAIN]}, ()))
    assert problems(read_dxf, path) == [
        "a.dxf: UNITS: got no such text, expected METRIC or ENGLISH "
        '(say units = "metric" if the file is in millimetres; its longest line is 1000 mm if a '
        "unit is a cm; 2540 mm if a unit is an inch)"
    ]
    (panel,) = read_dxf(path, units="metric")
    assert np.ptp(panel.outline, axis=0).tolist() == [0.1, 0.08]


def test_unknown_units(write, problems):
    path = write("a.dxf", dxf({"A": [polyline("1", SQUARE), GRAIN]}, ("Units: PARSEC",)))
    assert problems(read_dxf, path) == ["a.dxf: UNITS: got 'PARSEC', expected METRIC or ENGLISH"]


def test_clockwise_outline_is_turned_and_keeps_its_first_point(panel):
    read = panel(polyline("1", SQUARE[::-1]), GRAIN)
    assert area(read.outline) > 0
    assert read.outline[0].tolist() == [0.0, 0.08]


def test_open_polylines_are_chained_whatever_their_order_and_direction(panel):
    a, b, c, d = SQUARE
    read = panel(
        polyline("1", [c, b], closed=False),
        polyline("1", [a, (50, 1), b], closed=False),
        line("1", d, a),
        polyline("1", [(99.96, 80), (50, 81), d], closed=False),
        GRAIN,
    )
    assert area(read.outline) * 1e6 == pytest.approx(8000, abs=5)
    assert len(read.outline) == 6


def test_chained_outline_has_corners_where_its_lines_meet(panel):
    curve = [(100 - 20 * np.cos(t), 80 * t / np.pi) for t in np.linspace(0, np.pi, 41)]
    read = panel(
        polyline("1", [(0, 0), curve[0]], closed=False),
        polyline("1", curve[:21], closed=False),
        polyline("1", curve[20:], closed=False),
        polyline("1", [curve[-1], (0, 80), (0, 0)], closed=False),
        GRAIN,
    )
    corners = 1e3 * read.outline[read.corners]
    assert any(np.allclose(c, curve[20], atol=1e-6) for c in corners)
    assert len(corners) == 5


def test_turn_points_are_corners_and_curve_points_are_not(panel):
    outline = [(0, 0), (30, 0), (60, 0), (100, 0), (100, 80), (0, 80)]
    read = panel(polyline("1", outline), point("2", (60, 0.3)), point("3", (30, 0)), GRAIN)
    assert read.corners.tolist() == [0, 2, 3, 4, 5]


def test_half_piece_is_unfolded(panel):
    half = [(0, 0), (40, -10), (100, 0), (100, 80), (0, 80)]
    read = panel(
        polyline("1", half),
        polyline("14", [(10, 80), (10, 10), (90, 10), (90, 80)], closed=False),
        line("6", (0, 80), (100, 80)),
        line("8", (20, 30), (20, 80)),
        point("4", (100, 40)),
        point("4", (0, 80)),
        point("2", (90, 10)),
        GRAIN,
    )
    assert area(read.cut_outline) * 1e6 == pytest.approx(2 * (8000 + 500))
    assert area(read.outline) * 1e6 == pytest.approx(80 * 140)
    assert np.ptp(read.outline, axis=0) == pytest.approx([0.080, 0.140])
    (seam,) = read.internal_lines.values()
    assert sorted((1e3 * seam[:, 1]).tolist()) == pytest.approx([30.0, 80.0, 130.0])
    assert len(read.notches) == 3
    corners = 1e3 * read.outline[read.corners]
    # Where the halves meet, an edge may end: the middle of a front is a common sewing mark.
    expected = [[10, 10], [10, 80], [10, 150], [90, 10], [90, 80], [90, 150]]
    assert sorted(corners.round(6).tolist()) == expected


def test_mirror_line_of_a_whole_piece_folds_nothing(panel):
    read = panel(polyline("1", SQUARE), line("6", (0, 40), (100, 40)), GRAIN)
    assert area(read.outline) * 1e6 == pytest.approx(8000)


def test_open_sew_lines_that_end_on_the_cut_line(panel):
    read = panel(
        polyline("1", SQUARE),
        polyline("14", [(0, 10), (100.0, 10)], closed=False),
        polyline("14", [(90, 80), (90, 10.0)], closed=False),
        GRAIN,
    )
    assert area(read.outline) * 1e6 == pytest.approx(90 * 70)
    assert area(read.cut_outline) * 1e6 == pytest.approx(8000)


def test_sew_line_that_ends_inside(write, problems):
    entities = [polyline("1", SQUARE), polyline("14", [(0, 10), (50, 10)], closed=False), GRAIN]
    assert problems(read_dxf, write("a.dxf", dxf({"A": entities}))) == [
        "a.dxf: piece A, layer 14: got an open sew line, from [0.0, 10.0] to [50.0, 10.0] mm, "
        "expected a closed one, or both ends on the cut line"
    ]


def test_validation_copies_are_ignored(panel):
    read = panel(polyline("1", SQUARE), polyline("84", SQUARE), polyline("87", SQUARE), GRAIN)
    assert len(read.outline) == 4


def test_internal_lines_are_named_by_the_text_at_their_end(panel):
    named = ["0", "TEXT", "8", "8", "10", "20", "20", "20.2", "40", "1", "1", "tie-down"]
    rows = [
        line("8", (20, 20), (60, 20)),
        line("8", (20, 20.4), (20, 60)),
        line("8", (70, 70), (80, 70)),
    ]
    read = panel(polyline("1", SQUARE), *rows, named, GRAIN)
    assert list(read.internal_lines) == ["tie-down", "tie-down 2", "line3"]


def test_notch_kinds(panel):
    layers = {"4": "point", "80": "t", "81": "castle", "82": "check", "83": "u"}
    points = [point(layer, (10, 0)) for layer in layers]
    read = panel(polyline("1", SQUARE), *points, point("4", (20, 0), z=5), GRAIN)
    assert [(n.kind, n.depth) for n in read.notches] == [
        ("point", 0.0), ("v", 0.005), ("t", 0.0), ("castle", 0.0), ("check", 0.0), ("u", 0.0),
    ]  # fmt: skip


def graded():
    blocks = {}
    for size, width in (("38", 90), ("40", 100), ("42", 110)):
        outline = [(0, 0), (width, 0), (width, 80), (0, 80)]
        names = [text("1", "Piece Name: BACK"), text("1", f"SIZE: {size}")]
        blocks[f"BACK_{size}"] = [polyline("1", outline), *names, GRAIN]
    blocks["PATCH"] = [polyline("1", SQUARE), text("1", "Piece name: PATCH"), GRAIN]
    return blocks


@pytest.mark.parametrize(("size", "width"), [(None, 0.100), ("42", 0.110), ("38", 0.090)])
def test_graded_sizes(write, size, width):
    path = write("a.dxf", dxf(graded(), ("UNITS: METRIC", "Sample Size: 40")))
    back, patch = read_dxf(path, size=size)
    assert (back.name, patch.name) == ("BACK", "PATCH")
    assert np.ptp(back.outline[:, 0]) == pytest.approx(width)


def test_unknown_size(write, problems):
    path = write("a.dxf", dxf(graded(), ("UNITS: METRIC", "Sample Size: 40")))
    assert problems(read_dxf, path, size="44") == [
        "a.dxf: size: got '44', expected one of 38, 40, 42"
    ]
    path = write("b.dxf", dxf(graded()))
    assert problems(read_dxf, path) == ["b.dxf: size: got None, expected one of 38, 40, 42"]


def test_blocks_without_insert_are_pieces(write):
    path = write("a.dxf", dxf({"A": [polyline("1", SQUARE), GRAIN]}, inserted=False))
    assert len(read_dxf(path)) == 1


@pytest.mark.parametrize(
    ("entities", "message"),
    [
        ([polyline("1", SQUARE, closed=False), GRAIN],
         "piece A, layer 1: got an open outline, from [0.0, 0.0] to [0.0, 80.0] mm (80.00 mm "
         "apart), expected a closed outline"),
        ([polyline("1", [(0, 0), (100, 80), (100, 0), (0, 80)]), GRAIN],
         "piece A, layer 1: got an outline that crosses itself at (50 40) mm, expected a simple "
         "outline"),
        ([polyline("1", [(0, 0), (100, "nan"), (100, 80), (0, 80)]), GRAIN],
         "piece A, layer 1: got 1 nan or inf, expected finite points"),
        ([polyline("1", [(0, 0), (4, 0), (4, 3)]), GRAIN],
         "piece A: got a size of 4 mm, expected 5 mm to 10 m (check the UNITS text)"),
        ([polyline("1", [(0, 0), (11_000, 0), (0, 90)]), GRAIN],
         "piece A: got a size of 1.1e+04 mm, expected 5 mm to 10 m (check the UNITS text)"),
    ],
)  # fmt: skip
def test_bad_pieces(write, problems, entities, message):
    assert problems(read_dxf, write("a.dxf", dxf({"A": entities}))) == [f"a.dxf: {message}"]


def test_all_bad_pieces_are_named(write, problems):
    blocks = {
        "A": [polyline("1", SQUARE, closed=False), GRAIN],
        "B": [polyline("1", SQUARE), GRAIN],
        "C": [polyline("1", [(0, 0), (4, 0), (4, 3)]), GRAIN],
    }
    got = problems(read_dxf, write("a.dxf", dxf(blocks)))
    assert [g.split(":")[1] for g in got] == [" piece A, layer 1", " piece C"]


def test_unusual_size_warns(write):
    small = [polyline("1", [(0, 0), (15, 0), (15, 12), (0, 12)]), GRAIN]
    path = write("a.dxf", dxf({"A": small, "B": [polyline("1", SQUARE), GRAIN]}))
    with pytest.warns(InputWarning, match="piece A: a size of 15 mm is unusual"):
        read_dxf(path)


def test_a_small_cut_out_is_closed_and_said(panel):
    hole = polyline("11", [(40, 40), (44, 40), (44, 44)])
    with pytest.warns(InputWarning, match=r"1 cut-outs narrower than 5 mm are closed"):
        assert panel(polyline("1", SQUARE), hole, GRAIN).holes == ()


def test_insert_without_a_name(write):
    whole = dxf({"A": [polyline("1", SQUARE), GRAIN]})
    path = write("a.dxf", whole.replace("INSERT\n8\n1\n2\nA\n", "INSERT\n8\n1\n"))
    with pytest.warns(InputWarning, match="an INSERT names no block: not read"):
        (panel,) = read_dxf(path)
    assert panel.name == "A"


@pytest.mark.parametrize("content", ["not a drawing\n", "", "0\nSECTION\n2\nHEA"])
def test_foreign_file(write, problems, content):
    (message,) = problems(read_dxf, write("a.dxf", content))
    assert message.startswith("a.dxf: ")


def test_missing_file(tmp_path, problems):
    assert problems(read_dxf, tmp_path / "a.dxf") == [
        "a.dxf: file: got no such file, expected a file"
    ]


def test_truncated_file_is_refused_or_complete(write, problems):
    whole = dxf({"A": [polyline("1", SQUARE), GRAIN]})
    for length in range(40, len(whole) - 20, 37):
        assert problems(read_dxf, write("a.dxf", whole[:length]))


def test_a_piece_that_the_library_leaves_out_is_not_dropped_silently(write, problems):
    piece = [polyline("1", SQUARE), GRAIN]
    whole = dxf({"A": piece, "B": piece})
    path = write("a.dxf", whole.replace("0\nENDBLK\n", "", 1))
    assert problems(read_dxf, path) == [
        "a.dxf: file: got Missing required ENDBLK, ignoring content, expected a whole DXF file"
    ]


def test_what_the_library_complains_of_is_told_with_the_file(write):
    whole = dxf({"A": [polyline("1", SQUARE), GRAIN]})
    outside = whole.replace("ENDSEC\n", "ENDSEC\n0\nLINE\n8\n1\n", 1)
    with pytest.warns(InputWarning, match=r"odd\.dxf: .*found tags outside a SECTION"):
        read_dxf(write("odd.dxf", outside))
