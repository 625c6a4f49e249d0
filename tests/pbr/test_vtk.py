"""The fence: faces seen are those a ray meets; what goes wrong in GL is raised."""

from __future__ import annotations

import numpy as np
import pytest

from seatlook.errors import RenderError
from seatlook.model import Camera, named_view
from seatlook.pbr.kernels import bvh
from seatlook.pbr.kernels.surface import ray_through
from seatlook.pbr.shading.eye import eye_of
from support.reference.lit_sheets import above, sheet

pytestmark = pytest.mark.render


@pytest.fixture(scope="module")
def window():
    from seatlook.pbr._vtk import face_window

    return face_window()


def bumps(x, y):
    return 0.02 * np.sin(40 * x) * np.cos(30 * y)


def by_rays(solution, camera):
    tree = bvh.build(np.array(solution.positions), np.array(solution.cover.faces))
    eye, (width, height), stack = eye_of(camera, 1), camera.size, bvh.new_stack()
    ids = np.full((height, width), -1)
    for j in range(height):
        for i in range(width):
            leaf = bvh.nearest(tree, *eye.origin, *ray_through(eye, i, j), 0.0, stack)[0]
            ids[j, i] = -1 if leaf < 0 else tree.face[leaf]
    return ids


@pytest.mark.parametrize("size", [(80, 45), (45, 80), (64, 64), (7, 3), (1, 1)])
def test_faces_are_those_a_ray_meets(window, size):
    solution = sheet(bumps, steps=16)
    camera = named_view("front_34", target=np.zeros(3), size=size, distance=0.5)
    ids = window.faces(solution.positions, solution.cover.faces, camera, size)
    rays = by_rays(solution, camera)
    assert ids.shape == (size[1], size[0])
    # Only samples on an edge may go to either side.
    assert (ids != rays).sum() <= max(1, 0.004 * ids.size)


@pytest.mark.parametrize("size", [(80, 45), (45, 80), (61, 7)])
def test_parts_of_a_picture_are_the_picture(window, monkeypatch, size):
    """Above a size the window draws one part after the other."""
    from seatlook.pbr import _vtk

    solution = sheet(bumps, steps=16)
    camera = named_view("front_34", target=np.zeros(3), size=size, distance=0.5)
    whole = window.faces(solution.positions, solution.cover.faces, camera, size)
    monkeypatch.setattr(_vtk, "_LARGEST", 20)
    seen, count = np.full(whole.shape, -9), 0
    for part in _vtk.parts_of(size):
        count += 1
        assert (seen[part.lines, part.columns] == -9).all()
        mesh = (solution.positions, solution.cover.faces)
        seen[part.lines, part.columns] = window.faces(*mesh, camera, size, part)
        assert max(part.width, part.height) <= 20
    assert count >= 4
    assert (seen != whole).sum() <= max(1, 0.004 * whole.size)


def test_shader_that_does_not_compile_is_raised(capfd):
    from seatlook.pbr._vtk import FaceWindow

    broken = FaceWindow()
    broken._actor.GetShaderProperty().ClearAllFragmentShaderReplacements()
    broken._actor.GetShaderProperty().AddFragmentShaderReplacement(
        "//VTK::Light::Impl", True, "this is no GLSL;", False
    )
    solution = sheet(bumps, steps=2)
    with pytest.raises(RenderError, match="VTK reported: ERROR: In vtkShaderProgram"):
        broken.faces(solution.positions, solution.cover.faces, above(), (8, 8))
    assert capfd.readouterr().err == ""


def test_frame_without_face_numbers_is_raised():
    from seatlook.pbr._vtk import FaceWindow

    stock = FaceWindow()
    stock._actor.GetShaderProperty().ClearAllFragmentShaderReplacements()
    solution = sheet(bumps, steps=2)
    with pytest.raises(RenderError, match="holds no face numbers"):
        stock.faces(solution.positions, solution.cover.faces, above(fov=5.0), (8, 8))


def test_same_frame_twice_and_after_another(window):
    solution, other = sheet(bumps, steps=16), sheet(bumps, steps=3)
    camera = above(size=(40, 30))
    first = window.faces(solution.positions, solution.cover.faces, camera, (40, 30))
    window.faces(other.positions, other.cover.faces, camera, (90, 10))
    again = window.faces(solution.positions, solution.cover.faces, camera, (40, 30))
    assert (first == again).all()


def test_camera_along_its_up_vector_is_refused():
    camera = Camera(name="lost", position=np.array([0.0, 0.0, 1.0]), target=np.zeros(3))
    with pytest.raises(ValueError, match=r"camera lost: .*up vector across the view"):
        eye_of(camera, 1)


def test_describe_names_the_driver(window):
    assert "OpenGL renderer" in window.describe()
