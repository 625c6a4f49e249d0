import numpy as np
import pytest

from seatlook import mesh
from seatlook.flattening.surface import sides
from seatlook.seats.demo import PANELS, demo_design

SEAMS = {
    ("BOLSTER_L", "FRONT"),
    ("BOLSTER_L", "INSERT"),
    ("BOLSTER_L", "REAR"),
    ("BOLSTER_L", "SIDE_L"),
    ("BOLSTER_R", "FRONT"),
    ("BOLSTER_R", "INSERT"),
    ("BOLSTER_R", "REAR"),
    ("BOLSTER_R", "SIDE_R"),
    ("FRONT", "INSERT"),
    ("FRONT", "SIDE_L"),
    ("FRONT", "SIDE_R"),
    ("INSERT", "REAR"),
    ("REAR", "SIDE_L"),
    ("REAR", "SIDE_R"),
}


def test_size_and_place(surface):
    low, high = surface.vertices.min(axis=0), surface.vertices.max(axis=0)
    assert high[0] - low[0] == pytest.approx(0.50, abs=1e-3)
    assert high[1] - low[1] == pytest.approx(0.56, abs=0.01)
    assert low[2] == pytest.approx(0.025, abs=1e-6)
    assert 0.11 < high[2] < 0.14


def test_panels_conform_along_their_seams(surface):
    """Every seam is one chain of shared vertices: each side has a partner run backwards."""
    result = sides(surface.patches())
    by_name = {side.name: side for side in result}
    pairs = set()
    for side in result:
        if side.neighbour == "free":
            continue
        other = by_name[f"{side.neighbour}.{side.panel}"]
        assert (other.vertices[::-1] == side.vertices).all()
        pairs.add(tuple(sorted((side.panel, side.neighbour))))
    assert pairs == SEAMS
    free = {side.panel for side in result if side.neighbour == "free"}
    assert free == {"FRONT", "SIDE_L", "SIDE_R", "REAR"}


def test_front_is_sewn_to_three_panels_in_outline_order(surface):
    order = [s.neighbour for s in sides(surface.patches()) if s.panel == "FRONT"]
    at = order.index("free")
    # The face is looked at from the front, counter-clockwise: along the bottom towards +x, up.
    expected = ["free", "SIDE_L", "BOLSTER_L", "INSERT", "BOLSTER_R", "SIDE_R"]
    assert order[at:] + order[:at] == expected


def test_left_is_the_occupants_left_and_front_is_minus_y(surface):
    centre = {
        name: surface.vertices[surface.faces[surface.panel == i]].mean(axis=(0, 1))
        for i, name in enumerate(PANELS)
    }
    assert centre["BOLSTER_L"][0] > 0.1
    assert centre["SIDE_L"][0] > 0.2
    assert centre["BOLSTER_R"][0] < -0.1
    assert centre["FRONT"][1] < -0.2 < 0.2 < centre["REAR"][1]


def test_faces_look_outward(surface):
    up = mesh.face_normals(surface.vertices, surface.faces)
    for name, direction in (("FRONT", [0, -1, 0.2]), ("REAR", [0, 1, 0.2]), ("INSERT", [0, 0, 1])):
        assert (up[surface.panel == PANELS.index(name)] @ direction).min() > 0.4
    for name, x in (("SIDE_L", 1), ("SIDE_R", -1), ("BOLSTER_L", 0.5), ("BOLSTER_R", -0.5)):
        assert (up[surface.panel == PANELS.index(name)] @ [x, 0, 1]).min() > 0.1


def test_surface_is_the_same_left_and_right(cushion):
    p = np.random.default_rng(0).uniform(-0.3, 0.3, (500, 2))
    left, right = cushion.position(p), cushion.position(p * [-1, 1])
    assert np.allclose(left * [-1, 1, 1], right, atol=1e-15)


def normals(cushion, p):
    x, y = 1e-7 * np.eye(2)
    n = np.cross(
        cushion.position(p + x) - cushion.position(p - x),
        cushion.position(p + y) - cushion.position(p - y),
    )
    return n / np.linalg.norm(n, axis=1, keepdims=True)


def test_surface_has_no_crease_except_in_the_trenches(cushion):
    """Over a step of 20 um the normal turns by curvature times step, by the crease in a trench."""
    rng = np.random.default_rng(1)
    p = rng.uniform(-0.33, 0.33, (4000, 2))
    p[:200, 0] = cushion.half[0] - cushion.corner_radius  # where corners begin
    p[200:400, 0] = cushion.half[0] - cushion.roll  # where the roll begins
    p = p[np.abs(np.abs(p[:, 0]) - cushion.trench_x(p[:, 1])) > 2e-3]
    angle = rng.uniform(0, 6.28, len(p))
    step = 1e-5 * np.column_stack([np.cos(angle), np.sin(angle)])
    turned = np.linalg.norm(normals(cushion, p + step) - normals(cushion, p - step), axis=1)
    assert turned.max() < 2e-5 * 60  # no curvature above 60 1/m
    trench = np.array([[cushion.trench_x(0.0), 0.0]])
    step = np.array([1e-5, 0])
    left, right = normals(cushion, trench + step)[0], normals(cushion, trench - step)[0]
    assert np.degrees(np.arccos(left @ right)) > 60


def test_trench_lips_are_convex_and_as_deep_as_specified(cushion):
    """Across the trench the section falls and rises again with convex lips only."""
    x = np.linspace(0.0, 0.20, 2001)
    z = cushion.top(x, np.zeros(2001))
    bottom = cushion.trench_x(0.0)
    assert x[z[500:].argmin() + 500] == pytest.approx(bottom, abs=1e-4)
    assert z[0] - z.min() == pytest.approx(cushion.pillow, abs=0.002)
    assert z.max() - z.min() == pytest.approx(cushion.trench_depth, abs=0.006)
    smooth = np.abs(x[1:-1] - bottom) > 2e-4
    assert np.diff(z, 2)[smooth].max() < 1e-12


def test_top_is_level_with_the_bolsters_where_front_and_rear_are_sewn_on(cushion):
    x = np.linspace(-0.2, 0.2, 401)
    for y in (-cushion.fade, cushion.fade):
        assert np.abs(np.diff(cushion.top(x, np.full(401, y)), 3)).max() < 1e-12


@pytest.mark.parametrize("end", [-1.0, 1.0])
def test_no_crease_runs_on_into_front_and_rear(cushion, end):
    """Where the seam round the top crosses the trench line, less than 1 % of the depth is left."""
    x = np.linspace(0.1, 0.17, 200)
    feet = np.column_stack([x, np.full(200, end * cushion.half[1])])
    seam = cushion.ring(feet, np.tile([0.0, end], (200, 1)), level=None)
    crossing = seam[np.abs(x - cushion.trench_x(seam[:, 1])).argmin(), 1]
    assert 0 <= cushion.depth_share(crossing) < 0.01
    assert cushion.depth_share(0.9 * crossing) > 0.05


def test_insert_is_convex_along_the_middle_plane(cushion):
    """A cover under tension would lift off a dish."""
    y = np.linspace(-0.3, 0.3, 601)
    z = cushion.top(np.zeros(601), y)
    assert np.diff(z, 2).max() < 0


def test_foam_is_closed_and_looks_outward(foam, solid_angle):
    assert mesh.boundary_loops(foam.faces) == []
    assert len(foam.vertices) - len(mesh.edges(foam.faces)) + len(foam.faces) == 2
    corners = foam.vertices[foam.faces]
    volume = np.einsum("md,md->m", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6
    assert 0.025 < volume < 0.035
    inside = np.array([[0, 0, 0.05], [0.2, 0.2, 0.05], [0.24, 0, 0.01]])
    outside = np.array([[0, 0, 0.15], [0.26, 0, 0.05], [0, 0, -0.01]])
    assert np.allclose(solid_angle(inside, foam.vertices, foam.faces), 1, atol=1e-9)
    assert np.allclose(solid_angle(outside, foam.vertices, foam.faces), 0, atol=1e-9)


def test_foam_lies_half_a_thickness_below_the_cover(surface, foam, solid_angle, cushion):
    """Except over the slots: 0.4 mm below the face centres is outside, 0.8 mm is inside."""
    up = mesh.face_normals(surface.vertices, surface.faces)
    middle = surface.vertices[surface.faces].mean(axis=1)
    away = np.abs(np.abs(middle[:, 0]) - cushion.trench_x(middle[:, 1])) > 0.012
    for depth, expected in ((0.0004, 0.0), (0.0008, 1.0)):
        points = (middle - depth * up)[away][::149]
        result = solid_angle(points, foam.vertices, foam.faces)
        assert result == pytest.approx(np.full(len(points), expected), abs=1e-9)


def test_foam_leaves_room_under_the_wires(foam, solid_angle, cushion):
    """A slot as deep as said in the middle of the trench, none where the trench has run out."""
    for wire in ("trench_left", "trench_right"):
        line = foam.curves[wire]
        deepest = line[np.abs(line[:, 1]).argmin()]
        for below, expected in ((0.8 * cushion.slot, 0.0), (1.4 * cushion.slot, 1.0)):
            point = deepest - [0, 0, below]
            assert solid_angle(point[None], foam.vertices, foam.faces) == pytest.approx(expected)
        ends = line[[1, -2]] - [0, 0, 0.0015]
        assert solid_angle(ends, foam.vertices, foam.faces) == pytest.approx(1.0)


def test_wires_lie_on_the_seams_and_frame_on_the_lower_edges(surface, foam):
    by_name = {side.name: side for side in sides(surface.patches())}
    pairs = {
        "trench_left": "INSERT.BOLSTER_L",
        "trench_right": "INSERT.BOLSTER_R",
        "frame_front": "FRONT.free",
        "frame_left": "SIDE_L.free",
        "frame_rear": "REAR.free",
        "frame_right": "SIDE_R.free",
    }
    assert set(foam.curves) == set(pairs)
    for curve, side in pairs.items():
        line = surface.vertices[by_name[side].vertices]
        ends = foam.curves[curve][[0, -1]]
        forward = np.abs(ends - line[[0, -1]]).max()
        backward = np.abs(ends[::-1] - line[[0, -1]]).max()
        assert min(forward, backward) < 1e-9
        lengths = [mesh.arc_length(c)[-1] for c in (line, foam.curves[curve])]
        assert lengths[0] == pytest.approx(lengths[1], rel=1e-9)


def test_same_arguments_same_surface(surface):
    again = demo_design(element_size=0.010)
    assert (again.vertices == surface.vertices).all()
