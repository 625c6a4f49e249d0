from pathlib import Path
from types import MappingProxyType

import ezdxf
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from seatlook.flattening import flatten
from seatlook.io.pattern.dxf import read_dxf
from seatlook.io.pattern.dxf_write import write_dxf
from seatlook.io.pattern.seams import read_pattern, write_seams
from seatlook.model import Notch, Panel, Pattern
from seatlook.seats import demo_design

DATA = Path(__file__).parents[2] / "data"


def cover(name="LH bolster"):
    outline = np.array([[0, 0], [0.1, -0.0037], [0.2, 0], [0.2, 0.4], [0, 0.4]])
    return Panel(
        name=name,
        outline=outline,
        corners=np.array([0, 2, 3, 4]),
        cut_outline=outline * 1.1 - 0.01,
        grain=np.array([0.6, 0.8]),
        notches=(
            Notch(position=np.array([0.1, -0.01])),
            Notch(position=np.array([0.2, 0.2]), kind="v", depth=0.004),
            Notch(position=np.array([0.2, 0.3]), kind="castle", depth=0.003),
        ),
        internal_lines=MappingProxyType(
            {"tie-down": np.array([[0.02, 0.1], [0.1, 0.12], [0.18, 0.1]])}
        ),
        holes=(np.array([[0.05, 0.05], [0.08, 0.05], [0.08, 0.07]]),),
    )


def pattern_of(*panels):
    return Pattern(panels=panels, edges=MappingProxyType({}), seams=())


def assert_same(a, b):
    assert a.name == b.name
    for name in ("outline", "cut_outline", "grain"):
        assert np.abs(getattr(a, name) - getattr(b, name)).max() < 1e-12, name
    assert a.corners.tolist() == b.corners.tolist()
    assert len(a.holes) == len(b.holes)
    assert all(np.abs(x - y).max() < 1e-12 for x, y in zip(a.holes, b.holes, strict=True))
    assert sorted(a.internal_lines) == sorted(b.internal_lines)
    for name, points in a.internal_lines.items():
        assert np.abs(points - b.internal_lines[name]).max() < 1e-12
    assert {(n.kind, *n.position.round(9), round(n.depth, 9)) for n in a.notches} == {
        (n.kind, *n.position.round(9), round(n.depth, 9)) for n in b.notches
    }


def test_written_pattern_reads_back(tmp_path):
    panels = (cover(), cover("Sitzspiegel groß"), cover("シート"), cover("a/b:c"))
    write_dxf(pattern_of(*panels), tmp_path / "p.dxf")
    for a, b in zip(panels, read_dxf(tmp_path / "p.dxf"), strict=True):
        assert_same(a, b)


def test_sample_pattern_survives_writing(tmp_path):
    panels = read_dxf(DATA / "seat_cushion_demo_aama.dxf")
    write_dxf(pattern_of(*panels), tmp_path / "p.dxf")
    for a, b in zip(panels, read_dxf(tmp_path / "p.dxf"), strict=True):
        assert_same(a, b)


def test_same_pattern_gives_the_same_bytes(tmp_path):
    for name in ("p.dxf", "q.dxf"):
        write_dxf(pattern_of(cover()), tmp_path / name, style="S")
    assert (tmp_path / "p.dxf").read_bytes() == (tmp_path / "q.dxf").read_bytes()


@pytest.mark.filterwarnings("ignore:.*is the pattern out of scale")
@settings(max_examples=25, deadline=None)
@given(st.lists(st.floats(0.02, 1.4), min_size=3, max_size=40), st.floats(0, 6.28))
def test_any_star_shaped_outline_reads_back(tmp_path_factory, radii, turn):
    angle = turn + 2 * np.pi * np.arange(len(radii)) / len(radii)
    outline = np.array(radii)[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])
    a = Panel(name="P", outline=outline, corners=np.arange(len(radii)), cut_outline=outline,
              grain=np.array([1.0, 0.0]))  # fmt: skip
    path = tmp_path_factory.mktemp("dxf") / "p.dxf"
    write_dxf(pattern_of(a), path)
    (b,) = read_dxf(path)
    assert_same(a, b)


def test_flattened_demo_reads_back_to_a_hundredth_of_a_millimetre(tmp_path):
    """And the library's audit of the drawing finds nothing to mend or to refuse."""
    flat = flatten(demo_design(element_size=0.012))
    write_dxf(flat.pattern, tmp_path / "p.dxf", style="demo")
    write_seams(flat.pattern, tmp_path / "s.toml")
    again = read_pattern(tmp_path / "p.dxf", tmp_path / "s.toml")
    assert again.edges.keys() == flat.pattern.edges.keys()
    for name in flat.pattern.edges:
        assert again.edge_length(name) == pytest.approx(flat.pattern.edge_length(name), abs=1e-5)
    drawing = ezdxf.readfile(tmp_path / "p.dxf")
    assert drawing.dxfversion == "AC1009"
    audit = drawing.audit()
    assert [e.message for e in audit.errors] == []
    assert [e.message for e in audit.fixes] == []
    assert len(drawing.blocks) >= len(flat.pattern.panels)
