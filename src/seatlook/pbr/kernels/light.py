"""Light that arrives at a point: from discs and spheres, from the sky, from other faces."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from seatlook.pbr.kernels import leaf
from seatlook.pbr.kernels.area import is_rectangle, rectangle_at
from seatlook.pbr.kernels.coherent import FIRST_HALF, WHOLE
from seatlook.pbr.kernels.surface import along, cross, dot, minus, row, unit

# Angular radius [rad] below which a light is a point for shading.
SMALL = 0.01


class Lights(NamedTuple):
    """``near`` (k,): 0 far, 1 near, 2 and 3 rectangles; ``vector`` (k, 3).

    ``intensity`` (k, 3) [lux] or [cd]; ``size`` (k,): angular diameter [rad] or radius [m], of a
    rectangle that of a disc as large; ``sides`` (k, 2, 3) [m]: halves of a rectangle's;
    ``disc`` (s, 2): points of the unit disc that the samples of a pixel look at, one each.
    """

    near: npt.NDArray[np.int64]
    vector: npt.NDArray[np.float64]
    intensity: npt.NDArray[np.float64]
    size: npt.NDArray[np.float64]
    sides: npt.NDArray[np.float64]
    disc: npt.NDArray[np.float64]


class Indirect(NamedTuple):
    """What arrives from elsewhere, per vertex.

    ``diffuse`` (n, 3) [cd/m2]: mean over the half-space, of sky and other faces; ``mirrored``
    (n, 3) [cd/m2]: what other faces send into the lobe of the reflection that the eye sees;
    ``open`` (n,): share of that lobe that sees the sky; ``even`` (3,) [cd/m2]: sky equal
    everywhere; ``panorama`` (r, h, w, 3) [cd/m2]: sky as lobes of rising roughness see it, no
    levels where it is even.
    """

    diffuse: npt.NDArray[np.float64]
    mirrored: npt.NDArray[np.float64]
    open: npt.NDArray[np.float64]
    even: npt.NDArray[np.float64]
    panorama: npt.NDArray[np.float64]


@leaf()
def arriving(lights, k, p):
    """Unit direction to light k and irradiance (3,) [lux] on a plane facing it.

    A rectangle is taken for a small one.
    """
    if lights.near[k] == 0:
        return row(lights.vector, k), row(lights.intensity, k)
    to = minus(row(lights.vector, k), p)
    s = 1.0 / dot(to, to)
    if is_rectangle(lights, k):
        rectangle = rectangle_at(lights, k, p)
        s *= rectangle.ahead * np.sqrt(s)
    i = row(lights.intensity, k)
    return unit(to), (i[0] * s, i[1] * s, i[2] * s)


@leaf()
def across(l):
    """Two unit vectors across ``l``."""
    a = (1.0, 0.0, 0.0) if abs(l[0]) < 0.6 else (0.0, 1.0, 0.0)
    t = unit(cross(l, a))
    return t, cross(l, t)


@leaf()
def angle_of(lights, k, p):
    """Angular radius [rad] of light k seen from ``p``."""
    if lights.near[k] == 0:
        return 0.5 * lights.size[k]
    to = minus(row(lights.vector, k), p)
    return lights.size[k] / np.sqrt(dot(to, to))


class Disc(NamedTuple):
    """A light as a sample sees it: unit directions of its middle, and two across it.

    ``angle`` [rad]: angular radius, 0 where the middle stands for all; ``radius`` [rad]: that of
    the part around a point; ``wider``: what the part adds to the squared width of a lobe, twice
    the variance of the half-vectors, a sixteenth of the squared angle over the whole disc per axis.
    """

    middle: tuple[float, float, float]
    t: tuple[float, float, float]
    s: tuple[float, float, float]
    angle: float
    radius: float
    wider: float


@leaf()
def disc_of(lights, angle, middle):
    """Disc of angular radius ``angle`` [rad] around the unit direction ``middle``."""
    t, s = across(middle)
    points, wider = len(lights.disc), 0.125 * angle * angle
    radius = angle / np.sqrt(points)
    # Smaller than any lobe: the middle stands for all.
    if angle < SMALL:
        return Disc(middle, t, s, 0.0, radius, wider)
    return Disc(middle, t, s, angle, radius, wider / points)


@leaf()
def towards_point(disc, x, y):
    """Unit direction to a point of the unit disc on a light's, and the share of its part.

    By the shares, the parts together light a plane facing the middle like the whole.
    """
    d = along(along(disc.middle, disc.angle * x, disc.t), disc.angle * y, disc.s)
    length = np.sqrt(dot(d, d))
    scale = 1.0 / length
    return (d[0] * scale, d[1] * scale, d[2] * scale), length


@leaf()
def parts_of(code, count, points):
    """At how many of the ``points`` of a light's disc a sample looks.

    ``code``: its number in its pixel or what it stands for, see ``coherent``; ``count``: of its
    relief samples. Four of these or more share four points among themselves: if all looked at one,
    the light of the sample would go with its place.
    """
    if code == WHOLE or (code >= 0 and count >= 4 and points >= 4):
        return 4
    return 1 if code >= 0 else 2


@leaf()
def point_of(code, part, parts, points):
    """Point of the light's disc at which one of the parts of a sample looks."""
    if code >= 0:
        return (code + part * (points // parts)) % points
    if code == WHOLE:
        return part
    return 3 * part if code == FIRST_HALF else 1 + part


@leaf()
def above_horizon(cosine, smooth, angle):
    """Mean cosine over a disc of angular radius ``angle``, of which a part may have set.

    ``smooth``: cosine of the surface without its relief, behind which the disc sets for all of
    the relief. The disc is taken for a band of the same variance, a half-width of 0.87 radii.
    """
    w, least = 0.866 * angle, min(cosine, smooth)
    if least >= w:
        return cosine
    return ((cosine + w) ** 2 - (cosine - least) ** 2) / (4.0 * w) if least > -w else 0.0


@leaf()
def panorama_towards(panorama, roughness, d):
    """Luminance (3,) of the sky that a lobe of this roughness sees around direction ``d``."""
    last, h, w = panorama.shape[0] - 1, panorama.shape[1], panorama.shape[2]
    x = min(max(roughness, 0.0), 1.0) * last
    r = min(int(x), last - 1)
    c = x - r
    y = np.arccos(min(1.0, max(-1.0, d[2]))) / np.pi * h - 0.5
    y = min(max(y, 0.0), h - 1.0)
    j = min(int(y), h - 2)
    b = y - j
    x = np.arctan2(d[0], -d[1]) / (2.0 * np.pi) * w - 0.5
    i = int(np.floor(x))
    a = x - i
    i, n = i % w, (i + 1) % w
    w0, w1, w2, w3 = (1.0 - a) * (1.0 - b), a * (1.0 - b), (1.0 - a) * b, a * b
    low, high = panorama[r], panorama[r + 1]
    return (
        _mix(low, high, c, i, n, j, w0, w1, w2, w3, 0),
        _mix(low, high, c, i, n, j, w0, w1, w2, w3, 1),
        _mix(low, high, c, i, n, j, w0, w1, w2, w3, 2),
    )


@leaf()
def _mix(low, high, c, i, n, j, w0, w1, w2, w3, k):
    below = w0 * low[j, i, k] + w1 * low[j, n, k] + w2 * low[j + 1, i, k] + w3 * low[j + 1, n, k]
    above = w0 * high[j, i, k] + w1 * high[j, n, k]
    above += w2 * high[j + 1, i, k] + w3 * high[j + 1, n, k]
    return below + c * (above - below)
