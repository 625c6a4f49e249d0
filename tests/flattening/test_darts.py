"""Lines that end inside a panel: it is cut there, and both sides are sewn."""

import warnings

import numpy as np
import pytest
import shapely

from seatlook import io
from seatlook.errors import InputError, InputWarning
from seatlook.flattening import cut_along, flatten, relax
from seatlook.flattening.files import read_design, write_flat_pattern, write_panels
from seatlook.flattening.surface import sides
from support.seat_surfaces import cap, on_cap, undivided

HALF, SIZE = 0.16, 0.016


@pytest.fixture(autouse=True)
def quiet():
    """Strain is no matter here."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)
        yield


def ball(lines, *, saddle=False):
    surface = undivided(*cap(half=HALF, size=SIZE, saddle=saddle))
    return cut_along(surface, {k: on_cap(v, saddle=saddle) for k, v in lines.items()})


def line(start, end, count=6):
    return np.linspace(start, end, count)


PARTS = ("PANEL_1", "PANEL_2")
DARTS = {
    "front": line((0.003, -HALF), (0.003, -0.05)),
    "rear": line((0.02, HALF), (-0.01, 0.04)),
    "left": line((HALF, 0.011), (0.06, 0.02)),
}


def test_both_sides_of_a_dart_are_sewn_and_equally_long():
    result = flatten(ball({"front": DARTS["front"]}))
    (seam,) = result.pattern.seams
    assert (seam.name, seam.reverse) == ("front", True)
    assert {result.pattern.edges[e].panel for e in (seam.a, *seam.b)} == {"PANEL"}
    (length,) = result.seams
    assert abs(length.difference) < 5e-5
    assert length.design == pytest.approx(0.3 * (np.arcsin(HALF / 0.3) - np.arcsin(0.05 / 0.3)),
                                          rel=0.01)  # fmt: skip
    a, b = (result.pattern.edge_points(e) for e in (seam.a, *seam.b))
    assert a[-1].tolist() == b[0].tolist()  # the tip
    # What the dart takes up: the angle of the ball between tip and border, about K times area.
    mouth = np.linalg.norm(a[0] - b[-1])
    assert 0.004 < mouth < 0.04


def test_darts_take_strain_out():
    whole = flatten(undivided(*cap(half=HALF, size=SIZE))).panels[0].rms
    darted = flatten(ball(DARTS)).panels[0].rms
    assert darted < 0.8 * whole


def test_several_darts_meet_the_border_and_the_pattern_is_simple():
    result = flatten(ball(DARTS))
    assert [s.name for s in result.pattern.seams] == ["front", "left", "rear"]
    panel = result.pattern.panels[0]
    assert shapely.Polygon(panel.outline).is_valid
    assert shapely.Polygon(panel.cut_outline).is_valid
    names = {side.name for side in sides(ball(DARTS).patches())}
    flanks = [f"PANEL.PANEL.{place}" for place in ("left", "right.front", "right.rear")]
    assert {f"{flank}.{way}" for flank in flanks for way in ("in", "out")} <= names
    assert sum(name.startswith("PANEL.free.") for name in names) == len(names) - 6 == 3


def test_a_dart_from_a_seam_line_parts_that_seam():
    surface = ball({"across": line((-HALF, 0.0), (HALF, 0.0), 12), "dart": line((0, 0), (0, 0.09))})
    result = flatten(surface)
    assert sorted(s.name for s in result.pattern.seams) == [
        "across.PANEL_1-PANEL_2.left",
        "across.PANEL_1-PANEL_2.right",
        "dart",
    ]
    assert max(abs(s.difference) for s in result.seams) < 5e-5


def test_a_line_across_a_seam_makes_a_dart_on_either_side():
    surface = ball(
        {"across": line((-HALF, 0.0), (HALF, 0.0), 12), "both": line((0.01, -0.06), (-0.01, 0.09))}
    )
    names = sorted(s.name for s in flatten(surface).pattern.seams)
    across = [f"across.PANEL_1-PANEL_2.{place}" for place in ("left", "right")]
    assert names == [*across, "both.PANEL_1-PANEL_1", "both.PANEL_2-PANEL_2"]


def test_a_dart_from_a_corner():
    result = flatten(ball({"corner": line((-HALF, -HALF), (-0.06, -0.07))}))
    assert abs(result.seams[0].difference) < 5e-5


@pytest.mark.parametrize("saddle", [False, True])
def test_a_dart_where_there_is_nothing_to_take_up_stays_open(saddle):
    """In a saddle its sides would lie over each other; in a flat panel they touch."""
    if saddle:
        surface = ball({"dart": DARTS["front"]}, saddle=True)
    else:
        vertices, faces = cap(half=HALF, size=SIZE)
        flat = DARTS["front"]
        level = undivided(vertices * [1, 1, 0], faces)
        surface = cut_along(level, {"dart": np.column_stack([flat, np.zeros(len(flat))])})
    result = flatten(surface)
    assert abs(result.seams[0].difference) < 5e-5
    assert shapely.Polygon(result.pattern.panels[0].outline).is_valid
    (seam,) = result.pattern.seams
    a, b = (result.pattern.edge_points(e) for e in (seam.a, *seam.b))
    assert np.linalg.norm(a[0] - b[-1]) > 0.015 * result.seams[0].a


@pytest.mark.parametrize("saddle", [False, True])
@pytest.mark.parametrize("fabric", [None, "black-leather"])
@pytest.mark.parametrize("ease", [0.0, 0.02, -0.03])
def test_darts_settle_in_a_few_steps(monkeypatch, saddle, fabric, ease):
    """What keeps the sides apart has directions: the panel took 180 steps to turn after them."""
    monkeypatch.setattr(relax, "_MAX_STEPS", 20)
    across = line((-HALF, -0.03), (HALF, 0.05), 12)
    dart = line((0.0, -HALF), (0.01, -0.07))
    surface = ball({"across": across, "dart": dart}, saddle=saddle)
    cloth = {} if fabric is None else {n: io.read_material(fabric).fabric for n in PARTS}
    seam = "across"
    result = flatten(surface, fabrics=cloth, ease={seam: ease} if ease else {})
    (eased,) = (s for s in result.seams if s.seam == seam)
    assert eased.a == pytest.approx((1 + ease) * eased.b, rel=3e-4)


def test_a_line_inside_a_panel_is_refused_with_its_place():
    with pytest.raises(InputError, match=r"panel PANEL: got A, inside it near \[\d+, 0, 29\d\] mm"):
        ball({"A": line((-0.05, 0), (0.05, 0))})


@pytest.mark.parametrize("gap", [0.003, 0.006, 0.008])
def test_an_end_just_before_a_line_is_no_dart(gap):
    with pytest.raises(InputError, match=r"curve\.A\.points_mm\[5\]: got an end \d\.\d mm away"):
        ball({"A": line((0, -HALF), (0, HALF - gap))})


def test_darts_and_names_of_lines_stay_in_the_surface_that_is_written(tmp_path):
    """Flattened again from its file, the surface gives the same pattern."""
    lines = {**DARTS, "across": line((-HALF, 0.0), (HALF, 0.0), 12)}
    surface = ball({k: v for k, v in lines.items() if k != "left"})
    write_panels(surface, tmp_path / "panels.obj")
    again = read_design(tmp_path / "panels.obj")
    expected, result = flatten(surface), flatten(again)
    assert [s.seam for s in result.seams] == [s.seam for s in expected.seams]
    assert {"across", "front", "rear"} <= {s.seam for s in result.seams}
    for a, b in zip(result.seams, expected.seams, strict=True):
        assert (a.a, a.design) == pytest.approx((b.a, b.design), abs=2e-6)


def test_a_pattern_with_darts_is_read_back(tmp_path):
    result = flatten(ball(DARTS), allowance=0.008)
    write_flat_pattern(result, tmp_path)
    again = io.read_pattern(tmp_path / "pattern.dxf", tmp_path / "seams.toml")
    assert [s.name for s in again.seams] == [s.name for s in result.pattern.seams]
    for seam in result.pattern.seams:
        for name in (seam.a, *seam.b):
            expected = result.pattern.edge_points(name)
            assert again.edge_points(name)[[0, -1]] == pytest.approx(expected[[0, -1]], abs=1e-5)
            assert again.edge_length(name) == pytest.approx(result.pattern.edge_length(name),
                                                            abs=2e-5)  # fmt: skip
