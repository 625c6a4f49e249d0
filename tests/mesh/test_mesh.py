import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from seatlook import mesh
from seatlook.errors import InputError

H = 0.0075


def closed(corners, spacing):
    ring = np.vstack([corners, corners[:1]]).astype(float)
    sides = [mesh.resample(ring[i : i + 2], spacing)[:-1] for i in range(len(corners))]
    return np.concatenate(sides)


def rectangle(width, height, spacing):
    return closed(np.array([[0, 0], [width, 0], [width, height], [0, height]]), spacing)


def blob(amplitudes, phases, spacing, radius=0.1):
    t = np.linspace(0, 2 * np.pi, 600)
    r = radius * (
        1
        + sum(
            a * np.cos(k * t + p)
            for k, (a, p) in enumerate(zip(amplitudes, phases, strict=True), 2)
        )
    )
    ring = np.column_stack([r * np.cos(t), r * np.sin(t)])
    ring[-1] = ring[0]
    return mesh.resample(ring, spacing)[:-1]


def has_segments(faces, indices):
    present = {tuple(e) for e in mesh.edges(faces).tolist()}
    pairs = zip(indices, np.roll(indices, -1), strict=True)
    return all(tuple(sorted(map(int, pair))) in present for pair in pairs)


def test_edges_of_two_triangles():
    faces = np.array([[0, 1, 2], [0, 2, 3]])
    assert mesh.edges(faces).tolist() == [[0, 1], [0, 2], [0, 3], [1, 2], [2, 3]]


def test_boundary_loops_of_a_ring_and_of_a_closed_surface():
    faces = np.array(
        [[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4], [2, 0, 3], [2, 3, 5]]
    )  # a triangular tube
    assert [loop.tolist() for loop in mesh.boundary_loops(faces)] == [[0, 1, 2], [3, 5, 4]]
    tetrahedron = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
    assert mesh.boundary_loops(tetrahedron) == []


@settings(max_examples=50, deadline=None)
@given(st.lists(st.permutations(range(7)).map(lambda p: p[:3]), max_size=12))
def test_boundary_sides_are_those_that_occur_once(triangles):
    faces = np.array(triangles, dtype=np.int64).reshape(-1, 3)
    sides = [frozenset((f[k], f[(k + 1) % 3])) for f in faces.tolist() for k in range(3)]
    single = [k for k, side in enumerate(sides) if sides.count(side) == 1]
    assert mesh.boundary_sides(faces).tolist() == single


def test_boundary_loops_refuse_a_pinched_surface():
    with pytest.raises(InputError, match=r"touch in a vertex.*expected a manifold surface"):
        mesh.boundary_loops(np.array([[0, 1, 2], [0, 3, 4]]))


def test_angles_of_a_3_4_5_triangle_in_space():
    points = np.array([[0.0, 0, 1], [0, 4, 1], [3, 0, 1]])
    result = mesh.angles(points, np.array([[0, 1, 2]]))
    assert np.allclose(result, [[np.pi / 2, np.arctan2(3, 4), np.arctan2(4, 3)]])


def test_normals_of_a_sphere():
    points, faces = mesh.triangulate(blob([0.0], [0.0], H), H)
    x, y = points.T
    cap = np.column_stack([x, y, np.sqrt(0.3**2 - x**2 - y**2)])
    exact = cap / 0.3
    inner = np.setdiff1d(np.arange(len(cap)), mesh.boundary_loops(faces)[0])
    assert np.abs(mesh.vertex_normals(cap, faces) - exact)[inner].max() < 4e-3
    centre = cap[faces].mean(axis=1)
    outward = np.einsum("md,md->m", mesh.face_normals(cap, faces), centre)
    assert outward.min() > 0


def test_a_vertex_without_a_face_has_no_normal():
    """Nodes of deleted shells stay in the list; nobody divides by their length."""
    points = np.array([[0.0, 0, 1], [9, 9, 9], [0, 4, 1], [3, 0, 1]])
    normals = mesh.vertex_normals(points, np.array([[0, 3, 2]]))
    assert normals.tolist() == [[0, 0, 1], [0, 0, 0], [0, 0, 1], [0, 0, 1]]


def test_hexagonal_bias_of_known_meshes():
    lattice = np.array([[0, 0], [1, 0], [0.5, np.sqrt(0.75)]])
    pairs = np.array([[0, 1], [1, 2], [2, 0]])
    assert mesh.hexagonal_bias(lattice, pairs) == pytest.approx(1)
    square = np.array([[0.0, 0], [1, 0], [0, 1]])
    assert mesh.hexagonal_bias(square, np.array([[0, 1], [0, 2]])) == pytest.approx(0, abs=1e-12)


@pytest.mark.parametrize("spacing", [0.007, 0.01, 10.0])
def test_resample_steps_are_equal_along_the_line(spacing):
    t = np.linspace(0, np.pi / 2, 2000)
    line = 0.1 * np.column_stack([np.cos(t), np.sin(t), 0 * t])
    result = mesh.resample(line, spacing)
    steps = np.linalg.norm(np.diff(result, axis=0), axis=1)
    assert np.ptp(steps) < 1e-6
    assert len(steps) == max(1, round(0.1 * np.pi / 2 / spacing))
    assert (result[[0, -1]] == line[[0, -1]]).all()


def test_resample_refuses_a_point():
    with pytest.raises(InputError, match=r"length 0, spacing 0.1"):
        mesh.resample(np.zeros((2, 2)), 0.1)


@settings(max_examples=12, deadline=None, derandomize=True)
@given(
    amplitudes=st.lists(st.floats(-0.12, 0.12), min_size=3, max_size=3),
    phases=st.lists(st.floats(0, 6.28), min_size=3, max_size=3),
    seed=st.integers(0, 100),
    ratio=st.floats(0.8, 1.25),
)
def test_triangulation_keeps_the_outline_and_its_gates(amplitudes, phases, seed, ratio):
    boundary = blob(amplitudes, phases, ratio * H)
    points, faces = mesh.triangulate(boundary, H, seed=seed)
    b = len(boundary)
    assert (points[:b] == boundary).all()
    assert [loop.tolist() for loop in mesh.boundary_loops(faces)] == [list(range(b))]
    assert mesh.face_vectors(points, faces)[:, 2].min() > 0
    x, y = boundary.T
    shoelace = 0.5 * np.sum(x * np.roll(y, -1) - y * np.roll(x, -1))
    assert mesh.face_areas(points, faces).sum() == pytest.approx(shoelace, rel=1e-12)
    assert np.unique(faces).tolist() == list(range(len(points)))
    smallest = np.degrees(mesh.angles(points, faces)).min(axis=1)
    assert smallest.min() >= mesh.MIN_ANGLE_DEG
    assert np.quantile(smallest, 0.01) >= mesh.QUANTILE_ANGLE_DEG


@pytest.mark.parametrize("turn", [0.1, 0.4, 0.7, 1.0, 1.3])
def test_straight_edges_at_any_angle_leave_no_flat_triangle(turn):
    rotation = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    points, faces = mesh.triangulate(rectangle(0.25, 0.06, 0.012) @ rotation.T + 0.3, 0.012)
    area = mesh.face_areas(points, faces)
    assert area.min() > 0.1 * area.mean()
    assert area.sum() == pytest.approx(0.25 * 0.06, rel=1e-12)


@pytest.mark.parametrize("seed", range(4))
def test_size_and_bias_of_a_large_sheet(seed):
    points, faces = mesh.triangulate(rectangle(0.25, 0.2, 0.005), 0.005, seed=seed)
    pairs = mesh.edges(faces)
    length = mesh.edge_lengths(points, faces)
    assert length.mean() == pytest.approx(0.005, rel=0.03)
    assert length.std() / length.mean() < 0.17
    assert mesh.hexagonal_bias(points, pairs) < mesh.MAX_HEXAGONAL_BIAS


def test_the_lattice_alone_would_be_biased():
    """The gate can fail: a smooth hexagonal mesh is what it is there to refuse."""
    i, j = (a.ravel() for a in np.meshgrid(np.arange(20.0), np.arange(20.0)))
    points = np.column_stack([i + 0.5 * (j % 2), j * np.sqrt(0.75)])
    near = np.linalg.norm(points[:, None] - points[None], axis=2)
    pairs = np.argwhere((near > 0) & (near < 1.1))
    assert mesh.hexagonal_bias(points, pairs) > 0.99


@pytest.mark.parametrize("seed", range(3))
def test_internal_lines_become_edges(seed):
    boundary = rectangle(0.15, 0.12, H)
    start = boundary[8]
    line = mesh.resample(np.array([start, [0.08, 0.05], [0.1, 0.08]]), H)
    branch = mesh.resample(np.array([line[-1], [0.04, 0.09]]), H)
    points, faces = mesh.triangulate(boundary, H, lines=[line, branch], seed=seed)
    present = {tuple(e) for e in mesh.edges(faces).tolist()}
    for polyline in (line, branch):
        at = [int(np.linalg.norm(points - p, axis=1).argmin()) for p in polyline]
        assert np.allclose(points[at], polyline, atol=1e-12)
        assert {tuple(sorted(pair)) for pair in itertools.pairwise(at)} <= present
    k = len(boundary) + len(line) - 1 + len(branch) - 1
    assert np.allclose(points[len(boundary) : k], np.concatenate([line[1:], branch[1:]]))


def test_same_seed_same_mesh_other_seed_other_mesh():
    boundary = rectangle(0.1, 0.1, H)
    a, b, c = (mesh.triangulate(boundary, H, seed=s)[0] for s in (3, 3, 4))
    assert (a == b).all()
    assert a.shape != c.shape or not np.allclose(a, c)


@pytest.mark.parametrize("width", [1.0, 2.0, 3.5])
def test_narrow_strips_are_meshed(width):
    boundary = rectangle(0.15, width * H, H)
    points, faces = mesh.triangulate(boundary, H)
    assert has_segments(faces, np.arange(len(boundary)))
    assert np.degrees(mesh.angles(points, faces)).min() >= mesh.MIN_ANGLE_DEG


@pytest.mark.parametrize(
    ("corners", "message"),
    [
        ([[0, 0], [0, 0.1], [0.1, 0.1], [0.1, 0]], "outline: got clockwise"),
        ([[0, 0], [0.1, 0.1], [0.1, 0], [0, 0.1]], "outline: got .*[Ss]elf-intersection"),
        ([[0, 0], [0.2, 0], [0.2, 0.02]], r"mesh angles: got 5\.\d deg at \(\d+\.\d, "),
        ([[0, 0], [np.nan, 0], [0.2, 0.02]], "outline: got nan or inf"),
    ],
)
def test_bad_outlines_are_named(corners, message):
    boundary = np.array(corners, dtype=float)
    if np.isfinite(boundary).all():
        boundary = closed(boundary, 0.01)
    with pytest.raises(InputError, match=message):
        mesh.triangulate(boundary, 0.01)


def test_a_segment_that_cannot_be_an_edge_is_named():
    """A C shape: one long side of the gap has no points, the other one has many."""
    fine = mesh.resample(np.array([[0.1, 0.055], [0.03, 0.055]]), 0.01)
    coarse = np.array([[0, 0], [0.1, 0], [0.1, 0.05], [0.03, 0.05], [0.02, 0.0525]])
    boundary = np.concatenate([coarse, fine[::-1], [[0.1, 0.1], [0, 0.1]]])
    with pytest.raises(InputError, match=r"outline: got 1 segments .* at \(65\.0, 50\.0\) mm"):
        mesh.triangulate(boundary, 0.01)


def test_element_size_must_be_positive():
    with pytest.raises(InputError, match="element_size: got 0"):
        mesh.triangulate(rectangle(0.1, 0.1, 0.01), 0.0)


@pytest.mark.parametrize("turn", [1, -1])
def test_a_hole_is_left_open(turn):
    t = np.linspace(0, 2 * np.pi, 30, endpoint=False)
    hole = np.column_stack([0.15 + 0.05 * np.cos(t), 0.1 + 0.05 * np.sin(t)])[::turn]
    points, faces = mesh.triangulate(rectangle(0.3, 0.2, 0.01), 0.01, holes=[hole])
    loops = sorted(mesh.boundary_loops(faces), key=len)
    assert np.array_equal(np.sort(points[loops[0]], axis=0), np.sort(hole, axis=0))
    assert len(loops) == 2
    area = 0.3 * 0.2 - 0.5 * 30 * 0.05**2 * np.sin(2 * np.pi / 30)
    assert mesh.face_areas(points, faces).sum() == pytest.approx(area, rel=1e-9)


def test_a_hole_across_the_outline_is_refused():
    outline = np.array([[0, 0], [0.3, 0], [0.3, 0.2], [0, 0.2]])
    with pytest.raises(InputError, match="outline"):
        mesh.triangulate(outline, 0.1, holes=[outline + 0.1])
