"""Triangle meshes of a rectangle, from kind to unkind, for every test of an element."""

import numpy as np
from scipy.spatial import Delaunay

KINDS = ("uns", "right", "alt", "cross", "sliver")


def rectangle(kind, length, width, h, *, seed=0):
    """Rest vertices (n, 2) and faces (m, 3) of [0, length] x [0, width], edges about h long.

    Also of kind "graded": edges from 0.55 h to 1.45 h, areas from 1 to 5.
    """
    if kind == "graded":
        X, T = _jittered(length, width, h, seed)
        x, y = (X / [length, width]).T
        x = x + 0.45 / (4 * np.pi) * np.sin(4 * np.pi * x)
        y = y + 0.3 * y * (1 - y)
        return np.column_stack([length * x, width * y]), T
    nx, ny = max(1, round(length / h)), max(1, round(width / h))
    if kind == "uns":
        return _jittered(length, width, h, seed)
    X, T = _grid(nx, ny, kind)
    X = X * [length / nx, width / ny]
    if kind == "sliver":
        rng = np.random.default_rng(seed)
        inside = (X > 1e-9).all(axis=1) & (np.array([length, width]) - 1e-9 > X).all(axis=1)
        # Within a disc of 0.3 h no triangle turns over: angles down to about 5 degrees.
        r, phi = (
            0.3 * np.sqrt(rng.uniform(size=inside.sum())),
            rng.uniform(0, 2 * np.pi, inside.sum()),
        )
        step = np.stack([r * np.cos(phi), r * np.sin(phi)], axis=1)
        X[inside] += step * [length / nx, width / ny]
    return X, T


def _grid(nx, ny, kind):
    X = np.stack(np.meshgrid(np.arange(nx + 1.0), np.arange(ny + 1.0), indexing="ij"), axis=-1)
    i, j = np.meshgrid(np.arange(nx), np.arange(ny), indexing="ij")
    a = (i * (ny + 1) + j).ravel()
    b, c, d = a + ny + 1, a + ny + 2, a + 1
    X = X.reshape(-1, 2)
    if kind == "cross":
        mid = len(X) + np.arange(nx * ny)
        X = np.concatenate([X, np.stack([i.ravel() + 0.5, j.ravel() + 0.5], axis=1)])
        T = np.concatenate([np.stack([p, q, mid], 1) for p, q in ((a, b), (b, c), (c, d), (d, a))])
        return X, T
    first = np.stack([np.stack([a, b, c], 1), np.stack([a, c, d], 1)], 1)
    if kind == "alt":
        other = np.stack([np.stack([a, b, d], 1), np.stack([b, c, d], 1)], 1)
        first = np.where(((i + j).ravel() % 2 == 0)[:, None, None], first, other)
    return X, first.reshape(-1, 3)


def _jittered(length, width, h, seed):
    """Delaunay mesh of a jittered triangular lattice, smoothed a little, edges kept straight."""
    rng = np.random.default_rng(seed)
    nx, ny = max(1, round(length / h)), max(1, round(width / h))
    rim = [np.stack([np.linspace(0, length, nx + 1), np.full(nx + 1, y)], 1) for y in (0, width)]
    side = np.linspace(0, width, ny + 1)[1:-1]
    rim += [np.stack([np.full(len(side), x), side], 1) for x in (0, length)]
    rim = np.concatenate(rim)
    rows = max(1, round(width / (h * np.sqrt(0.75))))
    ys = width * np.arange(1, rows) / rows
    inner = []
    for k, y in enumerate(ys):
        xs = np.arange(0.5 if k % 2 == 0 else 1.0, nx - 0.4) * length / nx
        inner.append(np.stack([xs, np.full(len(xs), y)], 1))
    inner = np.concatenate(inner) if inner else np.zeros((0, 2))
    inner = inner + rng.uniform(-0.2, 0.2, inner.shape) * h
    X = np.concatenate([rim, inner])
    for _ in range(3):
        T = _delaunay(X)
        total, count = np.zeros_like(X), np.zeros(len(X))
        for k in range(3):
            np.add.at(total, T[:, k], X[T[:, k - 1]] + X[T[:, k - 2]])
            np.add.at(count, T[:, k], 2)
        mean = total / count[:, None]
        X[len(rim) :] = 0.5 * (X + mean)[len(rim) :]
    return X, _delaunay(X)


def _delaunay(X):
    T = Delaunay(X).simplices.astype(np.int64)
    p = X[T]
    u, v = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    area = 0.5 * (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
    T[area < 0] = T[area < 0][:, ::-1]
    # Straight rims make flat triangles of rim points alone.
    return T[np.abs(area) > 1e-9 * np.ptp(X) ** 2 / len(X)]
