"""Meshing a flat outline with triangles that prefer no direction."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import numpy as np
import shapely
from scipy.spatial import Delaunay, cKDTree

from seatlook.errors import InputError, Problem
from seatlook.mesh.polyline import Sizes, sizes_at
from seatlook.mesh.surface import (
    FloatArray,
    IntArray,
    angles,
    edges,
    face_areas,
    face_vectors,
    hexagonal_bias,
)

# Gates: a triangulation that misses one is refused, because W2 on it would be wrong.
MIN_ANGLE_DEG = 20.0
QUANTILE_ANGLE_DEG = 30.0
MAX_HEXAGONAL_BIAS = 0.1

_JITTER = 0.5  # of h, to each side; less leaves a six-fold lattice that steers buckles
_CLEARANCE = 0.55  # of h; free points closer than this to a neighbour or a line are dropped
_SMOOTHING_ROUNDS = 3
_RUNG = 1.25  # of neighbouring lattices where the size varies
_LATTICE = 0.865  # of h; thinning widens the mesh by the inverse (measured 1.156)
_REPAIR_ROUNDS = 12
_ENOUGH_DEG = 26.0  # repair beyond this costs half of the time and changes nothing in the solver
_ATTEMPTS = 6
_FLAT = 1e-9  # of the median area; a face below it is a line


def triangulate(
    boundary: FloatArray,
    element_size: float | Sizes,
    *,
    lines: Sequence[FloatArray] = (),
    holes: Sequence[FloatArray] = (),
    seed: int = 0,
) -> tuple[FloatArray, IntArray]:
    """Mesh a flat outline with nearly equilateral triangles that prefer no direction.

    Jittered lattice, thinned at the outline, Delaunay, centroid smoothing, repair by Delaunay
    refinement (Ruppert 1995) where angles are small.

    Parameters
    ----------
    boundary : (b, 2) float64 [m]
        Outline, counter-clockwise, first vertex not repeated, sampled at about ``element_size``.
    element_size : float [m], or one that varies
        Mean edge length h aimed at. Where it varies it should grow by a quarter of the way at most.
    lines : polylines (k, 2) [m]
        Sampled likewise; an end on the outline or on another line coincides with a point there.
    holes : closed polylines (k, 2) [m], the first vertex not repeated
        Sampled likewise; the mesh leaves them open.
    seed : int
        The same arguments give the same mesh.

    Returns
    -------
    points : (n, 2) float64 [m]
        The outline first, in its order, then the points of ``lines`` and of ``holes``, then the
        free ones.
    faces : (m, 3) int64
        Counter-clockwise; every segment of outline, lines and holes is an edge.

    Raises
    ------
    InputError
        The outline crosses itself or a hole, or runs clockwise; or no mesh passes the gates
        (smallest angle 20 degrees, 1 % quantile 30, hexagonal bias 0.1), with place and reason.

    Examples
    --------
    >>> from seatlook.mesh import angles, triangulate
    >>> t = np.linspace(0, 2 * np.pi, 60, endpoint=False)
    >>> points, faces = triangulate(np.column_stack([np.cos(t), np.sin(t)]), 0.1)
    >>> bool(np.degrees(angles(points, faces)).min() > 20)
    True
    """
    finest = element_size if isinstance(element_size, float | int) else element_size.finest
    region = _region(boundary, holes, finest)
    rings = [np.vstack([hole, hole[:1]]) for hole in holes]
    fixed, segments = _constraints(boundary, [*lines, *rings], finest)
    problems: list[Problem] = []
    for attempt in range(_ATTEMPTS):
        rng = np.random.default_rng((seed, attempt))
        free = _scatter(region, fixed, segments, element_size, rng)
        points, faces = _smoothed(region, fixed, segments, free, element_size)
        problems = _misses(points, faces, segments, len(fixed))
        if not problems:
            return points, faces
    raise InputError(problems)


def _region(
    boundary: FloatArray, holes: Sequence[FloatArray], element_size: float
) -> shapely.Polygon:
    """Return the outline as a prepared polygon after checking it."""
    if not np.isfinite(np.concatenate([boundary, *holes])).all():
        raise InputError.single("outline", got="nan or inf", expected="finite numbers")
    region = shapely.Polygon(boundary, holes)
    if not region.is_valid:
        raise InputError.single(
            "outline", got=shapely.is_valid_reason(region), expected="a simple closed curve"
        )
    if not shapely.is_ccw(region.exterior):
        raise InputError.single("outline", got="clockwise", expected="counter-clockwise")
    if not element_size > 0:
        raise InputError.single("element_size", got=element_size, expected="a number above 0")
    shapely.prepare(region)
    return region


def _constraints(
    boundary: FloatArray, lines: Sequence[FloatArray], element_size: float
) -> tuple[FloatArray, IntArray]:
    """Merge outline and lines into points (k, 2) and the segments (s, 2) to keep."""
    b = len(boundary)
    points = [np.asarray(row, dtype=np.float64) for row in boundary]
    segments = [(i, (i + 1) % b) for i in range(b)]
    for line in lines:
        indices = []
        for point in np.asarray(line, dtype=np.float64):
            distance = np.linalg.norm(np.array(points) - point, axis=1)
            nearest = int(distance.argmin())
            if distance[nearest] > 1e-6 * element_size:
                nearest = len(points)
                points.append(point)
            indices.append(nearest)
        segments += itertools.pairwise(indices)
    return np.array(points), np.array(segments, dtype=np.int64)


def _scatter(
    region: shapely.Polygon,
    fixed: FloatArray,
    segments: IntArray,
    size: float | Sizes,
    rng: np.random.Generator,
) -> FloatArray:
    """Return points inside the region as dense as they are to be, clear of all fixed lines.

    They are those of jittered, randomly turned lattices, of each where its step is the nearest.
    """
    ladder = _ladder(size)
    lattices = [_lattice(region, h, rng) for h in ladder]
    if len(ladder) > 1:
        between = np.sqrt(ladder[1:] * ladder[:-1])
        steps = [np.searchsorted(between, _LATTICE * sizes_at(size, p)) for p in lattices]
        lattices = [p[step == k] for k, (p, step) in enumerate(zip(lattices, steps, strict=True))]
    free = np.concatenate(lattices)
    clearance = _CLEARANCE * np.repeat(ladder, list(map(len, lattices)))
    walls = shapely.multilinestrings(fixed[segments])
    shapely.prepare(walls)
    clear = ~shapely.dwithin(walls, shapely.points(free), clearance)
    return _thin(free[clear], clearance[clear])


def _ladder(size: float | Sizes) -> FloatArray:
    """Steps (k,) [m] of the lattices that make all sizes, rising."""
    if isinstance(size, float | int):
        return np.array([_LATTICE * size])
    count = int(np.ceil(np.log(size.coarsest / size.finest) / np.log(_RUNG))) + 1
    return np.asarray(_LATTICE * np.geomspace(size.finest, size.coarsest, count))


def _lattice(region: shapely.Polygon, h: float, rng: np.random.Generator) -> FloatArray:
    """Points (k, 2) of one jittered, randomly turned lattice inside the region."""
    x0, y0, x1, y1 = region.bounds
    centre, radius = np.array([x0 + x1, y0 + y1]) / 2, np.hypot(x1 - x0, y1 - y0) / 2 + h
    rise = h * np.sqrt(3) / 2
    i, j = (a.ravel() for a in np.mgrid[-radius:radius:h, -radius:radius:rise])
    i = i + (np.round(j / rise) % 2) * h / 2
    lattice = np.column_stack([i, j]) + rng.uniform(-_JITTER, _JITTER, (len(i), 2)) * h
    turn = rng.uniform(0, np.pi / 3)
    rotation = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    points = centre + lattice @ rotation.T
    return np.asarray(points[shapely.contains_xy(region, points)])


def _thin(free: FloatArray, clearance: FloatArray) -> FloatArray:
    """Drop points until none is closer to another than the mean ``clearance`` (k,) of both."""
    keep = np.ones(len(free), dtype=bool)
    if len(free):
        pairs = cKDTree(free).query_pairs(clearance.max(), output_type="ndarray")
        away = np.linalg.norm(free[pairs[:, 0]] - free[pairs[:, 1]], axis=1)
        for i, j in pairs[away <= clearance[pairs].mean(axis=1)]:
            if keep[i] and keep[j]:
                keep[j] = False
    return free[keep]


def _smoothed(
    region: shapely.Polygon,
    fixed: FloatArray,
    segments: IntArray,
    free: FloatArray,
    size: float | Sizes,
) -> tuple[FloatArray, IntArray]:
    """Smooth, then repair the small angles that are left; Delaunay all along."""
    k = len(fixed)
    points, faces = _delaunay(region, fixed, segments, free)
    for _ in range(_SMOOTHING_ROUNDS):
        points, faces = _delaunay(region, fixed, segments, _centroids(points, faces, size)[k:])
    for _ in range(_REPAIR_ROUNDS):
        smallest = np.degrees(angles(points, faces)).min(axis=1)
        if smallest.min() > _ENOUGH_DEG and np.quantile(smallest, 0.01) > QUANTILE_ANGLE_DEG + 1:
            break
        bad = smallest < QUANTILE_ANGLE_DEG
        free = _repair(points, faces[bad], k, size, region)
        points, faces = _delaunay(region, fixed, segments, free)
        points, faces = _delaunay(region, fixed, segments, _centroids(points, faces, size)[k:])
    return points, faces


def _delaunay(
    region: shapely.Polygon, fixed: FloatArray, segments: IntArray, free: FloatArray
) -> tuple[FloatArray, IntArray]:
    """Triangulate inside the region; free points that keep a segment from being an edge go."""
    while True:
        points = np.concatenate([fixed, free])
        faces = np.asarray(Delaunay(points).simplices, dtype=np.int64)
        faces = faces[shapely.contains_xy(region, points[faces].mean(axis=1))]
        area = face_vectors(points, faces)[:, 2]
        faces[area < 0] = faces[area < 0, ::-1]
        # Where an outline runs straight, rounding leaves flat triangles between its points.
        faces = faces[np.abs(area) > _FLAT * np.median(np.abs(area))]
        missing = _missing(segments, faces, len(points))
        if not len(missing) or not len(free):
            return points, faces
        ends = fixed[missing]
        middle, radius = ends.mean(axis=1), np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1) / 2
        inside = cKDTree(free).query_ball_point(middle, radius * (1 + 1e-9))
        encroaching = np.unique(np.concatenate([np.array(i, dtype=np.int64) for i in inside]))
        if not len(encroaching):
            return points, faces
        free = np.delete(free, encroaching, axis=0)


def _missing(segments: IntArray, faces: IntArray, n: int) -> IntArray:
    """Return the segments that are no edge of the faces."""
    present = edges(faces) @ [n, 1]
    return np.asarray(segments[~np.isin(np.sort(segments, axis=1) @ [n, 1], present)])


def _centroids(points: FloatArray, faces: IntArray, size: float | Sizes) -> FloatArray:
    """Move each vertex to the mean of its faces' centroids, weighted by area over size^4.

    So weighted, small faces beside large ones stay small (Gersho 1979); of one size, area decides.
    """
    centre = points[faces].mean(axis=1)
    h = sizes_at(size, centre)
    area = face_areas(points, faces) * (h.min(initial=np.inf) / h) ** 4
    weight = np.bincount(faces.ravel(), np.repeat(area, 3), minlength=len(points))
    moment = np.repeat(area[:, None] * centre, 3, axis=0)
    total = np.column_stack(
        [np.bincount(faces.ravel(), column, minlength=len(points)) for column in moment.T]
    )
    weight[weight == 0] = np.inf  # a point outside every face is dropped by the next round
    return np.asarray(total / weight[:, None])


def _repair(
    points: FloatArray, bad: IntArray, k: int, size: float | Sizes, region: shapely.Polygon
) -> FloatArray:
    """Drop a free end of short edges, add circumcentres of large triangles; return free points."""
    p = points[bad]
    lengths = np.linalg.norm(np.roll(p, -1, axis=1) - p, axis=2)
    radius = lengths.prod(axis=1) / (4 * face_areas(points, bad))
    short = lengths.argmin(axis=1)
    rows = np.arange(len(bad))
    ends = np.maximum(bad[rows, short], bad[rows, (short + 1) % 3])
    small = (radius < 0.75 * sizes_at(size, p.mean(axis=1))) & (ends >= k)
    keep = np.ones(len(points), dtype=bool)
    keep[ends[small]] = False
    added = _circumcentres(p[~small])
    added = added[shapely.contains_xy(region, added)]
    if len(added):
        distance, _ = cKDTree(points[keep]).query(added)
        clearance = 0.45 * sizes_at(size, added)
        far = distance > clearance
        added = _thin(added[far], clearance[far])
    return np.concatenate([points[k:][keep[k:]], added])


def _circumcentres(p: FloatArray) -> FloatArray:
    """Return the circumcentre (m, 2) of triangles (m, 3, 2)."""
    u, v = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    uu, vv = (u**2).sum(axis=1), (v**2).sum(axis=1)
    twice = 2 * (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
    offset = np.column_stack([uu * v[:, 1] - vv * u[:, 1], vv * u[:, 0] - uu * v[:, 0]])
    return np.asarray(p[:, 0] + offset / twice[:, None])


def _misses(points: FloatArray, faces: IntArray, segments: IntArray, k: int) -> list[Problem]:
    """Return which gates the mesh misses."""
    missing = _missing(segments, faces, len(points))
    if len(missing):
        x, y = 1e3 * points[missing[0]].mean(axis=0)
        return [
            Problem(
                key="outline",
                got=f"{len(missing)} segments that cannot be edges, first at ({x:.1f}, {y:.1f}) mm",
                expected="points spaced no wider than the gap to the line opposite",
            )
        ]
    angle = np.degrees(angles(points, faces)).min(axis=1)
    worst, low = int(angle.argmin()), float(np.quantile(angle, 0.01))
    x, y = 1e3 * points[faces[worst]].mean(axis=0)
    problems = []
    if angle[worst] < MIN_ANGLE_DEG or low < QUANTILE_ANGLE_DEG:
        problems.append(
            Problem(
                key="mesh angles",
                got=f"{angle[worst]:.1f} deg at ({x:.1f}, {y:.1f}) mm, 1 % quantile {low:.1f} deg",
                expected=f"at least {MIN_ANGLE_DEG:g} and {QUANTILE_ANGLE_DEG:g} deg",
                hint="sharp corner, notch or uneven sampling of the outline",
            )
        )
    free = _open_edges(points, faces, k)
    # A mean of N random directions is itself about 1/sqrt(N): small meshes get that on top.
    allowed = MAX_HEXAGONAL_BIAS + 2 / np.sqrt(max(len(free), 1))
    if len(free) and hexagonal_bias(points, free) > allowed:
        problems.append(
            Problem(
                key="mesh hexagonal bias",
                got=f"{hexagonal_bias(points, free):.2f}",
                expected=f"at most {allowed:.2f}",
            )
        )
    return problems


def _open_edges(points: FloatArray, faces: IntArray, k: int) -> IntArray:
    """Return the edges at least three rings away from fixed points, which steer their rows."""
    near = np.arange(len(points)) < k
    for _ in range(3):
        near[faces[near[faces].any(axis=1)]] = True
    pairs = edges(faces)
    return np.asarray(pairs[~near[pairs].any(axis=1)])
