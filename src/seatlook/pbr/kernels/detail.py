"""What relief, measured maps, holes and thread make of a sample."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from seatlook.pbr.kernels import leaf
from seatlook.pbr.kernels.grain import grain, holes
from seatlook.pbr.kernels.measured import measured
from seatlook.pbr.kernels.relief_samples import spread
from seatlook.pbr.kernels.sewn import sewn_relief
from seatlook.pbr.kernels.stitch import away_from_seam, reach, seam_at, seam_relief, tilt
from seatlook.pbr.kernels.surface import along, dot, unit


class Detail(NamedTuple):
    """A sample as it is shaded.

    ``n``: normal; ``left``: share of the light that the holes leave; ``within, beside``: added to
    the squared width of the lobes of relief samples, and of the lobe of them all.
    """

    n: tuple[float, float, float]
    colour: tuple[float, float, float]
    roughness: float
    metalness: float
    left: float
    within: float
    beside: float


@leaf()
def _pattern_at(mesh, f, b1, b2):
    """Pattern coordinates inside face f."""
    i, j, k = mesh.faces[f, 0], mesh.faces[f, 1], mesh.faces[f, 2]
    b0 = 1.0 - b1 - b2
    return (
        b0 * mesh.uv[i, 0] + b1 * mesh.uv[j, 0] + b2 * mesh.uv[k, 0],
        b0 * mesh.uv[i, 1] + b1 * mesh.uv[j, 1] + b2 * mesh.uv[k, 1],
    )


@leaf()
def detail_of(stage, sample, material, relief, has_relief):
    """Detail of a sample; where it ``has_relief`` that goes into ``relief``."""
    mesh, look, hit, place = stage.mesh, stage.look, sample.hit, sample.place
    f, b1, b2, n = hit.face, hit.b1, hit.b2, place.n
    roughness, metal, tint = material.roughness, material.metalness, (1.0, 1.0, 1.0)
    share, own, shade, light, within, beside = 1.0, 0.0, 1.0, 1.0, 0.0, 0.0
    if material.texture >= 0 or material.maps >= 0 or material.perforation_diameter > 0.0:
        u, w = _pattern_at(mesh, f, b1, b2)
        width = hit.t * hit.between / np.sqrt(max(0.05, dot(n, place.v)))
        su, sv, gu, gv = 0.0, 0.0, 0.0, 0.0
        if material.maps >= 0:
            tint, roughness, metal, su, sv = measured(look.maps, material, u, w, width)
        if material.texture >= 0 and not has_relief:
            gu, gv, roughness, share = grain(look.textures, material, roughness, u, w, width)
        if material.texture >= 0 or material.maps >= 0:
            n = unit(along(along(n, -su - gu, place.warp), -sv - gv, place.weft))
        if material.perforation_diameter > 0.0:
            pitch, diameter = material.perforation_pitch, material.perforation_diameter
            light = 1.0 - holes(pitch, diameter, u, w, width)
    distance, arc, rows = seam_at(mesh, f, b1, b2)
    if distance < reach(look.thread):
        away, onward = away_from_seam(mesh, f)
        width = hit.t * hit.between / np.sqrt(max(0.05, abs(dot(hit.plane, place.v))))
        if look.thread.built:
            sa, so, left, covered, bright = sewn_relief(look.thread, rows, distance, arc, width)
        else:
            sa, so, left, covered = seam_relief(look.thread, distance, arc, width)
            bright = 1.0
        n = unit(tilt(n, away, onward, sa, so))
        share *= left
        own, shade = covered * look.thread.own, bright
        roughness += covered * max(0.0, 0.6 - roughness)
    if has_relief:
        n, within, beside, grey = spread(stage, sample, material, n, (u, w), relief)
        share *= grey
    share *= 1.0 - own
    own *= shade
    base, thread = material.albedo, look.thread.colour
    colour = (
        base[0] * tint[0] * share + own * thread[0],
        base[1] * tint[1] * share + own * thread[1],
        base[2] * tint[2] * share + own * thread[2],
    )
    return Detail(n, colour, roughness, metal, light, within, beside)
