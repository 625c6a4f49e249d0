"""The drape test of Cusick: a round cloth that hangs freely over a round table."""

import numpy as np

from seatlook import mesh
from seatlook.model import Cover, Curve, Stage
from support.covers import cover, cylinder, foam

CLOTH, TABLE = 0.15, 0.09  # m, radii


def cusick(vertices: int, bending: float = 1e-5) -> Cover:
    """Cloth of 2 kN/m, 0.3 kg/m2 and ``bending`` [N m] over a table that hardly gives way."""
    h = np.sqrt(np.pi * CLOTH**2 / vertices / np.sqrt(0.75))
    angle = np.arange(0.0, 2.0 * np.pi, h / CLOTH)[:-1]
    X, T = mesh.triangulate(CLOTH * np.column_stack([np.cos(angle), np.sin(angle)]), h)
    # Seven waves of a hundredth of a millimetre: a round cloth has no place of its own to fold.
    wave = 1e-5 * np.sin(7.0 * np.arctan2(X[:, 1], X[:, 0]))
    corners, faces = cylinder(TABLE, 0.04, 96)
    upright = corners[:, [0, 2, 1]] * [1.0, -1.0, 1.0]
    column = np.array([0.0, 0.5, 0.8])
    return cover(
        [(X, T, np.column_stack([X, 2.6e-4 + wave]))],
        foam=foam(upright - [0.0, 0.0, 0.02], faces, young=3e4, strain=column,
                  stress=60.0 * 3e4 * column, friction=0.3),
        stages=[Stage(name="drop", start=0.0, end=0.2)],
        h=h,
        thickness=5e-4,
        density=0.3,
        warp=Curve.linear(2000.0),
        weft=Curve.linear(2000.0),
        shear=Curve.linear(500.0),
        bending_warp=bending,
        bending_weft=bending,
        bending_twist=0.5 * bending,
    )  # fmt: skip
