"""Buckling load of a sheet on springs, by eigenvalues."""

import numpy as np
from scipy.sparse import diags_array
from scipy.sparse.linalg import eigsh

from support import fabrics, meshes
from support.reference.counter_examples import sheet_of
from support.reference.morley import MorleySheet


def threshold(element, kind, per_wave, *, tension=0.0, bend=5e-5, bed=2e6, waves=3, seed=0):
    """Buckling load of a sheet on springs over 2 sqrt(B K), minus 1; tension across the wave."""
    length = 2 * np.pi * (bend / bed) ** 0.25
    X, T = meshes.rectangle(kind, waves * length, 2 * length, length / per_wave, seed=seed)
    fabric = fabrics.isotropic(bend=bend)
    sheet = MorleySheet(X, T, fabric) if element == "morley" else sheet_of(element, X, T, fabric)

    def pulled(along, across):
        size = max(abs(along), abs(across))
        if element == "morley":
            return sheet.stress_stiffness(np.diag([along, across]) / size)
        x = np.pad(X * [1 + along, 1 + across], ((0, 0), (0, 1)))
        matrix = sheet.membrane.hessian(x).tocsr()[2::3][:, 2::3]
        return matrix / (1000.0 * size)

    springs = diags_array(sheet.mass / fabric.density * bed)
    stiff = sheet.bending.stiffness() + springs + tension * pulled(0.0, 1e-4)
    held = np.zeros(len(sheet.mass), dtype=bool)
    held[: len(X)] = (X[:, 0] < 1e-9) | (X[:, 0] > X[:, 0].max() - 1e-9)
    inner = np.flatnonzero(~held)
    top = eigsh(
        pulled(-1e-4, 0.0).tocsc()[inner][:, inner] * -1.0,
        k=1,
        M=stiff.tocsc()[inner][:, inner],
        which="LA",
        tol=1e-5,
        return_eigenvectors=False,
        v0=np.random.default_rng(0).standard_normal(len(inner)),
    )
    return 1.0 / top[0] / (2.0 * np.sqrt(bed * bend)) - 1.0
