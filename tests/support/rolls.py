"""A flat sheet, and the same rolled up."""

import numpy as np

from seatlook import mesh


def sheet(width=0.12, height=0.08, h=0.004, seed=0):
    corners = np.array([[0, 0], [width, 0], [width, height], [0, height], [0, 0]])
    rim = np.concatenate([mesh.resample(corners[i : i + 2], h)[:-1] for i in range(4)])
    return mesh.triangulate(rim, h, seed=seed)


def rolled(points, radius):
    """Bend a flat sheet round a cylinder along its first axis."""
    angle = points[:, 0] / radius
    return np.column_stack([radius * np.sin(angle), points[:, 1], radius * np.cos(angle)])
