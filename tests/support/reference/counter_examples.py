"""Elements and a method that fail, for charts and for tests of what they get wrong.

No part of the product: linear triangles with hinges, the six-node patch, position-based dynamics.
"""

import numpy as np
from numba import njit
from scipy.sparse import csc_array, csr_array, diags_array, eye_array, kron

from seatlook.solver.element.edgeslope import areas, edges_of
from seatlook.solver.element.elastic import ElasticSheet


class MatrixBending:
    """Bending energy 1/2 sum x_c . K x_c of one scalar matrix (n, n) [N/m]."""

    def __init__(self, matrix):
        self._matrix = csr_array(matrix)

    def value(self, x, gradient):
        force = self._matrix @ x
        gradient += force
        return 0.5 * float((force * x).sum())

    def stiffness(self):
        return csc_array(self._matrix)

    def hessian(self, x, *, definite=False):
        del x, definite
        return csc_array(kron(self._matrix, eye_array(3)))


class LinearMembrane:
    """Constant-strain triangles of a linear fabric: A/2 E . D E with Green's strain E."""

    def __init__(self, X, T, fabric):
        self._faces, self._area, self._count = T, areas(X, T), len(X)
        self._stiffness = fabric.membrane_matrix
        p = X[T]
        rest = np.stack([p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]], axis=2)
        slopes = np.linalg.inv(rest)
        # Gradients of the three hat functions, (m, 3, 2).
        self._hat = np.concatenate([-slopes.sum(axis=1, keepdims=True), slopes], axis=1)

    def _deformed(self, x):
        F = np.einsum("tnd,tna->tda", x[self._faces], self._hat)
        C = np.einsum("tda,tdb->tab", F, F)
        E = np.stack([0.5 * (C[:, 0, 0] - 1), 0.5 * (C[:, 1, 1] - 1), C[:, 0, 1]], axis=1)
        return F, E

    def _rates(self, F):
        """Derivative of the strains by the corners, (m, 3 strains, 3 corners, 3 axes)."""
        f, g, hat = F[:, :, 0], F[:, :, 1], self._hat
        one = np.einsum("tn,td->tnd", hat[:, :, 0], f)
        two = np.einsum("tn,td->tnd", hat[:, :, 1], g)
        both = np.einsum("tn,td->tnd", hat[:, :, 0], g) + np.einsum("tn,td->tnd", hat[:, :, 1], f)
        return np.stack([one, two, both], axis=1)

    def value(self, x, gradient):
        F, E = self._deformed(x)
        S = E @ self._stiffness
        force = np.einsum("tk,tknd,t->tnd", S, self._rates(F), self._area)
        np.add.at(gradient, self._faces, force)
        return 0.5 * float(((S * E).sum(axis=1) * self._area).sum())

    def stiffness(self):
        pull = np.tile([self._stiffness[0, 0], self._stiffness[1, 1], 0.0], (len(self._area), 1))
        return self._strings(pull)

    def _strings(self, S):
        tensor = np.stack([S[:, 0], S[:, 2], S[:, 2], S[:, 1]], axis=1).reshape(-1, 2, 2)
        blocks = np.einsum("tia,tab,tjb,t->tij", self._hat, tensor, self._hat, self._area)
        rows = np.broadcast_to(self._faces[:, :, None], blocks.shape)
        columns = np.broadcast_to(self._faces[:, None, :], blocks.shape)
        index = rows.ravel(), columns.ravel()
        return csc_array((blocks.ravel(), index), shape=(self._count, self._count))

    def hessian(self, x, *, definite=False):
        F, E = self._deformed(x)
        m = len(E)
        place = 3 * self._faces[:, None, :, None] + np.arange(3)
        columns = np.broadcast_to(place, (m, 3, 3, 3)).ravel()
        shape = (3 * m, 3 * self._count)
        rates = csr_array((self._rates(F).ravel(), columns, 9 * np.arange(3 * m + 1)), shape=shape)
        weight = kron(diags_array(self._area), csr_array(self._stiffness))
        positive = rates.T @ weight @ rates
        if definite:
            return csc_array(positive)
        return csc_array(positive + kron(self._strings(E @ self._stiffness), eye_array(3)))


class LinearSheet:
    """Constant-strain triangles with the bending of a matrix; offers what an ElasticSheet does."""

    def __init__(self, X, T, fabric, matrix):
        self.faces, self.edges, self.area = T, edges_of(X, T), areas(X, T)
        self.membrane = LinearMembrane(X, T, fabric)
        self.bending = MatrixBending(matrix)
        self.thickness = np.full(len(T), fabric.thickness)
        share = np.repeat(fabric.density * self.area / 3.0, 3)
        self.mass = np.bincount(T.ravel(), share, minlength=len(X))

    @property
    def energies(self):
        return (self.membrane, self.bending)

    def stiffness(self):
        return self.membrane.stiffness()

    def across(self):
        return self.bending.stiffness()


def hinges(X, T, bend):
    """Stiffness of hinges, energy 1/2 B l^2 / A theta^2, theta the turn between two triangles."""
    edges, area = edges_of(X, T), areas(X, T)
    inner = np.flatnonzero(~edges.free)
    rows, columns, values = [], [], []
    for side, sign in ((0, 1.0), (1, -1.0)):
        face = edges.faces[inner, side]
        p = X[T[face]]
        for k in range(3):
            # The gradient of corner k's hat function points from the opposite edge to it.
            along = p[:, k - 1] - p[:, k - 2]
            hat = np.stack([-along[:, 1], along[:, 0]], axis=1) / (2.0 * area[face])[:, None]
            rows.append(np.arange(len(inner)))
            columns.append(T[face, k])
            values.append(sign * (hat * edges.normal[inner]).sum(axis=1))
    index = np.concatenate(rows), np.concatenate(columns)
    turn = csr_array((np.concatenate(values), index), shape=(len(inner), len(X)))
    both = area[edges.faces[inner]].sum(axis=1)
    stiff = bend * edges.length[inner] ** 2 / both
    return csr_array(turn.T @ turn.multiply(stiff[:, None])), turn, stiff


def patches(X, T, D):
    """Stiffness of the quadratic through each triangle's six nodes, of least curvature at rims."""
    edges, area = edges_of(X, T), areas(X, T)
    rows, columns, values = [], [], []
    for t, corners in enumerate(T):
        sides = [e for e in edges.of_face[t] if edges.faces[e, 1] >= 0]
        far = [int(T[edges.faces[e].sum() - t].sum() - edges.ends[e].sum()) for e in sides]
        nodes = [*corners, *far]
        h = np.sqrt(area[t])
        u, v = ((X[nodes] - X[corners].mean(axis=0)) / h).T
        plane = np.stack([np.ones_like(u), u, v], axis=1)
        curved = np.stack([0.5 * u * u, 0.5 * v * v, 0.5 * u * v], axis=1)
        # What the far nodes see beyond the plane through the corners.
        beyond = np.hstack([-plane[3:] @ np.linalg.inv(plane[:3]), np.eye(len(far))])
        fit = np.linalg.pinv(beyond @ curved) @ beyond / h**2
        rows.append(np.repeat(3 * t + np.arange(3), len(nodes)))
        columns.append(np.tile(nodes, 3))
        values.append(fit.ravel())
    index = np.concatenate(rows), np.concatenate(columns)
    H = csr_array((np.concatenate(values), index), shape=(3 * len(T), len(X)))
    return csr_array(H.T @ kron(diags_array(area), csr_array(D)) @ H)


def sheet_of(element, X, T, fabric, **options):
    """The product's sheet ("edgeslope"), or linear triangles with "hinge" or "patch6" bending."""
    if element == "edgeslope":
        return ElasticSheet(X, T, np.zeros(len(T), dtype=np.int64), [fabric], **options)
    if element == "hinge":
        return LinearSheet(X, T, fabric, hinges(X, T, fabric.bending_warp)[0])
    return LinearSheet(X, T, fabric, patches(X, T, fabric.bending_matrix))


def position_based(X, T, fabric, x, fixed, gravity, *, dt, iterations):
    """One step of extended position-based dynamics from rest (Macklin et al. 2016).

    Constraints are the three strains of every triangle (Poisson's ratio 0) and the turn at every
    hinge, one after the other; ``iterations`` sweeps over all of them.
    """
    area = areas(X, T)
    _, turn, stiff = hinges(X, T, fabric.bending_warp)
    p = X[T]
    rest = np.linalg.inv(np.stack([p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]], axis=2))
    share = np.repeat(fabric.density * area / 3.0, 3)
    inverse = np.where(fixed, 0.0, 1.0 / np.bincount(T.ravel(), share, minlength=len(X)))
    stretch = np.array([c.stiffness[0] for c in (fabric.warp, fabric.weft, fabric.shear)])
    x = np.array(x)
    x[~fixed] += dt**2 * np.asarray(gravity)
    strain_load, turn_load = np.zeros((len(T), 3)), np.zeros((len(stiff), 3))
    turn = _compressed(turn)
    for _ in range(iterations):
        _strain_sweep(x, T, rest, inverse, area, stretch, dt, strain_load)
        _turn_sweep(x, *turn, inverse, stiff, dt, turn_load)
    return x


def _compressed(matrix):
    """Pointers, columns and values of a sparse matrix, duplicates summed."""
    matrix = matrix.copy()
    matrix.sum_duplicates()
    return matrix.indptr, matrix.indices, matrix.data


@njit(cache=True)
def _strain_sweep(x, T, rest, inverse, area, stretch, dt, load):
    F = np.empty((3, 2))
    g = np.empty((3, 3))
    for t in range(len(T)):
        a, b, c = T[t]
        for k in range(3):
            for d in range(3):
                u, v = x[b, d] - x[a, d], x[c, d] - x[a, d]
                F[d, 0] = u * rest[t, 0, 0] + v * rest[t, 1, 0]
                F[d, 1] = u * rest[t, 0, 1] + v * rest[t, 1, 1]
            i, j = (0, 0) if k == 0 else ((1, 1) if k == 1 else (0, 1))
            dot = F[0, i] * F[0, j] + F[1, i] * F[1, j] + F[2, i] * F[2, j]
            value = 0.5 * (dot - 1.0) if k < 2 else dot
            for d in range(3):
                f, e = (F[d, i], F[d, j]) if k == 2 else (0.5 * F[d, i], 0.5 * F[d, i])
                g[1, d] = f * rest[t, 0, j] + e * rest[t, 0, i]
                g[2, d] = f * rest[t, 1, j] + e * rest[t, 1, i]
                g[0, d] = -g[1, d] - g[2, d]
            weight = 0.0
            for n in range(3):
                w = inverse[T[t, n]]
                weight += w * (g[n, 0] ** 2 + g[n, 1] ** 2 + g[n, 2] ** 2)
            soft = 1.0 / (stretch[k] * area[t] * dt * dt)
            change = (-value - soft * load[t, k]) / (weight + soft)
            load[t, k] += change
            for n in range(3):
                for d in range(3):
                    x[T[t, n], d] += inverse[T[t, n]] * g[n, d] * change


@njit(cache=True)
def _turn_sweep(x, start, nodes, weights, inverse, stiff, dt, load):
    for e in range(len(stiff)):
        soft = 1.0 / (stiff[e] * dt * dt)
        weight = 0.0
        for q in range(start[e], start[e + 1]):
            weight += inverse[nodes[q]] * weights[q] ** 2
        for d in range(3):
            value = 0.0
            for q in range(start[e], start[e + 1]):
                value += weights[q] * x[nodes[q], d]
            change = (-value - soft * load[e, d]) / (weight + soft)
            load[e, d] += change
            for q in range(start[e], start[e + 1]):
                x[nodes[q], d] += inverse[nodes[q]] * weights[q] * change
