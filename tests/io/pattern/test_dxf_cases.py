"""Files as exporters write them: each is read, and what is not in it is said."""

import warnings
from pathlib import Path

import numpy as np
import pytest

from seatlook.errors import InputWarning
from seatlook.io import read_panels, read_pattern, report_dxf

DATA = Path(__file__).parents[2] / "data/patterns"


def read(name, **options):
    """Return the panels by name, and the warnings without the path of the file."""
    path = DATA / f"{name}.dxf"
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", InputWarning)
        panels = read_panels(path, **options)
    said = [str(w.message) for w in caught]
    assert all(text.startswith(f"{path}: ") for text in said)
    return {p.name: p for p in panels}, [text.removeprefix(f"{path}: ") for text in said]


def area_mm2(points):
    x, y = 1e3 * points.T
    return 0.5 * np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)


def test_round_panel():
    panels, said = read("circle_panel")
    assert list(panels) == ["P", "Q"]
    assert area_mm2(panels["P"].outline) == pytest.approx(np.pi * 140**2, rel=1e-5)
    assert said == []


def test_sew_line_on_layer_8():
    panels, said = read("sew_on_8")
    assert area_mm2(panels["P"].outline) == pytest.approx(400 * 300)
    assert area_mm2(panels["P"].cut_outline) == pytest.approx(420 * 320)
    assert len(panels["P"].internal_lines) == 0
    assert said == [
        "piece P: nothing on layer 14: the line on layer 8 that runs parallel inside the outline "
        "is taken for the sew line"
    ]


def test_pattern_out_of_scale():
    _, said = read("tenth_scale")
    assert said == [
        "the largest piece is 40 mm: is the pattern out of scale? (400 mm if a unit is a cm)"
    ]


def test_chinese_names_without_a_code_page():
    panels, said = read("gbk_names")
    assert list(panels) == ["坐垫"]
    assert said == ["no code page is given: read as gb18030, a guess"]
    panels, said = read("gbk_names", encoding="gbk")
    assert list(panels) == ["坐垫"]
    assert said == []


def test_no_grain_line():
    panels, said = read("no_grain")
    assert panels["P"].grain.tolist() == [0.0, 1.0]
    assert said == ["piece P: no grain line on layer 7: the warp runs along +y; else say grain_deg"]
    panels, said = read("no_grain", grain_deg=30.0)
    assert panels["P"].grain == pytest.approx([np.sqrt(0.75), 0.5])
    assert said == []


def test_slash_in_a_name():
    panels, said = read("slash_name")
    assert list(panels) == ["SIDE L/R"]
    assert said == []


def test_unit_of_the_header():
    panels, said = read("no_units_insunits_mm")
    assert area_mm2(panels["P"].outline) == pytest.approx(400 * 300)
    assert said == ["no UNITS text: a unit is 1 mm, by $INSUNITS"]


def test_slit_in_pieces_is_a_notch():
    panels, said = read("slit_pieces")
    assert area_mm2(panels["P"].outline) == pytest.approx(400 * 300)
    (notch,) = panels["P"].notches
    assert 1e3 * notch.position == pytest.approx([200, 0])
    assert notch.depth == pytest.approx(8e-3)
    assert said == []


def test_gap_in_the_outline():
    panels, said = read("gap_02mm")
    assert area_mm2(panels["P"].outline) == pytest.approx(400 * 300, abs=0.5 * 400 * 0.2)
    assert len(panels["P"].outline) == 4
    assert said == ["piece P: gaps up to 0.20 mm in the outline are joined"]


def test_outlines_without_blocks():
    panels, said = read("flat_no_blocks")
    assert list(panels) == ["piece1", "piece2"]
    assert [area_mm2(p.outline) for p in panels.values()] == pytest.approx([120000, 120000])
    assert said == ["no blocks: 2 closed outlines are read, each as a piece"]


def test_mirrored_piece_by_quantity():
    panels, said = read("qty_mirrored")
    assert list(panels) == ["P", "P_mirrored"]
    assert area_mm2(panels["P_mirrored"].outline) == pytest.approx(400 * 300)
    assert said == ["piece P: quantity 1,1: the mirrored piece is P_mirrored"]


def test_options_reach_the_reader_from_a_pattern(tmp_path):
    seams = tmp_path / "s.toml"
    seams.write_text(
        'schema = 1\n[edge."坐垫.low"]\npanel = "坐垫"\nfrom_mm = [0, 0]\nto_mm = [400, 0]\n'
    )
    pattern = read_pattern(DATA / "gbk_names.dxf", seams, encoding="gb18030")
    assert [p.name for p in pattern.panels] == ["坐垫"]


def test_report_says_what_is_read():
    report = report_dxf(DATA / "sew_on_8.dxf")
    (piece,) = report.pieces
    assert (piece.name, piece.block, piece.quantity) == ("P", "P", "1")
    assert dict(piece.layers) == {"1": 4, "7": 1, "8": 1}
    assert report.mm_per_unit == 1.0
