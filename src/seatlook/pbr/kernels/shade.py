"""Radiance of every sample: direct lights, sky and first bounce, with one BRDF."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from numba import njit

from seatlook.pbr.kernels import leaf
from seatlook.pbr.kernels.brdf import Tables, albedo_towards, brdf, view_of
from seatlook.pbr.kernels.grain import Textures, grain
from seatlook.pbr.kernels.stitch import Thread, away_from_seam, relief, seam_at, tilt
from seatlook.pbr.kernels.surface import (
    along,
    blend,
    cross,
    dot,
    meet,
    minus,
    ray_through,
    row,
    row_of,
    unit,
)
from seatlook.pbr.kernels.tables import coupling_at


class Lights(NamedTuple):
    """``near`` (k,): 0 far, 1 near; ``vector`` (k, 3); ``intensity`` (k, 3) [lux] or [cd]."""

    near: npt.NDArray[np.int64]
    vector: npt.NDArray[np.float64]
    intensity: npt.NDArray[np.float64]


class Around(NamedTuple):
    """What arrives from elsewhere, per vertex, as luminance equal from all open directions.

    ``sky`` (n, 3) [cd/m2]: the share of the sky not covered; ``bounce`` (n, 3) [cd/m2]: what the
    cover itself sends.
    """

    sky: npt.NDArray[np.float64]
    bounce: npt.NDArray[np.float64]


class Look(NamedTuple):
    """What the surface is made of.

    ``materials`` (p,): records of ``brdf.MATERIAL`` per panel; ``couplings`` (p, k): mean of what
    reaches their diffuse base, over roughness.
    """

    materials: npt.NDArray[np.void]
    couplings: npt.NDArray[np.float64]
    tables: Tables
    textures: Textures
    thread: Thread


@leaf()
def arriving(lights, k, p):
    """Unit direction to light k and irradiance (3,) [lux] on a plane facing it."""
    if lights.near[k] == 0:
        return row(lights.vector, k), row(lights.intensity, k)
    to = minus(row(lights.vector, k), p)
    s = 1.0 / dot(to, to)
    i = row(lights.intensity, k)
    return unit(to), (i[0] * s, i[1] * s, i[2] * s)


@leaf()
def _towards_eye(n, v):
    """Normal bent just enough to face the eye, which interpolated ones at a silhouette do not."""
    c = dot(n, v)
    if c >= 0.01:
        return n
    return unit(along(n, 0.01 - c, v))


@leaf()
def _frame(n, warp):
    """Unit warp in the plane of ``n`` and the weft beside it."""
    t = along(warp, -dot(warp, n), n)
    if dot(t, t) < 1e-12:
        t = (n[1], -n[0], 0.0) if abs(n[2]) < 0.9 else (0.0, n[2], -n[1])
        t = along(t, -dot(t, n), n)
    t = unit(t)
    return t, cross(n, t)


@leaf()
def sample(mesh, look, lights, around, f, hit, visible, work):
    """Radiance of one sample into ``work[0]``; ``work`` is (2, 3).

    ``hit``: (weight, weight, distance, face normal, unit ray, angle between samples);
    ``visible`` (k,): share of each light that is not hidden.
    """
    b1, b2, t, plane, ray, spread = hit
    v = (-ray[0], -ray[1], -ray[2])
    p = blend(mesh.vertices, mesh.faces, f, b1, b2)
    n = unit(blend(mesh.normals, mesh.faces, f, b1, b2))
    if dot(plane, v) < 0.0:
        n = (-n[0], -n[1], -n[2])
    n = _towards_eye(n, v)
    material = look.materials[mesh.panel[f]]
    warp, weft = _frame(n, blend(mesh.warp, mesh.faces, f, b1, b2))
    roughness, share, lighter = material.roughness, 1.0, 0.0
    if material.texture >= 0:
        i, j, k = mesh.faces[f, 0], mesh.faces[f, 1], mesh.faces[f, 2]
        u = (1.0 - b1 - b2) * mesh.uv[i, 0] + b1 * mesh.uv[j, 0] + b2 * mesh.uv[k, 0]
        w = (1.0 - b1 - b2) * mesh.uv[i, 1] + b1 * mesh.uv[j, 1] + b2 * mesh.uv[k, 1]
        width = t * spread / np.sqrt(max(0.05, dot(n, v)))
        su, sv, roughness, share = grain(look.textures, material, u, w, width)
        n = unit(along(along(n, -su, warp), -sv, weft))
    distance, arc = seam_at(mesh, f, b1, b2)
    if distance < np.inf:
        away, onward = away_from_seam(mesh, f)
        width = t * spread / np.sqrt(max(0.05, abs(dot(plane, v))))
        sa, so, left, covered = relief(look.thread, distance, arc, width)
        n = unit(tilt(n, away, onward, sa, so))
        share *= left
        lighter = covered * look.thread.lighter
        roughness += covered * max(0.0, 0.6 - roughness)
    n = _towards_eye(n, v)
    warp, weft = _frame(n, warp)
    out, f_out = work[0], work[1]
    view = view_of(
        look.tables, material, roughness, share, lighter, dot(warp, v), dot(weft, v), dot(n, v)
    )
    albedo_towards(look.tables, material, view, f_out)
    sky, bounce = (
        blend(around.sky, mesh.faces, f, b1, b2),
        blend(around.bounce, mesh.faces, f, b1, b2),
    )
    for c in range(3):
        out[c] = f_out[c] * (sky[c] + bounce[c])
    mean = coupling_at(look.couplings[mesh.panel[f]], view.table_roughness)
    for k in range(len(lights.near)):
        if visible[k] <= 0.0:
            continue
        l, e = arriving(lights, k, p)
        NoL = dot(n, l)
        if NoL <= 1e-5:
            continue
        brdf(look.tables, material, mean, view, dot(warp, l), dot(weft, l), NoL, f_out)
        for c in range(3):
            out[c] += f_out[c] * NoL * e[c] * visible[k]


@njit(cache=True)
def shade(mesh, eye, ids, look, lights, around, visibility, factor, out):
    """Mean radiance of ``factor`` x ``factor`` samples added to each pixel of ``out`` (h, w, 3).

    ``ids`` (h factor, w factor): face per sample, -1 for none; ``visibility`` likewise, (k, ., .),
    in 1/255. Returns the number of samples that hold something.
    """
    work = np.zeros((2, 3))
    weight = 1.0 / (factor * factor)
    visible = np.ones(len(lights.near))
    spread = np.sqrt(dot(row_of(eye.right), row_of(eye.right)))
    spread /= np.sqrt(dot(row_of(eye.first), row_of(eye.first)))
    count = 0
    for j in range(ids.shape[0]):
        for i in range(ids.shape[1]):
            f = ids[j, i]
            if f < 0:
                continue
            count += 1
            ray = ray_through(eye, i, j)
            b1, b2, t, plane = meet(mesh, eye, f, ray)
            for k in range(len(visible)):
                visible[k] = visibility[k, j, i] / 255.0
            hit = (b1, b2, t, plane, ray, spread)
            sample(mesh, look, lights, around, f, hit, visible, work)
            for c in range(3):
                out[j // factor, i // factor, c] += weight * work[0, c]
    return count
