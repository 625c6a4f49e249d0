"""Cut-outs of panels: the cover has them, their borders are free, nothing is measured there."""

from dataclasses import replace

import numpy as np
import pytest

from seatlook import assemble
from seatlook.errors import InputError
from seatlook.mesh import boundary_loops, face_areas
from seatlook.model.zones import FREE_EDGE
from support.scenes import two_panels


def with_hole(hole, element_size=0.01):
    scene = two_panels(element_size=element_size)
    left, right = scene.pattern.panels
    panels = (replace(left, holes=(np.array(hole, dtype=float),)), right)
    return replace(scene, pattern=replace(scene.pattern, panels=panels))


def circle(x, y, radius, count=40):
    t = np.linspace(0, 2 * np.pi, count, endpoint=False)
    return np.column_stack([x + radius * np.cos(t), y + radius * np.sin(t)])


@pytest.mark.parametrize("radius", [0.006, 0.015, 0.03])
def test_the_mesh_of_a_panel_has_its_hole(radius):
    cover = assemble(with_hole(circle(0.05, 0.05, radius)))
    assert len(boundary_loops(cover.faces)) == 3  # of two panels and the hole
    rim = boundary_loops(cover.faces)
    (hole,) = [k for k in rim if np.linalg.norm(cover.uv[k] - 0.05, axis=1).max() < 0.04]
    assert np.linalg.norm(cover.uv[hole] - 0.05, axis=1) == pytest.approx(radius, rel=5e-3)
    near = np.linalg.norm(cover.uv[cover.faces].mean(axis=1) - 0.05, axis=1) < radius + 0.01
    left = cover.panel == 0
    assert {cover.zone_names[z] for z in cover.zone[near & left]} == {FREE_EDGE}


def test_a_square_hole_keeps_its_corners_and_its_area():
    corners = [[0.03, 0.03], [0.06, 0.03], [0.06, 0.07], [0.03, 0.07]]
    scene = with_hole(corners)
    cover = assemble(scene)
    area = face_areas(cover.uv, cover.faces)[cover.panel == 0].sum()
    assert area == pytest.approx(0.1 * 0.1 - 0.03 * 0.04, rel=1e-9)
    assert scene.pattern.panels[0].area == pytest.approx(area, rel=1e-9)


def test_a_hole_narrower_than_an_element_is_refused_with_a_way_on():
    with pytest.raises(InputError) as caught:
        assemble(with_hole(circle(0.05, 0.05, 0.004)))
    (problem,) = caught.value.problems
    assert problem.key == "panel.LEFT"
    assert problem.got == "a cut-out 7.98 mm wide near (50, 50) mm"
    assert "element_size_mm" in problem.hint
    assert "smallest_notch_mm" in problem.hint
