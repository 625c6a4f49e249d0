"""The half-space seen from each vertex, by rays."""

from __future__ import annotations

import numpy as np
from numba import njit

from seatlook.pbr.kernels import leaf
from seatlook.pbr.kernels.bvh import nearest, new_stack
from seatlook.pbr.kernels.light import across, panorama_towards
from seatlook.pbr.kernels.noise import even
from seatlook.pbr.kernels.shadow import ABOVE, disc_at, reaches, to_middle
from seatlook.pbr.kernels.surface import (
    along,
    blend,
    cross,
    dot,
    lift,
    minus,
    row,
)

# What a ray meets other than the front of a face: the sky, what does not shine; or it is not sent.
OPEN, DARK, UNSENT = -1, -2, -3
# Taken for the distance [m] of what does not shine: the inside of a cover or a seam.
DARK_AT = 0.01


@njit(cache=True)
def inset(mesh, face, out):
    """Points (n, 3) at which light is gathered: vertices, and inside ``face`` those on an edge.

    ``face`` (n,): -1 within a panel. On a seam the point of a vertex touches the other panel.
    """
    for i in range(len(out)):
        p, f = row(mesh.vertices, i), face[i]
        if f >= 0:
            b1 = 0.6 if mesh.faces[f, 1] == i else 0.2
            b2 = 0.6 if mesh.faces[f, 2] == i else 0.2
            p = lift(mesh, f, b1, b2, blend(mesh.vertices, mesh.faces, f, b1, b2))
        for k in range(3):
            out[i, k] = p[k]


@njit(cache=True)
def lit(bvh, points, normals, lights, out):
    """Whether the middle of light k reaches point i, into ``out`` (k, n)."""
    stack = new_stack()
    for i in range(out.shape[1]):
        p, n = row(points, i), row(normals, i)
        o = along(p, 5 * ABOVE, n)
        for k in range(len(out)):
            l, far = to_middle(disc_at(lights, k, p))
            out[k, i] = 1.0 if dot(l, n) > 0.0 and reaches(bvh, o, n, l, far, stack) else 0.0


@leaf()
def direction(n, i, q, strata):
    """Direction q of strata^2 cosine-weighted ones around ``n``, turned per vertex i."""
    t, s = across(n)
    turn, shift = even(i, 0, 0), even(i, 1, 0)
    a = (q // strata + shift) / strata
    phi = 2.0 * np.pi * (q % strata + turn) / strata
    r, up = np.sqrt(a), np.sqrt(1.0 - a)
    return along(along((n[0] * up, n[1] * up, n[2] * up), r * np.cos(phi), t), r * np.sin(phi), s)


@leaf()
def face_met(bvh, o, d, faces, stack):
    """Face in front of which a ray ends; ``OPEN``, or ``DARK`` at the back of a face.

    Faces from ``faces`` on, below a seam, count as backs.
    """
    leaf, _, _, _ = nearest(bvh, o[0], o[1], o[2], d[0], d[1], d[2], 0.0, stack)
    if leaf < 0:
        return OPEN
    f = bvh.face[leaf]
    front = dot(cross(row(bvh.edge1, leaf), row(bvh.edge2, leaf)), d) < 0.0
    return f if front and f < faces else DARK


@njit(cache=True, nogil=True)
def sky_seen(normals, which, hits, strata, panorama, unhidden, out):
    """Mean luminance (m, 3) of a panorama over the open directions.

    What an unhidden plane gets (``unhidden`` (m, 3)) times the share that is open of what all
    directions see, each blurred to what it stands for: a window in a dark room is hit by chance,
    and few rays by themselves would leave patches of light and dark.
    """
    width = np.sqrt(1.0 / strata)
    open_, every = np.empty(3), np.empty(3)
    for r in range(len(hits)):
        n = row(normals, which[r])
        open_[:], every[:] = 0.0, 1e-30
        for q in range(strata * strata):
            seen = panorama_towards(panorama, width, direction(n, which[r], q, strata))
            for k in range(3):
                every[k] += seen[k]
                if hits[r, q] == OPEN:
                    open_[k] += seen[k]
        for k in range(3):
            out[r, k] = unhidden[r, k] * open_[k] / every[k]


@njit(cache=True, nogil=True)
def gather(bvh, faces, points, normals, which, strata, hits):
    """What the vertices ``which`` see along strata^2 cosine-weighted directions, into ``hits``."""
    stack = new_stack()
    for r in range(len(which)):
        i = which[r]
        n = row(normals, i)
        o = along(row(points, i), 10 * ABOVE, n)
        for q in range(strata * strata):
            hits[r, q] = face_met(bvh, o, direction(n, i, q, strata), faces, stack)


@njit(cache=True)
def around(mesh, points, hits, out):
    """How far [m] the faces met by the rays of each point are, as a harmonic mean, into ``out``."""
    third = 1.0 / 3.0
    for r in range(len(hits)):
        total = 0.0
        for q in range(hits.shape[1]):
            f = hits[r, q]
            if f >= 0:
                to = minus(blend(mesh.vertices, mesh.faces, f, third, third), row(points, r))
                total += 1.0 / max(1e-4, np.sqrt(dot(to, to)))
            elif f == DARK:
                total += 1.0 / DARK_AT
        out[r] = hits.shape[1] / total if total > 0.0 else np.inf


@leaf()
def bounce(mesh, hits, albedo, luminances, out):
    """Mean luminance (m, 3) from the faces met, Lambert with ``albedo`` (p, 3).

    ``luminances`` (n, 3): luminance that the vertices get.
    """
    for r in range(hits.shape[0]):
        out[r] = 0.0
        for q in range(hits.shape[1]):
            f = hits[r, q]
            if f < 0:
                continue
            a, b, c = mesh.faces[f, 0], mesh.faces[f, 1], mesh.faces[f, 2]
            for k in range(3):
                mean = (luminances[a, k] + luminances[b, k] + luminances[c, k]) / 3.0
                out[r, k] += albedo[mesh.panel[f], k] * mean / hits.shape[1]
