"""What the cover sends to its own vertices, and what the lobe of a reflection sees from there."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from numba import njit

from seatlook.pbr.kernels import leaf
from seatlook.pbr.kernels.brdf import (
    COAT_F0,
    MIN_ALPHA,
    Reflector,
    albedo_towards,
    brdf,
    view_of,
)
from seatlook.pbr.kernels.bvh import new_stack
from seatlook.pbr.kernels.light import Lights, above_horizon, across, angle_of, arriving
from seatlook.pbr.kernels.lobes import F90, GGX, F_Schlick, lobe_of
from seatlook.pbr.kernels.noise import even
from seatlook.pbr.kernels.rays import DARK, OPEN, UNSENT, direction, face_met
from seatlook.pbr.kernels.shadow import ABOVE
from seatlook.pbr.kernels.stage import Look, frame, towards_eye
from seatlook.pbr.kernels.surface import Mesh, along, blend, cross, dot, minus, row, row_of, unit
from seatlook.pbr.kernels.tables import coupling_at

# Widths (alpha) of the lobes along which rays go, whatever the material: polish and grain.
_WIDTHS = (0.1, 0.35)
# Squared width by which rays of one per solid angle widen the lobes they meet: that of a disc as
# large, four times for the curvature of what they meet.
_BLUR = 4 * 0.125 / np.pi
# Of what is gathered over the half-space a ray counts as if it stood for a steradian: light that a
# highlight throws onto cloth is spread over that, or its few rays would let single points glow.
_OVER_HALF_SPACE = 1.0
# Rays along a reflection by which highlights in it are blurred, however many there are.
_RESOLVED = 72.0
# Of a lamp, what a face sends onto cloth is no brighter than a white card facing it, and what is
# mirrored no brighter than four: a highlight at grazing angles that few rays meet would outshine
# all that they see.
_SENT, _MIRRORED = 1.0 / np.pi, 4.0 / np.pi


@leaf()
def _visible_normal(alpha, x, z, a, b):
    """Heitz 2018: half-vector of a GGX lobe among those seen along (x, 0, z), for (a, b) in 1."""
    v = unit((alpha * x, 0.0, z))
    r, phi = np.sqrt(a), 2.0 * np.pi * b
    t1, t2 = r * np.cos(phi), r * np.sin(phi)
    s = 0.5 * (1.0 + v[2])
    t2 = (1.0 - s) * np.sqrt(1.0 - t1 * t1) + s * t2
    up = np.sqrt(max(0.0, 1.0 - t1 * t1 - t2 * t2))
    # The second axis across v is y, the first one (-z, 0, x).
    h = (up * v[0] - t2 * v[2], t1, up * v[2] + t2 * v[0])
    return unit((alpha * h[0], alpha * h[1], max(1e-6, h[2])))


@leaf()
def _lobe(i, q, strata, n, v):
    """Ray q from vertex i: unit direction mirrored at the half-vectors of one width."""
    NoV = dot(n, v)
    t = along(v, -NoV, n)
    side = np.sqrt(dot(t, t))
    t = across(n)[0] if side < 1e-6 else (t[0] / side, t[1] / side, t[2] / side)
    s = cross(n, t)
    width, cell = q // (strata * strata), q % (strata * strata)
    a = (cell // strata + even(i, 2, width)) / strata
    b = (cell % strata + even(i, 3, width)) / strata
    alpha = _WIDTHS[0] if width == 0 else _WIDTHS[1]
    h = _visible_normal(alpha, side, NoV, a, b)
    d = 2.0 * (h[0] * side + h[2] * NoV)
    x, y, z = d * h[0] - side, d * h[1], d * h[2] - NoV
    return along(along((z * n[0], z * n[1], z * n[2]), x, t), y, s)


@leaf()
def _density(NoV, NoH):
    """Probability of a ray of ``_lobe`` per solid angle, over all widths."""
    total = 0.0
    for alpha in _WIDTHS:
        d = NoH * NoH * (alpha * alpha - 1.0) + 1.0
        view = NoV + np.sqrt(alpha * alpha + (1.0 - alpha * alpha) * NoV * NoV)
        total += alpha * alpha / (np.pi * d * d) * 0.5 / view
    return total / len(_WIDTHS)


@leaf()
def _reflectance(material, n, v, d):
    """What base and coat reflect of light from ``d`` towards ``v``, but for bounces in them."""
    h = unit(along(v, 1.0, d))
    NoV, NoL, NoH, LoH = dot(n, v), dot(n, d), min(1.0, dot(n, h)), min(1.0, dot(d, h))
    metal, f0 = material.metalness, material.f0
    lobe = GGX(lobe_of(max(material.roughness**2, MIN_ALPHA), 0.0), NoV, NoL, NoH)
    value = (1.0 - metal) * F_Schlick(f0, F90(f0), LoH)
    if material.coat > 0.0:
        coat = material.coat * F_Schlick(COAT_F0, 1.0, LoH)
        top = GGX(lobe_of(material.coat_roughness**2, 0.0), NoV, NoL, NoH)
        value = value * (1.0 - coat) * lobe + (1.0 - metal) * coat * top
    else:
        value *= lobe
    if metal > 0.0:
        grey = (material.albedo[0] + material.albedo[1] + material.albedo[2]) / 3.0
        value += metal * F_Schlick(grey, F90(grey), LoH) * lobe
    return value * NoL


class Sources(NamedTuple):
    """What sends light from face to face.

    ``lit`` (k, n): share of each light that reaches a vertex; ``sky`` (n, 3) [cd/m2]: what else
    does, equal from everywhere.
    """

    mesh: Mesh
    look: Look
    lights: Lights
    lit: npt.NDArray[np.float64]
    sky: npt.NDArray[np.float64]


class Vertices(NamedTuple):
    """What some vertices see: their numbers ``which`` (m,), rising, and ``hits`` (m, rays).

    ``hits``: face met by each ray, or one of the codes of ``rays``.
    """

    which: npt.NDArray[np.int64]
    hits: npt.NDArray[np.int32]


class Reflection(NamedTuple):
    """How the reflections towards an eye are looked along.

    ``eye`` (3,); ``points`` (n, 3): where light is gathered; 2 ``strata``^2 rays per vertex.
    """

    eye: npt.NDArray[np.float64]
    points: npt.NDArray[np.float64]
    strata: int


@njit(cache=True, nogil=True)
def look_along_lobes(bvh, faces, reflection, normals, which, hits):
    """What the vertices ``which`` see along 2 strata^2 rays of reflection, into ``hits``.

    ``faces``: those from that number on count as backs.
    """
    stack, eye = new_stack(), row_of(reflection.eye)
    for r in range(len(which)):
        i = which[r]
        p = row(reflection.points, i)
        v = unit(minus(eye, p))
        n = towards_eye(row(normals, i), v)
        o = along(p, 10 * ABOVE, n)
        for q in range(hits.shape[1]):
            d = _lobe(i, q, reflection.strata, n, v)
            hits[r, q] = UNSENT
            if dot(n, d) > 1e-5:
                hits[r, q] = face_met(bvh, o, d, faces, stack)


@leaf()
def _send(sources, f, d, density, most, work):
    """Luminance that face f, seen from afar, sends against the ray d, into ``work[0]``.

    ``density``: rays like this one per solid angle; highlights of a finer detail than they resolve
    are blurred, or single vertices would glow. ``most``: of a lamp's irradiance facing it.
    """
    mesh, look, lights, third = sources.mesh, sources.look, sources.lights, 1.0 / 3.0
    v = (-d[0], -d[1], -d[2])
    n = towards_eye(unit(blend(mesh.normals, mesh.faces, f, third, third)), v)
    p = blend(mesh.vertices, mesh.faces, f, third, third)
    warp, weft = frame(n, row(mesh.warp, mesh.faces[f, 0]))
    panel = mesh.panel[f]
    material = look.materials[panel]
    colour = row_of(material.albedo)
    view = view_of(
        look.tables, material, material.roughness, colour, dot(warp, v), dot(weft, v), dot(n, v)
    )
    out, f_out, diffuse = work[0], work[1], work[2]
    coat = albedo_towards(look.tables, material, view, f_out, diffuse)
    sky = blend(sources.sky, mesh.faces, f, third, third)
    for c in range(3):
        out[c] = (f_out[c] + coat + diffuse[c]) * sky[c]
    mean = coupling_at(look.couplings[panel], view.roughness)
    reflector = Reflector(material, look.layers[panel], look.fibres[panel], mean, view)
    for k in range(len(lights.near)):
        seen = 0.0
        for corner in range(3):
            seen += third * sources.lit[k, mesh.faces[f, corner]]
        if seen <= 0.0:
            continue
        l, e = arriving(lights, k, p)
        angle = angle_of(lights, k, p)
        NoL = above_horizon(dot(n, l), dot(n, l), angle)
        if NoL <= 1e-5:
            continue
        wider = 0.125 * angle * angle + _BLUR / density
        x, y = dot(warp, l), dot(weft, l)
        brdf(look.tables, reflector, wider, x, y, NoL, f_out)
        for c in range(3):
            out[c] += seen * min(f_out[c] * NoL, most) * e[c]


@njit(cache=True, nogil=True)
def first_bounce(sources, vertices, strata, out):
    """Mean luminance (m, 3) that vertices get from the faces they met."""
    work, rays, hits = np.zeros((3, 3)), strata * strata, vertices.hits
    for r in range(len(hits)):
        i = vertices.which[r]
        n = row(sources.mesh.normals, i)
        out[r] = 0.0
        for q in range(rays):
            if hits[r, q] >= 0:
                d = direction(n, i, q, strata)
                _send(sources, hits[r, q], d, _OVER_HALF_SPACE, _SENT, work)
                for c in range(3):
                    out[r, c] += work[0, c] / rays


@leaf()
def _covered(hits):
    """Whether any ray met the cover."""
    covered = False
    for hit in hits:
        covered |= hit >= 0 or hit == DARK
    return covered


@njit(cache=True, nogil=True)
def reflected(sources, vertices, reflection, panels, share, out):
    """What a reflection sees: ``share`` (m,) of it open, and mean luminance (m, 3) of faces met.

    ``panels`` (n,): panel of every vertex.
    """
    work, hits, eye = np.zeros((3, 3)), vertices.hits, row_of(reflection.eye)
    for r in range(len(hits)):
        share[r], out[r] = 1.0, 0.0
        if not _covered(hits[r]):
            continue
        i = vertices.which[r]
        v = unit(minus(eye, row(reflection.points, i)))
        n = towards_eye(row(sources.mesh.normals, i), v)
        material = sources.look.materials[panels[i]]
        total, open_ = 0.0, 0.0
        for q in range(hits.shape[1]):
            if hits[r, q] == UNSENT:
                continue
            d = _lobe(i, q, reflection.strata, n, v)
            density = _density(dot(n, v), dot(n, unit(along(v, 1.0, d))))
            weight = _reflectance(material, n, v, d) / density
            total += weight
            if hits[r, q] == OPEN:
                open_ += weight
            elif hits[r, q] >= 0:
                _send(sources, hits[r, q], d, _RESOLVED * density, _MIRRORED, work)
                for c in range(3):
                    out[r, c] += weight * work[0, c]
        if total > 0.0:
            share[r] = open_ / total
            for c in range(3):
                out[r, c] /= total
