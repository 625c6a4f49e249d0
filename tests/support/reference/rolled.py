"""A strip bent to a full circle by turning its end, against B kappa and a closed circle."""

import numpy as np

from seatlook.solver.element.elastic import ElasticSheet
from seatlook.solver.methods.newton import Potential, newton
from support import fabrics, meshes
from support.reference.waves import flat


def rolled(X, T, angle, slenderness):
    """Energy of a strip whose last edge is turned by ``angle``, over B W / 2, and where it ends."""
    first, last = X[:, 0] < 1e-9, X[:, 0] > 1 - 1e-9
    c, s = np.cos(angle), np.sin(angle)
    turned = np.where((X[:, :1] > 0.5), flat(X) @ np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]), 0.0)
    ends = np.where(X[:, :1] > 0.5, turned, flat(X))
    sheet = ElasticSheet(
        X,
        T,
        np.zeros(len(T)),
        [fabrics.isotropic(12 / slenderness**2, 1.0, thickness=slenderness)],
        clamped=first | last,
        positions=ends,
    )
    x = np.column_stack([np.sin(angle * X[:, 0]), angle * X[:, 1], 1 - np.cos(angle * X[:, 0])])
    potential = Potential(sheet.energies, (), np.repeat(~first[:, None], 3, axis=1))
    found = newton(potential, x / angle, tolerance=1e-6, max_iterations=100)
    assert found.residual <= 1e-6
    return found.energy[-1] / (0.5 * X[:, 1].max()), found.x[last].mean(axis=0)


def missed(kind, edges, slenderness):
    """Share by which the moment of a full circle misses B kappa, and the gap of its ends [L].

    The moment is the energy's derivative by the turn; what it misses, the strip over-rolls.
    """
    X, T = meshes.rectangle(kind, 1.0, 0.2, 1 / edges)
    turn, step = 2 * np.pi, 0.02
    high, low = (rolled(X, T, turn + sign * step, slenderness)[0] for sign in (1, -1))
    _, end = rolled(X, T, turn, slenderness)
    return 0.5 * (high - low) / (2 * step) / turn - 1.0, np.hypot(end[0], end[2])
