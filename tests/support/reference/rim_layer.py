"""The layer along the free edge of a bent sheet: a load along the edge against its closed form."""

import numpy as np
from scipy.sparse import block_diag, csc_array
from scipy.sparse.linalg import splu

from seatlook.solver.element.elastic import ElasticSheet
from support import fabrics, meshes


def rim_stiffness(kind, ratio, *, radius=60.0, seed=0):
    """Stiffness of a free edge against a radial load along it, over the exact one, minus 1.

    A thin sheet bent to a ``radius`` gives way in a layer 1 / b wide, b^4 = K / (4 B radius^2): a
    beam (B) on a bed (K / radius^2, its hoop stretch), stiffness 2 B b^3 to a length. The width is
    1 here, and elements are ``ratio`` of it.
    """
    length, width = 16.0, 12.0
    stretch, bend = 1.0, 0.25 / radius**2
    X, T = meshes.rectangle(kind, length, width, ratio, seed=seed)
    angle = (X[:, 0] - 0.5 * length) / radius
    c, s, zero = np.cos(angle), np.sin(angle), np.zeros(len(X))
    x = np.column_stack([radius * s, X[:, 1], radius * c])
    ends = (X[:, 0] < 1e-9) | (X[:, 0] > length - 1e-9)
    fabric = fabrics.isotropic(stretch, bend, thickness=np.sqrt(12 * bend / stretch))
    sheet = ElasticSheet(X, T, np.zeros(len(T)), [fabric], clamped=ends, positions=x)
    # Radial, along the axis, along the arc; the ends may move within their planes only.
    frame = np.stack(
        [np.stack([s, zero, c], 1), np.stack([zero, zero + 1, zero], 1), np.stack([c, zero, -s], 1)]
    )
    turn = block_diag(list(frame.transpose(1, 0, 2)), format="csr")
    hessian = csc_array(turn @ (sheet.membrane.hessian(x) + sheet.bending.hessian(x)) @ turn.T)
    free = np.ones((len(X), 3), dtype=bool)
    free[ends, 2] = False
    free[np.argmax(X[:, 1]), 1] = False
    rim = np.flatnonzero(X[:, 1] < 1e-9)
    rim = rim[np.argsort(X[rim, 0])]
    load = np.zeros((len(X), 3))
    half = 0.5 * np.diff(X[rim, 0])
    load[rim[:-1], 0] += half
    load[rim[1:], 0] += half
    index = np.flatnonzero(free)
    moved = splu(hessian[index][:, index]).solve(load.ravel()[index])
    return length / (load.ravel()[index] @ moved) / (2 * bend) - 1
