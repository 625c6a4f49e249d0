"""Surfaces as they come out of scanners and other programs, and the whole ones."""

import numpy as np
import trimesh


def cushion(subdivisions=4):
    """Vertices [m] and faces of a rounded cushion of 0.5 x 0.45 x 0.14 m, from a sphere."""
    ball = trimesh.creation.icosphere(subdivisions=subdivisions)
    v = np.asarray(ball.vertices)
    rounded = v / (v**4).sum(axis=1)[:, None] ** 0.25
    return rounded * [0.25, 0.225, 0.07], np.array(ball.faces)


def volume(vertices, faces):
    a, b, c = vertices[faces].transpose(1, 0, 2)
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6


def without(vertices, faces, centre, radius):
    """Faces of a surface but those around a point."""
    middle = vertices[faces].mean(axis=1)
    return faces[np.linalg.norm(middle - centre, axis=1) > radius]


def scan(seed=0, noise=0.0003):
    """Return a cushion as scanned: open below, with holes, noise, specks, fins, faces turned."""
    rng = np.random.default_rng(seed)
    vertices, faces = cushion()
    above = vertices[faces].mean(axis=1)[:, 2] > -0.045
    faces = faces[above]
    for x, y in ((-0.14, -0.12), (-0.12, 0.1), (0.13, -0.1), (0.1, 0.12)):
        centre = np.array([x, y, 0.068]) + rng.uniform(-0.03, 0.03, 3) * [1, 1, 0]
        faces = without(vertices, faces, centre, rng.uniform(0.02, 0.03))
    vertices = vertices + noise * rng.normal(size=vertices.shape)
    turned = rng.permutation(len(faces))[:40]
    faces[turned] = faces[turned, ::-1]
    again = faces[rng.permutation(len(faces))[:5]]
    specks = rng.uniform(-0.3, 0.3, (3, 1, 3)) + rng.uniform(-0.002, 0.002, (3, 3, 3))
    first = len(vertices)
    tips = np.array([[0.01, 0.02, 0.15], [0.05, -0.02, 0.14]])
    fins = np.column_stack([faces[100:102, :2], first + 9 + np.arange(2)])
    loose = first + np.arange(9).reshape(3, 3)
    return (
        np.concatenate([vertices, specks.reshape(-1, 3), tips]),
        np.concatenate([faces, again, loose, fins]),
    )


def whole_seat():
    """Vertices [m] and faces of a cushion and a back that overlap: 0.9 x 1.2 x 1.0 m in all."""
    v, f = cushion(5)
    v = v / [0.25, 0.225, 0.07]
    seat = v * [0.45, 0.60, 0.125] + [0.0, 0.0, 0.125]
    back = v * [0.42, 0.12, 0.45] + [0.0, 0.48, 0.55]
    return np.concatenate([seat, back]), np.concatenate([f, f + len(v)])
