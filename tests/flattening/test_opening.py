"""Rings and tubes: opened by one seam where it is seen least, or along a line that is drawn."""

import warnings

import numpy as np
import pytest

from seatlook import mesh
from seatlook.errors import InputError, InputWarning
from seatlook.flattening import DesignSurface, cut_along, flatten
from seatlook.flattening.cutting import opened
from support.seat_surfaces import box_cushion, cap, flat_ring, on_cap, swept, tube, undivided


def quietly(make, *args, **kwargs):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)
        return make(*args, **kwargs)


def test_a_surface_without_rings_stays_as_it_is():
    surface = undivided(*cap(size=0.03))
    assert opened(surface) is surface


@pytest.mark.parametrize("size", [0.008, 0.02])
def test_a_tube_becomes_a_rectangle_cut_at_the_rear(size):
    with pytest.warns(
        InputWarning, match=r"panel PANEL has 2 borders: it is cut.*from \[-?\d+, (100|9\d), 0\] to"
    ):
        surface = opened(undivided(*tube(size=size)))
    result = flatten(surface)
    (seam,) = result.pattern.seams
    assert seam.name == "PANEL-CLOSING"
    assert result.seams[0].a == pytest.approx(0.2, rel=1e-6)
    assert abs(result.strain).max() < 1e-6
    width = np.ptp(result.pattern.panels[0].outline, axis=0)
    assert sorted(width) == pytest.approx([0.2, 0.2 * np.pi], rel=0.01)


def test_the_band_of_a_cushion_is_closed_by_one_seam():
    with pytest.warns(InputWarning, match="panel BAND has 2 borders"):
        surface = opened(box_cushion(base=False))
    result = flatten(surface)
    seams = {seam.seam: seam for seam in result.seams}
    assert seams["BAND-CLOSING"].design == pytest.approx(0.08, rel=1e-6)
    assert seams.keys() == {"BAND-CLOSING", "BAND-TOP"}
    assert max(abs(seam.difference) for seam in result.seams) < 5e-5
    assert max(panel.rms for panel in result.panels) < 0.006


def test_the_band_of_a_closed_cover_becomes_two_panels():
    """No border pulls one strip round the foam; the halves start at the front and at the rear."""
    with pytest.warns(InputWarning, match="panel BAND has 2 borders"):
        surface = opened(box_cushion(base=True))
    result = flatten(surface)
    assert {p.panel for p in result.panels} == {"BAND_1", "BAND_2", "TOP", "BASE"}
    closing = [seam for seam in result.seams if seam.seam.startswith("BAND-CLOSING")]
    assert [seam.design for seam in closing] == pytest.approx([0.08, 0.08], rel=1e-6)
    areas = [p.area for p in result.panels if p.panel.startswith("BAND")]
    assert areas[0] == pytest.approx(areas[1], rel=0.2)
    assert max(abs(seam.difference) for seam in result.seams) < 5e-5
    assert max(panel.rms for panel in result.panels) < 0.006


def test_a_drawn_line_says_where_the_ring_is_closed():
    surface = box_cushion()
    front = np.array([[0.01, -0.18, 0.0], [-0.01, -0.18, 0.08]])
    rims = {
        name: surface.vertices[np.append(loop, loop[0])]
        for name, part in (("top", 1), ("base", 2))
        for loop in mesh.boundary_loops(surface.faces[surface.panel == part])
    }
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        cut = cut_along(surface, {**rims, "closing": front})
    result = flatten(cut)
    assert sorted(s.seam for s in result.seams) == ["base", "closing", "top"]
    assert cut.panel_names == surface.panel_names


def test_a_ring_that_would_meet_itself_becomes_two_panels():
    with pytest.warns(InputWarning, match="panel PANEL has 2 borders"):
        surface = opened(undivided(*flat_ring()))
    assert surface.panel_names == ("PANEL_1", "PANEL_2")
    result = flatten(surface)
    assert sorted(s.seam for s in result.seams) == ["PANEL-CLOSING", "PANEL-CLOSING_2"]
    assert abs(result.strain).max() < 1e-7


@pytest.mark.parametrize("spread", [0.2, 1.0, 3.0])
def test_a_cone_opens_to_a_fan(spread):
    surface = quietly(opened, undivided(*tube(size=0.01, height=0.06, spread=spread)))
    turn = 2 * np.pi * spread / np.hypot(1, spread)
    assert len(surface.panel_names) == (2 if turn > np.radians(300) else 1)
    result = flatten(surface)
    assert abs(result.strain).max() < 2e-3


def test_an_insert_inside_a_panel_leaves_a_ring_that_is_opened():
    angle = np.linspace(0, 2 * np.pi, 25)
    ring = on_cap(0.08 * np.column_stack([np.cos(angle), np.sin(angle)]))
    ring[-1] = ring[0]
    surface = quietly(cut_along, undivided(*cap(half=0.16, size=0.012)), {"ring": ring})
    assert len(surface.panel_names) == 3
    assert max(abs(s.difference) for s in quietly(flatten, surface).seams) < 5e-5


def test_a_panel_with_two_holes_is_opened():
    angle = np.linspace(0, 2 * np.pi, 17)
    lines = {}
    for name, x in (("a", -0.08), ("b", 0.08)):
        lines[name] = on_cap([x, 0.0] + 0.04 * np.column_stack([np.cos(angle), np.sin(angle)]))
        lines[name][-1] = lines[name][0]
    surface = quietly(cut_along, undivided(*cap(half=0.16, size=0.012)), lines)
    result = quietly(flatten, surface)
    assert max(abs(s.difference) for s in result.seams) < 5e-5


def test_a_group_of_two_pieces_becomes_two_panels():
    vertices, faces = cap(half=0.1, size=0.03)
    both = undivided(
        np.concatenate([vertices, vertices + np.array([0.5, 0, 0])]),
        np.concatenate([faces, faces + len(vertices)]),
        "BOLSTER",
    )
    surface = opened(both)
    assert surface.panel_names == ("BOLSTER_1", "BOLSTER_2")


def test_a_ring_that_touches_itself_in_a_point_is_two_corners():
    """Two triangles that share one vertex alone, in one panel, are two pieces."""
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0]], dtype=float) / 5
    faces = np.array([[0, 1, 2], [0, 3, 4]])
    surface = opened(undivided(vertices, faces))
    assert [len(patch.vertices) for patch in surface.patches()] == [3, 3]


def test_a_panel_that_touches_itself_in_a_point_is_flattened():
    """A bent strip whose two ends meet in one corner."""
    turn = np.linspace(0, 1.5 * np.pi, 30)
    rims = [r * np.column_stack([np.cos(turn), np.sin(turn), 0 * turn]) for r in (0.2, 0.1)]
    n = len(turn)
    i = np.arange(n - 1)
    faces = np.concatenate(
        [np.column_stack([i, i + 1, i + n + 1]), np.column_stack([i, i + n + 1, i + n])]
    )
    vertices = np.concatenate(rims)
    # One triangle from the last rung to the first corner.
    faces = np.concatenate([faces, [[n - 1, n, 2 * n - 1]]])
    surface = undivided(vertices, faces)
    (patch,) = surface.patches()
    assert len(patch.vertices) == len(vertices) + 1
    assert abs(flatten(surface, allowance=0.0).strain).max() < 1e-7
    with pytest.raises(InputError, match=r"panel PANEL, allowance: got 10 mm, .* near \[.* mm"):
        flatten(surface)


@pytest.mark.parametrize("tight", [True, False])
def test_a_closed_surface_and_a_handle_are_refused(tight):
    if tight:
        surface = box_cushion(size=0.03)
        shape = undivided(surface.vertices, surface.faces)
        expected = (
            r"panel PANEL: got a closed surface round .* \(cut it along a line that is closed\)"
        )
    else:
        u = np.linspace(0, 2 * np.pi, 12, endpoint=False)
        r = 0.1 + 0.03 * np.cos(u)
        rims = np.stack([
            np.column_stack([r * np.cos(v), r * np.sin(v), 0.03 * np.sin(u)]) for v in u
        ])  # fmt: skip
        vertices, faces = swept(np.concatenate([rims, rims[:1]]))
        faces = faces % len(rims.reshape(-1, 3))
        shape = undivided(vertices[: 12 * 12], faces[1:])
        expected = r"panel PANEL: got 1 boundary curves, Euler number -1"
    with pytest.raises(InputError, match=expected):
        opened(shape).patches()


def test_all_panels_that_are_none_are_named_at_once():
    vertices, faces = tube()
    pair = DesignSurface(
        vertices=np.concatenate([vertices, vertices + np.array([1.0, 0, 0])]),
        faces=np.concatenate([faces, faces + len(vertices)]),
        panel=np.repeat([0, 1], len(faces)),
        panel_names=("L", "R"),
    )
    with pytest.raises(InputError) as caught:
        pair.patches()
    assert [problem.key for problem in caught.value.problems] == ["panel L", "panel R"]


@pytest.mark.parametrize("aside", [0.0008, 0.004, -0.012])
def test_a_ring_is_not_closed_beside_the_end_of_another_seam(aside):
    """A seam of a millimetre could be neither sewn nor meshed."""
    surface = box_cushion()
    rims = {
        name: surface.vertices[np.append(loop, loop[0])]
        for name, part in (("top", 1), ("base", 2))
        for loop in mesh.boundary_loops(surface.faces[surface.panel == part])
    }
    rim, low = rims["top"], rims["base"]
    back = rim[:, 1].argmax()
    end = rim[back] + [aside, 0.0, 0.0]
    middle = np.array([aside, 0.0, surface.vertices[:, 2].max()])
    across = np.stack([end * [1, -1, 1], middle, end])
    whole = undivided(surface.vertices, surface.faces)
    cut = quietly(cut_along, whole, {"top": rim, "base": low, "across": across})
    result = quietly(flatten, cut)
    assert min(seam.a for seam in result.seams) > 0.0149


def test_a_bare_panel_is_left_out_and_its_border_is_free():
    surface = box_cushion()
    rims = {
        name: surface.vertices[np.append(loop, loop[0])]
        for name, part in (("top", 1), ("base", 2))
        for loop in mesh.boundary_loops(surface.faces[surface.panel == part])
    }
    whole = undivided(surface.vertices, surface.faces)
    below = {"BASE": np.array([0.0, 0.0, surface.vertices[:, 2].min()])}
    cut = quietly(cut_along, whole, rims, bare=below)
    assert len(cut.panel_names) == 2
    assert len(mesh.boundary_loops(cut.faces)) == 1
    result = quietly(flatten, cut)
    assert sum(name.endswith(".free") for name in result.pattern.edges) == 1
    everywhere = {**below, "TOP": middle_of(surface, 1), "BAND": middle_of(surface, 0)}
    with pytest.raises(InputError, match="only bare ones: BASE, TOP, BAND, expected one to cover"):
        quietly(cut_along, whole, rims, bare=everywhere)


def middle_of(surface, panel):
    faces = surface.faces[surface.panel == panel]
    return surface.vertices[faces[len(faces) // 2]].mean(axis=0)


def closed_box():
    surface = box_cushion(base=True)
    rims = {
        name: surface.vertices[np.append(loop, loop[0])]
        for name, part in (("top", 1), ("base", 2))
        for loop in mesh.boundary_loops(surface.faces[surface.panel == part])
    }
    front, rear = (surface.vertices[surface.vertices[:, 1].argsort()[k]] for k in (0, -1))
    return surface, rims, front, rear


def test_both_halves_of_a_ring_have_its_name():
    surface, rims, front, _ = closed_box()
    whole = undivided(surface.vertices, surface.faces)
    names = {"STRIP": front, "LID": middle_of(surface, 1)}
    with pytest.warns(InputWarning, match="panel STRIP has 2 borders"):
        cut = cut_along(whole, rims, names=names)
    assert {"STRIP_1", "STRIP_2", "LID"} < set(cut.panel_names)
    assert sum(line.startswith("STRIP-CLOSING") for line in cut.seam_lines.values()) > 1


def test_each_half_of_a_ring_may_have_a_name_of_its_own():
    surface, rims, front, rear = closed_box()
    whole = undivided(surface.vertices, surface.faces)
    cut = quietly(cut_along, whole, rims, names={"NEAR": front, "FAR": rear})
    assert {"NEAR", "FAR"} < set(cut.panel_names)
    beside = front + np.array([0.001, 0.0, 0.0])
    with pytest.raises(InputError, match=r"panel.AGAIN.point_mm: got a point in the same panel"):
        quietly(cut_along, whole, rims, names={"NEAR": front, "AGAIN": beside, "FAR": rear})
    with pytest.raises(InputError, match=r"panel.OFF.point_mm: got one farther away"):
        quietly(cut_along, whole, rims, names={"OFF": front - [0.0, 0.1, 0.0]})
