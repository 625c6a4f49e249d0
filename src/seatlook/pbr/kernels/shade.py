"""Radiance of every sample: direct lights, sky and first bounce, with one BRDF."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from numba import njit

from seatlook.pbr.kernels import leaf
from seatlook.pbr.kernels.brdf import Tables, albedo_towards, brdf, brdf_isotropic, view_of
from seatlook.pbr.kernels.grain import Textures, grain, holes
from seatlook.pbr.kernels.light import (
    above_horizon,
    angle_of,
    arriving,
    disc_of,
    panorama_towards,
    parts_of,
    point_of,
    towards_point,
)
from seatlook.pbr.kernels.measured import Measured, measured
from seatlook.pbr.kernels.relief_light import brdf_facets, look_at_discs
from seatlook.pbr.kernels.relief_samples import (
    ROOM,
    faceted,
    layers_to_eye,
    mirrored_facets,
    spread,
)
from seatlook.pbr.kernels.stitch import (
    Thread,
    away_from_seam,
    reach,
    relief,
    seam_at,
    tilt,
)
from seatlook.pbr.kernels.surface import (
    along,
    blend,
    cross,
    dot,
    meet,
    meet_plane,
    ray_through,
    row_of,
    unit,
)
from seatlook.pbr.kernels.tables import coupling_at

# Pixels across the squares in which a picture is shaded.
_TILE = 16


class Look(NamedTuple):
    """What the surface is made of.

    ``materials`` (p,): records of ``brdf.MATERIAL`` per panel; ``couplings`` (p, k): mean of what
    reaches their diffuse base, over roughness; ``layers`` (p, n, 5) and ``fibres`` (p, n): see
    ``tables``; ``changed`` (1,): room for a record of a sample whose metalness is that of a map.
    """

    materials: npt.NDArray[np.void]
    couplings: npt.NDArray[np.float64]
    layers: npt.NDArray[np.float64]
    fibres: npt.NDArray[np.float64]
    tables: Tables
    textures: Textures
    maps: Measured
    changed: npt.NDArray[np.void]
    thread: Thread


@leaf()
def towards_eye(n, v):
    """Normal bent just enough to face the eye, which interpolated ones at a silhouette do not."""
    c = dot(n, v)
    if c >= 0.01:
        return n
    return unit(along(n, 0.01 - c, v))


@leaf()
def frame(n, warp):
    """Unit warp in the plane of ``n`` and the weft beside it."""
    t = along(warp, -dot(warp, n), n)
    if dot(t, t) < 1e-12:
        t = (n[1], -n[0], 0.0) if abs(n[2]) < 0.9 else (0.0, n[2], -n[1])
        t = along(t, -dot(t, n), n)
    t = unit(t)
    return t, cross(n, t)


@leaf()
def _blend_one(values, faces, f, b1, b2):
    """Value of a vertex table (n,) inside face f."""
    i, j, k = faces[f, 0], faces[f, 1], faces[f, 2]
    return (1.0 - b1 - b2) * values[i] + b1 * values[j] + b2 * values[k]


@leaf()
def _pattern_at(mesh, f, b1, b2):
    """Pattern coordinates inside face f."""
    i, j, k = mesh.faces[f, 0], mesh.faces[f, 1], mesh.faces[f, 2]
    b0 = 1.0 - b1 - b2
    return (
        b0 * mesh.uv[i, 0] + b1 * mesh.uv[j, 0] + b2 * mesh.uv[k, 0],
        b0 * mesh.uv[i, 1] + b1 * mesh.uv[j, 1] + b2 * mesh.uv[k, 1],
    )


class Place(NamedTuple):
    """Point of the surface as its relief does not change it, seen by all samples of a pixel.

    ``n`` faces the eye along ``v``; ``warp, weft`` lie in the surface; ``diffuse, mirrored, open``
    as in ``light.Around``.
    """

    p: tuple[float, float, float]
    v: tuple[float, float, float]
    n: tuple[float, float, float]
    warp: tuple[float, float, float]
    weft: tuple[float, float, float]
    diffuse: tuple[float, float, float]
    mirrored: tuple[float, float, float]
    open: float


@leaf()
def _place(mesh, around, f, hit):
    b1, b2, _, plane, ray, _ = hit
    v = (-ray[0], -ray[1], -ray[2])
    n = unit(blend(mesh.normals, mesh.faces, f, b1, b2))
    if dot(plane, v) < 0.0:
        n = (-n[0], -n[1], -n[2])
    n = towards_eye(n, v)
    warp, weft = frame(n, blend(mesh.warp, mesh.faces, f, b1, b2))
    return Place(
        blend(mesh.vertices, mesh.faces, f, b1, b2),
        v,
        n,
        warp,
        weft,
        blend(around.diffuse, mesh.faces, f, b1, b2),
        blend(around.mirrored, mesh.faces, f, b1, b2),
        _blend_one(around.open, mesh.faces, f, b1, b2),
    )


@leaf()
def _detail(mesh, look, eye, material, f, hit, place, covers, side, facets):
    """Normal with relief and thread, base colour, roughness, metalness, light left by the holes.

    With ``covers`` above 0 the relief goes into ``facets``, ``side`` along each side of as many
    samples; the last two returned add to the squared width of their lobes, and of the lobe of
    them all.
    """
    b1, b2, t, plane, _, between = hit
    n, v = place.n, place.v
    roughness, metal, tint = material.roughness, material.metalness, (1.0, 1.0, 1.0)
    share, own, kept, within, beside = 1.0, 0.0, 1.0, 0.0, 0.0
    if material.texture >= 0 or material.maps >= 0 or material.perforation_diameter > 0.0:
        u, w = _pattern_at(mesh, f, b1, b2)
        width = t * between / np.sqrt(max(0.05, dot(n, v)))
        su, sv, gu, gv = 0.0, 0.0, 0.0, 0.0
        if material.maps >= 0:
            tint, roughness, metal, su, sv = measured(look.maps, material, u, w, width)
        if material.texture >= 0 and covers == 0:
            gu, gv, roughness, share = grain(look.textures, material, roughness, u, w, width)
        if material.texture >= 0 or material.maps >= 0:
            n = unit(along(along(n, -su - gu, place.warp), -sv - gv, place.weft))
        if material.perforation_diameter > 0.0:
            kept = 1.0 - holes(
                material.perforation_pitch, material.perforation_diameter, u, w, width
            )
    distance, arc = seam_at(mesh, f, b1, b2)
    if distance < reach(look.thread):
        away, onward = away_from_seam(mesh, f)
        width = t * between / np.sqrt(max(0.05, abs(dot(plane, v))))
        sa, so, left, covered = relief(look.thread, distance, arc, width)
        n = unit(tilt(n, away, onward, sa, so))
        share *= left
        own = covered * look.thread.own
        roughness += covered * max(0.0, 0.6 - roughness)
    if covers > 0:
        n, within, beside, grey = spread(
            mesh, look.textures, eye, material, f, place, n, (u, w), t, covers, side, facets
        )
        share *= grey
    share *= 1.0 - own
    base, thread = material.albedo, look.thread.colour
    colour = (
        base[0] * tint[0] * share + own * thread[0],
        base[1] * tint[1] * share + own * thread[1],
        base[2] * tint[2] * share + own * thread[2],
    )
    return n, colour, roughness, metal, kept, within, beside


@leaf()
def sample(mesh, look, eye, lights, around, f, hit, place, q, visible, side, work, facets):
    """Radiance of one sample into ``work[0]``; ``work`` is (3, 3), ``facets`` room for its relief.

    ``hit``: (weight, weight, distance, face normal, unit ray, angle between samples);
    ``visible`` (k,): share of each light that is not hidden; ``q``: number of the sample in its
    pixel, -1 or -2 where it is the first or second that stands for two, -3 where it does for four;
    ``side``: facets along each side of its relief.
    """
    panel = mesh.panel[f]
    material, v, covers, count = look.materials[panel], place.v, 0, 0
    if faceted(material):
        covers, count = 2 if q == -3 else 1, side * side
    bare = _detail(mesh, look, eye, material, f, hit, place, covers, side, facets)
    n, colour, roughness, metal, kept, within, beside = bare
    if metal != material.metalness or roughness != material.roughness:
        count = 0  # of such a sample the layers are not at hand: one lobe shows its relief
    if metal != material.metalness:
        look.changed[0] = material
        look.changed[0].metalness = metal
        material = look.changed[0]
    n = towards_eye(n, v)
    warp, weft = place.warp, place.weft
    if material.anisotropy != 0.0:
        warp, weft = frame(n, warp)
    out, f_out = work[0], work[1]
    view = view_of(look.tables, material, roughness, colour, dot(warp, v), dot(weft, v), dot(n, v))
    mean = coupling_at(look.couplings[panel], view.table_roughness)
    layers, fibres = look.layers[panel], look.fibres[panel]
    shares = (1.0, 1.0)
    if count > 0:
        layers_to_eye(layers, facets, count)
        shares = mirrored_facets(material, view, facets, count, place.n, within, v)
        look_at_discs(lights, q, facets, count)
    _from_around(look, around, place, material, view, beside, n, shares, work)
    for k in range(len(lights.near)):
        if visible[k] <= 0.0:
            continue
        middle, e = arriving(lights, k, place.p)
        disc = disc_of(lights, angle_of(lights, k, place.p), middle)
        if count > 0:
            wide, m = within, place.n
            brdf_facets(
                material, layers, fibres, mean, view, facets, count, disc, wide, m, v, f_out
            )
            for c in range(3):
                out[c] += f_out[c] * e[c] * visible[k]
            continue
        points = len(lights.disc)
        parts = parts_of(q, 0, points) if disc.angle > 0.0 else 1
        for part in range(parts):
            point = point_of(q, part, parts, points)
            l, share = towards_point(disc, lights.disc[point, 0], lights.disc[point, 1])
            NoL = above_horizon(dot(n, l), dot(place.n, l), disc.radius)
            if NoL <= 1e-5:
                continue
            if material.anisotropy == 0.0:
                h, wide = unit(along(v, 1.0, l)), disc.wider + beside
                NoH, LoH = min(1.0, dot(n, h)), min(1.0, dot(l, h))
                brdf_isotropic(
                    look.tables, material, fibres, mean, view, wide, NoL, NoH, LoH, f_out
                )
            else:
                x, y = dot(warp, l), dot(weft, l)
                brdf(look.tables, material, fibres, mean, view, disc.wider, x, y, NoL, f_out)
            for c in range(3):
                out[c] += f_out[c] * NoL * e[c] * share * visible[k] / parts
    for c in range(3):
        out[c] *= kept


@leaf()
def _blurred(roughness, more):
    return min(1.0, (roughness**4 + more) ** 0.25) if more > 0.0 else roughness


@leaf()
def _from_around(look, around, place, material, view, beside, n, shares, work):
    """Light of the sky and of other faces that goes to the eye, into ``work[0]``.

    ``shares``: what base and coat mirror, relative to one lobe at ``n``.
    """
    out, specular, diffuse = work[0], work[1], work[2]
    coat = shares[1] * albedo_towards(look.tables, material, view, specular, diffuse)
    base = top = row_of(around.even)
    if len(around.panorama):
        mirror = along((-place.v[0], -place.v[1], -place.v[2]), 2.0 * view.NoV, n)
        rough = _blurred(view.table_roughness, beside)
        base = top = panorama_towards(around.panorama, rough, mirror)
        if coat > 0.0:
            rough = _blurred(material.coat_roughness, beside)
            top = panorama_towards(around.panorama, rough, mirror)
    for c in range(3):
        specular[c] *= shares[0]
        out[c] = diffuse[c] * place.diffuse[c] + (specular[c] + coat) * place.mirrored[c]
        out[c] += place.open * (specular[c] * base[c] + coat * top[c])


@leaf()
def _plain(material):
    """Whether one sample stands for a pixel: there is no detail, or facets show it."""
    even = material.texture < 0 or faceted(material)
    return even and material.maps < 0 and material.perforation_diameter == 0.0


@njit(cache=True)
def shade(mesh, eye, ids, alike, look, lights, around, visibility, factor, side, backdrop, out):
    """Mean radiance of ``factor`` x ``factor`` samples into each pixel of ``out`` (h, w, 3).

    ``ids`` (h factor, w factor): face per sample, -1 for none, where ``backdrop`` (3,) is seen;
    ``visibility`` likewise, (k, ., .), in 1/255; ``side``: facets along each side of a pixel. Where
    a pixel's 2 x 2 samples are ``alike`` (h, w), only the diagonal is shaded, each for an area
    twice as large, or one for all where the surface has no relief or facets show it.
    Returns the greatest radiance of the surface, nan where one is not finite.
    """
    work, total, brightest = np.zeros((3, 3)), np.zeros(3), 0.0
    visible, facets = np.ones(len(lights.near)), np.empty(ROOM)
    spread = np.sqrt(dot(row_of(eye.right), row_of(eye.right)))
    spread /= np.sqrt(dot(row_of(eye.first), row_of(eye.first)))
    height, width = alike.shape
    columns = -(-width // _TILE)
    # By tiles: neighbours lie on the same faces, whose vertices are then still at hand.
    for number in range(columns * -(-height // _TILE) * _TILE * _TILE):
        tile, inside = number // (_TILE * _TILE), number % (_TILE * _TILE)
        y = tile // columns * _TILE + inside // _TILE
        x = tile % columns * _TILE + inside % _TILE
        if y >= height or x >= width:
            continue
        total[:], missed = 0.0, 0
        first, pair, weight = ids[factor * y, factor * x], alike[y, x], 1.0 / (factor * factor)
        one = pair and _plain(look.materials[mesh.panel[first]])
        if pair:
            weight = 1.0 if one else 0.5
            ray = ray_through(eye, 2 * x + 0.5, 2 * y + 0.5)
            b1, b2, t, plane = meet_plane(mesh, eye, first, ray)
            hit = (b1, b2, t, plane, ray, 2.0 * np.sqrt(weight) * spread)
            place = _place(mesh, around, first, hit)
        for q in range(factor * factor):
            if (pair and q % 3) or (one and q):
                continue
            i, j = x * factor + q % factor, y * factor + q // factor
            f, point = ids[j, i], q
            if f < 0:
                missed += 1
                continue
            if one:
                point = -3
            elif pair:
                point = -1 if q == 0 else -2
            if not one:
                ray = ray_through(eye, i, j)
                b1, b2, t, plane = meet(mesh, eye, f, ray)
                hit = (b1, b2, t, plane, ray, np.sqrt(2.0) * spread if pair else spread)
            if not pair:
                place = _place(mesh, around, f, hit)
            for k in range(len(visible)):
                visible[k] = visibility[k, j, i] / 255.0
            few = side if pair else -(-side // factor)
            sample(
                mesh, look, eye, lights, around, f, hit, place, point, visible, few, work, facets
            )
            for c in range(3):
                total[c] += weight * work[0, c]
        for c in range(3):
            # What is not a number is kept: nothing is greater.
            if total[c] > brightest or total[c] != total[c]:
                brightest = total[c]
            out[y, x, c] = total[c] + missed * weight * backdrop[c]
    return brightest
