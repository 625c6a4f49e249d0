"""Borders, sides and seams of surfaces: one curve each, and names that any mesh gives."""

import numpy as np
import pytest

from seatlook import mesh
from seatlook.errors import InputWarning
from seatlook.flattening import DesignSurface
from seatlook.flattening.border import borders
from seatlook.flattening.cutting import cut_along
from seatlook.flattening.cutting.opening import opened
from seatlook.flattening.pattern import pair
from seatlook.flattening.surface import sides
from seatlook.seats import demo_design
from support.seat_surfaces import box_cushion, cap, on_cap, tube, undivided

LINES = {"across": (-0.2, 0.03, 0.2, -0.01), "left trench": (0.08, -0.2, 0.05, 0.2)}


def cut_cap(size):
    """A cap under two lines that cross: four panels, on a mesh of any size."""
    lines = {}
    for name, (x, y, u, v) in LINES.items():
        share = np.linspace(0.0, 1.0, 15)[:, None]
        lines[name] = on_cap((1 - share) * [x, y] + share * [u, v])
    return cut_along(undivided(*cap(size=size)), lines)


FORMS = {
    "demo": demo_design,
    "cap": lambda *, element_size: cut_cap(element_size),
}


@pytest.mark.parametrize("form", FORMS)
def test_names_stay_when_a_surface_is_meshed_anew(form):
    seen = set()
    for size in (0.011, 0.016, 0.024):
        surface = FORMS[form](element_size=size)
        all_sides = sides(surface.patches())
        names = [side.name for side in all_sides]
        assert len(set(names)) == len(names)
        seams = [seam.name for seam in pair(all_sides, surface.seam_lines)]
        assert len(set(seams)) == len(seams)
        around = [(border.name, border.edges) for border in borders(surface)]
        seen.add((*sorted(names), *sorted(seams), *map(str, around)))
    assert len(seen) == 1


def test_panels_that_share_several_seams_say_where():
    vertices, faces = cap(size=0.02)
    x, y, _ = vertices[faces].mean(axis=1).T
    core = (np.abs(x) < 0.06) & (np.abs(y) < 0.1)
    front = (np.abs(x) < 0.06) & (y <= -0.1)
    surface = DesignSurface(
        vertices=vertices,
        faces=faces,
        panel=np.where(core, 0, np.where(front, 1, 2)),
        panel_names=("CORE", "FRONT", "BACK"),
    )
    all_sides = sides(surface.patches())
    seams = pair(all_sides)
    assert {seam.name for seam in seams} == {
        "CORE-FRONT",
        "CORE-BACK",
        "FRONT-BACK.left",
        "FRONT-BACK.right",
    }
    for seam in seams:
        place = seam.name.split(".")[1:]
        assert seam.a.split(".")[2:] == seam.b[0].split(".")[2:] == place


def test_a_border_is_one_closed_curve_through_all_its_edges():
    surface = demo_design(element_size=0.02)
    (border,) = borders(surface)
    assert border.name == "border"
    assert set(border.edges) == {"FRONT.free", "SIDE_L.free", "REAR.free", "SIDE_R.free"}
    assert (border.curve[0] == border.curve[-1]).all()
    assert border.junctions[0] == 0.0
    assert border.junctions[-1] == pytest.approx(mesh.length(border.curve))
    points = {side.name: surface.vertices[side.vertices] for side in sides(surface.patches())}
    arc = mesh.arc_length(border.curve)
    for edge, start, end in zip(border.edges, border.junctions, border.junctions[1:], strict=False):
        ends = [
            np.array([np.interp(at, arc, column) for column in border.curve.T])
            for at in (start, end)
        ]
        np.testing.assert_allclose(ends, points[edge][[0, -1]], atol=1e-12)


def test_several_borders_are_told_apart_and_a_closed_cover_has_none():
    with pytest.warns(InputWarning, match="panel BAND has 2 borders"):
        box = opened(box_cushion(size=0.03))
    assert borders(box) == ()
    vertices, faces = tube(size=0.03)
    half = DesignSurface(
        vertices=vertices, faces=faces,
        panel=(vertices[faces].mean(axis=1)[:, 0] > 0).astype(np.int64),
        panel_names=("RIGHT", "LEFT"),
    )  # fmt: skip
    assert {border.name for border in borders(half)} == {"border.bottom", "border.top"}
    for border in borders(half):
        assert len(border.edges) == 2
