"""No panel is ever folded over, however curved it is; what it costs is said, with the place."""

import warnings

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from seatlook import mesh
from seatlook.errors import InputWarning, SeatlookError
from seatlook.flattening import flatten
from seatlook.flattening.face_map import area_ratios, gradient_of, largest_step, stretches
from seatlook.flattening.relax import flatten_patch
from seatlook.flattening.start import conformal_map, dirichlet_map, tutte_map, unfolded_start
from support.curved_panels import box, cone, cup, half_ellipsoid, lid, one_panel
from support.fabrics import isotropic
from support.rolls import rolled, sheet


def turned(flat, faces):
    a, b, c = flat[faces].transpose(1, 2, 0)
    return int((((b - a)[0] * (c - a)[1] - (b - a)[1] * (c - a)[0]) <= 0).sum())


def turned_faces(surface, result):
    return sum(turned(result.flat[p.name], p.faces) for p in surface.patches())


@pytest.mark.parametrize("depth", [0.02, 0.04, 0.06, 0.1, 0.16, 0.24])
def test_a_box_of_one_piece_is_never_folded(depth):
    surface = one_panel(*box(depth))
    with pytest.warns(InputWarning, match=r"panel CAP is stretched by \d+\.\d % near \["):
        result = flatten(surface)
    assert turned_faces(surface, result) == 0
    assert result.strain.max() < 1.2  # steps of Green's energy alone went to 9.5


@pytest.mark.parametrize(("cells", "depth"), [(4, 0.02), (4, 0.04), (8, 0.04)])
def test_a_lid_sewn_to_its_walls_is_never_folded(cells, depth):
    surface = lid(depth, cells=cells)
    with pytest.warns(InputWarning, match="panel LID"):
        result = flatten(surface)
    assert turned_faces(surface, result) == 0
    assert max(abs(seam.difference) for seam in result.seams) < 5e-5
    assert [excess.panel for excess in result.excess] == ["LID"]


@pytest.mark.parametrize("height", [0.03, 0.06, 0.09])
@pytest.mark.parametrize("size", [0.3, 0.14, 0.07])
def test_half_an_ellipsoid_is_never_folded(height, size):
    surface = one_panel(*half_ellipsoid(height, size=size))
    with pytest.warns(InputWarning, match="panel CAP"):
        result = flatten(surface)
    assert turned_faces(surface, result) == 0
    assert result.panels[0].rms < {0.03: 0.035, 0.06: 0.075, 0.09: 0.14}[height]


@settings(max_examples=20, deadline=None, derandomize=True)
@given(
    shape=st.sampled_from(["cup", "box", "ellipsoid"]),
    depth=st.floats(0.005, 0.3),
    length=st.floats(0.05, 0.4),
    power=st.floats(2.0, 10.0),
    size=st.floats(0.15, 0.4),
)
def test_no_random_shape_is_folded(shape, depth, length, power, size):
    if shape == "cup":
        vertices, faces = cup(depth, power=power, length=length, size=size)
    elif shape == "box":
        vertices, faces = box(depth, cells=round(1 / size), length=length)
    else:
        vertices, faces = half_ellipsoid(depth, length=length, size=size)
    assert turned(flatten_patch(vertices, faces), faces) == 0


def test_cylinder_and_cone_are_flattened_without_strain():
    flat, faces = sheet()
    surface = one_panel(rolled(flat, 0.08), faces)
    assert np.abs(flatten(surface).strain).max() < 1e-3
    vertices, _, faces = cone(0.5, size=0.006)
    result = flatten(one_panel(vertices, faces))
    assert np.abs(result.strain).max() < 1e-3
    assert result.excess == ()


def test_tutte_turns_no_face_where_the_conformal_map_does():
    vertices, faces = box(0.24)
    assert turned(conformal_map(vertices, faces), faces) > 0
    assert turned(tutte_map(vertices, faces), faces) == 0
    assert turned(unfolded_start(vertices, faces), faces) == 0


def test_dirichlet_map_of_a_sheet_is_the_sheet():
    flat, faces = sheet(h=0.01)
    space = rolled(flat, 0.1)
    gradient, area = gradient_of(space, faces), mesh.face_areas(space, faces)
    x = dirichlet_map(tutte_map(space, faces), gradient, area)
    assert np.abs(stretches(space, faces, x) - 1).max() < 5e-3


def test_the_largest_step_stops_before_a_face_has_no_area():
    """A corner that moves by 2 over the base 1 away is stopped at 0.8 of half its way."""
    x = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    gradient = gradient_of(np.column_stack([x, np.zeros(3)]), np.array([[0, 1, 2]]))
    down = np.array([[0.0, 0.0], [0.0, 0.0], [0.0, -2.0]])
    assert largest_step(x, down, gradient) == pytest.approx(0.4)
    assert largest_step(x, -down, gradient) == 1.0
    assert largest_step(x, 0 * down, gradient) == 1.0
    # All corners shrink to one point: a double root.
    assert largest_step(x, -2 * x, gradient) == pytest.approx(0.4)


@settings(max_examples=60, deadline=None)
@given(seed=st.integers(0, 10_000))
def test_no_random_step_turns_a_face(seed):
    flat, faces = sheet(h=0.02)
    space = np.column_stack([flat, np.zeros(len(flat))])
    step = np.random.default_rng(seed).normal(scale=0.05, size=flat.shape)
    gradient = gradient_of(space, faces)
    scale = largest_step(flat, step, gradient)
    assert (area_ratios(flat + scale * step, gradient) > 0).all()
    assert (area_ratios(flat + 1.3 * scale * step, gradient) <= 0).any() == (scale < 1)


def test_a_dart_leads_from_the_border_to_the_place():
    surface = one_panel(*half_ellipsoid(0.09))
    with pytest.warns(InputWarning, match=r"sew a dart from \[.*\] to \[.*\] mm"):
        excess = flatten(surface).excess[0]
    assert excess.dart[0, 2] == pytest.approx(0.0, abs=1e-9)
    assert excess.dart[-1, 2] > 0.06
    assert excess.limit == 0.05
    assert 0.02 < excess.area < 0.06


def test_a_limit_comes_from_the_curve_of_the_fabric():
    surface = one_panel(*half_ellipsoid(0.06))
    soft = isotropic(2000.0)  # 340 N/m at a Green strain of 0.17
    with pytest.warns(InputWarning):
        result = flatten(surface, fabrics={"CAP": soft})
    assert result.excess[0].limit == pytest.approx(np.sqrt(1.34) - 1, abs=2e-4)


@pytest.mark.parametrize("shape", [box(0.24), cup(0.2), half_ellipsoid(0.09)])
def test_a_fabric_neither_folds_nor_leaves_cloth_without_bound(shape):
    """The energy of a fabric gives way to cloth that is much too much: faces grew 14 times."""
    surface = one_panel(*shape)
    with pytest.warns(InputWarning, match="panel CAP"):
        result = flatten(surface, fabrics={"CAP": isotropic(8000.0)})
    assert turned_faces(surface, result) == 0
    assert result.strain.min() > -0.65
    assert result.strain.max() < 1.2


def test_an_outline_that_crosses_itself_is_named_with_panel_and_place():
    """A spiral ramp of more than a turn lies over itself in the plane."""
    turn = np.linspace(0, 2.4 * np.pi, 60)
    rim = [r * np.column_stack([np.cos(turn), np.sin(turn), 0.2 * turn]) for r in (0.1, 0.2)]
    rim[1][:, 2] = rim[0][:, 2]
    a, b = np.arange(59), np.arange(59) + 60
    faces = np.concatenate([np.column_stack([a, b, b + 1]), np.column_stack([a, b + 1, a + 1])])
    vertices = np.concatenate(rim) * [1, 1, 0.3]
    with pytest.raises(SeatlookError, match=r"panel CAP: its flat outline crosses .* near \[.* mm"):
        flatten(one_panel(vertices, faces), allowance=0.0)


def test_a_face_without_area_is_named_with_panel_and_place():
    vertices, faces = box(0.02)
    vertices = vertices.copy()
    a, b, c = faces[0]
    vertices[c] = 0.5 * (vertices[a] + vertices[b])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        with pytest.raises(SeatlookError, match=r"panel CAP: .*near \[.* mm"):
            flatten(one_panel(vertices, faces))
