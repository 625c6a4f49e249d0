import numpy as np
import pytest

from seatlook import mesh
from seatlook.errors import InputError
from seatlook.flattening import DesignSurface, flatten


def half_pipe(radius=0.1, turn=1.5, length=0.16, h=0.008):
    """Part of a cylinder along y cut into two panels by a seam at its top."""
    half = radius * turn / 2
    corners = np.array([[-half, 0], [half, 0], [half, length], [-half, length], [-half, 0]])
    stops = [corners[0], [0, 0], corners[1], corners[2], [0, length], corners[3], corners[0]]
    rim = np.concatenate(
        [mesh.resample(np.array(stops[i : i + 2]), h)[:-1] for i in range(len(stops) - 1)]
    )
    seam = mesh.resample(np.array([[0, 0], [0, length]]), h)
    flat, faces = mesh.triangulate(rim, h, lines=[seam])
    angle = flat[:, 0] / radius
    space = np.column_stack([radius * np.sin(angle), flat[:, 1], radius * np.cos(angle)])
    panel = (flat[faces].mean(axis=1)[:, 0] < 0).astype(np.int64)
    surface = DesignSurface(vertices=space, faces=faces, panel=panel, panel_names=("L", "R"))
    return surface, flat


def width(panel):
    return np.ptp(panel.outline[:, 0])


def test_developable_panels_come_out_exactly():
    surface, flat = half_pipe(h=0.005)
    result = flatten(surface)
    for patch, name in zip(surface.patches(), "LR", strict=True):
        exact = flat[patch.source]
        moved = result.flat[name] - result.flat[name].mean(axis=0)
        rotation, _ = np.linalg.qr(np.eye(2))
        assert np.abs(moved - (exact - exact.mean(axis=0)) @ rotation.T).max() < 1e-4 * 0.16
    assert np.abs(result.strain).max() < 1e-3
    assert [p.panel for p in result.panels] == ["L", "R"]
    assert max(p.rms for p in result.panels) < 2e-4


def test_demo_seams_are_equally_long(flattened):
    assert len(flattened.seams) == 14
    for seam in flattened.seams:
        assert abs(seam.difference) < 1e-4
        assert seam.a == pytest.approx(seam.design, rel=0.016)


def test_demo_seams_match_piece_by_piece(flattened):
    pattern = flattened.pattern
    for seam in pattern.seams:
        a, b = pattern.edge_points(seam.a), pattern.edge_points(seam.b[0])[::-1]
        assert np.abs(mesh.arc_length(a) - mesh.arc_length(b)).max() < 1e-4


def test_demo_strain_is_small(flattened, surface):
    assert flattened.strain.shape == (len(surface.faces), 2)
    for panel in flattened.panels:
        assert panel.rms < 0.012
        assert panel.smallest > -0.04
        assert panel.largest < 0.04
    assert sum(p.area for p in flattened.panels) == pytest.approx(0.42, abs=0.02)


def test_strain_report_is_that_of_the_faces(flattened, surface):
    """Each principal strain weighs with the face's area on the form."""
    for i, panel in enumerate(flattened.panels):
        own = surface.panel == i
        area = mesh.face_areas(surface.vertices, surface.faces[own])
        strain = flattened.strain[own]
        assert panel.mean == pytest.approx(np.average(strain.mean(axis=1), weights=area))
        assert panel.rms == pytest.approx(
            np.sqrt(np.average((strain**2).mean(axis=1), weights=area))
        )
        assert (strain[:, 0] <= strain[:, 1]).all()


def test_panels_are_face_up_with_the_front_below(flattened):
    """Counter-clockwise outlines; on the top panels the rear is up and the left is right."""
    for panel in flattened.pattern.panels:
        x, y = panel.outline.T
        assert 0.5 * np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)) > 0
        assert panel.grain.tolist() == [0, 1]
    pattern = flattened.pattern
    front, rear = (pattern.edge_points(f"INSERT.{n}").mean(axis=0) for n in ("FRONT", "REAR"))
    left, right = (pattern.edge_points(f"INSERT.BOLSTER_{n}").mean(axis=0) for n in ("L", "R"))
    assert rear[1] - front[1] > 0.5
    assert left[0] - right[0] > 0.25
    top, low = (pattern.edge_points(f"FRONT.{n}").mean(axis=0) for n in ("INSERT", "free"))
    assert top[1] > low[1]


def test_pattern_is_mirrored_left_to_right(flattened):
    for left, right in (("BOLSTER_L", "BOLSTER_R"), ("SIDE_L", "SIDE_R")):
        a, b = flattened.pattern.panel(left), flattened.pattern.panel(right)
        assert width(a) == pytest.approx(width(b), rel=2e-3)
        areas = [p.area for p in flattened.panels if p.panel in (left, right)]
        assert areas[0] == pytest.approx(areas[1], rel=1e-3)


def test_poses_are_rigid_and_keep_the_visible_side_out(flattened, surface):
    for patch in surface.patches():
        pose = flattened.placement[patch.name]
        assert np.allclose(pose.rotation @ pose.rotation.T, np.eye(3), atol=1e-12)
        assert np.linalg.det(pose.rotation) == pytest.approx(1)
        outward = mesh.face_vectors(patch.vertices, patch.faces).sum(axis=0)
        assert pose.rotation[:, 2] @ outward / np.linalg.norm(outward) > 0.99
        placed = flattened.flat[patch.name] @ pose.rotation[:, :2].T + pose.translation
        gap = placed - patch.vertices
        assert 0.02 < np.linalg.norm(gap.mean(axis=0)) < 0.05
        assert np.linalg.norm(gap - gap.mean(axis=0), axis=1).max() < 0.06


def test_waiting_panels_are_clear_of_the_foam(flattened, surface, foam, solid_angle):
    for patch in surface.patches():
        pose = flattened.placement[patch.name]
        placed = flattened.flat[patch.name] @ pose.rotation[:, :2].T + pose.translation
        inside = solid_angle(placed[::31], foam.vertices, foam.faces) > 0.5
        assert not inside.any(), patch.name


def test_sharp_corners_of_free_edges_are_corners():
    surface, _ = half_pipe()
    for panel in flatten(surface).pattern.panels:
        assert len(panel.corners) == 4
        low, high = panel.outline.min(axis=0), panel.outline.max(axis=0)
        box = [[low[0], low[1]], [high[0], low[1]], [high[0], high[1]], [low[0], high[1]]]
        result = panel.outline[panel.corners]
        gaps = np.linalg.norm(result[:, None] - np.array(box)[None], axis=2)
        assert gaps.min(axis=0).max() < 1e-4


@pytest.mark.parametrize("name", ["L.R", "L-R"])
def test_ease_lengthens_one_sewing_line_only(name):
    surface, _ = half_pipe()
    plain = flatten(surface).seams[0]
    eased = flatten(surface, ease={name: 0.02}).seams[0]
    assert eased.a / plain.a == pytest.approx(1.02, abs=2e-4)
    assert eased.b == pytest.approx(plain.b, rel=1e-4)
    assert eased.difference == pytest.approx(0.02 * plain.b, rel=0.02)


def test_ease_fades_into_the_panel_and_spares_the_others():
    surface, _ = half_pipe()
    strain = flatten(surface, ease={"R.L": 0.03}).strain
    middle = surface.vertices[surface.faces].mean(axis=1)
    near = (surface.panel == 1) & (middle[:, 0] > -0.01)
    far = (surface.panel == 1) & (middle[:, 0] < -0.06)
    assert strain[near, 0].mean() == pytest.approx(-0.03 / 1.03, abs=0.004)
    assert strain[far, 0].mean() > -0.006
    assert np.abs(strain[surface.panel == 0]).max() < 2e-3


def test_eased_line_stays_smooth_and_nearly_even():
    """A chain of held lengths would crumple; every piece takes its part of the ease instead."""
    surface, _ = half_pipe()
    plain = flatten(surface).pattern.edge_points("L.R")
    line = flatten(surface, ease={"L.R": 0.04}).pattern.edge_points("L.R")
    step = np.diff(line, axis=0)
    ratio = np.hypot(*step.T) / np.hypot(*np.diff(plain, axis=0).T)
    assert ratio.min() > 1.025
    assert ratio.max() < 1.06
    turn = np.diff(np.unwrap(np.arctan2(step[:, 1], step[:, 0])))
    assert np.degrees(np.abs(np.diff(turn)).max()) < 0.5


def test_demo_takes_an_ease_of_four_percent(surface, flattened):
    eased = flatten(surface, ease={"INSERT-BOLSTER_L": 0.04})
    plain = {seam.seam: seam for seam in flattened.seams}
    for seam in eased.seams:
        grown = 1.04 if seam.seam == "INSERT-BOLSTER_L" else 1.0
        assert seam.a == pytest.approx(grown * plain[seam.seam].a, rel=2e-4)
        assert seam.b == pytest.approx(plain[seam.seam].b, rel=2e-4)


def test_a_short_panel_is_narrower_and_not_shorter():
    surface, _ = half_pipe()
    plain, short = flatten(surface), flatten(surface, short={"R": 0.03})
    a, b = plain.pattern.panel("R"), short.pattern.panel("R")
    assert width(b) / width(a) == pytest.approx(0.97, abs=1e-9)
    assert np.ptp(b.outline[:, 1]) == pytest.approx(np.ptp(a.outline[:, 1]), rel=1e-9)
    assert width(short.pattern.panel("L")) == pytest.approx(width(plain.pattern.panel("L")))
    assert short.strain[surface.panel == 1, 1].mean() == pytest.approx(0.031, abs=1e-3)


def test_tension_makes_everything_smaller():
    surface, _ = half_pipe()
    plain, tight = flatten(surface), flatten(surface, tension=0.01)
    for a, b in zip(plain.pattern.panels, tight.pattern.panels, strict=True):
        assert np.ptp(b.outline, axis=0) == pytest.approx(0.99 * np.ptp(a.outline, axis=0))
    assert tight.strain.mean() == pytest.approx(0.0101, abs=2e-4)


def test_wrong_names_and_fractions_are_all_named():
    surface, _ = half_pipe(h=0.02)
    with pytest.raises(InputError) as caught:
        flatten(surface, ease={"L.Q": 0.02, "R.L": 0.5})
    assert str(caught.value).splitlines() == [
        "ease: got 'L.Q', expected one of L.R, R.L (did you mean 'L.R'?)",
        "ease R.L: got 0.5, expected -0.2 to 0.2",
    ]
    with pytest.raises(InputError, match=r"short: got 'X', expected one of L, R"):
        flatten(surface, short={"X": 0.1})
    with pytest.raises(InputError, match=r"tension: got nan, expected -0\.2 to 0\.2"):
        flatten(surface, tension=float("nan"))
