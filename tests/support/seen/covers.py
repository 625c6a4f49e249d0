"""Drawn covers with waves on them, seen aslant."""

from dataclasses import replace

import numpy as np

from seatlook.model import Appearance, Camera, Rig, sun
from seatlook.visibility.view import Sampling
from support.reference.lit_sheets import grid

DEEP = 0.5e-3
COARSE = Sampling("draft", 17.0)  # as a picture of 320 x 240 through ``oblique``
BLACK = Appearance(albedo=np.full(3, 0.03), roughness=0.35)
ROUGH = Appearance(albedo=np.full(3, 0.5), roughness=0.9)
RIG = Rig(name="sun", lights=(sun(elevation_deg=50, azimuth_deg=90),), ambient=600.0)


def oblique(size=(160, 120)):
    return Camera(
        name="oblique",
        position=np.array([0.3, -0.6, 0.7]),
        target=np.zeros(3),
        vertical_fov_deg=14.0,
        size=size,
    )


def wave(length, depth=DEEP):
    return lambda x, y: depth * np.cos(2 * np.pi * x / length)


def block(top, steps=60):
    """Foam under the sheet: a box with a finely meshed lid at z = top(x, y)."""
    points, faces = grid((-0.15, -0.15), (0.15, 0.15), (steps, steps))
    lid = np.column_stack([points, top(*points.T)])
    floor = np.column_stack([points, np.full(len(points), -0.08)])
    n = len(points)
    half = faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    key, count = np.unique(np.sort(half, axis=1) @ [n, 1], return_counts=True)
    rim = half[np.isin(np.sort(half, axis=1) @ [n, 1], key[count == 1])]
    a, b = rim.T
    wall = np.vstack([np.stack([b, a, a + n], axis=1), np.stack([b, a + n, b + n], axis=1)])
    return np.vstack([lid, floor]), np.vstack([faces, faces[:, ::-1] + n, wall])


def ridge(x, y):
    """Part of the design: as narrow as a wrinkle and ten times as high."""
    return 10 * DEEP * np.exp(-((x / 0.025) ** 2))


def zoned(solution):
    """Left half, a seam band in the middle, right half, a free edge all round."""
    centre = solution.cover.rest[solution.cover.faces].mean(axis=1)
    zone = np.where(centre[:, 0] < 0, 0, 2)
    zone[np.abs(centre[:, 0]) < 0.01] = 1
    zone[(np.abs(centre) > 0.085).any(axis=1)] = 3
    names = ("left interior", "seam a-b", "right interior", "free edge")
    return replace(solution, cover=replace(solution.cover, zone=zone, zone_names=names))
