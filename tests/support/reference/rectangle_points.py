"""Direct light of rectangles by brute force: very many points on each, a ray to every one."""

from __future__ import annotations

import numpy as np
from numba import njit

from seatlook.model import Appearance, Camera, Rig
from seatlook.pbr.kernels.brdf import Reflector, brdf, view_of
from seatlook.pbr.kernels.bvh import new_stack
from seatlook.pbr.kernels.light import Indirect
from seatlook.pbr.kernels.noise import even
from seatlook.pbr.kernels.shadow import reaches, start_of
from seatlook.pbr.kernels.stage import Hit, Stage, frame, place_at, towards_eye
from seatlook.pbr.kernels.surface import along, cross, dot, meet, ray_through, row, row_of
from seatlook.pbr.kernels.tables import coupling_at
from seatlook.pbr.light.rig import pack_lights
from seatlook.pbr.shading.eye import eye_of
from seatlook.pbr.shading.look import look_of
from seatlook.pbr.shading.studio import Studio


def direct(
    studio: Studio,
    appearance: Appearance,
    *,
    rig: Rig,
    camera: Camera,
    factor: int = 4,
    points: tuple[int, int] = (32, 4),
    seed: int = 0,
) -> np.ndarray:
    """Radiance (h, w, 3) of a plain material under rectangles alone, by ``factor``^2 samples.

    Each looks at ``points`` along and across, each at random in its part: ``factor``^2 times as
    many per pixel.
    """
    mesh, n = studio.surface.mesh, len(studio.surface.mesh.vertices)
    none = Indirect(
        np.zeros((n, 3)), np.zeros((n, 3)), np.ones(n), np.zeros(3), np.zeros((0, 2, 4, 3))
    )
    look = look_of(studio.solution.cover, appearance, studio.thread)
    stage = Stage(mesh, eye_of(camera, factor), look, pack_lights(rig), none)
    out = np.zeros((*camera.size[::-1], 3))
    _add(stage, studio._bvh, studio.faces(camera, factor), factor, points, seed, out)
    return out


@njit
def _add(stage, bvh, ids, factor, points, seed, out):
    stack, f_out, mesh, look = new_stack(), np.zeros(3), stage.mesh, stage.look
    for j in range(ids.shape[0]):
        for i in range(ids.shape[1]):
            f = ids[j, i]
            if f < 0:
                continue
            ray = ray_through(stage.eye, i, j)
            b1, b2, t, plane = meet(mesh, stage.eye, f, ray)
            place = place_at(mesh, stage.indirect, Hit(f, b1, b2, t, plane, ray, 0.0))
            start = start_of(mesh, stage.eye, f, i, j)
            n = towards_eye(place.n, place.v)
            warp, weft = frame(n, place.warp)
            x, y, z = dot(warp, place.v), dot(weft, place.v), dot(n, place.v)
            panel = mesh.panel[f]
            material = look.materials[panel]
            colour = row_of(material.albedo)
            view = view_of(look.tables, material, material.roughness, colour, x, y, z)
            mean = coupling_at(look.couplings[panel], view.roughness)
            reflector = Reflector(material, look.layers[panel], look.fibres[panel], mean, view)
            for k in range(len(stage.lights.near)):
                a, b = row(stage.lights.sides[k], 0), row(stage.lights.sides[k], 1)
                m = cross(a, b)
                scale = 1.0 / np.sqrt(dot(m, m))
                for q in range(points[0] * points[1]):
                    number = (seed * len(stage.lights.near) + k) * points[0] * points[1] + q
                    s = 2.0 * (q // points[1] + even(i, j, 2 * number)) / points[0] - 1.0
                    r = 2.0 * (q % points[1] + even(i, j, 2 * number + 1)) / points[1] - 1.0
                    to = along(along(row(stage.lights.vector, k), s, a), r, b)
                    d = (to[0] - place.p[0], to[1] - place.p[1], to[2] - place.p[2])
                    far = np.sqrt(dot(d, d))
                    l = (d[0] / far, d[1] / far, d[2] / far)
                    ahead = -dot(m, l) * scale
                    if stage.lights.near[k] == 3:
                        ahead = abs(ahead)
                    NoL = dot(n, l)
                    if ahead <= 0.0 or NoL <= 0.0 or dot(place.n, l) <= 0.0:
                        continue
                    if not reaches(bvh, start[0], start[1], l, far, stack):
                        continue
                    brdf(look.tables, reflector, 0.0, dot(warp, l), dot(weft, l), NoL, f_out)
                    weight = NoL * ahead / (far * far * points[0] * points[1] * factor * factor)
                    for c in range(3):
                        share = f_out[c] * weight * stage.lights.intensity[k, c]
                        out[j // factor, i // factor, c] += share
