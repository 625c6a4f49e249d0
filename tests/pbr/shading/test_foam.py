"""Foam is drawn below the cover that it carries, beside sharp edges and corners too."""

from __future__ import annotations

import numpy as np
import pytest

from seatlook import model
from seatlook.pbr.kernels.surface import Mesh
from seatlook.pbr.shading.foam import pressed
from support.boxes import rounded_block
from support.scenes import foam_material

SIZE = np.array([0.28, 0.13, 0.176])


def sheets(size, spacing):
    """Five panels of a box that share no vertices, open below."""
    x, normals, faces, panel = [], [], [], []
    for number, (axis, sign) in enumerate([(0, -1), (0, 1), (1, -1), (1, 1), (2, 1)]):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        nu, nv = (max(1, round(size[k] / spacing)) for k in (u, v))
        i, j = (w.ravel() for w in np.meshgrid(np.arange(nu + 1), np.arange(nv + 1), indexing="ij"))
        sheet = np.zeros((len(i), 3))
        sheet[:, axis] = sign * size[axis] / 2
        sheet[:, u], sheet[:, v] = (i / nu - 0.5) * size[u], (j / nv - 0.5) * size[v]
        at = sum(map(len, x)) + np.arange(len(i)).reshape(nu + 1, nv + 1)
        a, b, c, d = at[:-1, :-1], at[1:, :-1], at[1:, 1:], at[:-1, 1:]
        quads = np.stack([a, b, c, a, c, d], axis=-1).reshape(-1, 3)
        faces.append(quads if sign > 0 else quads[:, ::-1])
        normals.append(np.tile(sign * np.eye(3)[axis], (len(i), 1)))
        x.append(sheet + np.array([0.0, 0.0, size[2] / 2]))
        panel.append(np.full(len(faces[-1]), number))
    x, faces = np.concatenate(x), np.concatenate(faces)
    n = len(x)
    return Mesh(
        x,
        np.concatenate(normals),
        np.zeros((n, 3)),
        np.zeros((n, 2)),
        faces,
        np.concatenate(panel),
        np.full((n, 2), np.inf),
    )


@pytest.mark.parametrize("spacing", [0.002, 0.007, 0.025])
@pytest.mark.parametrize("beyond", [0.0, 0.004, 0.012])
def test_no_foam_stands_out_of_the_corners_of_a_box(spacing, beyond):
    vertices, faces = rounded_block(SIZE + 2 * beyond, 0.0, 0.006)
    foam = model.Foam(vertices=vertices - [0.0, 0.0, beyond], faces=faces, material=foam_material())
    x = pressed(foam, sheets(SIZE, spacing))
    above = x[foam.vertices[:, 2] > 0.02]
    inner = np.array([SIZE[0] / 2, SIZE[1] / 2])
    assert (np.abs(above[:, :2]) - inner).max() == pytest.approx(-0.003, abs=1e-9)
    assert above[:, 2].max() == pytest.approx(SIZE[2] - 0.003, abs=1e-9)


def test_foam_far_from_the_cover_stays_as_it_is():
    vertices, faces = rounded_block(SIZE - 0.08, 0.0, 0.02)
    foam = model.Foam(vertices=vertices, faces=faces, material=foam_material())
    assert np.array_equal(pressed(foam, sheets(SIZE, 0.01)), vertices)
