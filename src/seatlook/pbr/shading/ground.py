"""The floor that a seat stands on, and the valance that hides its hem."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.ndimage import gaussian_filter1d
from scipy.spatial import ConvexHull

from seatlook.mesh.polyline import arc_length, points_at
from seatlook.model import Appearance, FloatArray, IntArray

# Rings of the floor [m] beside the seat's outline, closer where its shadow is; the last one is as
# good as the horizon. Inside, as shares of the way to the middle.
_OUTSIDE = (0.002, 0.008, 0.018, 0.032, 0.05, 0.075, 0.11, 0.16, 0.23, 0.34, 0.5, 0.75, 1.2, 2.5)
_FAR = (6.0, 16.0, 40.0)
_INSIDE = (0.97, 0.92, 0.84, 0.74, 0.6, 0.4, 0.15)
_SECTORS = 128
# A valance [m]: how far it reaches above the hem, stands off the cover, and goes down at least and
# at most; its points are so far apart and its waves shorter than the last are ironed out.
_ABOVE, _OFF, _LEAST, _MOST, _STEP, _EVEN = 0.008, 0.005, 0.01, 0.08, 0.008, 0.012
# Two ends of panels at a hem closer than this [m] follow each other.
_NEXT = 0.03
# Dark moulded plastic, matt; judgement.
VALANCE = Appearance(albedo=np.full(3, 0.06), roughness=1.0, f0=0.0)


class Ground(NamedTuple):
    """What lies around a seat: ``vertices, normals`` (g, 3), ``faces`` (h, 3), the floor's first.

    ``floor``: how many of the faces are the floor's; ``rim`` (r,): vertices farthest away.
    """

    vertices: FloatArray
    normals: FloatArray
    faces: IntArray
    floor: int
    rim: IntArray


def floor_look(albedo: float) -> Appearance:
    """Appearance of a matt grey floor."""
    return Appearance(albedo=np.full(3, albedo), roughness=1.0, f0=0.0)


def ground_of(x: FloatArray, normals: FloatArray, hem: IntArray, below: FloatArray) -> Ground:
    """Floor and valance of a cover.

    Parameters
    ----------
    x, normals : (n, 3) of the cover; hem : (e, 2) free edges, the cover to their left
    below : (k, 3)      what the cover is drawn over; may be empty
    """
    low = float(np.concatenate([x[:, 2], below[:, 2]]).min())
    walls = [_valance(x, normals, loop, below, low) for loop in hem_loops(x, hem)]
    points = np.vstack([x, below, *(vertices for vertices, _, _ in walls)])
    parts, floor = [_floor(points[:, :2], low), *walls], 0
    first = np.cumsum([0, *(len(vertices) for vertices, _, _ in parts)])
    floor = len(parts[0][2])
    return Ground(
        np.vstack([vertices for vertices, _, _ in parts]),
        np.vstack([normal for _, normal, _ in parts]),
        np.vstack([faces + k for k, (_, _, faces) in zip(first, parts, strict=False)]),
        floor,
        np.arange(first[1] - _SECTORS, first[1]),
    )


def hem_loops(x: FloatArray, edges: IntArray) -> list[IntArray]:
    """Free edges (e, 2) as closed lines of vertices: from the end of one panel to the next one."""
    following = dict(edges.tolist())
    ends, chains = set(edges[:, 1].tolist()), []
    for start in [*(a for a in following if a not in ends), *following]:
        chain = [start]
        while chain[-1] in following:
            chain.append(following.pop(chain[-1]))
        if len(chain) > 1:
            chains.append(chain)
    loops = []
    while chains:
        loop = chains.pop(0)
        while chains:
            gaps = [float(np.linalg.norm(x[chain[0]] - x[loop[-1]])) for chain in chains]
            back = float(np.linalg.norm(x[loop[0]] - x[loop[-1]]))
            if min(gaps) > min(_NEXT, back):
                break
            loop += chains.pop(int(np.argmin(gaps)))
        loops.append(np.array(loop[:-1] if loop[0] == loop[-1] else loop))
    return loops


def _valance(
    x: FloatArray, normals: FloatArray, loop: IntArray, below: FloatArray, low: float
) -> tuple[FloatArray, FloatArray, IntArray]:
    """Strip around a hem that hides it and the edge of the foam: vertices, normals, faces."""
    p, n = _even(x[loop], normals[loop])
    along = np.roll(p, -1, axis=0) - np.roll(p, 1, axis=0)
    down = np.cross(along, n)
    down /= np.maximum(np.linalg.norm(down, axis=1, keepdims=True), 1e-12)
    mean = down.mean(axis=0)
    mean /= max(float(np.linalg.norm(mean)), 1e-12)
    # Its lower edge is even, whatever waves the hem has.
    deepest = float(((below - p.mean(axis=0)) @ mean).max(initial=_LEAST))
    reach = (deepest - (p - p.mean(axis=0)) @ mean) / np.maximum(down @ mean, 0.2)
    reach = np.clip(reach, _LEAST, _MOST)[:, None]
    bottom, top, lip = p + reach * down + _OFF * n, p - _ABOVE * down + _OFF * n, p - _ABOVE * down
    bottom[:, 2] = np.maximum(bottom[:, 2], low)
    k = np.arange(len(p))
    following = np.roll(k, -1)
    size = len(p)

    def strip(upper: int, lower: int) -> IntArray:
        a, b, c, d = (
            upper * size + k, lower * size + k, lower * size + following, upper * size + following
        )  # fmt: skip
        return np.concatenate([np.column_stack([a, b, c]), np.column_stack([a, c, d])])

    # A back shell closes it: of what lies within, nothing is seen from behind.
    vertices = np.vstack([top, bottom, lip, top, bottom, bottom.mean(axis=0)])
    back = np.broadcast_to(mean, (size + 1, 3))
    shell = np.column_stack([np.full(size, 5 * size), 4 * size + following, 4 * size + k])
    faces = np.vstack([strip(0, 1), strip(2, 3), shell])
    return vertices, np.vstack([n, n, -down, -down, back]), faces


def _even(p: FloatArray, n: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Closed line (k, 3) in even steps without small waves, and the unit normals along it."""
    closed = np.vstack([p, p[:1]])
    arc = arc_length(closed)
    count = max(8, int(arc[-1] / _STEP))
    at = np.arange(count) * arc[-1] / count
    values = np.column_stack([closed, np.vstack([n, n[:1]])])
    out = np.column_stack([np.interp(at, arc, column) for column in values.T])
    out = gaussian_filter1d(out, _EVEN / _STEP, axis=0, mode="wrap")
    normal = out[:, 3:] / np.maximum(np.linalg.norm(out[:, 3:], axis=1, keepdims=True), 1e-12)
    return out[:, :3], normal


def _floor(points: FloatArray, low: float) -> tuple[FloatArray, FloatArray, IntArray]:
    """Rings around the outline of ``points`` (n, 2) seen from above, at the height ``low``."""
    outline = points[ConvexHull(points).vertices]
    closed = np.vstack([outline, outline[:1]])
    arc = arc_length(closed)
    at = np.arange(_SECTORS) * arc[-1] / _SECTORS
    line = points_at(closed, at)
    along = np.roll(line, -1, axis=0) - np.roll(line, 1, axis=0)
    out = np.column_stack([along[:, 1], -along[:, 0]])
    out /= np.linalg.norm(out, axis=1, keepdims=True)
    out = gaussian_filter1d(out, 2.0, axis=0, mode="wrap")
    out /= np.linalg.norm(out, axis=1, keepdims=True)
    middle = line.mean(axis=0)
    rings = [np.broadcast_to(middle, line.shape)]
    rings += [middle + share * (line - middle) for share in reversed(_INSIDE)]
    rings += [line + far * out for far in (*_OUTSIDE, *_FAR)]
    flat = np.vstack(rings)
    vertices = np.column_stack([flat, np.full(len(flat), low)])
    k, n = np.arange(_SECTORS), _SECTORS
    following = np.roll(k, -1)
    faces = []
    for ring in range(len(rings) - 1):
        a, b = ring * n + k, ring * n + following
        c, d = a + n, b + n
        faces.append(np.column_stack([a, c, d]))
        if ring:
            faces.append(np.column_stack([a, d, b]))
    return vertices, np.tile([0.0, 0.0, 1.0], (len(flat), 1)), np.vstack(faces)
