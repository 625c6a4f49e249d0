"""Every shape of the family, at sizes drawn at random: a sound surface, foam, wires, pattern."""

import warnings
from itertools import combinations

import numpy as np
import pytest

from seatlook import mesh
from seatlook.errors import InputWarning
from seatlook.flattening import flatten
from seatlook.mesh.closest import closest_places, distance_to_segments, pseudonormals
from seatlook.mesh.overlap import shared_area
from seatlook.seats import SHAPES, Cushion, demo_design, design_surface, foam_mesh, shaped

pytestmark = pytest.mark.first

ELEMENT = 0.014
PANEL_COUNTS = {
    "cushion": 7, "horseshoe": 10, "backrest": 8, "headrest": 3, "box": 2, "saddle": 2,
}  # fmt: skip


def sizes():
    """A size of each shape, drawn, and corners and a nearly flat one of the range of one."""
    rng = np.random.default_rng(1702)
    for name in SHAPES:
        for scale, bolster in rng.uniform((0.6, 0.0), (1.6, 0.1), (1, 2)):
            yield pytest.param((name, scale, bolster), id=f"{name}-{scale:.2f}-{1e3 * bolster:.0f}")
    for scale, bolster in ((0.6, 0.1), (1.6, 0.0), (1.0, 0.0045)):
        yield pytest.param(("horseshoe", scale, bolster), id=f"{scale}-{1e3 * bolster:g}")


@pytest.fixture(params=sizes(), scope="module")
def made(request):
    name, scale, bolster = request.param
    form = shaped(name, scale, bolster)
    return name, design_surface(form, element_size=ELEMENT), foam_mesh(form, element_size=ELEMENT)


def test_triangles_are_even_on_the_surface(made):
    """The gates of meshing hold in space too, where they were only asked for in the plane."""
    _, surface, _ = made
    smallest = np.degrees(mesh.angles(surface.vertices, surface.faces)).min(axis=1)
    assert smallest.min() > 18.0
    assert np.quantile(smallest, 0.01) > 28.0
    area = mesh.face_areas(surface.vertices, surface.faces)
    assert np.sqrt(area.mean() * 4 / np.sqrt(3)) == pytest.approx(ELEMENT, rel=0.1)


def test_foam_is_closed_and_looks_outward(made):
    _, _, foam = made
    assert mesh.boundary_loops(foam.faces) == []
    assert len(foam.vertices) - len(mesh.edges(foam.faces)) + len(foam.faces) == 2
    corner = foam.vertices[foam.faces]
    assert np.einsum("md,md->m", corner[:, 0], np.cross(corner[:, 1], corner[:, 2])).sum() > 0
    assert len(mesh.intersecting_pairs(foam.vertices, foam.faces)) == 0


def test_cover_lies_outside_its_foam_but_close(made):
    _, surface, foam = made
    middle = surface.vertices[surface.faces].mean(axis=1)
    place = closest_places(middle, foam.vertices, foam.faces, reach=np.inf)
    normal, _ = pseudonormals(foam.vertices, foam.faces, place)
    height = np.einsum("kd,kd->k", place.offset, normal)
    assert height.min() > 0.0
    assert np.median(height) == pytest.approx(0.0006, abs=1e-5)
    assert height.max() < 0.004  # over a tie-down's room


def test_wires_lie_on_seams(made):
    """Every point of a wire lies on an edge between two panels."""
    _, surface, foam = made
    for wire in foam.curves.values():
        edge = seam_edges(surface)
        away = distance_to_segments(
            wire, surface.vertices[edge[:, 0]], surface.vertices[edge[:, 1]]
        )
        assert away.max() < 0.0015  # chords of the wire and of the mesh


def seam_edges(surface):
    owner = {}
    for face, panel in zip(surface.faces.tolist(), surface.panel.tolist(), strict=True):
        for a, b in zip(face, face[1:] + face[:1], strict=True):
            owner[a, b] = panel
    return np.array([(a, b) for (a, b), p in owner.items() if owner.get((b, a), p) != p])


def test_panels_and_border(made):
    name, surface, _ = made
    assert len(surface.panel_names) == PANEL_COUNTS[name]
    assert set(surface.panel.tolist()) == set(range(len(surface.panel_names)))
    assert len(mesh.boundary_loops(surface.faces)) == 1


def test_every_size_flattens(made):
    _, surface, _ = made
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)  # high bolsters strain; see the measurements
        flat = flatten(surface, tension=0.01)
    assert max(panel.rms for panel in flat.panels) < 0.09
    assert max(abs(seam.difference) for seam in flat.seams) < 5e-5
    starts = [pose.at(flat.pattern.panel(n).outline) for n, pose in flat.placement.items()]
    assert all(shared_area(one, two) == 0.0 for one, two in combinations(starts, 2))


@pytest.mark.parametrize("name", SHAPES)
def test_left_is_right_mirrored(name):
    form = shaped(name, 0.9, 0.04)
    line = np.concatenate(list(form.drawing().lines.values()))
    left, right = form.position(line), form.position(line * [-1, 1])
    assert np.allclose(left * [-1, 1, 1], right, atol=1e-12)


def test_the_cushion_of_the_family_is_the_demo():
    assert Cushion.sized(1.0, 0.013) == pytest.approx(Cushion())
    surface = design_surface(shaped("cushion", 1.0, 0.013), element_size=0.012)
    demo = demo_design(element_size=0.012)
    assert set(surface.panel_names) == set(demo.panel_names)
    for name in demo.panel_names:
        areas = [
            mesh.face_areas(s.vertices, s.faces)[s.panel == s.panel_names.index(name)].sum()
            for s in (surface, demo)
        ]
        assert areas[0] == pytest.approx(areas[1], rel=0.01)


def test_higher_bolsters_stand_higher():
    for name in ("cushion", "horseshoe"):
        heights = [
            np.ptp(design_surface(shaped(name, 1.0, b), element_size=0.014).vertices[:, 2])
            for b in (0.0, 0.05, 0.1)
        ]
        assert np.diff(heights) == pytest.approx([0.05, 0.05], abs=0.012)


def test_twice_the_size_is_twice_the_size():
    for name in ("headrest", "box", "saddle"):
        sizes = [
            np.ptp(design_surface(shaped(name, s, 0.0), element_size=0.014).vertices, axis=0)
            for s in (0.7, 1.4)
        ]
        assert sizes[1] == pytest.approx(2 * sizes[0], rel=0.01)
