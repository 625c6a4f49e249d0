"""Lines drawn into triangle meshes, and joined where they end."""

import numpy as np
import pytest
import shapely
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from seatlook import mesh
from seatlook.errors import InputError
from seatlook.mesh.drawing import FLAT, SAME
from seatlook.mesh.imprint import imprint
from seatlook.mesh.line_ends import lay_on
from support.meshes import KINDS, rectangle

LENGTH, WIDTH, H = 0.4, 0.3, 0.03


def plane(kind, seed=0):
    flat, faces = rectangle(kind, LENGTH, WIDTH, H, seed=seed)
    return np.column_stack([flat, np.zeros(len(flat))]), faces


def points(*rows):
    return np.array([[*row, 0.0] for row in rows])


def length_of(drawn, name):
    ends = np.array([edge for edge, line in drawn.edges.items() if line == name])
    return np.linalg.norm(drawn.vertices[ends[:, 0]] - drawn.vertices[ends[:, 1]], axis=1).sum()


@pytest.mark.parametrize("kind", KINDS)
@settings(max_examples=10, deadline=None)
@given(ends=st.lists(st.floats(0.02, 0.28), min_size=2, max_size=2), seed=st.integers(0, 9))
def test_edges_run_along_a_straight_line_and_no_face_turns_over(kind, ends, seed):
    vertices, faces = plane(kind, seed)
    line = points((0, ends[0]), (LENGTH, ends[1]))
    drawn = imprint(vertices, faces, {"A": line})
    used = np.unique(list(drawn.edges))
    way = line[1] - line[0]
    off = np.abs(np.cross(way, drawn.vertices[used] - line[0])[:, 2]) / np.linalg.norm(way)
    # A corner of the border takes an end that is nearer than this share of an edge.
    assert off.max() <= SAME * 1.1 * H
    assert length_of(drawn, "A") == pytest.approx(np.linalg.norm(way), abs=2 * SAME * 1.1 * H)
    assert mesh.face_vectors(drawn.vertices, drawn.faces)[:, 2].min() > 0
    assert mesh.face_areas(drawn.vertices, drawn.faces).sum() == pytest.approx(
        LENGTH * WIDTH, abs=1e-12
    )


def test_parts_of_a_face_name_it():
    vertices, faces = plane("uns")
    drawn = imprint(vertices, faces, {"A": points((0, 0.11), (0.17, 0.2), (LENGTH, 0.07))})
    whole = np.bincount(drawn.source, mesh.face_areas(drawn.vertices, drawn.faces))
    before = mesh.face_areas(vertices, faces)
    # Vertices that give way, and narrow faces that are merged, shift the borders of faces.
    assert np.abs(whole - before).max() < 0.5 * before.max()
    assert whole.sum() == pytest.approx(before.sum(), abs=1e-12)


def test_a_line_on_edges_leaves_the_mesh_as_it_is():
    vertices, faces = plane("right")
    drawn = imprint(vertices, faces, {"A": points((0, 0.15), (LENGTH, 0.15))})
    assert np.abs(drawn.vertices - vertices).max() < 1e-15
    assert drawn.faces.tolist() == faces.tolist()
    assert length_of(drawn, "A") == pytest.approx(LENGTH)


def test_crossing_lines_share_a_vertex_and_keep_their_names():
    vertices, faces = plane("uns")
    lines = {"A": points((0, 0.1), (LENGTH, 0.2)), "B": points((0.1, 0), (0.3, WIDTH))}
    drawn = imprint(vertices, faces, lines)
    used = [
        {v for edge, line in drawn.edges.items() if line == name for v in edge} for name in "AB"
    ]
    (shared,) = used[0] & used[1]
    assert drawn.vertices[shared] == pytest.approx([0.2, 0.15, 0.0], abs=1e-9)
    for name, line in lines.items():
        assert length_of(drawn, name) == pytest.approx(np.linalg.norm(line[1] - line[0]), abs=1e-9)


def test_a_line_round_a_cylinder_is_as_long_as_it_should_be():
    radius, angle = 0.1, 1.2
    flat, faces = rectangle("uns", radius * 2 * angle, WIDTH, 0.01)
    turn = flat[:, 0] / radius - angle
    vertices = np.column_stack([radius * np.sin(turn), flat[:, 1], radius * np.cos(turn)])
    s = np.linspace(-angle, angle, 9)
    helix = np.column_stack([radius * np.sin(s), 0.15 + 0.05 * s, radius * np.cos(s)])
    helix = lay_on(vertices, faces, {"A": helix}, tolerance=0.002)["A"]
    drawn = imprint(vertices, faces, {"A": helix})
    exact = 2 * angle * np.hypot(radius, 0.05)
    assert length_of(drawn, "A") == pytest.approx(exact, rel=2e-3)  # the mesh: chords of arcs
    radial = np.hypot(drawn.vertices[:, 0], drawn.vertices[:, 2])
    inner = radius * np.cos(np.ptp(turn[faces], axis=1).max() / 2)
    assert radial.max() < radius + FLAT
    assert radial.min() > inner - FLAT


@pytest.mark.parametrize("ends", [(0.1504, 0.1504), (0.148, 0.1535), (0.1, 0.19), (0.02, 0.28)])
def test_a_crease_stays_where_it_is(ends):
    vertices, faces = plane("right")
    ridge = np.unique(vertices[:, 0])[7]
    vertices[:, 2] = -np.abs(vertices[:, 0] - ridge)
    before = mesh.face_areas(vertices, faces).sum()
    at = np.array([0.0, LENGTH])
    line = np.column_stack([at, ends, -np.abs(at - ridge)])
    drawn = imprint(vertices, faces, {"A": line})
    assert len(drawn.edges) > 10
    assert np.abs(drawn.vertices[:, 2] + np.abs(drawn.vertices[:, 0] - ridge)).max() <= 2 * FLAT
    assert mesh.face_areas(drawn.vertices, drawn.faces).sum() == pytest.approx(before, rel=1e-3)


def test_a_line_over_a_hole_leaves_the_surface():
    vertices, faces = plane("right")
    middle = vertices[faces].mean(axis=1)
    hole = (np.abs(middle[:, 0] - 0.2) < 0.05) & (np.abs(middle[:, 1] - 0.15) < 0.05)
    line = points((0, 0.151), (0.01, 0.151), (LENGTH, 0.151))
    with pytest.raises(
        InputError, match=r"curve\.A\.points_mm: got no way .* stays on the surface"
    ):
        imprint(vertices, faces[~hole], {"A": line})


def test_ends_are_joined_within_the_tolerance():
    vertices, faces = plane("uns")
    lines = {
        "A": points((0.0015, 0.1), (LENGTH + 0.0015, 0.1)),
        "B": points((0.2, 0.1012), (0.2, WIDTH)),
        "C": points((0.1, 0.2), (0.1985, 0.2), (0.1, 0.25), (0.1, 0.2)),
        "D": points((0.1985, 0.1985), (0.3, 0.2), (LENGTH, 0.2)),
    }
    laid = lay_on(vertices, faces, lines, tolerance=0.002)
    assert laid["A"].tolist() == points((0, 0.1), (0.2, 0.1), (LENGTH, 0.1)).tolist()
    assert laid["B"][0] == pytest.approx([0.2, 0.1, 0])
    assert len(laid["C"]) in (4, 5)
    assert laid["D"][0, 0] == pytest.approx(0.2, abs=2e-3)


def test_every_line_that_lies_off_or_ends_nowhere_is_named():
    vertices, faces = plane("uns")
    off = points((0, 0.1), (0.2, 0.1), (LENGTH, 0.1))
    off[1, 2] = 0.0031
    with pytest.raises(InputError) as caught:
        lay_on(vertices, faces, {"A": off, "B": off[::-1]}, tolerance=0.002)
    assert [str(p) for p in caught.value.problems] == [
        f"curve.{name}.points_mm[1]: got 3.10 mm, expected within 2 mm of the surface"
        for name in "AB"
    ]
    short = points((0, 0.1), (0.2, 0.1))
    with pytest.raises(InputError, match=r"curve\.A\.points_mm\[1\]: got an end 8\.0 mm away"):
        lay_on(
            vertices, faces, {"A": short, "B": points((0, 0.108), (LENGTH, 0.108))}, tolerance=2e-3
        )
    with pytest.raises(InputError, match=r"or as the tip of a dart 10 mm clear of them"):
        lay_on(vertices, faces, {"A": points((0, 0.1), (LENGTH - 0.009, 0.1))}, tolerance=0.002)


def test_the_tip_of_a_dart_stays_where_it_is():
    vertices, faces = plane("uns")
    dart = points((0, 0.1), (0.2, 0.1))
    assert lay_on(vertices, faces, {"A": dart}, tolerance=0.002)["A"].tolist() == dart.tolist()


@pytest.mark.parametrize("kind", KINDS)
@settings(max_examples=10, deadline=None)
@given(ends=st.lists(st.floats(0.02, 0.28), min_size=2, max_size=2), seed=st.integers(0, 9))
def test_a_border_that_is_shared_keeps_its_vertices(kind, ends, seed):
    vertices, faces = plane(kind, seed)
    line = points((0, ends[0]), (LENGTH, ends[1]))
    drawn = imprint(vertices, faces, {"A": line}, border=False)
    (rim,) = mesh.boundary_loops(faces)
    assert np.isin(rim, drawn.faces).all()
    assert (drawn.vertices[rim] == vertices[rim]).all()


def test_narrow_faces_are_merged_and_the_line_stays_straight():
    vertices, faces = plane("right")
    drawn = imprint(vertices, faces, {"A": points((0, 0.1525), (LENGTH, 0.1475))})
    assert np.degrees(mesh.angles(drawn.vertices, drawn.faces).min()) > 3
    used = np.unique(list(drawn.edges))
    x, y, _ = drawn.vertices[used].T
    assert np.abs(y - (0.1525 - 0.0125 * x)).max() < 1e-12


def creased(seed):
    """A sheet of steep folds, and two places on it."""
    rng, n = np.random.default_rng(seed), 6
    x, y = np.divmod(np.arange(n * n), n)
    points = 0.01 * np.column_stack([x, y, 2 * (x % 2)]) + rng.normal(scale=1e-3, size=(n * n, 3))
    a = (n * np.arange(n - 1)[:, None] + np.arange(n - 1)).ravel()
    faces = np.concatenate(
        [np.column_stack(k) for k in ((a, a + n, a + n + 1), (a, a + n + 1, a + 1))]
    )
    on = rng.choice(len(faces), 2, replace=False)
    share = rng.dirichlet(np.ones(3), 2)[:, :, None]
    return points, faces, (share * points[faces[on]]).sum(axis=1)


def test_over_creases_a_line_is_drawn_or_refused():
    """It never goes on for ever, back and forth between two vertices beside a crease."""
    drawn, refused = 0, set()
    for seed in range(60):
        points, faces, line = creased(seed)
        try:
            imprint(points, faces, {"a": line})
            drawn += 1
        except InputError as error:
            refused.add(error.problems[0].expected)
    assert 20 < drawn < 60
    assert refused == {"a line that stays on the surface"}


def concave_block(seed):
    """A block with a concave sharp edge, its faces of all shapes; a line drawn beside the edges."""
    outline = [(-0.3, -0.2), (0.3, -0.2), (0.3, 0.05), (0.05, 0.05), (0.05, 0.2), (-0.3, 0.2)]
    block = trimesh.creation.extrude_polygon(shapely.Polygon(outline), 0.1)
    block = trimesh.Trimesh(*trimesh.remesh.subdivide_to_size(block.vertices, block.faces, 0.05))
    block.merge_vertices()
    rng = np.random.default_rng(seed)
    ring = np.array(shapely.Polygon(outline).exterior.segmentize(0.04).coords)[:-1]
    line = np.column_stack([ring, np.full(len(ring), 0.1)]) + rng.normal(0, 5e-4, (len(ring), 3))
    return np.array(block.vertices), np.array(block.faces), np.vstack([line, line[:1]])


@pytest.mark.parametrize("seed", range(12))
def test_a_line_beside_sharp_edges_parts_a_block_in_two(seed):
    vertices, faces, line = concave_block(seed)
    drawn = imprint(vertices, faces, {"a": line})
    rows = mesh.inner_sides(drawn.faces)
    half = np.sort(drawn.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)[rows[:, 0]], axis=1)
    link = np.array([tuple(pair) not in drawn.edges for pair in half.tolist()])
    pairs = rows[link] // 3
    graph = coo_array((np.ones(len(pairs)), tuple(pairs.T)), shape=(len(drawn.faces),) * 2)
    count, part = connected_components(graph, directed=False)
    assert count == 2
    areas = np.sort(np.bincount(part, mesh.face_areas(drawn.vertices, drawn.faces)))
    assert areas[0] == pytest.approx(0.2025, rel=0.02)
    ends = np.array(list(drawn.edges))
    length = np.linalg.norm(drawn.vertices[ends[:, 0]] - drawn.vertices[ends[:, 1]], axis=1).sum()
    assert length < 1.05 * 2.0
