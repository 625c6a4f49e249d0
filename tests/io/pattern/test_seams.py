from pathlib import Path

import numpy as np
import pytest

from seatlook.io.pattern.dxf import read_dxf
from seatlook.io.pattern.dxf_write import write_dxf
from seatlook.io.pattern.seams import read_panels, read_pattern, read_seams, write_seams

DATA = Path(__file__).parents[2] / "data"
DXF, SEAMS = DATA / "seat_cushion_demo_aama.dxf", DATA / "seat_cushion_demo.seams.toml"
TEXT = SEAMS.read_text()


@pytest.fixture(scope="module")
def panels():
    return read_dxf(DXF)


@pytest.fixture
def refused(write, panels, problems):
    """Read the sample seams with one text replaced; return the messages."""

    def refused(old, new):
        assert old in TEXT
        return problems(read_seams, write("s.toml", TEXT.replace(old, new, 1)), panels)

    return refused


def test_sample_edges_have_the_lengths_they_were_drawn_with():
    pattern = read_pattern(DXF, SEAMS)
    for name, length in {
        "CENTER.front": 300.8881,
        "CENTER.right": 460.2087,
        "BOLSTER_R.outer": 457.6585,
        "BOLSTER_L.rear": 95.2524,
        "FRONT.top": 521.663,
    }.items():
        assert 1e3 * pattern.edge_length(name) == pytest.approx(length, abs=0.003)
    assert [s.name for s in pattern.seams] == ["right bolster", "left bolster", "front"]
    assert pattern.seams[2].b == ("BOLSTER_R.front", "CENTER.front", "BOLSTER_L.front")
    assert pattern.seams[0].reverse
    assert pattern.seams[0].pitch == 0.005


def test_edges_run_in_outline_order(panels, write):
    """From the rear left corner over the outline's last vertex to the front right one."""
    text = '[edge.round]\npanel = "CENTER"\nfrom_mm = [0, 460]\nto_mm = [300, 0]\n'
    pattern = read_seams(write("s.toml", text), panels)
    points = pattern.edge_points("round")
    assert np.allclose(points[[0, 40, 80]], [[0, 0.46], [0, 0], [0.3, 0]])
    assert len(points) == 81


def test_edge_that_starts_where_it_ends_is_the_whole_outline(panels, write):
    text = '[edge.all]\npanel = "FRONT"\nfrom_mm = [0, 130]\nto_mm = [0, 130]\n'
    pattern = read_seams(write("s.toml", text), panels)
    assert len(pattern.edge_points("all")) == 5


def test_edges_snap_within_2_mm(panels, write):
    text = TEXT.replace("to_mm = [300.0, 0.0]", "to_mm = [301.2, -1.2]", 1)
    pattern = read_seams(write("s.toml", text), panels)
    assert np.allclose(pattern.edge_points("CENTER.front")[-1], [0.3, 0.0])


def test_end_away_from_corners(refused):
    assert refused("to_mm = [300.0, 0.0]", "to_mm = [303.0, 0.0]") == [
        "s.toml:7: edge.CENTER.front.to_mm: got [303.0, 0.0], expected a point within 2 mm of a "
        "corner or turn point of CENTER (the nearest is [300.0, 0.0], which is 3.0 mm away)"
    ]


def test_seam_of_an_edge_that_does_not_exist(refused):
    line = TEXT.splitlines().index('b = ["BOLSTER_R.inner"]') + 1
    assert refused('b = ["BOLSTER_R.inner"]', 'b = ["BOLSTER_R.iner"]') == [
        f"s.toml:{line}: seam[0].b: got 'BOLSTER_R.iner', expected an edge of this file "
        "(did you mean 'BOLSTER_R.inner'?)"
    ]


def test_edge_of_an_unknown_panel(refused):
    assert refused('panel = "CENTER"', 'panel = "CENTRE"')[0] == (
        "s.toml:5: edge.CENTER.front.panel: got 'CENTRE', expected one of CENTER, BOLSTER_R, "
        "BOLSTER_L, FRONT (did you mean 'CENTER'?)"
    )


def test_seam_of_an_edge_with_itself(refused):
    (message,) = refused('b = ["BOLSTER_R.inner"]', 'b = "CENTER.right"')
    assert message.endswith("seam[0].b: got 'CENTER.right', expected another edge than a")


def test_stated_length_is_checked(refused):
    (message,) = refused("length_b_mm = 460.2087", "length_b_mm = 461.0")
    assert message.endswith(
        "seam[0].length_b_mm: got 461.0, expected 460.206, the length in the pattern"
    )


def test_two_errors_are_reported_together(write, panels, problems):
    text = TEXT.replace("FRONT.top", "FRONT.upper", 1).replace("[300.0, 460.0]", "[300, 'x']", 1)
    got = problems(read_seams, write("s.toml", text), panels)
    assert len(got) == 2
    assert "expected an array of 2 numbers" in got[0]
    assert "got 'FRONT.top', expected an edge of this file (did you mean" in got[1]


def test_written_seams_read_back(tmp_path):
    pattern = read_pattern(DXF, SEAMS)
    write_dxf(pattern, tmp_path / "p.dxf")
    write_seams(pattern, tmp_path / "p.seams.toml")
    again = read_pattern(tmp_path / "p.dxf", tmp_path / "p.seams.toml")
    assert again.edges == pattern.edges
    assert again.seams == pattern.seams
    for name in pattern.edges:
        assert again.edge_length(name) == pytest.approx(pattern.edge_length(name), abs=1e-9)


def test_unknown_format(tmp_path, problems):
    assert problems(read_panels, tmp_path / "cover.svg") == [
        "cover.svg: file: got '.svg', expected one of .dxf"
    ]


@pytest.mark.parametrize(
    ("other", "start", "end", "length"),
    [
        pytest.param("FRONT", (521.663, 130), (0, 130), 521.7, id="too long"),
        pytest.param("BOLSTER_R", (0, 0), (0, 456.27), 663.3, id="the wrong way round"),
    ],
)
def test_sides_that_differ_by_more_than_ten_percent(
    write, panels, problems, other, start, end, length
):
    text = f"""
        [edge.a]
        panel = "CENTER"
        from_mm = [300, 0]
        to_mm = [300, 460]
        [edge.b]
        panel = "{other}"
        from_mm = {list(start)}
        to_mm = {list(end)}
        [[seam]]
        name = "s"
        a = "a"
        b = "b"
    """
    (message,) = problems(read_seams, write("s.toml", text), panels)
    assert message.startswith(
        f"s.toml:10: seam[0]: got 's' with sides of 460.2 and {length} mm, "
        "expected sides that differ by at most 10%"
    )
