"""Open polylines as arrays: lengths along them, places on them, distances to them."""

from __future__ import annotations

from functools import reduce
from typing import Protocol

import numpy as np
import numpy.typing as npt

from seatlook.errors import InputError

FloatArray = npt.NDArray[np.float64]

_SAME = 1e-6  # m
_FINE = 4.0  # steps of the finest size in which a varying size is summed up


class Sizes(Protocol):
    """An element size [m] that varies from place to place."""

    @property
    def finest(self) -> float:
        """Smallest size anywhere [m]."""
        ...

    @property
    def coarsest(self) -> float:
        """Largest size anywhere [m]."""
        ...

    def __call__(self, points: FloatArray) -> FloatArray:
        """Sizes (k,) [m] at points (k, 2) [m]."""
        ...


def sizes_at(size: float | Sizes, points: FloatArray) -> FloatArray:
    """Element size (k,) [m] at points (k, 2), everywhere the same or not."""
    if isinstance(size, float | int):
        return np.full(len(points), float(size))
    return size(points)


def distance_to_polyline(points: FloatArray, line: FloatArray) -> FloatArray:
    """Distance (m,) of points (m, d) to an open polyline (k, d), in its unit.

    Examples
    --------
    >>> distance_to_polyline(np.array([[0.5, 1.0], [2.0, 0.0]]), np.array([[0.0, 0], [1, 0]]))
    array([1., 1.])
    """
    return nearest_places(line, points)[0]


def nearest_place(line: FloatArray, point: FloatArray) -> tuple[float, float]:
    """Distance of a point (2,) from a polyline (k, 2), and the arc length of the place there [m].

    Examples
    --------
    >>> nearest_place(np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]]), np.array([1.5, 0.5]))
    (0.5, 1.5)
    """
    distance, place = nearest_places(line, point[None])
    return float(distance[0]), float(place[0])


def nearest_places(line: FloatArray, points: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Distances (m,) of points (m, d) from a polyline (k, d), and arc lengths (m,) there [m]."""
    start, step = line[:-1], np.diff(line, axis=0)
    offset = points[:, None] - start
    length2 = np.maximum((step**2).sum(axis=1), 1e-300)
    along = np.clip((offset * step).sum(axis=2) / length2, 0.0, 1.0)
    distance = np.sqrt(((offset - along[..., None] * step) ** 2).sum(axis=2))
    k = distance.argmin(axis=1)
    row = np.arange(len(points))
    place = arc_length(line)[k] + along[row, k] * np.sqrt(length2[k])
    return np.asarray(distance[row, k]), np.asarray(place)


def segment_lengths(polyline: FloatArray) -> FloatArray:
    """Return the length (k - 1,) [m] of each segment of an open polyline (k, d)."""
    return np.asarray(np.linalg.norm(np.diff(polyline, axis=0), axis=1))


def is_closed(polyline: FloatArray) -> bool:
    """Return whether a polyline (k, d) [m] ends where it begins, within 1 um.

    Examples
    --------
    >>> corners = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 0.0]])
    >>> is_closed(corners), is_closed(corners[:-1])
    (True, False)
    """
    return len(polyline) > 3 and bool(np.linalg.norm(polyline[0] - polyline[-1]) <= _SAME)


def arc_length(polyline: FloatArray) -> FloatArray:
    """Return the length run through (k,) [m] at each point of an open polyline (k, d)."""
    return np.concatenate([[0.0], np.cumsum(segment_lengths(polyline))])


def length(polyline: FloatArray) -> float:
    """Return the whole length [m] of an open polyline (k, d).

    It is summed in pairs, so that its last bits are not those of ``arc_length``.

    Examples
    --------
    >>> length(np.array([[0.0, 0.0], [3.0, 4.0], [3.0, 5.0]]))
    6.0
    """
    return float(reduce(np.hypot, np.diff(polyline, axis=0).T).sum())


def resample(polyline: FloatArray, spacing: float | Sizes) -> FloatArray:
    """Return points of equal arc length on an open polyline (k, d), both ends kept.

    The step is the length divided by the nearest whole number of ``spacing`` (at least one). Where
    that varies, so do the steps.

    Examples
    --------
    >>> resample(np.array([[0.0, 0.0], [3.0, 0.0], [3.0, 1.0]]), 0.9)[:, 0]
    array([0., 1., 2., 3., 3.])
    """
    s = arc_length(polyline)
    at = _places(polyline, s, spacing)
    points = np.column_stack([np.interp(at, s, column) for column in polyline.T])
    points[[0, -1]] = polyline[[0, -1]]  # bit for bit, so that neighbours share their corners
    return points


def resampled_steps(polyline: FloatArray, spacing: float | Sizes) -> FloatArray:
    """Return how far (m,) [m] along the polyline the points of ``resample`` are apart.

    Examples
    --------
    >>> resampled_steps(np.array([[0.0, 0.0], [3.0, 0.0], [3.0, 1.0]]), 0.9)
    array([1., 1., 1., 1.])
    """
    s = arc_length(polyline)
    at = _places(polyline, s, spacing)
    if isinstance(spacing, float | int):
        return np.full(len(at) - 1, s[-1] / (len(at) - 1))
    return np.diff(at)


def _places(polyline: FloatArray, s: FloatArray, spacing: float | Sizes) -> FloatArray:
    """Arc lengths [m] at which a polyline with arc lengths ``s`` of its points is sampled."""
    finest = spacing if isinstance(spacing, float | int) else spacing.finest
    if not (finest > 0 and s[-1] > 0):
        raise InputError.single(
            "resample", got=f"length {s[-1]:g}, spacing {finest:g}", expected="numbers above 0"
        )
    if isinstance(spacing, float | int):
        return np.linspace(0.0, s[-1], max(1, round(s[-1] / spacing)) + 1)
    fine = np.linspace(0.0, s[-1], max(1, round(_FINE * s[-1] / finest)) + 1)
    size = spacing(np.column_stack([np.interp(fine, s, column) for column in polyline.T]))
    return even_places(fine, size)


def even_places(at: FloatArray, spacing: FloatArray) -> FloatArray:
    """Places [m] from the first to the last of ``at`` (k,), as far apart as ``spacing`` (k,) says.

    Examples
    --------
    >>> even_places(np.array([0.0, 1.0, 2.0]), np.array([0.25, 0.5, 0.5])).round(3)
    array([0.   , 0.333, 0.667, 1.   , 1.5  , 2.   ])
    """
    density = 0.5 * (1.0 / spacing[1:] + 1.0 / spacing[:-1])
    counted = np.concatenate([[0.0], np.cumsum(np.diff(at) * density)])
    numbers = np.linspace(0.0, counted[-1], max(1, round(counted[-1])) + 1)
    return np.interp(numbers, counted, at)


def points_at(line: FloatArray, places: FloatArray) -> FloatArray:
    """Return the points (s, d) at lengths ``places`` (s,) [m] along a polyline (k, d).

    A closed polyline, whose first point is its last, goes on beyond its ends.

    Examples
    --------
    >>> points_at(np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]]), np.array([0.5, 1.5]))
    array([[0.5, 0. ],
           [1. , 0.5]])
    """
    arc = arc_length(line)
    at = places % arc[-1] if is_closed(line) else places
    return np.column_stack([np.interp(at, arc, column) for column in line.T])


def directions_at(line: FloatArray, places: FloatArray) -> FloatArray:
    """Return the unit directions (s, d) at lengths ``places`` (s,) [m] along a polyline (k, d).

    In the middle of a segment it is the segment's; from there it turns evenly to the next middle,
    as on the smooth curve that the polyline stands for.

    Examples
    --------
    >>> directions_at(np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]]), np.array([0.2, 1.5]))
    array([[1., 0.],
           [0., 1.]])
    """
    arc, steps = arc_length(line), segment_lengths(line)
    unit = np.diff(line, axis=0)[steps > 0] / steps[steps > 0, None]
    middle = (arc[:-1] + arc[1:])[steps > 0] / 2
    at = places
    if is_closed(line):
        at = places % arc[-1]
        unit = np.concatenate([unit[-1:], unit, unit[:1]])
        middle = np.concatenate([middle[-1:] - arc[-1], middle, middle[:1] + arc[-1]])
    direction = np.column_stack([np.interp(at, middle, column) for column in unit.T])
    return np.asarray(direction / np.linalg.norm(direction, axis=1, keepdims=True))
