"""Where panels start and where free borders are laid, on foams of plain shapes."""

from __future__ import annotations

from itertools import combinations, pairwise

import numpy as np
import pytest
import shapely

from seatlook import io
from seatlook.assembly.sewn_surface import free_borders
from seatlook.assembly.unfolding import lay_out
from seatlook.mesh import arc_length
from seatlook.model import Edge, Foam, Panel, Pattern, Seam

TURN = np.linspace(0.0, 2 * np.pi, 81)[:-1]


def box_foam(width: float, depth: float, height: float, lean_deg: float = 0.0) -> Foam:
    """A sharp box on the floor, leaning back."""
    corners = np.array([[x, y, z] for z in (0, 1) for y in (-0.5, 0.5) for x in (-0.5, 0.5)])
    corners = corners * [width, depth, height]
    c, s = np.cos(np.radians(lean_deg)), np.sin(np.radians(lean_deg))
    corners = corners @ np.array([[1, 0, 0], [0, c, s], [0, -s, c]])
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (1, 3, 7, 5), (3, 2, 6, 7), (2, 0, 4, 6)]
    faces = np.array([f for a, b, c, d in quads for f in ((a, b, c), (a, c, d))], dtype=np.int64)
    material = io.read_foam_material("foam-seat")
    return Foam(vertices=np.ascontiguousarray(corners), faces=faces, material=material)


def panel(name: str, outline: np.ndarray, corners: list[int]) -> Panel:
    return Panel(
        name=name, outline=np.ascontiguousarray(outline, dtype=np.float64),
        corners=np.array(corners, dtype=np.int64), cut_outline=outline.copy(),
        grain=np.array([0.0, 1.0]),
    )  # fmt: skip


def strip(name: str, length: float, height: float, parts: int = 40) -> tuple[Panel, list[Edge]]:
    """A rectangle with edges bottom, right, top, left, its long ones cut in parts."""
    x = np.linspace(0.0, length, parts + 1)
    outline = np.concatenate(
        [np.column_stack([x, 0 * x]), np.column_stack([x[::-1], 0 * x + height])]
    )
    stops = [0, parts, parts + 1, 2 * parts + 1]
    words = ("bottom", "right", "top", "left")
    edges = [
        Edge(name=f"{name}.{word}", panel=name, start=a, end=b)
        for word, (a, b) in zip(words, pairwise([*stops, 0]), strict=True)
    ]
    return panel(name, outline, stops), edges


def boxed(size: float, height: float) -> Pattern:
    """A round top, and a strip about it that is closed by one seam."""
    radius = size / 2
    disc = radius * np.column_stack([np.sin(TURN), -np.cos(TURN)])
    girth = float(arc_length(np.vstack([disc, disc[:1]]))[-1])
    side, edges = strip("BOXING", girth, height)
    rim = Edge(name="TOP.rim", panel="TOP", start=0, end=0)
    return Pattern(
        panels=(panel("TOP", np.roll(disc, -40, axis=0), [0]), side),
        edges={edge.name: edge for edge in (rim, *edges)},
        seams=(
            Seam(name="TOP-BOXING", a="TOP.rim", b=("BOXING.top",)),
            Seam(name="BOXING", a="BOXING.left", b=("BOXING.right",)),
        ),
    )


def test_a_strip_that_is_closed_leaves_one_border():
    assert free_borders(boxed(0.5, 0.1)) == (("BOXING.bottom",),)


def test_a_tube_has_two_borders_and_a_panel_without_seams_its_outline():
    side, edges = strip("TUBE", 0.8, 0.3)
    named = {edge.name: edge for edge in edges}
    seam = Seam(name="TUBE", a="TUBE.left", b=("TUBE.right",))
    tube = Pattern(panels=(side,), edges=named, seams=(seam,))
    assert set(free_borders(tube)) == {("TUBE.bottom",), ("TUBE.top",)}
    (whole,) = free_borders(Pattern(panels=(side,), edges=named, seams=()))
    assert whole == ("TUBE.bottom", "TUBE.right", "TUBE.top", "TUBE.left")


def test_a_border_with_a_stretch_without_name_is_left_out():
    side, edges = strip("TUBE", 0.8, 0.3)
    named = {edge.name: edge for edge in edges if edge.name != "TUBE.top"}
    seam = Seam(name="TUBE", a="TUBE.left", b=("TUBE.right",))
    assert free_borders(Pattern(panels=(side,), edges=named, seams=(seam,))) == (("TUBE.bottom",),)


def test_the_border_of_a_box_runs_round_it_where_the_cloth_ends():
    foam = box_foam(0.4, 0.4, 0.15)
    layout = lay_out(boxed(0.5, 0.1), foam)
    (border,) = layout.borders
    assert border.name == "border"
    np.testing.assert_allclose(border.curve[0], border.curve[-1], atol=1e-12)
    # The cloth reaches over the top and down the sides; what it leaves is the floor and a rest.
    cloth = np.pi * 0.25**2 + np.pi * 0.5 * 0.1
    assert border.curve[:, 2] == pytest.approx(0.15 - (cloth - 0.16) / 1.6, abs=0.003)
    # Seen from above it runs counter-clockwise, as outlines do.
    assert shapely.LinearRing(border.curve[:-1, :2]).is_ccw
    # The strip's ends meet behind, opposite to where its middle hangs.
    assert border.curve[0, 1] > 0.15


@pytest.mark.parametrize("lean", [-25.0, 0.0, 20.0])
def test_the_border_of_a_foam_that_leans_leans_with_it(lean):
    foam = box_foam(0.4, 0.15, 0.4, lean)
    (border,) = lay_out(boxed(0.5, 0.1), foam).borders
    away = border.curve - border.curve.mean(axis=0)
    normal = np.linalg.svd(away)[2][2]
    c, s = np.cos(np.radians(lean)), np.sin(np.radians(lean))
    assert abs(normal @ [0.0, c, s]) == pytest.approx(1.0, abs=1e-6)


@pytest.mark.parametrize("size", [(0.49, 0.55, 0.12), (0.6, 0.6, 0.1), (0.3, 0.3, 0.3)])
def test_panels_that_start_in_one_plane_lie_beside_each_other(demo_scene, size):
    pattern = io.load_scene(demo_scene).pattern
    layout = lay_out(pattern, box_foam(*size))
    for one, other in combinations(pattern.panels, 2):
        pose = layout.poses[one.name]
        other_pose = layout.poses[other.name]
        world = other.outline @ other_pose.rotation[:, :2].T + other_pose.translation
        flat = (world - pose.translation) @ pose.rotation
        if np.abs(flat[:, 2]).max() > 1e-3:
            continue
        shared = shapely.Polygon(one.outline).intersection(shapely.Polygon(flat[:, :2])).area
        assert shared < 0.01 * min(one.area, other.area)
