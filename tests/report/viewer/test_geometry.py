"""The triangles that are sent: all of the drawn surface, panel by panel."""

from __future__ import annotations

import numpy as np
import pytest

from seatlook.pbr.shading.studio import Studio
from seatlook.report.viewer.geometry import add_geometry, triangles_of
from seatlook.report.viewer.pack import Buffers
from support.reference.lit_sheets import flat, sheet

pytestmark = pytest.mark.render


@pytest.fixture(scope="module")
def stage():
    return Studio(sheet(flat, steps=8))


def area(vertices, faces):
    a, b, c = (vertices[corner] for corner in faces.T)
    return np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2


def test_triangles_cover_the_panels_once(stage):
    sent, mesh = triangles_of(stage), stage.surface.mesh
    vertices = mesh.vertices[sent.used]
    first, count, refined = sent.parts[0]
    assert (first, count) == (0, refined)
    assert refined == sent.children * len(stage.surface.coarse_faces)
    whole = area(mesh.vertices, mesh.faces[: stage.surface.faces])
    assert area(vertices, sent.faces[:refined]) == pytest.approx(whole, rel=1e-6)


def test_each_triangle_lies_in_the_solvers_face_that_it_stands_for(stage):
    sent = triangles_of(stage)
    surface = stage.surface
    middle = surface.mesh.uv[sent.used][sent.faces[: sent.parts[0][2]]].mean(axis=1)
    corners = stage.solution.cover.rest[surface.coarse_faces[sent.coarse]]
    for child in range(sent.children):
        a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
        edges = np.stack([b - a, c - a], axis=2)
        weights = np.linalg.solve(edges, (middle[child :: sent.children] - a)[..., None])[..., 0]
        assert weights.min() > 0
        assert weights.sum(axis=1).max() < 1


def test_what_is_sent_is_as_fine_as_a_hair(stage):
    buffers = Buffers()
    triangles, said = add_geometry(stage, buffers)
    low, step = (np.array(said["position"][key]) for key in ("low", "step"))
    back = low + step * buffers.arrays["position"]
    assert np.abs(back - stage.surface.mesh.vertices[triangles.used]).max() < 1e-5
    # An even sheet sees all of the sky.
    assert buffers.arrays["open"].min() == 255


def test_alike_corners_are_sent_once(stage):
    sent = triangles_of(stage)
    mesh = stage.surface.mesh
    rows = np.hstack([mesh.vertices, mesh.normals, mesh.uv])[sent.used].round(6)
    assert len(np.unique(rows, axis=0)) == len(sent.used)
