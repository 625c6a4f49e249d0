"""Linear out-of-plane behaviour of a flat sheet: false bending, buckling loads."""

import numpy as np
from scipy.sparse import diags_array
from scipy.sparse.linalg import eigsh, spsolve

from seatlook.solver.element.elastic import ElasticSheet
from support import fabrics, meshes


def normal_part(hessian):
    """Rows and columns of the third axis."""
    return hessian.tocsr()[2::3][:, 2::3]


def flat(X):
    return np.pad(X, ((0, 0), (0, 1)))


def false_bending(kind, edges_per_wave, *, edges=48, degrees=0.0):
    """c in B_num = c T h^2 of a wave across the tension, which should cost nothing.

    The wave runs at ``degrees`` to the grid and is looked at away from the rim, where it would
    not be free of moments.
    """
    X, T = meshes.rectangle(kind, 1.0, 1.0, 1.0 / edges)
    sheet = ElasticSheet(X, T, np.zeros(len(T)), [fabrics.isotropic()])
    q, amplitude, a = 2 * np.pi * edges / edges_per_wave, 1e-3, np.radians(degrees)
    phases = q * (X @ [np.cos(a), np.sin(a)])[:, None] + np.arange(4) * np.pi / 4
    strain = np.mean(
        [sheet.membrane.strain(np.column_stack([X, amplitude * np.sin(p)])) for p in phases.T],
        axis=0,
    )
    along = strain @ [np.sin(a) ** 2, np.cos(a) ** 2, -np.sin(a) * np.cos(a)]
    inner = ((X[T] > 0.12) & (X[T] < 0.88)).all(axis=(1, 2))
    share = sheet.area * inner * np.prod(np.sin(np.pi * X[T].mean(axis=1)) ** 2, axis=1)
    energy = (share @ along) / share.sum() / amplitude**2
    return energy / (0.25 * q**4) / sheet.edges.length.mean() ** 2


def winkler_load(kind, edges_per_wave, *, bed=2e6, bend=5e-5, waves=5):
    """Buckling load of a sheet on springs [N/m3] over its exact value 2 sqrt(B K), minus 1."""
    length = 2 * np.pi * (bend / bed) ** 0.25
    X, T = meshes.rectangle(kind, waves * length, 2 * length, length / edges_per_wave)
    sheet = ElasticSheet(X, T, np.zeros(len(T)), [fabrics.isotropic(bend=bend)])
    x = flat(X * [1 - 1e-4, 1.0])
    K = normal_part(sheet.membrane.hessian(x)) / sheet.membrane.stress(x)[0, 0]
    springs = diags_array(sheet.mass / 0.3 * bed)
    inner = np.flatnonzero((X[:, 0] > 1e-9) & (X[:, 0] < X[:, 0].max() - 1e-9))
    stiff = (sheet.bending.stiffness() + springs).tocsc()[inner][:, inner]
    top = eigsh(
        K.tocsc()[inner][:, inner],
        k=1,
        M=stiff.tocsc(),
        which="LA",
        tol=1e-6,
        return_eigenvectors=False,
        v0=np.random.default_rng(0).standard_normal(len(inner)),
    )
    return 1 / top[0] / (2 * np.sqrt(bed * bend)) - 1


def lateral_load(kind, slenderness, rows, *, poisson=0.3):
    """(q L)_cr L^2 / sqrt(EI GJ) of a strip on edge under its own weight, clamped at one end."""
    X, T = meshes.rectangle(kind, 1.0, slenderness, slenderness / rows)
    clamped = X[:, 0] < 1e-9
    fabric = fabrics.isotropic(12e6, 1.0, poisson, density=1.0)
    sheet = ElasticSheet(X, T, np.zeros(len(T)), [fabric], clamped=clamped)
    free = np.flatnonzero(~clamped)
    inplane = np.sort(np.concatenate([3 * free, 3 * free + 1]))
    x, weight = flat(X), 1e-3
    force = np.zeros_like(x)
    force[:, 1] = -weight * sheet.mass
    sag = np.zeros(x.size)
    H = sheet.membrane.hessian(x).tocsr()[inplane][:, inplane]
    sag[inplane] = spsolve(H.tocsc(), force.ravel()[inplane])
    sag = sag.reshape(-1, 3)
    # The load's part of the Hessian, linear in the sag.
    up, down = (normal_part(sheet.membrane.hessian(x + sign * sag)) for sign in (1, -1))
    geometric = (0.5 * (up - down))[free][:, free].tocsc()
    bending = sheet.bending.stiffness()[free][:, free].tocsc()
    top = eigsh(
        -geometric,
        k=1,
        M=bending,
        which="LM",
        tol=1e-6,
        return_eigenvectors=False,
        v0=np.random.default_rng(0).standard_normal(len(free)),
    )
    load = weight * slenderness / abs(top[0])
    EI, GJ = (1 - poisson**2) * slenderness, 2 * (1 - poisson) * slenderness
    return load / np.sqrt(EI * GJ)


def sine_curvature_error(kind, edges_per_wave, *, edges=48, amplitude=1e-4):
    """Error rms / peak of the curvature tensor of a skew sine sheet: raw, and recovered."""
    X, T = meshes.rectangle(kind, 1.0, 1.0, 1.0 / edges)
    sheet = ElasticSheet(X, T, np.zeros(len(T)), [fabrics.isotropic()])
    q = 2 * np.pi * edges / edges_per_wave
    along = np.array([np.cos(0.35), np.sin(0.35)])
    x = np.column_stack([X, amplitude * np.sin(q * (X @ along))])
    centre = X[T].mean(axis=1)
    exact = (amplitude * q**2 * np.sin(q * (centre @ along)))[:, None, None] * np.outer(
        along, along
    )
    inner = ((centre > 0.12) & (centre < 0.88)).all(axis=1)
    return [
        np.sqrt(((kappa - exact)[inner] ** 2).sum(axis=(1, 2)).mean()) / (amplitude * q**2)
        for kappa in (sheet.curvatures(x), sheet.recovered_curvatures(x))
    ]
