"""Surfaces cut into panels along lines."""

import numpy as np
import pytest

from seatlook import mesh
from seatlook.errors import InputError
from seatlook.flattening import DesignSurface, cut_along, flatten
from seatlook.flattening.pattern import pair
from seatlook.flattening.surface import FREE, sides
from support.meshes import rectangle
from support.seat_surfaces import cap, on_cap

LENGTH, WIDTH = 0.4, 0.3


def undivided(vertices, faces):
    panel = np.zeros(len(faces), dtype=np.int64)
    return DesignSurface(vertices=vertices, faces=faces, panel=panel, panel_names=("PANEL",))


def sheet(kind="uns"):
    flat, faces = rectangle(kind, LENGTH, WIDTH, 0.03)
    return undivided(np.column_stack([flat, np.zeros(len(flat))]), faces)


def rolled(radius=0.1, turn=1.5):
    flat, faces = rectangle("uns", radius * turn, WIDTH, 0.01)
    return undivided(on_cylinder(flat, radius, turn), faces)


def on_cylinder(flat, radius=0.1, turn=1.5):
    angle = flat[:, 0] / radius - turn / 2
    return np.column_stack([radius * np.sin(angle), flat[:, 1], radius * np.cos(angle)])


def flat_line(*rows):
    return np.array([[*row, 0.0] for row in rows])


def areas(surface):
    face = mesh.face_areas(surface.vertices, surface.faces)
    return dict(zip(surface.panel_names, np.bincount(surface.panel, face).tolist(), strict=True))


def seam_lines_of(surface):
    by_name = {side.name: side for side in sides(surface.patches())}
    return {
        seam.name: surface.vertices[by_name[seam.a].vertices]
        for seam in pair(tuple(by_name.values()))
    }


@pytest.mark.parametrize("kind", ["uns", "right", "cross", "sliver"])
@pytest.mark.parametrize(
    ("line", "front"),
    [
        (flat_line((0, 0.113), (LENGTH, 0.171)), LENGTH * (0.113 + 0.171) / 2),
        (flat_line((0, 0.15), (LENGTH, 0.15)), LENGTH * 0.15),
        (
            flat_line((0, 0.113), (0.23, 0.187), (LENGTH, 0.071)),
            0.23 * (0.113 + 0.187) / 2 + 0.17 * (0.187 + 0.071) / 2,
        ),
    ],
)
def test_areas_on_a_plane_are_exact(kind, line, front):
    cut = cut_along(sheet(kind), {"A": line})
    result = areas(cut)
    assert sum(result.values()) == pytest.approx(LENGTH * WIDTH, abs=1e-12)
    assert result["PANEL_1"] == pytest.approx(front, abs=1e-9)
    assert result["PANEL_2"] == pytest.approx(LENGTH * WIDTH - front, abs=1e-9)


def test_outlines_are_made_of_lines_and_border_alone():
    lines = {
        "across": flat_line((0, 0.113), (0.23, 0.187), (LENGTH, 0.071)),
        "branch": flat_line((0.231, 0.1865), (0.3, WIDTH)),
    }
    whole = sheet()
    cut = cut_along(whole, lines)
    patches = cut.patches()  # each a connected piece without holes
    assert [patch.name for patch in patches] == ["PANEL_1", "PANEL_2", "PANEL_3"]
    on_border = 0
    for side in sides(patches):
        ends = np.sort(np.column_stack([side.vertices[:-1], side.vertices[1:]]), axis=1)
        at = cut.vertices[ends].reshape(-1, 2, 3)
        if side.neighbour == FREE:
            rim = np.isin(at[:, :, :2], [0.0]) | np.isclose(at[:, :, :2], [LENGTH, WIDTH])
            assert rim.all(axis=1).any(axis=1).all()
            on_border += np.linalg.norm(at[:, 1] - at[:, 0], axis=1).sum()
        else:
            assert all(tuple(edge) in cut.seam_lines for edge in ends.tolist())
    assert on_border == pytest.approx(2 * (LENGTH + WIDTH))
    assert [seam.seam for seam in flatten(cut).seams] == [
        "across.PANEL_1-PANEL_2",
        "across.PANEL_1-PANEL_3",
        "branch",
    ]


def test_panels_keep_the_names_of_the_groups_they_were_part_of():
    whole = sheet("right")
    left = whole.vertices[whole.faces].mean(axis=1)[:, 0] > 0.2
    grouped = DesignSurface(
        vertices=whole.vertices,
        faces=whole.faces,
        panel=left.astype(np.int64),
        panel_names=("R", "L"),
    )
    cut = cut_along(
        grouped,
        {"A": flat_line((0.21, 0), (0.21, WIDTH)), "B": flat_line((0.21, 0.1), (LENGTH, 0.1))},
    )
    assert cut.panel_names == ("R", "L_1", "L_2")
    assert areas(cut)["L_1"] == pytest.approx(0.19 * 0.1, abs=1e-9)


def test_a_cylinder_cut_aslant_comes_out_flat():
    flat = np.column_stack([np.linspace(0, 0.15, 16), np.linspace(0.1, 0.2, 16)])
    cut = cut_along(rolled(), {"A": on_cylinder(flat)})
    result = flatten(cut)
    exact = np.hypot(0.15, 0.1)
    (seam,) = result.seams
    assert seam.seam == "A"
    assert seam.a == pytest.approx(exact, rel=1e-3)
    assert seam.b == pytest.approx(seam.a, abs=5e-5)
    assert list(areas(cut).values()) == pytest.approx([0.15 * WIDTH / 2] * 2, rel=2e-3)
    # The area lost is that of the mesh itself, chords for arcs.
    assert sum(areas(cut).values()) == pytest.approx(sum(areas(rolled()).values()), rel=1e-4)
    assert max(panel.rms for panel in result.panels) < 1e-3


def test_demo_cut_along_its_own_seams_is_the_demo_again(surface, flattened):
    cut = cut_along(undivided(surface.vertices, surface.faces), seam_lines_of(surface))
    assert len(cut.faces) == len(surface.faces)
    assert sorted(areas(cut).values()) == pytest.approx(sorted(areas(surface).values()), rel=1e-9)
    again = {seam.seam: seam for seam in flatten(cut).seams}
    assert again.keys() == {seam.seam for seam in flattened.seams}
    for seam in flattened.seams:
        assert again[seam.seam].a == pytest.approx(seam.a, abs=5e-5)


def test_demo_cut_where_it_has_no_edges_is_the_demo_again(surface, flattened):
    from seatlook.seats import demo_design

    lines = seam_lines_of(demo_design(element_size=0.0075))
    cut = cut_along(undivided(surface.vertices, surface.faces), lines)
    assert len(cut.faces) > 1.03 * len(surface.faces)
    assert sorted(areas(cut).values()) == pytest.approx(sorted(areas(surface).values()), rel=1e-3)
    again = {seam.seam: seam for seam in flatten(cut).seams}
    for seam in flattened.seams:
        assert again[seam.seam].a == pytest.approx(seam.a, abs=5e-5)


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        (
            {"A": flat_line((0, 0.1), (LENGTH, 0.1)), "B": flat_line((0, 0.103), (0.01, 0.1))},
            r"panel PANEL_\d: got 0\.15 cm2 near .* expected at least 1 cm2",
        ),
    ],
)
def test_panels_that_are_none_are_refused(lines, message):
    with pytest.raises(InputError, match=message):
        cut_along(sheet(), lines)


def test_a_line_along_a_tube_opens_it_and_two_divide_it():
    turn = np.linspace(0, 2 * np.pi, 25)[:-1]
    ring = np.column_stack([0.1 * np.cos(turn), 0.1 * np.sin(turn)])
    vertices = np.array([[x, y, z] for z in (0.0, 0.1, 0.2) for x, y in ring])
    i = np.arange(24)
    a, b = np.concatenate([i, i + 24]), np.concatenate([(i + 1) % 24, (i + 1) % 24 + 24])
    faces = np.concatenate([np.column_stack([a, b, b + 24]), np.column_stack([a, b + 24, a + 24])])
    lines = {"slit": np.array([[0.1, 0, 0], [0.1, 0, 0.2]])}
    (whole,) = cut_along(undivided(vertices, faces), lines).patches()
    assert (len(whole.faces), len(whole.vertices)) == (96, len(vertices) + 3)
    back = np.array([[-0.1, 0, 0], [-0.1, 0, 0.2]])
    halves = cut_along(undivided(vertices, faces), {**lines, "back": back})
    assert [len(patch.faces) for patch in halves.patches()] == [48, 48]


@pytest.mark.parametrize("size", [0.003, 0.006, 0.010, 0.015])
@pytest.mark.parametrize("seed", [0, 1])
def test_lines_that_pass_close_to_vertices_and_each_other_leave_few_slivers(size, seed):
    """Two lines 12 mm apart that are hardly parallel, and a third that ends on one at a slant."""
    rng = np.random.default_rng(seed)
    whole = undivided(*cap(half=0.16, size=size))
    y0, y1 = rng.uniform(-0.1, 0.1, 2)
    x = rng.uniform(-0.1, 0.1)
    across = (y1 - y0) / 0.32
    lines = {
        "a": np.linspace((-0.16, y0), (0.16, y1), 25),
        "b": np.linspace((x, y0 + across * (x + 0.16)), (x + 0.02, 0.16), 9),
        "c": np.linspace((-0.16, y0 + 0.012), (0.16, y1 + 0.0125), 25),
    }
    cut = cut_along(whole, {name: on_cap(line) for name, line in lines.items()})
    narrow = np.degrees(mesh.angles(cut.vertices, cut.faces).min(axis=1))
    # Before narrow faces were merged: 26 to 108 below 5 degrees, the least 0.02.
    assert (narrow < 5).sum() <= 8
    assert narrow.min() > 0.5
    assert sum(areas(cut).values()) == pytest.approx(sum(areas(whole).values()), rel=1e-4)
    for name, line in lines.items():
        used = np.unique([e for e, n in cut.seam_lines.items() if n == name])
        start, way = line[0], line[-1] - line[0]
        off = cut.vertices[used, :2] - start
        off = np.abs(off[:, 0] * way[1] - off[:, 1] * way[0]) / np.hypot(*way)
        assert off.max() < 2.2e-3  # the plane between two points leans with the surface
