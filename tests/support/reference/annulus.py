"""The slit annulus of Sze, Liu and Lo (2004): one edge of the slit clamped, the other lifted."""

import numpy as np

from seatlook.mesh import triangulate
from seatlook.solver import Load, Sheet, SheetSettings, Support, solve_sheet
from support import fabrics

INNER, OUTER, THICKNESS, YOUNG, LOAD = 6.0, 10.0, 0.03, 21e6, 0.8
# Deflections of the inner and the outer end of the lifted edge: of a thin (Kirchhoff) plate, and
# as printed, with shells that also shear.
THIN, PRINTED = np.array([13.84, 17.48]), np.array([13.891, 17.528])
_SLIT = 1e-6  # rad, between its two edges


def uniform(h, seed=0, *, hold_area=False):
    """Rest, faces, and the vertices of the clamped and of the lifted edge, from ``triangulate``.

    Vertices of the rims lie on the circles, or so that the polygons have the circles' areas.
    """
    outer, inner, across = (
        max(2, round(length / h))
        for length in (2 * np.pi * OUTER, 2 * np.pi * INNER, OUTER - INNER)
    )
    turn = 2 * np.pi - _SLIT
    wide, narrow = OUTER, INNER
    if hold_area:
        wide, narrow = (
            radius * np.sqrt(2 * np.pi / count / np.sin(2 * np.pi / count))
            for radius, count in ((OUTER, outer), (INNER, inner))
        )
    side = np.linspace(wide, narrow, across + 1)
    rim = np.concatenate(
        [
            _arc(wide, np.linspace(0, turn, outer + 1)),
            _arc(side[1:-1], turn),
            _arc(narrow, np.linspace(turn, 0, inner + 1)),
            _arc(side[-2:0:-1], 0.0),
        ]
    )
    X, T = triangulate(rim, h, seed=seed)
    clamped = np.concatenate([[0], np.arange(outer + across + inner, len(rim))])
    return X, T, clamped, np.arange(outer, outer + across + 1)


def polar(rows, around, finest=1.0):
    """The same from a polar grid, its rows graded to ``finest`` of their mean at both rims."""
    s = np.linspace(0, 1, rows + 1)
    radius = INNER + (OUTER - INNER) * (s - (1 - finest) * np.sin(2 * np.pi * s) / (2 * np.pi))
    angle = np.linspace(0, 2 * np.pi - _SLIT, around + 1)
    X = np.concatenate([_arc(radius, a) for a in angle])
    i, j = (a.ravel() for a in np.meshgrid(np.arange(around), np.arange(rows), indexing="ij"))
    a = i * (rows + 1) + j
    b, c, d = a + 1, a + rows + 2, a + rows + 1
    T = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    return X, T, np.arange(rows + 1), around * (rows + 1) + np.arange(rows + 1)


def deflections(X, T, clamped, lifted, *, start=None, method="newton"):
    """Lift (2,) of the inner and the outer end, and the solution."""
    held = np.zeros(len(X), dtype=bool)
    held[clamped] = True
    lifted = lifted[np.argsort(np.hypot(*X[lifted].T))]
    half = 0.5 * LOAD * np.diff(np.hypot(*X[lifted].T))
    forces = np.zeros((len(X), 3))
    forces[lifted[:-1], 2] += half
    forces[lifted[1:], 2] += half
    fabric = fabrics.isotropic(YOUNG * THICKNESS, YOUNG * THICKNESS**3 / 12, thickness=THICKNESS)
    solved = solve_sheet(
        Sheet(X, T, fabric),
        support=Support(clamped=held),
        load=Load(forces=forces),
        start=start,
        settings=SheetSettings(tolerance=1e-5, method=method),
        strict=True,
    )
    return solved.positions[lifted[[0, -1]], 2], solved


def _arc(radius, angle):
    return np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=-1)
