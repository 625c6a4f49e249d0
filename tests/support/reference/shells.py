"""Shells that are curved at rest: those of Sze, Liu and Lo (2004), and a pinched ring.

What is printed there was found with 4-node shells that also shear (S4R), on fine meshes.
"""

import numpy as np

from seatlook.solver import Load, Moment, Sheet, SheetSettings, Support, solve_sheet
from support import fabrics, meshes


def shell(X, T, natural, young, thickness, poisson=0.3):
    """A sheet of an isotropic material (linear in tension and compression) with a shape."""
    plane = young / (1 - poisson**2)
    fabric = fabrics.isotropic(
        plane * thickness, plane * thickness**3 / 12, poisson, thickness=thickness
    )
    return Sheet(X, T, fabric, natural=natural)


def ring(edges, kind="uns", thickness=0.02, load=1e-3):
    """Errors of how far a thin ring of radius 1 is pressed together, and how far it widens.

    One quarter of it; pi/4 - 2/pi and 2/pi - 1/2 of P R^3 / (E I) in a ring that does not stretch.
    """
    turn, width = 0.5 * np.pi, 0.2
    X, T = meshes.rectangle(kind, turn, width, turn / edges)
    natural = np.column_stack([np.sin(X[:, 0]), X[:, 1], np.cos(X[:, 0])])
    crown, side = X[:, 0] < 1e-9, X[:, 0] > turn - 1e-9
    fixed = np.stack([crown, np.zeros_like(crown), side], axis=1)
    fixed[np.flatnonzero(crown)[0], 1] = True
    row = np.flatnonzero(crown)
    row = row[np.argsort(X[row, 1])]
    share = 0.25 * load * np.diff(X[row, 1])
    forces = np.zeros((len(X), 3))
    forces[row[:-1], 2] -= share
    forces[row[1:], 2] -= share
    solved = solve_sheet(
        Sheet(X, T, fabrics.isotropic(12 / thickness**2, 1.0, thickness=thickness), natural),
        support=Support(fixed=fixed, guided=crown | side),
        load=Load(forces=forces),
        settings=SheetSettings(tolerance=2e-5),
        strict=True,
    )
    move = (solved.positions - natural) / load
    pressed, wider = -move[row, 2].mean(), move[side, 0].mean()
    return pressed / (np.pi / 8 - 1 / np.pi) - 1, wider / (1 / np.pi - 0.25) - 1


def half_cylinder(h, kind="uns", load=2000.0, steps=10):
    """Sinking of the loaded point of a clamped half cylinder pinched at its free end: 1.71505.

    One half of it: the plane through the crown is one of symmetry, and so are those through the
    straight edges.
    """
    radius, length, thickness, young = 1.016, 3.048, 0.03, 2.0685e7
    X, T = meshes.rectangle(kind, length, 0.5 * np.pi * radius, h)
    angle = X[:, 1] / radius
    natural = np.column_stack([X[:, 0], -radius * np.sin(angle), radius * np.cos(angle)])
    crown, edge = X[:, 1] < 1e-9, X[:, 1] > 0.5 * np.pi * radius - 1e-9
    fixed = np.stack([np.zeros_like(edge), crown, edge], axis=1)
    forces = np.zeros((len(X), 3))
    point = np.flatnonzero(crown & (X[:, 0] > length - 1e-9))[0]
    forces[point, 2] = -0.5 * load
    solved = solve_sheet(
        shell(X, T, natural, young, thickness),
        support=Support(fixed=fixed, clamped=X[:, 0] < 1e-9, guided=crown | edge),
        load=Load(forces=forces),
        settings=SheetSettings(tolerance=1e-5, steps=steps),
        strict=True,
    )
    return natural[point, 2] - solved.positions[point, 2], solved


def hemisphere(rows, kind="uns", load=400.0, steps=5):
    """Inward and outward move of the loaded points of a hemisphere with a hole of 18 degrees.

    One quarter of it; 4.067 and 8.178. The map keeps angles.
    """
    radius, thickness, young = 10.0, 0.04, 6.825e7
    top = np.log(np.tan(np.radians(0.5 * (90 - 18) + 45)))
    X, T = meshes.rectangle(kind, 0.5 * np.pi, top, top / rows)
    height = np.tanh(X[:, 1])
    around = 1 / np.cosh(X[:, 1])
    natural = radius * np.column_stack([around * np.cos(X[:, 0]), around * np.sin(X[:, 0]), height])
    start, end = X[:, 0] < 1e-9, X[:, 0] > 0.5 * np.pi - 1e-9
    equator = X[:, 1] < 1e-9
    first, second = np.flatnonzero(start & equator)[0], np.flatnonzero(end & equator)[0]
    fixed = np.stack([end, start, np.zeros_like(start)], axis=1)
    fixed[first, 2] = fixed[second, 2] = False
    # Nothing else holds it along its axis.
    fixed[np.flatnonzero(start & (X[:, 1] > top - 1e-9))[0], 2] = True
    forces = np.zeros((len(X), 3))
    forces[first, 0], forces[second, 1] = 0.5 * load, -0.5 * load
    solved = solve_sheet(
        shell(radius * X, T, natural, young, thickness),
        support=Support(fixed=fixed, guided=start | end),
        load=Load(forces=forces),
        settings=SheetSettings(tolerance=1e-5, steps=steps),
        strict=True,
    )
    move = solved.positions - natural
    return np.array([-move[second, 1], move[first, 0]]), solved


def pinched_cylinder(h, kind="uns", load=12000.0, steps=10):
    """Inward move of the loaded point, outward of that a quarter round: 83.102 and 34.272.

    One eighth of a pinched cylinder with rigid diaphragms at its ends.
    """
    radius, length, thickness, young = 100.0, 200.0, 1.0, 30e3
    across = 0.5 * np.pi * radius
    X, T = meshes.rectangle(kind, 0.5 * length, across, h)
    angle = X[:, 1] / radius
    natural = np.column_stack([X[:, 0], -radius * np.sin(angle), radius * np.cos(angle)])
    middle, end = X[:, 0] < 1e-9, X[:, 0] > 0.5 * length - 1e-9
    crown, side = X[:, 1] < 1e-9, X[:, 1] > across - 1e-9
    fixed = np.stack([middle, crown | end, side | end], axis=1)
    forces = np.zeros((len(X), 3))
    point, other = np.flatnonzero(crown & middle)[0], np.flatnonzero(side & middle)[0]
    forces[point, 2] = -0.25 * load
    solved = solve_sheet(
        shell(X, T, natural, young, thickness),
        support=Support(fixed=fixed, guided=middle | crown | side),
        load=Load(forces=forces),
        settings=SheetSettings(tolerance=1e-5, steps=steps),
        strict=True,
    )
    move = solved.positions - natural
    return np.array([-move[point, 2], -move[other, 1]]), solved


def rolled_by_a_moment(edges, kind="uns", share=1.0, steps=20):
    """Tip (-u, w) of a cantilever of 12 x 1 x 0.1 under a share of the moment of a full circle.

    Half of its width, with its middle line in a plane of symmetry: free to twist, a strip that is
    all but rolled up leaves its plane. Closed form second.
    """
    length, width, thickness, young = 12.0, 1.0, 0.1, 1.2e6
    X, T = meshes.rectangle(kind, length, 0.5 * width, length / edges)
    end, middle = X[:, 0] > length - 1e-9, X[:, 1] < 1e-9
    bend = young * thickness**3 / 12
    turn = 2 * np.pi * share
    solved = solve_sheet(
        Sheet(X, T, fabrics.isotropic(young * thickness, bend, thickness=thickness)),
        support=Support(
            fixed=np.stack([0 * middle, middle, 0 * middle], axis=1).astype(bool),
            clamped=X[:, 0] < 1e-9,
            guided=middle,
        ),
        load=Load(moments=[Moment(end, (0.0, -bend * turn / length, 0.0))]),
        settings=SheetSettings(tolerance=1e-5, steps=steps),
        strict=True,
    )
    tip = solved.positions[end].mean(axis=0)
    exact = np.array([length - length * np.sin(turn) / turn, length * (1 - np.cos(turn)) / turn])
    return np.array([length - tip[0], tip[2]]), exact
