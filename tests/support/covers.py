"""Covers made by hand: rectangles of one fabric, sewn, tied and laid on simple foams."""

import dataclasses

import numpy as np

from seatlook import model
from support.meshes import rectangle
from support.scenes import block, fabric, foam_material


def cover(panels, *, foam=None, stitchings=(), anchors=(), stages=(), h, **fabric_change):
    """Cover of ``panels`` = (rest, faces, positions) in one fabric."""
    rest, faces, positions, panel, count = [], [], [], [], 0
    for k, (X, T, x) in enumerate(panels):
        rest.append(X)
        faces.append(T + count)
        positions.append(x)
        panel.append(np.full(len(T), k))
        count += len(X)
    material = model.Material(
        name="cloth",
        fabric=fabric(**fabric_change),
        appearance=model.Appearance(albedo=np.full(3, 0.2)),
    )
    faces = np.concatenate(faces)
    return model.Cover(
        rest=np.concatenate(rest),
        uv=np.concatenate(rest),
        positions=np.concatenate(positions),
        faces=faces,
        panel=np.concatenate(panel),
        panel_names=tuple(f"panel {k}" for k in range(len(panels))),
        materials=(material,) * len(panels),
        zone=np.zeros(len(faces), dtype=np.int64),
        zone_names=("all",),
        stitchings=tuple(stitchings),
        anchors=tuple(anchors),
        stages=tuple(stages),
        foam=foam,
        element_size=h,
    )


def sheet(length, width, h, *, z=0.0, kind="uns", at=(0.0, 0.0)):
    """Rest, faces and level positions of a rectangle."""
    X, T = rectangle(kind, length, width, h)
    return X, T, np.column_stack([X + np.asarray(at), np.full(len(X), z)])


def foam(vertices, faces, **change):
    """Foam of the tests' material with some fields changed."""
    material = dataclasses.replace(foam_material(), **change)
    return model.Foam(vertices=vertices, faces=faces, material=material)


def flat_foam(size=0.3, height=0.1, **change):
    """Block whose top lies at z = 0."""
    half = 0.5 * size
    return foam(*block((-half, -half, -height), (half, half, 0.0)), **change)


def vertices_as_points(vertices):
    """Points that are vertices."""
    vertices = np.asarray(vertices)
    return model.Points(
        vertices=np.stack([vertices, vertices], axis=1),
        weights=np.tile([1.0, 0.0], (len(vertices), 1)),
    )


def points_along(X, line, at):
    """Points at arc lengths ``at`` [0, 1] of the straight row of vertices ``line``."""
    s = np.linalg.norm(X[line] - X[line[0]], axis=1)
    s = s / s[-1]
    k = np.clip(np.searchsorted(s, at, side="right") - 1, 0, len(line) - 2)
    t = (at - s[k]) / (s[k + 1] - s[k])
    line = np.asarray(line)
    return model.Points(
        vertices=np.stack([line[k], line[k + 1]], axis=1), weights=np.stack([1 - t, t], axis=1)
    )


def row(X, axis, value):
    """Vertices on the line X[axis] = value, in order along the other axis."""
    found = np.flatnonzero(np.abs(X[:, axis] - value) < 1e-9)
    return found[np.argsort(X[found, 1 - axis])]


def sphere(radius, level):
    """Octahedron refined ``level`` times and blown up, outward normals."""
    v = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], float)
    f = np.array(
        [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]]
    )
    for _ in range(level):
        pairs = np.sort(np.concatenate([f[:, [0, 1]], f[:, [1, 2]], f[:, [2, 0]]]), axis=1)
        unique, index = np.unique(pairs, axis=0, return_inverse=True)
        ab, bc, ca = (len(v) + index.reshape(3, -1))[:]
        a, b, c = f.T
        v = np.concatenate([v, v[unique].mean(axis=1)])
        f = np.concatenate(
            [np.stack(t, axis=1) for t in ((a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca))]
        )
    return radius * v / np.linalg.norm(v, axis=1)[:, None], f


def cylinder(radius, length, segments):
    """Closed cylinder along y, outward normals."""
    angle = 2 * np.pi * np.arange(segments) / segments
    ring = np.column_stack([radius * np.cos(angle), np.zeros(segments), radius * np.sin(angle)])
    half = np.array([0.0, 0.5 * length, 0.0])
    v = np.concatenate([ring - half, ring + half, [-half, half]])
    i = np.arange(segments)
    j = (i + 1) % segments
    low, high = 2 * segments, 2 * segments + 1
    faces = [
        np.stack([i, i + segments, j], 1),
        np.stack([j, i + segments, j + segments], 1),
        np.stack([np.full(segments, low), i, j], 1),
        np.stack([np.full(segments, high), j + segments, i + segments], 1),
    ]
    return v, np.concatenate(faces)


def volume(vertices, faces):
    """Enclosed volume, positive for outward normals."""
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)
