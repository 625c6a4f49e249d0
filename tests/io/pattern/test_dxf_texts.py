"""Units and names as exporters write them, each with a right value to compare with."""

import warnings

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from seatlook.errors import InputError, InputWarning
from seatlook.io import read_dxf, report_dxf
from support.dxf_sheet import L_AREA, L_SHAPE, Sheet, area, one_piece


@pytest.mark.parametrize(
    ("insunits", "measurement", "title", "options", "mm"),
    [
        (None, None, "METRIC", {}, 1),
        (None, None, "english", {}, 25.4),
        (None, None, "CM", {}, 10),
        (5, None, "METRIC", {}, 1),
        (5, None, None, {}, 10),
        (1, None, None, {}, 25.4),
        (6, None, None, {}, 1000),
        (0, 1, None, {}, 1),
        (0, 0, None, {}, 25.4),
        (5, None, None, {"units": "metric"}, 1),
        (None, None, None, {"units": "cm"}, 10),
    ],
)
def test_units(write, insunits, measurement, title, options, mm):
    header = [] if insunits is None else ["9", "$INSUNITS", "70", f"{insunits:6d}"]
    header += [] if measurement is None else ["9", "$MEASUREMENT", "70", str(measurement)]
    size = 300 / mm
    rows = ["0", "SECTION", "2", "HEADER", *header, "0", "ENDSEC", "0", "SECTION", "2", "ENTITIES"]
    rows += ["0", "POLYLINE", "8", "1", "66", "1", "70", "1"]
    for x, y in ((0, 0), (size, 0), (size, size), (0, size)):
        rows += ["0", "VERTEX", "8", "1", "10", str(x), "20", str(y)]
    rows += ["0", "SEQEND"]
    if title is not None:
        rows += ["0", "TEXT", "8", "1", "10", "0", "20", "0", "40", "1", "1", f"Units: {title}"]
    path = write("a.dxf", "\n".join([*rows, "0", "ENDSEC", "0", "EOF", ""]))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)
        (panel,) = read_dxf(path, **options)
    assert 1e3 * np.ptp(panel.outline, axis=0) == pytest.approx([300, 300])


NAMES = {
    "gb18030": ("座垫", "靠背左", "坐垫面料", "头枕", "后排座椅", "左侧翼", "扶手", "中间片"),
    "cp932": ("シート", "背もたれ", "座面", "左側", "ヘッドレスト", "右サイド", "中央", "ｼｰﾄ"),
    "cp1252": ("Größe", "Rücken", "Sitzspiegel groß", "côté", "Kopfstütze", "Übergröße", "señal"),
    "utf-8": ("座垫", "シート", "Größe", "чехол", "🪑"),
}


@pytest.mark.parametrize("encoding", NAMES)
def test_names_without_a_code_page(tmp_path, encoding):
    for name in NAMES[encoding]:
        path = tmp_path / "a.dxf"
        path.write_bytes(one_piece(name).encode(encoding))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", InputWarning)
            assert [p.name for p in read_dxf(path)] == [name]
        assert [p.name for p in read_dxf(path, encoding=encoding)] == [name]


@pytest.mark.parametrize(
    ("encoding", "message"),
    [
        ("klingon", "encoding: got 'klingon', expected an encoding, as gb18030 or cp932"),
        ("ascii", "expected the encoding of this file"),
    ],
)
def test_encoding_that_is_not_that_of_the_file(tmp_path, encoding, message):
    path = tmp_path / "a.dxf"
    path.write_bytes(one_piece("座垫").encode("gbk"))
    with pytest.raises(InputError, match=message):
        read_dxf(path, encoding=encoding)


@settings(max_examples=60, deadline=None)
@given(
    st.text(st.characters(exclude_categories=("C", "Z"), exclude_characters="\\%^"), min_size=1)
    .map(lambda text: text.strip())
    .filter(lambda text: text and not text.startswith("*"))
)
def test_block_names_of_any_characters(tmp_path_factory, name):
    path = tmp_path_factory.mktemp("name") / "a.dxf"
    path.write_bytes(one_piece(name).encode("utf-8"))
    assert [p.name for p in read_dxf(path)] == [name]


def test_two_blocks_of_one_name_put_once_are_refused(write):
    whole = one_piece("A")
    start, stop = whole.index("0\nBLOCK\n"), whole.index("0\nENDSEC")
    path = write("a.dxf", whole[:stop] + whole[start:stop] + whole[stop:])
    with pytest.raises(InputError, match="got 2 blocks called a, put in 1 places, expected a name"):
        read_dxf(path)


@pytest.mark.parametrize("name", ["DETAIL", "LH/RH"])
def test_blocks_of_one_name_are_pieces_by_their_order(write, name):
    """As an exporter writes pieces that nobody has named."""
    whole = one_piece(name)
    start, stop = whole.index("0\nBLOCK\n"), whole.index("0\nENDSEC")
    other = whole[start:stop].replace("\n300\n", "\n360\n")
    insert = whole.index("0\nINSERT")
    again = "0\nINSERT\n8\n1\n2\n" + name + "\n10\n0\n20\n500\n"
    path = write("a.dxf", whole[:stop] + other + whole[stop:insert] + again + whole[insert:])
    with pytest.warns(InputWarning) as said:
        panels = read_dxf(path)
    assert [p.name for p in panels] == [name, f"{name}_2"]
    assert [area(p.cut_outline) for p in panels] == pytest.approx([L_AREA, L_AREA + 60 * 100])
    assert any("several blocks have one name, each is a piece" in str(w.message) for w in said)


def test_a_file_without_a_unit_is_in_mm_where_only_that_makes_a_piece(write):
    whole = one_piece("A").replace("UNITS: METRIC", "made by hand")
    with pytest.warns(InputWarning, match="names no unit: read in mm, as its longest line is 300"):
        (panel,) = read_dxf(write("a.dxf", whole))
    assert area(panel.cut_outline) == pytest.approx(L_AREA)
    small = whole.replace("\n300\n", "\n200\n")
    fitting = "2000 mm if a unit is a cm; 200 mm if a unit is a mm"
    with pytest.raises(InputError, match=f"UNITS: got no such text.*its longest line is {fitting}"):
        read_dxf(write("b.dxf", small))


def test_a_pattern_that_is_too_large_is_named(write):
    whole = one_piece("A").replace("UNITS: METRIC", "UNITS: ENGLISH")
    said = report_dxf(write("a.dxf", whole)).warnings()
    assert said[-1].startswith(
        "the largest piece is 7620 mm: is the pattern out of scale? (3000 mm"
    )


@pytest.mark.parametrize("ends", ["\r\n", "\r"])
@pytest.mark.parametrize("tail", ["", "\x1a", "\n \n"])
def test_line_ends_of_every_system(tmp_path, ends, tail):
    (tmp_path / "a.dxf").write_bytes((one_piece("A") + tail).replace("\n", ends).encode())
    (panel,) = read_dxf(tmp_path / "a.dxf")
    assert area(panel.cut_outline) == pytest.approx(L_AREA)


def test_decimal_commas_are_named(write, problems):
    german = one_piece("A").replace("\n300\n", "\n300,5\n")
    (message,) = problems(read_dxf, write("a.dxf", german))
    assert message.endswith("(its numbers have a decimal comma, as 300,5)")


def test_what_the_library_says_is_cut_short(write, problems):
    (message,) = problems(read_dxf, write("a.dxf", "x" * 5000))
    assert len(message) < 300


def test_where_no_layer_is_an_outline_the_option_for_layers_is_named(write, problems):
    (message,) = problems(read_dxf, write("a.dxf", one_piece("A").replace("\n8\n1\n", "\n8\nS\n")))
    assert "layers with entities: 7, S;" in message
    assert "--layer NAME=CUT" in message


OWN_LAYERS = {"Schnitt": "CUT", "naht": "sew", "Laufrichtung": "7"}


@pytest.fixture
def german(tmp_path):
    sheet = Sheet(tmp_path / "a.dxf")
    block = sheet.block("P", None, grain=False)
    sheet.line(block, L_SHAPE, layer="SCHNITT")
    sheet.line(block, [(10, 10), (290, 10), (290, 90), (110, 90), (110, 190), (10, 190)], "Naht")
    block.add_line((50, 20), (80, 20), dxfattribs={"layer": "Laufrichtung"})
    sheet.insert("P")
    return sheet


def test_layers_mean_what_is_said(german):
    with pytest.raises(InputError, match="pieces: got none"):
        german.read()
    panels, said = german.read(layers=OWN_LAYERS)
    assert area(panels["P"].cut_outline) == pytest.approx(L_AREA)
    assert 1e3 * panels["P"].outline.min() == pytest.approx(10)
    assert np.abs(panels["P"].grain) == pytest.approx([1.0, 0.0])
    assert said == []


@pytest.mark.parametrize(
    ("layers", "message"),
    [
        ({"Schnitt": "CUTS"}, "layers.Schnitt: got 'CUTS', expected CUT"),
        ({"Zuschnitt": "CUT"}, "layers: got 'Zuschnitt', expected one of "),
    ],
)
def test_layers_that_do_not_exist_are_named(german, layers, message):
    with pytest.raises(InputError) as refused:
        german.read(layers=layers)
    assert message in str(refused.value)
