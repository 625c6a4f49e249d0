"""Panels that no sheet covers without strain: boxes, cups and half ellipsoids; and a cone."""

from itertools import pairwise

import numpy as np

from seatlook import mesh
from seatlook.flattening import DesignSurface


def one_panel(vertices, faces, name="CAP"):
    panel = np.zeros(len(faces), dtype=np.int64)
    return DesignSurface(vertices=vertices, faces=faces, panel=panel, panel_names=(name,))


def box(depth, *, cells=4, width=0.28, length=0.12):
    """The top and the walls of a box [m], closed at its upright edges."""
    x = np.linspace(-width / 2, width / 2, cells + 1)
    y = np.linspace(-length / 2, length / 2, cells + 1)
    squares = []
    for i in range(cells):
        a, b, c, d = x[i], x[i + 1], y[i], y[i + 1]
        squares += [[(a, e, 0), (b, e, 0), (b, f, 0), (a, f, 0)] for e, f in pairwise(y)]
        squares += [[(a, y[0], -depth), (b, y[0], -depth), (b, y[0], 0), (a, y[0], 0)]]
        squares += [[(b, y[-1], -depth), (a, y[-1], -depth), (a, y[-1], 0), (b, y[-1], 0)]]
        squares += [[(x[0], d, -depth), (x[0], c, -depth), (x[0], c, 0), (x[0], d, 0)]]
        squares += [[(x[-1], c, -depth), (x[-1], d, -depth), (x[-1], d, 0), (x[-1], c, 0)]]
    vertices, corner = np.unique(np.reshape(squares, (-1, 3)), axis=0, return_inverse=True)
    quads = corner.reshape(-1, 4)
    return vertices, np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def lid(depth, *, cells=4, skirt=0.04):
    """A box of one piece with a skirt sewn below its front and its rear wall."""
    vertices, faces = box(depth, cells=cells)
    low = np.isclose(vertices[:, 2], -depth)
    rims = [np.flatnonzero(low & np.isclose(vertices[:, 1], y)) for y in (-0.06, 0.06)]
    panel = [np.zeros(len(faces), dtype=np.int64)]
    for index, side in ((1, -1), (2, 1)):
        rim = rims[index - 1]
        rim = rim[np.argsort(-side * vertices[rim, 0])]
        below = len(vertices) + np.arange(len(rim))
        vertices = np.concatenate([vertices, vertices[rim] - [0, 0, skirt]])
        a, b, c, d = below[:-1], below[1:], rim[1:], rim[:-1]
        faces = np.concatenate([faces, np.column_stack([a, b, c]), np.column_stack([a, c, d])])
        panel.append(np.full(2 * len(a), index))
    names = ("LID", "FRONT", "REAR")
    return DesignSurface(
        vertices=vertices, faces=faces, panel=np.concatenate(panel), panel_names=names
    )


def disk(size):
    angle = np.linspace(0, 2 * np.pi, round(2 * np.pi / size), endpoint=False)
    return mesh.triangulate(np.column_stack([np.cos(angle), np.sin(angle)]), size)


def cup(depth, *, power=2.0, brim=0.5, size=0.16, length=0.12):
    """A flat top and a wall round it; elliptic for power 2, nearly a box for 8."""
    points, faces = disk(size)
    r = np.linalg.norm(points, axis=1)
    direction = points / np.maximum(r, 1e-12)[:, None]
    norm = (np.abs(direction) ** power).sum(axis=1) ** (1 / power)
    out = direction * (np.minimum(r / brim, 1) / np.maximum(norm, 1e-12))[:, None]
    down = -depth * np.maximum(r - brim, 0) / (1 - brim)
    return np.column_stack([0.14 * out[:, 0], 0.5 * length * out[:, 1], down]), faces


def half_ellipsoid(height, *, size=0.16, length=0.12):
    points, faces = disk(size)
    r = np.minimum(np.linalg.norm(points, axis=1), 1)
    direction = points / np.maximum(r, 1e-12)[:, None]
    out = np.sin(0.5 * np.pi * r)[:, None] * direction
    up = height * np.cos(0.5 * np.pi * r)
    return np.column_stack([0.14 * out[:, 0], 0.5 * length * out[:, 1], up]), faces


def cone(slope, *, size=0.008):
    """Part of the mantle of a cone, 100 to 250 mm from its tip, and its flat shape."""
    turn = np.linspace(-0.8, 0.8, round(0.25 * 1.6 / size))
    outer = 0.25 * np.column_stack([np.cos(turn), np.sin(turn)])
    inner = mesh.resample(0.1 * np.column_stack([np.cos(turn), np.sin(turn)])[::-1], size)
    sides = [mesh.resample(np.array([outer[-1], inner[0]]), size)[1:-1],
             mesh.resample(np.array([inner[-1], outer[0]]), size)[1:-1]]  # fmt: skip
    flat, faces = mesh.triangulate(np.concatenate([outer, sides[0], inner, sides[1]]), size)
    r, angle = np.hypot(*flat.T), np.arctan2(flat[:, 1], flat[:, 0]) / slope
    space = [slope * r * np.cos(angle), slope * r * np.sin(angle), -r * np.sqrt(1 - slope**2)]
    return np.column_stack(space), flat, faces
