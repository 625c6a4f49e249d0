"""Fabrics for tests of the element and the solver."""

import numpy as np

from seatlook.model import Curve, Fabric


def isotropic(stretch=1000.0, bend=5e-5, poisson=0.0, *, density=0.3, thickness=1e-3):
    """Linear fabric of one stiffness [N/m], [N m] in every direction."""
    return Fabric(
        thickness=thickness,
        density=density,
        warp=Curve.linear(stretch),
        weft=Curve.linear(stretch),
        shear=Curve.linear(0.5 * stretch * (1.0 - poisson)),
        poisson=poisson,
        bending_warp=bend,
        bending_weft=bend,
        bending_twist=0.5 * bend * (1.0 - poisson),
        bending_poisson=poisson,
    )


def woven(*, compression_ratio=0.1):
    """Orthotropic fabric with a toe, a shear curve and a slack branch."""
    return Fabric(
        thickness=8e-4,
        density=0.3,
        warp=Curve(strain=[0.0, 0.02, 0.05], stiffness=[900.0, 2000.0, 5000.0]),
        weft=Curve(strain=[0.0, 0.04], stiffness=[700.0, 1500.0]),
        shear=Curve(strain=[0.0, 0.1], stiffness=[60.0, 300.0]),
        poisson=0.3,
        compression_ratio=compression_ratio,
        bending_warp=6e-5,
        bending_weft=2e-5,
        bending_twist=1.5e-5,
        bending_poisson=0.2,
    )


def rotation(rng):
    """Random proper rotation (3, 3)."""
    q, r = np.linalg.qr(rng.standard_normal((3, 3)))
    q = q * np.sign(np.diag(r))
    return q if np.linalg.det(q) > 0 else -q
