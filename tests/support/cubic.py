"""A surface whose curvature varies in size, sign and direction, and its exact curvature."""

import numpy as np

SIZE = (0.12, 0.09)  # of the rest plane [m]
FRAME = np.linalg.qr(np.random.default_rng(7).normal(size=(3, 3)))[0]
FRAME *= np.linalg.det(FRAME)


def surface(X, bent=1.0):
    """A cubic over the rest plane, stretched unequally and sheared, turned and moved in space.

    Its curvature goes through 0, changes its sign and its directions. ``bent``: its height over the
    full one.
    """
    x, y = X.T
    u, v = x - 0.05, y - 0.04
    z = 60 * u**3 - 90 * u**2 * v + 40 * u * v**2 + 50 * v**3 + 2 * u * v - 1.5 * v**2
    flat = np.column_stack([1.06 * x + 0.05 * y, 0.97 * y])
    return np.array([0.2, 0.1, -0.4]) + np.column_stack([flat, bent * z]) @ FRAME.T


def derivatives(X, bent=1.0, e=1e-4):
    """First (k, 2, 3) and second (k, 2, 2, 3) derivatives of the surface, by differences."""
    step = e * np.eye(2)
    first = np.stack(
        [(surface(X + d, bent) - surface(X - d, bent)) / (2 * e) for d in step], axis=1
    )
    second = np.empty((len(X), 2, 2, 3))
    for i in range(2):
        for j in range(2):
            a, b = step[i], step[j]
            far = [surface(X + d, bent) for d in (a + b, a - b, b - a, -a - b)]
            second[:, i, j] = (far[0] - far[1] - far[2] + far[3]) / (4 * e**2)
    return first, second


def exact(X, bent=1.0):
    """Curvature (k, 2, 2) in rest axes, -n . x,ij, and the tensor (k, 3, 3) in space."""
    first, second = derivatives(X, bent)
    normal = np.cross(first[:, 0], first[:, 1])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    form = -np.einsum("kd,kijd->kij", normal, second)
    dual = np.linalg.inv(first @ first.transpose(0, 2, 1)) @ first
    return form, np.einsum("kia,kij,kjb->kab", dual, form, dual)


def share(error, field):
    """Rms of an error over the rms of the field by which it varies about its mean."""
    axes = tuple(range(1, field.ndim))
    varied = ((field - field.mean(axis=0)) ** 2).sum(axis=axes).mean()
    return np.sqrt((error**2).sum(axis=axes).mean() / varied)
