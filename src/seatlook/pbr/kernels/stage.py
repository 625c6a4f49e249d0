"""What is drawn, and one sample of it: where its ray meets the surface, and the frame there."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from seatlook.pbr.kernels import leaf
from seatlook.pbr.kernels.brdf import Tables
from seatlook.pbr.kernels.grain import Textures
from seatlook.pbr.kernels.light import Indirect, Lights
from seatlook.pbr.kernels.measured import Measured
from seatlook.pbr.kernels.stitch import Thread
from seatlook.pbr.kernels.surface import Eye, Mesh, along, blend, cross, dot, unit


class Look(NamedTuple):
    """What the surface is made of.

    ``materials`` (p,): records of ``brdf.MATERIAL`` per panel; ``couplings`` (p, k): mean of what
    reaches their diffuse base, over roughness; ``layers`` (p, n, 5) and ``fibres`` (p, n): see
    ``tables``.
    """

    materials: npt.NDArray[np.void]
    couplings: npt.NDArray[np.float64]
    layers: npt.NDArray[np.float64]
    fibres: npt.NDArray[np.float64]
    tables: Tables
    textures: Textures
    maps: Measured
    thread: Thread


class Stage(NamedTuple):
    """What is drawn: a surface, where it is seen from, what it is made of and what lights it."""

    mesh: Mesh
    eye: Eye
    look: Look
    lights: Lights
    indirect: Indirect


class Hit(NamedTuple):
    """Where a ray meets a face: weights of its second and third corner, distance ``t`` [m].

    ``plane``: unit normal of the face; ``between``: angle to the ray of the next sample.
    """

    face: int
    b1: float
    b2: float
    t: float
    plane: tuple[float, float, float]
    ray: tuple[float, float, float]
    between: float


class Place(NamedTuple):
    """Point of the surface as its relief does not change it, seen by all samples of a pixel.

    ``n`` faces the eye along ``v``; ``warp, weft`` lie in the surface; ``diffuse, mirrored, open``
    as in ``light.Indirect``.
    """

    p: tuple[float, float, float]
    v: tuple[float, float, float]
    n: tuple[float, float, float]
    warp: tuple[float, float, float]
    weft: tuple[float, float, float]
    diffuse: tuple[float, float, float]
    mirrored: tuple[float, float, float]
    open: float


class Sample(NamedTuple):
    """One sample of a picture.

    ``code``: its number in its pixel, or what it stands for, see ``coherent``; ``side``: relief
    samples along each side of it.
    """

    hit: Hit
    place: Place
    code: int
    side: int


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
def inside(b1, b2):
    """Weights of the second and third corner held within the face."""
    b1 = min(max(b1, 0.0), 1.0)
    return b1, min(max(b2, 0.0), 1.0 - b1)


@leaf()
def _open_at(share, faces, f, b1, b2):
    """Open share (n,) in face f."""
    return (1.0 - b1 - b2) * share[faces[f, 0]] + b1 * share[faces[f, 1]] + b2 * share[faces[f, 2]]


@leaf()
def place_at(mesh, indirect, hit):
    """Place that a ray meets.

    What was gathered at the corners of the face lies between them: a line through a bright and a
    dark one leads below 0 beside the face, where the middle of a pixel may be.
    """
    f, b1, b2, plane, ray = hit.face, hit.b1, hit.b2, hit.plane, hit.ray
    c1, c2 = inside(b1, b2)
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
        blend(indirect.diffuse, mesh.faces, f, c1, c2),
        blend(indirect.mirrored, mesh.faces, f, c1, c2),
        _open_at(indirect.open, mesh.faces, f, c1, c2),
    )
