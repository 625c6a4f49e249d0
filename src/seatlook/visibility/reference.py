"""The cover without its wrinkles, seen from one camera: what a score compares with.

Vertices move along their camera rays only, so every pixel keeps its panel, its texture, its seam
and its silhouette; a texture shifted by one pixel would outscore any wrinkle.
"""

from __future__ import annotations

from collections import OrderedDict
from dataclasses import replace
from typing import Literal

import numpy as np

from seatlook.errors import InputError
from seatlook.mesh import vertex_normals
from seatlook.model import Camera, Cover, FloatArray, Foam, Solution
from seatlook.solver.foam.distance import DistanceField, distance_field
from seatlook.visibility.outline import cutoffs
from seatlook.wrinkle import low_passed

# What a score compares with: the cover smoothed along the camera's rays; the cover as it is, shaded
# with the normals of that; the surface that was designed.
Mode = Literal["view-ray", "normals", "design"]
# Waves up to this length [m] count as wrinkles; demo covers wrinkle on their foam at 63 mm.
CUTOFF = 0.1
# The triangles of the foam show up as waves of its element size. Waves shorter than this many of
# the cover's elements, which the cover cannot show correctly either, stay in the reference.
_RESOLVED = 3.0
# Cosine between ray and normal from which a pixel is scored. Below its half, where a ray measures
# width rather than depth, and on the far side vertices are not moved.
GRAZING = 0.2
_PASSES, _FAR_PASSES = 3, 8


def smooth_reference(
    solution: Solution,
    camera: Camera,
    *,
    cutoff: float = CUTOFF,
    crests: FloatArray | None = None,
) -> Solution:
    """Take the waves shorter than ``cutoff`` out of the cover, along the rays of one camera.

    With a foam the *distance from its surface* is smoothed, so that crown, bolsters and trenches,
    which belong to the design, stay as they are whatever their radius; without one the shape
    itself is. Outlines of panels, and with them all seams, hooks and frames, keep their place, and
    beside them a bend that follows them stays, see :func:`seatlook.visibility.outline.cutoffs`.
    Of a wave of the cut-off length half stays.

    Parameters
    ----------
    cutoff : float [m]
    crests : (n,) [m]    the :func:`waves` of this cover over its foam, where they are known

    Returns
    -------
    Solution
        The same in all but its positions; not an equilibrium.

    Raises
    ------
    InputError
        A cut-off of 0 or less, a camera inside the cover.
    """
    if not cutoff > 0:
        raise InputError.single("cutoff", got=cutoff, expected="a wavelength above 0 m")
    cover, x = solution.cover, np.array(solution.positions)
    if cover.foam is None:
        ray = _rays(camera, x)
        off, normal = _off_smooth_shape(cover, x, cutoff)
        step = off * _seen(-_dot(normal, ray))
        return replace(solution, positions=x + step[:, None] * ray)
    height, _ = field_of(cover.foam).at(x)
    target = np.where(np.isfinite(height), height, 0.0)
    target = target - (_band(cover, target, cutoff) if crests is None else crests)
    return _moved(solution, cover.foam, camera, target, passes=_PASSES)


def design_reference(solution: Solution, camera: Camera) -> Solution:
    """Lay the cover on the foam as designed, half its thickness above it, along the camera's rays.

    Unlike the smoothed shape it has no sag and no gap: every difference from the drawn shape counts
    as visible.

    Raises
    ------
    InputError
        No foam, a camera inside the cover.
    """
    target = half_thickness(solution.cover)
    return _moved(solution, foam_of(solution.cover), camera, target, passes=_FAR_PASSES)


def on_foam(solution: Solution) -> Solution:
    """Lay the cover on the foam's surface, half its thickness above it: no wrinkle, no sag.

    Raises
    ------
    InputError
        No foam.
    """
    cover = solution.cover
    field, half = field_of(foam_of(cover)), half_thickness(cover)
    x = np.array(solution.positions)
    for _ in range(8):
        height, normal = field.at(x)
        known = np.isfinite(height)
        x[known] -= (height - half)[known, None] * normal[known]
    return replace(solution, positions=x)


def foam_of(cover: Cover) -> Foam:
    """Return the foam below a cover; InputError where there is none."""
    if cover.foam is None:
        raise InputError.single("foam", got="none", expected="the surface the cover was made for")
    return cover.foam


def half_thickness(cover: Cover) -> FloatArray:
    """Height (n,) [m] at which the mid surface lies over the foam."""
    half = np.zeros(len(cover.rest))
    np.maximum.at(half, cover.faces.ravel(), np.repeat(cover.thickness / 2, 3))
    return half


def _moved(
    solution: Solution, foam: Foam, camera: Camera, target: FloatArray, *, passes: int
) -> Solution:
    """Move vertices along their rays to the target height (n,) over the foam."""
    x = np.array(solution.positions)
    field, ray = field_of(foam), _rays(camera, x)
    height, normal = field.at(x)
    known = np.isfinite(height)
    for _ in range(passes):
        off = np.where(known & np.isfinite(height), height - target, 0.0)
        x += (off * _seen(-_dot(normal, ray)))[:, None] * ray
        height, normal = field.at(x)
    return replace(solution, positions=x)


def _rays(camera: Camera, x: FloatArray) -> FloatArray:
    """Unit vectors (n, 3) from the camera to points."""
    ray = x - camera.position
    length = np.linalg.norm(ray, axis=1, keepdims=True)
    if not length.min() > 0:
        raise InputError.single("camera.position", got="on the cover", expected="away from it")
    return np.asarray(ray / length)


_fields: OrderedDict[int, tuple[Foam, DistanceField]] = OrderedDict()


def field_of(foam: Foam) -> DistanceField:
    """Distance from a foam; those of the last two foams are cached."""
    if id(foam) not in _fields:
        _fields[id(foam)] = foam, distance_field(foam.vertices, foam.faces)
        if len(_fields) > 2:
            _fields.popitem(last=False)
    return _fields[id(foam)][1]


def waves(solution: Solution, *, cutoff: float = CUTOFF) -> FloatArray:
    """Height (n,) [m] of every vertex over the smooth shape, along its normal."""
    cover, x = solution.cover, np.array(solution.positions)
    if cover.foam is None:
        return _off_smooth_shape(cover, x, cutoff)[0]
    height, _ = field_of(cover.foam).at(x)
    return _band(cover, np.where(np.isfinite(height), height, 0.0), cutoff)


def height_over_design(solution: Solution) -> FloatArray:
    """Height (n,) [m] of every vertex over the designed surface; 0 where there is no foam below."""
    height, _ = field_of(foam_of(solution.cover)).at(np.array(solution.positions))
    return np.where(np.isfinite(height), height - half_thickness(solution.cover), 0.0)


def _off_smooth_shape(cover: Cover, x: FloatArray, cutoff: float) -> tuple[FloatArray, FloatArray]:
    """Height (n,) over the low-passed shape itself, and its normals (n, 3)."""
    smooth = low_passed(cover, x, wavelength=cutoffs(cover, cutoff))
    normal = vertex_normals(smooth, cover.faces)
    return _dot(normal, x - smooth), normal


def _band(cover: Cover, height: FloatArray, cutoff: float) -> FloatArray:
    """Part of a height (n,) in waves between the element size and ``cutoff``; 0 on outlines."""
    long = low_passed(cover, height[:, None], wavelength=cutoffs(cover, cutoff))[:, 0]
    resolved = _RESOLVED * cover.element_size
    return low_passed(cover, (height - long)[:, None], wavelength=resolved)[:, 0]


def _seen(cosine: FloatArray) -> FloatArray:
    """Way along the ray per height, faded out from grazing views to the far side."""
    fade = np.clip(2 * cosine / GRAZING - 1, 0.0, 1.0)
    return np.asarray(fade / np.maximum(cosine, GRAZING / 2))


def _dot(a: FloatArray, b: FloatArray) -> FloatArray:
    return np.asarray(np.einsum("ij,ij->i", a, b))
