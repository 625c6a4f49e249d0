"""Which pixels are scored: away from seams, hems, silhouettes and edges of shadows that move."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt
from scipy.ndimage import distance_transform_edt

from seatlook.errors import InputError
from seatlook.model import Camera, Rig, Solution
from seatlook.model.zones import FREE_EDGE
from seatlook.pbr import Studio
from seatlook.visibility.outline import outline_distance
from seatlook.visibility.reference import GRAZING

# What lies closer [m] to a seam, a hem, a silhouette or an edge of a shadow that moves is not
# scored: there the sewing, the outline or the shadow changes, and not a wrinkle.
MARGIN = 0.020
# Neighbouring pixels whose depths are further apart [m] lie on either side of a silhouette.
_JUMP = 0.020
# A shadow has moved where the shares of a light that two covers see differ by more [1/255].
_MOVED = 64

Mask = npt.NDArray[np.bool_]
Numbers = npt.NDArray[np.int32]
Reals = npt.NDArray[np.float32]


@dataclass(frozen=True, slots=True, kw_only=True)
class Region:
    """Where a score is taken, pixel by pixel.

    Parameters
    ----------
    mask : (h, w) bool            zones that count, ``MARGIN`` away from seams, hems, silhouettes
    face : (h, w) int32           face of the solution, -1 where the pixel shows none
    zone : (h, w) int32           zone of that face, -1 outside the mask
    area : (h, w) float32 [m2]    of the surface that the pixel shows, 0 where none
    side : (h, w) float32 [m]     of the pixel, across the view at its depth; 0 where none
    """

    mask: Mask
    face: Numbers
    zone: Numbers
    area: Reals
    side: Reals

    def without(self, left_out: Mask) -> Region:
        """The same without some of its pixels (h, w)."""
        mask = self.mask & ~left_out
        return replace(self, mask=mask, zone=np.where(mask, self.zone, np.int32(-1)))

    @property
    def pixel(self) -> float:
        """Side [m] of the middle one of the pixels that count."""
        return float(np.median(self.side[self.mask]))


def region(studio: Studio, camera: Camera, *, zones: tuple[str, ...] | None = None) -> Region:
    """Find the pixels that are scored.

    Parameters
    ----------
    zones : names to take; None = all but seam bands and free edges

    Raises
    ------
    InputError
        An unknown zone, or no pixel left.
    """
    cover = studio.solution.cover
    names = cover.zone_names
    if zones is None:
        zones = tuple(n for n in names if n != FREE_EDGE and not n.startswith("seam "))
    unknown = sorted(set(zones) - set(names))
    if unknown:
        raise InputError.single(
            "zones", got=repr(unknown[0]), expected=f"some of {', '.join(names)}"
        )
    face = solver_faces(studio, camera)
    cosine, area, depth = _pixels_on(studio.solution, camera, face)
    side = depth * np.float32(_pixel_tangent(camera))
    zone = np.where(face >= 0, cover.zone.astype(np.int32)[face], np.int32(-1))
    inner = outline_distance(cover)[cover.faces].mean(axis=1) >= MARGIN
    mask = np.isin(zone, [names.index(name) for name in zones]) & inner[face]
    silhouette = (face < 0) | (cosine < GRAZING) | _steps(depth, _JUMP)
    mask &= ~_beside(silhouette, side)
    if not mask.any():
        raise InputError.single(
            f"camera {camera.name}",
            got=f"no pixel of the zones, {1e3 * MARGIN:g} mm from seams and silhouettes",
            expected="a view of them",
        )
    zone = np.where(mask, zone, np.int32(-1))
    return Region(mask=mask, face=face, zone=zone, area=area, side=side)


def moving_shadows(
    test: Studio, reference: Studio, rig: Rig, camera: Camera, quality: str, side: Reals
) -> Mask:
    """Pixels (h, w) beside an edge of light and shade that moves from one cover to the other.

    An edge that only one of them has is the shadow of a wrinkle, and counts.

    Parameters
    ----------
    side : (h, w) [m]    see :class:`Region`
    """
    first, second = (one.shadows(rig, camera, quality) for one in (test, reference))
    out = np.zeros(side.shape, dtype=bool)
    for before, after in zip(second, first, strict=True):
        step = len(before) // len(side)
        before, after = before[::step, ::step], after[::step, ::step]
        moved = np.abs(before.astype(np.int16) - after) > _MOVED
        if moved.any():
            out |= moved & _beside(_steps(before, _MOVED), side)
    return _beside(out, side)


def solver_faces(studio: Studio, camera: Camera) -> Numbers:
    """Face of the solution that each pixel shows, (h, w), -1 for foam and background."""
    drawn, panels = studio.faces(camera), studio.surface.faces
    children = np.int32(panels // len(studio.solution.cover.faces))
    return np.where((drawn >= 0) & (drawn < panels), drawn // children, np.int32(-1))


def _beside(edge: Mask, side: Reals) -> Mask:
    """Pixels (h, w) closer than ``MARGIN`` to those of an edge, as seen."""
    if not edge.any():
        return edge
    return np.asarray(distance_transform_edt(~edge) * side < MARGIN)


def _steps(values: npt.NDArray[np.float32 | np.uint8], least: float) -> Mask:
    """Pixels (h, w) whose value is more than ``least`` away from that of a neighbour."""
    out = np.zeros(values.shape, dtype=bool)
    for axis in (0, 1):
        step = np.abs(np.diff(values.astype(np.float32), axis=axis)) > least
        first, last = [slice(None)] * 2, [slice(None)] * 2
        first[axis], last[axis] = slice(None, -1), slice(1, None)
        out[tuple(first)] |= step
        out[tuple(last)] |= step
    return out


def _pixels_on(solution: Solution, camera: Camera, face: Numbers) -> tuple[Reals, Reals, Reals]:
    """Cosine between ray and face, area [m2] on it, and depth [m] of every pixel, each (h, w)."""
    p = solution.positions[solution.cover.faces]
    vector = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
    ray = camera.position - p.mean(axis=1)
    distance = np.linalg.norm(ray, axis=1)
    cosine = np.einsum("ij,ij->i", vector, ray) / (np.linalg.norm(vector, axis=1) * distance)
    forward = camera.target - camera.position
    depth = -ray @ (forward / np.linalg.norm(forward))
    # A pixel's square on a plane across the view; distance / depth turns it to the ray.
    area = (depth * _pixel_tangent(camera)) ** 2 * (depth / distance) / np.maximum(cosine, 1e-3)
    values = (value.astype(np.float32) for value in (cosine, area, depth))
    cosine, area, depth = (np.where(face >= 0, value[face], np.float32(0)) for value in values)
    return cosine, area, depth


def _pixel_tangent(camera: Camera) -> float:
    """Side of a pixel over its depth."""
    return float(2 * np.tan(np.radians(camera.vertical_fov_deg) / 2) / camera.size[1])
