"""A strip that hangs from a clamp, and the step that explicit steps allow it."""

import numpy as np

from seatlook import model
from seatlook.solver import Load, Sheet, SheetSettings, Support, solve_sheet
from seatlook.solver.methods.explicit import stable_step
from support import meshes


def hanging(kind="uns", *, edges=8, thickness=0.02, stiffness_ratio=1.0, stretch=None, **options):
    """Strip of length 1 and B = 1 that hangs from a clamp with Gamma = 1."""
    X, T = meshes.rectangle(kind, 1.0, 0.25, 1.0 / edges)
    stretch = 12.0 / thickness**2 if stretch is None else stretch
    fabric = model.Fabric(
        thickness=thickness,
        density=1.0,
        warp=model.Curve.linear(stretch * stiffness_ratio),
        weft=model.Curve.linear(stretch),
        shear=model.Curve.linear(0.5 * stretch),
        bending_warp=1.0,
        bending_weft=1.0,
        bending_twist=0.5,
    )
    return X, solve_sheet(
        Sheet(X, T, fabric),
        support=Support(clamped=X[:, 0] < 1e-9),
        load=Load(gravity=(0, 0, -1.0)),
        settings=SheetSettings(**options),
    )


def explicit_limit(**options):
    X, solved = hanging(method="newton", **options)
    free = np.flatnonzero(np.repeat(X[:, 0] > 1e-9, 3))
    hessian = sum(e.hessian(solved.positions, definite=True) for e in solved.sheet.energies)
    return stable_step(
        hessian.tocsr()[free][:, free].tocsc(), np.repeat(solved.sheet.mass, 3)[free]
    )
