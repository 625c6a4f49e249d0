"""Plain NumPy twins of the compiled kernels."""

import numpy as np

from seatlook.solver.element.edgeslope import Rows


def edge_strains(x, ends, length, rows, offset):
    """Green strain of every edge along its arc; ``rows`` (e, n) gives the second derivative."""
    bow = rows @ x + offset
    chord = x[ends[:, 1]] - x[ends[:, 0]]
    square = (chord**2).sum(axis=1) / length**2 + (bow**2).sum(axis=1) * length**2 / 12.0
    return 0.5 * (square - 1.0)


def along_rims(E, edges, area):
    """Strains E (m, ...) after triangles with one free edge and their neighbours have exchanged."""
    out, free = E.copy(), edges.free[edges.of_face].sum(axis=1)
    for a, b in edges.faces[~edges.free]:
        if (free[a] == 1) != (free[b] == 1):
            # Half of a third of the way to each neighbour, in the area that both have.
            part = min(area[a], area[b]) / 6.0 * (E[b] - E[a])
            out[a] += part / area[a]
            out[b] -= part / area[b]
    return out


def curve(strain, stiffness, e):
    """Energy and stress of a piecewise linear stiffness by fine quadrature from zero strain."""
    s = np.linspace(0.0, e, 20001)
    k = np.interp(s, strain, stiffness)
    step = np.diff(s)
    stress = np.concatenate([[0.0], np.cumsum(0.5 * (k[1:] + k[:-1]) * step)])
    return float((0.5 * (stress[1:] + stress[:-1]) * step).sum()), float(stress[-1])


def quadratic(matrix, x):
    """Half of x . K x, and K x."""
    return 0.5 * float((x * (matrix @ x)).sum()), matrix @ x


def conormal_slopes(X, ends, start, nodes, values, ridge):
    """Mean slope across every edge from a weighted least-squares cubic through the edge's ends.

    Its cubic terms are held near zero by ``ridge``.
    """
    out = np.empty(len(ends))
    hold = np.eye(8)[:4] * np.sqrt(ridge)
    for e, (p, q) in enumerate(ends):
        along = X[q] - X[p]
        length = np.hypot(*along)
        t = along / length
        n = np.array([t[1], -t[0]])
        others = nodes[start[e] + 2 : start[e + 1]]
        r = (X[others] - 0.5 * (X[p] + X[q])) / length
        s, d = r @ t, r @ n
        cubic = [s * (s**2 - 0.25) / 6, d * (s**2 - 1 / 12) / 2, s * d**2 / 2, d**3 / 6]
        A = np.stack([*cubic, 0.5 * (s**2 - 0.25), s * d, 0.5 * d**2, d], axis=1)
        w = np.sqrt(1.0 / ((r**2).sum(axis=1) + 0.05))
        mean, rise = 0.5 * (values[p] + values[q]), values[q] - values[p]
        right = np.concatenate([np.zeros(4), (values[others] - mean - rise * s) * w])
        left = np.concatenate([hold, A * w[:, None]])
        out[e] = np.linalg.lstsq(left, right, rcond=None)[0][7] / length
    return out


def curvature_rows(X, edges, rows, area):
    """Dense (m, 3, n) rows of (x,11  x,22  2 x,12) by Green's theorem, edge by edge."""
    out = np.zeros((len(area), 3, len(X)))
    for t in range(len(area)):
        for k in range(3):
            e = edges.of_face[t, k]
            p, q = edges.ends[e]
            nu = edges.normal[e]
            tau = np.array([-nu[1], nu[0]])
            gradient = np.zeros((2, len(X)))
            for i in range(rows.start[e], rows.start[e + 1]):
                gradient[:, rows.nodes[i]] += nu * rows.weights[i]
            gradient[:, q] += tau / edges.length[e]
            gradient[:, p] -= tau / edges.length[e]
            scale = edges.sign[t, k] * edges.length[e] / area[t]
            out[t, 0] += scale * nu[0] * gradient[0]
            out[t, 1] += scale * nu[1] * gradient[1]
            out[t, 2] += scale * (nu[0] * gradient[1] + nu[1] * gradient[0])
    return out


def bending_matrix(rows, edges, area, stiffness, share):
    """Dense (n, n) matrix of ``sum A k . D k`` plus ``share`` of the jumps across inner edges."""
    inner = edges.faces[:, 1] >= 0
    sides = inner[edges.of_face].sum(axis=1)
    K = np.einsum("t,tin,tij,tjm->nm", area, rows, stiffness, rows)
    for first, second in edges.faces[inner]:
        weight = share * (area[first] / sides[first] + area[second] / sides[second])
        jump = rows[first] - rows[second]
        K += weight * jump.T @ (0.5 * (stiffness[first] + stiffness[second])) @ jump
    return K


def morley_matrix(X, edges, area, stiffness):
    """Dense (n, n) bending matrix of Morley's plate element, the turns of its edges condensed."""
    n, e = len(X), len(edges.ends)
    turns = Rows(np.arange(e + 1), n + np.arange(e), np.ones(e))
    rows = curvature_rows(np.concatenate([X, np.zeros((e, 2))]), edges, turns, area)
    K = np.einsum("t,tin,tij,tjm->nm", area, rows, stiffness, rows, optimize=True)
    return K[:n, :n] - K[:n, n:] @ np.linalg.solve(K[n:, n:], K[n:, :n])


def shell_bending(rows, natural, x, sheet, stiffness, share=0.4):
    """Energy of (x,ij - b n) and of its jumps, triangle by triangle and edge by edge."""
    change = np.empty((len(rows), 3, 3))
    for t, (a, b, c) in enumerate(x[sheet.faces]):
        normal = np.cross(b - a, c - a)
        change[t] = rows[t] @ x - np.outer(natural[t], normal / np.linalg.norm(normal))
    energy = 0.5 * np.einsum("t,tci,tcd,tdi", sheet.area, change, stiffness, change)
    inner = sheet.edges.faces[:, 1] >= 0
    sides = inner[sheet.edges.of_face].sum(axis=1)
    for first, second in sheet.edges.faces[inner]:
        weight = share * (sheet.area[first] / sides[first] + sheet.area[second] / sides[second])
        jump = change[first] - change[second]
        mean = 0.5 * (stiffness[first] + stiffness[second])
        energy += 0.5 * weight * np.einsum("ci,cd,di", jump, mean, jump)
    return energy
