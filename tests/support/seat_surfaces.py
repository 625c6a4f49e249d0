"""Surfaces with panels that are rings, tubes and caps, of own making, at any edge length."""

import numpy as np

from seatlook import mesh
from seatlook.flattening import DesignSurface


def undivided(vertices, faces, name="PANEL"):
    panel = np.zeros(len(faces), dtype=np.int64)
    return DesignSurface(vertices=vertices, faces=faces, panel=panel, panel_names=(name,))


def swept(rims):
    """A strip of quads halved, through closed rims (k, n, 3) that follow each other."""
    k, n, _ = rims.shape
    i = np.arange(n)
    faces = []
    for row in range(k - 1):
        a, b = row * n + i, row * n + (i + 1) % n
        faces += [np.column_stack([a, b, b + n]), np.column_stack([a, b + n, a + n])]
    return rims.reshape(-1, 3), np.concatenate(faces)


def tube(radius=0.1, height=0.2, *, size=0.02, spread=0.0):
    """A round wall; ``spread`` is how much wider it is above: at 1 it is a cone of 45 degrees."""
    turn = np.linspace(0, 2 * np.pi, max(8, round(2 * np.pi * radius / size)), endpoint=False)
    rows = max(2, round(height / size) + 1)
    z = np.linspace(0, height, rows)[:, None]
    r = radius + spread * z
    return swept(np.stack([r * np.cos(turn), r * np.sin(turn), z + 0 * turn], axis=2))


def flat_ring(inner=0.1, outer=0.2, *, size=0.02):
    turn = np.linspace(0, 2 * np.pi, round(2 * np.pi * outer / size), endpoint=False)
    r = np.linspace(outer, inner, round((outer - inner) / size) + 1)[:, None]
    return swept(np.stack([r * np.cos(turn), r * np.sin(turn), 0 * r + 0 * turn], axis=2))


def box_cushion(*, size=0.012, half=(0.2, 0.18), height=0.08, crown=0.03, base=True):
    """A cushion with a crowned TOP, a ring-shaped BAND round it and, if asked for, a flat BASE."""
    turn = np.linspace(0, 2 * np.pi, 400)
    c, s = np.cos(turn), np.sin(turn)
    r = (np.abs(c / half[0]) ** 6 + np.abs(s / half[1]) ** 6) ** (-1 / 6)
    rim = mesh.resample(np.column_stack([r * c, r * s]), size)[:-1]
    n, rows = len(rim), round(height / size) + 1
    z = np.linspace(0, height, rows)
    walls, band = swept(np.stack([np.column_stack([rim, np.full(n, h)]) for h in z]))
    inner, flat = mesh.triangulate(rim, size)
    inner = inner[n:]
    up = height + crown * np.prod(1 - (inner / half) ** 2, axis=1)
    vertices = [walls, np.column_stack([inner, up])]
    first = len(walls) + np.arange(len(inner))
    faces = [band, np.append((rows - 1) * n + np.arange(n), first)[flat]]
    if base:
        vertices.append(np.column_stack([inner, np.zeros(len(inner))]))
        faces.append(np.append(np.arange(n), first + len(inner))[flat[:, ::-1]])
    return DesignSurface(
        vertices=np.concatenate(vertices),
        faces=np.concatenate(faces),
        panel=np.repeat(np.arange(len(faces)), [len(f) for f in faces]),
        panel_names=("BAND", "TOP", "BASE")[: len(faces)],
    )


def cap(radius=0.3, half=0.2, *, size=0.01, saddle=False):
    """A square piece of a ball, or of a saddle of the same curvatures, on a mesh of its own."""
    corners = half * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1], [-1, -1]])
    rim = np.concatenate([mesh.resample(corners[i : i + 2], size)[:-1] for i in range(4)])
    flat, faces = mesh.triangulate(rim, size)
    x, y = flat.T
    z = (x * x - y * y) / (2 * radius) if saddle else np.sqrt(radius**2 - x * x - y * y)
    return np.column_stack([flat, z]), faces


def on_cap(points, radius=0.3, *, saddle=False):
    """Lift points (k, 2) onto the cap."""
    x, y = np.asarray(points, dtype=float).T
    z = (x * x - y * y) / (2 * radius) if saddle else np.sqrt(radius**2 - x * x - y * y)
    return np.column_stack([x, y, z])
