"""Solved covers made by formula, small enough to draw in a test."""

from __future__ import annotations

import numpy as np

from seatlook.model import Appearance, Camera, Cover, Curve, Fabric, Material, Solution

FABRIC = Fabric(
    thickness=0.001,
    density=0.8,
    warp=Curve.linear(1e4),
    weft=Curve.linear(1e4),
    shear=Curve.linear(4e3),
    bending_warp=1e-4,
    bending_weft=1e-4,
    bending_twist=5e-5,
)
GREY = Appearance(albedo=np.full(3, 0.5), f0=0.0)


def grid(low, high, steps):
    """Points (n, 2) and counter-clockwise faces of a rectangle cut ``steps`` times each way."""
    (u0, v0), (u1, v1) = low, high
    u, v = np.meshgrid(np.linspace(u0, u1, steps[0] + 1), np.linspace(v0, v1, steps[1] + 1))
    i = np.arange(u.size).reshape(u.shape)
    a, b, c, d = i[:-1, :-1], i[:-1, 1:], i[1:, 1:], i[1:, :-1]
    faces = [np.column_stack([x.ravel() for x in t]) for t in ((a, b, c), (a, c, d))]
    return np.column_stack([u.ravel(), v.ravel()]), np.vstack(faces)


def sheet(height, *, size=0.2, steps=24, appearance=GREY, panels=1, element_size=None):
    """Solution over a square of ``size`` [m]; ``height(x, y)`` in m; panels split along x."""
    rests, faces, panel, n = [], [], [], 0
    cuts = np.linspace(-size / 2, size / 2, panels + 1)
    for k in range(panels):
        points, f = grid(
            (cuts[k], -size / 2), (cuts[k + 1], size / 2), (max(1, steps // panels), steps)
        )
        rests.append(points)
        faces.append(f + n)
        panel.append(np.full(len(f), k))
        n += len(points)
    rest, f, p = np.vstack(rests), np.vstack(faces), np.concatenate(panel)
    x = np.column_stack([rest, height(rest[:, 0], rest[:, 1])])
    material = Material(name="test", fabric=FABRIC, appearance=appearance)
    cover = Cover(
        rest=rest,
        uv=rest,
        positions=x,
        faces=f,
        panel=p,
        panel_names=tuple(f"panel{k}" for k in range(panels)),
        materials=(material,) * panels,
        zone=np.zeros(len(f), dtype=int),
        zone_names=("all",),
        element_size=element_size or size / steps,
    )
    flat = np.zeros((len(f), 2, 2))
    return Solution(
        cover=cover,
        positions=x,
        velocities=np.zeros((n, 3)),
        strain_top=flat,
        strain_mid=flat,
        strain_bottom=flat,
        friction_anchor=np.full((n, 3), np.nan),
        stage="cover",
        status="converged",
    )


def flat(x, y):
    """Height of a flat sheet."""
    return 0.0 * x


def above(distance=1.0, size=(64, 48), fov=12.0, at=(0.0, 0.0, 0.0)):
    """Camera straight above."""
    at = np.array(at)
    return Camera(
        name="above",
        position=at + np.array([0.0, 0.0, distance]),
        target=at,
        up=np.array([0.0, 1.0, 0.0]),
        vertical_fov_deg=fov,
        size=size,
    )
