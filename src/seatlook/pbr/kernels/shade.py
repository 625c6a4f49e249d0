"""Radiance of every sample: direct lights, sky and first bounce, with one BRDF."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from numba import njit

from seatlook.pbr.kernels import leaf
from seatlook.pbr.kernels.area import CELLS, CORNERS, is_rectangle
from seatlook.pbr.kernels.area_light import add_to_lobe, add_to_relief
from seatlook.pbr.kernels.brdf import Reflector, albedo_towards, brdf, brdf_isotropic, view_of
from seatlook.pbr.kernels.coherent import FIRST_HALF, SECOND_HALF, WHOLE
from seatlook.pbr.kernels.detail import detail_of
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
from seatlook.pbr.kernels.parts import in_parts
from seatlook.pbr.kernels.relief_light import brdf_of_relief, look_at_discs
from seatlook.pbr.kernels.relief_samples import (
    MOST,
    RELIEF,
    Relief,
    layers_towards,
    mirrored_by,
    sampled,
)
from seatlook.pbr.kernels.stage import Hit, Sample, Stage, frame, place_at, towards_eye
from seatlook.pbr.kernels.surface import along, dot, meet, meet_plane, ray_through, row_of, unit
from seatlook.pbr.kernels.tables import coupling_at

# Pixels across the squares in which a picture is shaded.
_TILE = 16


class Raster(NamedTuple):
    """What the ``factor`` x ``factor`` samples of each of (h, w) pixels see.

    ``ids`` (h factor, w factor): face per sample, -1 for none; ``visibility`` (k, h factor,
    w factor): share of each light, in 1/255, of a rectangle its cells, one bit each;
    ``coherent`` (h, w): pixels of 2 x 2 samples of which fewer are enough; ``side``: relief
    samples along each side of a pixel.
    """

    ids: npt.NDArray[np.int32]
    visibility: npt.NDArray[np.uint8]
    coherent: npt.NDArray[np.bool_]
    factor: int
    side: int


class Scratch(NamedTuple):
    """Room for one pixel; nothing in it outlives that.

    ``total`` (3,): radiance of the pixel; ``work`` (3, 3): that of a sample in the first row;
    ``visible`` (k,): share of each light that the sample sees; ``material`` (1,): record of one
    whose metalness is that of a map; ``relief`` (1,): record of ``relief_samples.RELIEF``;
    ``corners`` (2, n, 4), ``shares`` (2, n) and ``cells`` (c, 11): of the cells of a rectangle;
    ``edge``: row of a relief.
    """

    total: npt.NDArray[np.float64]
    work: npt.NDArray[np.float64]
    visible: npt.NDArray[np.float64]
    material: npt.NDArray[np.void]
    relief: npt.NDArray[np.void]
    corners: npt.NDArray[np.float64]
    shares: npt.NDArray[np.float64]
    cells: npt.NDArray[np.float64]
    edge: npt.NDArray[np.float64]


@leaf()
def _shade(stage, sample, scratch):
    """Radiance of one sample into ``scratch.work[0]``."""
    look, lights, place = stage.look, stage.lights, sample.place
    panel = stage.mesh.panel[sample.hit.face]
    material, v, out = look.materials[panel], place.v, scratch.work[0]
    rows, has_relief = scratch.relief[0], sampled(material)
    relief = Relief(rows, sample.side * sample.side)
    detail = detail_of(stage, sample, material, relief, has_relief)
    roughness, metal = detail.roughness, detail.metalness
    if metal != material.metalness or roughness != material.roughness:
        has_relief = False  # of such a sample the layers are not at hand: one lobe shows its relief
    if metal != material.metalness:
        scratch.material[0] = material
        scratch.material[0].metalness = metal
        material = scratch.material[0]
    n = towards_eye(detail.n, v)
    warp, weft = place.warp, place.weft
    if material.anisotropy != 0.0:
        warp, weft = frame(n, warp)
    x, y, z = dot(warp, v), dot(weft, v), dot(n, v)
    view = view_of(look.tables, material, roughness, detail.colour, x, y, z)
    mean = coupling_at(look.couplings[panel], view.roughness)
    reflector = Reflector(material, look.layers[panel], look.fibres[panel], mean, view)
    shares = (1.0, 1.0)
    if has_relief:
        layers_towards(reflector.layers, rows.NoV, relief.size, rows.layers)
        shares = mirrored_by(reflector, relief, detail.within, place.n, v)
        look_at_discs(lights, sample.code, relief)
    _add_indirect(stage, place, reflector, detail.beside, n, shares, scratch.work)
    for k in range(len(lights.near)):
        if scratch.visible[k] <= 0.0:
            continue
        bits = int(scratch.visible[k] * 255.0 + 0.5)
        if has_relief and is_rectangle(lights, k):
            add_to_relief(lights, k, bits, place, reflector, relief, detail.within, scratch)
        elif has_relief:
            _add_to_relief(lights, k, place, reflector, relief, detail.within, scratch)
        elif is_rectangle(lights, k):
            axes, wide = (n, warp, weft), detail.beside
            add_to_lobe(look.tables, lights, k, bits, place, reflector, axes, wide, scratch)
        else:
            _add_to_lobe(stage, k, sample, reflector, (n, warp, weft), detail.beside, scratch)
    for c in range(3):
        out[c] *= detail.left


@leaf()
def _add_to_relief(lights, k, place, reflector, relief, within, scratch):
    """Light k as the samples of a relief reflect it."""
    out, f_out = scratch.work[0], scratch.work[1]
    middle, e = arriving(lights, k, place.p)
    disc = disc_of(lights, angle_of(lights, k, place.p), middle)
    brdf_of_relief(reflector, relief, disc, within, place.n, place.v, f_out)
    for c in range(3):
        out[c] += f_out[c] * e[c] * scratch.visible[k]


@leaf()
def _add_to_lobe(stage, k, sample, reflector, axes, beside, scratch):
    """Light k as one lobe with ``axes`` (normal, warp, weft) reflects it."""
    look, lights, place, q = stage.look, stage.lights, sample.place, sample.code
    (n, warp, weft), v = axes, place.v
    out, f_out = scratch.work[0], scratch.work[1]
    middle, e = arriving(lights, k, place.p)
    disc = disc_of(lights, angle_of(lights, k, place.p), middle)
    points = len(lights.disc)
    parts = parts_of(q, 0, points) if disc.angle > 0.0 else 1
    for part in range(parts):
        point = point_of(q, part, parts, points)
        l, share = towards_point(disc, lights.disc[point, 0], lights.disc[point, 1])
        NoL = above_horizon(dot(n, l), dot(place.n, l), disc.radius)
        if NoL <= 1e-5:
            continue
        if reflector.material.anisotropy == 0.0:
            h, wide = unit(along(v, 1.0, l)), disc.wider + beside
            NoH, LoH = min(1.0, dot(n, h)), min(1.0, dot(l, h))
            brdf_isotropic(look.tables, reflector, wide, NoL, NoH, LoH, f_out)
        else:
            x, y = dot(warp, l), dot(weft, l)
            brdf(look.tables, reflector, disc.wider, x, y, NoL, f_out)
        for c in range(3):
            out[c] += f_out[c] * NoL * e[c] * share * scratch.visible[k] / parts


@leaf()
def _blurred(roughness, more):
    return min(1.0, (roughness**4 + more) ** 0.25) if more > 0.0 else roughness


@leaf()
def _add_indirect(stage, place, reflector, beside, n, shares, work):
    """Light of the sky and of other faces that goes to the eye, into ``work[0]``.

    ``shares``: what base and coat mirror, relative to one lobe at ``n``.
    """
    material, view, indirect = reflector.material, reflector.sight, stage.indirect
    out, specular, diffuse = work[0], work[1], work[2]
    coat = shares[1] * albedo_towards(stage.look.tables, material, view, specular, diffuse)
    base = top = row_of(indirect.even)
    if len(indirect.panorama):
        mirror = along((-place.v[0], -place.v[1], -place.v[2]), 2.0 * view.NoV, n)
        rough = _blurred(view.roughness, beside)
        base = top = panorama_towards(indirect.panorama, rough, mirror)
        if coat > 0.0:
            rough = _blurred(material.coat_roughness, beside)
            top = panorama_towards(indirect.panorama, rough, mirror)
    for c in range(3):
        specular[c] *= shares[0]
        out[c] = diffuse[c] * place.diffuse[c] + (specular[c] + coat) * place.mirrored[c]
        out[c] += place.open * (specular[c] * base[c] + coat * top[c])


@leaf()
def _plain(material):
    """Whether one sample stands for a pixel: there is no detail, or relief samples show it."""
    even = material.texture < 0 or sampled(material)
    return even and material.maps < 0 and material.perforation_diameter == 0.0


@leaf()
def _pixel(stage, raster, x, y, between, scratch):
    """Radiance that the surface sends through a pixel, into ``scratch.total``.

    ``between``: angle between samples. Returns the share of the pixel in which nothing is seen.
    """
    mesh, eye, ids, factor, total = stage.mesh, stage.eye, raster.ids, raster.factor, scratch.total
    total[:], missed = 0.0, 0
    first, pair, weight = (
        ids[factor * y, factor * x],
        raster.coherent[y, x],
        1.0 / (factor * factor),
    )
    one = pair and _plain(stage.look.materials[mesh.panel[first]])
    if pair:
        weight = 1.0 if one else 0.5
        ray = ray_through(eye, 2 * x + 0.5, 2 * y + 0.5)
        b1, b2, t, plane = meet_plane(mesh, eye, first, ray)
        hit = Hit(first, b1, b2, t, plane, ray, 2.0 * np.sqrt(weight) * between)
        place = place_at(mesh, stage.indirect, hit)
    for q in range(factor * factor):
        if (pair and q % 3) or (one and q):
            continue
        i, j = x * factor + q % factor, y * factor + q // factor
        f, code = ids[j, i], q
        if f < 0:
            missed += 1
            continue
        if one:
            code = WHOLE
        elif pair:
            code = FIRST_HALF if q == 0 else SECOND_HALF
        if not one:
            ray = ray_through(eye, i, j)
            b1, b2, t, plane = meet(mesh, eye, f, ray)
            hit = Hit(f, b1, b2, t, plane, ray, np.sqrt(2.0) * between if pair else between)
        if not pair:
            place = place_at(mesh, stage.indirect, hit)
        for k in range(len(scratch.visible)):
            scratch.visible[k] = raster.visibility[k, j, i] / 255.0
        side = raster.side if pair else -(-raster.side // factor)
        _shade(stage, Sample(hit, place, code, side), scratch)
        for c in range(3):
            total[c] += weight * scratch.work[0, c]
    return missed * weight


def shade(stage: Stage, raster: Raster, backdrop: np.ndarray, out: np.ndarray) -> float:
    """Mean radiance of the samples into each pixel of ``out`` (h, w, 3).

    ``backdrop`` (3,) is seen where no surface is. Of a coherent pixel only the diagonal is shaded,
    each sample for an area twice as large, or one for all where the surface has no relief or relief
    samples show it.
    Returns the greatest radiance of the surface, nan where one is not finite.
    """
    lines = -(-raster.coherent.shape[0] // _TILE)
    return float(
        np.max(in_parts(lines, lambda a, b: _shade_tiles(stage, raster, backdrop, (a, b), out)))
    )


@njit(cache=True, nogil=True)
def _shade_tiles(stage, raster, backdrop, lines, out):
    """Shade the lines of tiles from ``lines[0]`` on and before ``lines[1]``."""
    scratch = Scratch(
        np.zeros(3),
        np.zeros((3, 3)),
        np.ones(len(stage.lights.near)),
        stage.look.materials[:1].copy(),
        np.empty(1, RELIEF),
        np.empty((2, CORNERS, 4)),
        np.empty((2, CORNERS)),
        np.empty((CELLS, 11)),
        np.empty(MOST * MOST),
    )
    eye, brightest = stage.eye, 0.0
    between = np.sqrt(dot(row_of(eye.right), row_of(eye.right)))
    between /= np.sqrt(dot(row_of(eye.first), row_of(eye.first)))
    height, width = raster.coherent.shape
    columns = -(-width // _TILE)
    # By tiles: neighbours lie on the same faces, whose vertices are then still at hand.
    size = columns * _TILE * _TILE
    for number in range(lines[0] * size, lines[1] * size):
        tile, inside = number // (_TILE * _TILE), number % (_TILE * _TILE)
        y = tile // columns * _TILE + inside // _TILE
        x = tile % columns * _TILE + inside % _TILE
        if y >= height or x >= width:
            continue
        missed = _pixel(stage, raster, x, y, between, scratch)
        for c in range(3):
            value = scratch.total[c]
            # What is not a number stays: nothing is greater.
            if value > brightest or value != value:
                brightest = value
            out[y, x, c] = value + missed * backdrop[c]
    return brightest
