"""Signed distance of the closed foam surface as a smooth (C2) field."""

from __future__ import annotations

import hashlib
from collections import OrderedDict
from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from seatlook.errors import InputError
from seatlook.model import FloatArray, IntArray
from seatlook.solver.foam import field_cache
from seatlook.solver.kernels import distance as kernel

_BAND = 2.0  # cells around the surface whose distance is searched over all faces
_PASSES = 3  # over the nodes further away, each trying its neighbours' nearest faces
_MAX_NODES = 40_000_000  # 320 MB, and 1.3 GB while it is made; a whole seat at 4 mm has 21


@dataclass(frozen=True, slots=True)
class DistanceField:
    """Cubic B-spline of a signed distance, negative inside.

    Parameters
    ----------
    coefficients : (nx, ny, nz) float64 [m]
    grid : (4,) float64 [m]     first node and spacing
    least_extent : float [m]    smallest side of the surface's bounding box
    """

    coefficients: FloatArray
    grid: FloatArray
    least_extent: float

    def at(self, points: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return distance (k,) [m] and gradient (k, 3); outside the grid inf and 0."""
        phi, gradient = np.empty(len(points)), np.empty((len(points), 3))
        kernel.evaluate(
            self.coefficients, self.grid, np.array(points, dtype=float, order="C"), phi, gradient
        )
        return phi, gradient


_CACHE_SIZE = 2  # fields of one evaluation: the foam, and what the finished shape is compared with
_fields: OrderedDict[str, DistanceField] = OrderedDict()


def distance_field(
    vertices: FloatArray, faces: IntArray, *, spacing: float = 0.004, margin: float = 0.02
) -> DistanceField:
    """Signed distance of a closed surface with outward normals.

    Exact point-triangle distances near the surface, the nearest face carried on beyond, sign from
    the winding number along vertical lines, then cubic B-spline interpolation, which is C2.

    Fields are kept under the content of their surfaces: the last two in memory, more of them on
    disk (``field_cache``), from where one of 1.1 million nodes is read in 20 ms.

    Parameters
    ----------
    vertices : (n, 3) float64 [m]; faces : (m, 3) int64
    spacing : float [m]     of the grid
    margin : float [m]      of the grid around the surface

    Raises
    ------
    InputError
        The surface is not closed, turned inside out, or too large for the spacing (wrong unit?).
    """
    key = _digest(vertices, faces, spacing, margin)
    if key not in _fields:
        _fields[key] = _read(key) or _written(key, _built(vertices, faces, spacing, margin))
        if len(_fields) > _CACHE_SIZE:
            _fields.popitem(last=False)
    _fields.move_to_end(key)
    return _fields[key]


def _digest(vertices: FloatArray, faces: IntArray, spacing: float, margin: float) -> str:
    parts = (vertices.astype(float), faces.astype(np.int64), np.array([spacing, margin]))
    content = (f"{part.shape}".encode() + part.tobytes() for part in parts)
    return hashlib.sha256(b"".join(content)).hexdigest()


def _read(key: str) -> DistanceField | None:
    arrays = field_cache.read(key)
    if arrays is None:
        return None
    return DistanceField(arrays["coefficients"], arrays["grid"], float(arrays["least_extent"]))


def _written(key: str, field: DistanceField) -> DistanceField:
    field_cache.write(
        key,
        coefficients=field.coefficients,
        grid=field.grid,
        least_extent=np.array(field.least_extent),
    )
    return field


def _built(vertices: FloatArray, faces: IntArray, spacing: float, margin: float) -> DistanceField:
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    pad = margin + 4 * spacing
    size = np.ceil((high - low + 2 * pad) / spacing).astype(np.int64) + 1
    if np.prod(size.astype(float)) > _MAX_NODES:
        raise InputError.single(
            "foam",
            got=f"size {np.array2string(high - low, precision=4)} m",
            expected=f"at most {_MAX_NODES} grid nodes at {spacing * 1e3:g} mm",
            hint="is it in the right unit?",
        )
    # The odd fractions keep grid lines off the edges of meshes drawn on round numbers.
    start = low - pad + spacing * np.array([0.137, 0.219, 0.071])
    grid = np.array([*start, spacing])
    vertices, faces = np.array(vertices, order="C"), np.array(faces, order="C")
    shape = tuple(int(s) for s in size)
    # Half the bytes of int64: a whole seat's grid is large, its faces are few.
    distance2, nearest = np.full(shape, np.inf), np.full(shape, -1, dtype=np.int32)
    kernel.fill_band(vertices, faces, grid, _BAND, distance2, nearest)
    # Further out a closer face may not have reached the node: search there by neighbours.
    far = distance2 > (_BAND * spacing) ** 2
    distance2[far] = np.inf
    index = ndimage.distance_transform_edt(far, return_distances=False, return_indices=True)
    nearest = nearest[tuple(index)]
    del index
    before = np.ones(shape, dtype=np.bool_)
    for _ in range(_PASSES):
        changed = np.zeros(shape, dtype=np.bool_)
        kernel.improve(vertices, faces, grid, distance2, nearest, far, before, changed)
        before = changed
    del nearest, far
    phi = np.sqrt(distance2, out=distance2)
    np.negative(phi, out=phi, where=_inside(vertices, faces, grid, shape))
    coefficients = ndimage.spline_filter(phi, order=3, mode="mirror")
    return DistanceField(coefficients, grid, float((high - low).min()))


def _inside(
    vertices: FloatArray, faces: IntArray, grid: FloatArray, shape: tuple[int, ...]
) -> np.ndarray[tuple[int, ...], np.dtype[np.bool_]]:
    """Nodes around which the surface winds once or more.

    Where it passes through itself, as in the pocket of a button, it may wind the other way: that is
    outside.
    """
    winding = np.zeros(shape, dtype=np.int32)
    kernel.count_crossings(vertices, faces, grid, winding)
    np.cumsum(winding, axis=2, out=winding)
    if winding[:, :, -1].any():
        raise InputError.single(
            "foam",
            got=f"a surface that leaves {np.count_nonzero(winding[:, :, -1])} vertical lines open",
            expected="a closed surface with consistent normals",
        )
    if np.count_nonzero(winding < 0) > np.count_nonzero(winding > 0):
        raise InputError.single("foam", got="normals pointing inward", expected="outward normals")
    return np.asarray(winding > 0)
