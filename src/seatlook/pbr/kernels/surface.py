"""From a sample's triangle to its point, normal and frame on the drawn surface."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from numba import njit

from seatlook.pbr.kernels import leaf


class Mesh(NamedTuple):
    """The drawn surface: ``vertices, normals, warp`` (n, 3), ``uv`` (n, 2), ``faces`` (m, 3).

    ``uv`` [m] lie in the flat panel, the first along the warp, whose unit direction is ``warp``;
    ``panel`` (m,) picks the material; ``seam`` (n, 3): distance from the seam and length along it
    [m], infinite elsewhere, and rows of stitches beside it.
    """

    vertices: npt.NDArray[np.float64]
    normals: npt.NDArray[np.float64]
    warp: npt.NDArray[np.float64]
    uv: npt.NDArray[np.float64]
    faces: npt.NDArray[np.int64]
    panel: npt.NDArray[np.int64]
    seam: npt.NDArray[np.float64]


# How far beside a face its plane stands for what is there, as a share of the face's height.
_BESIDE = 0.5


class Eye(NamedTuple):
    """Pinhole: a sample in column i, row j looks along ``first + i right + j down``, each (3,)."""

    origin: npt.NDArray[np.float64]
    first: npt.NDArray[np.float64]
    right: npt.NDArray[np.float64]
    down: npt.NDArray[np.float64]

    def part(self, left: int, top: int) -> Eye:
        """Same eye, for samples counted from one in the picture."""
        return self._replace(first=self.first + left * self.right + top * self.down)


@leaf()
def dot(a, b):
    """Scalar product of two triples."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@leaf()
def cross(a, b):
    """Vector product of two triples."""
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


@leaf()
def unit(a):
    """Triple scaled to length 1."""
    s = 1.0 / np.sqrt(dot(a, a))
    return (a[0] * s, a[1] * s, a[2] * s)


@leaf()
def row(table, i):
    """Row of an (n, 3) array as a triple."""
    return (table[i, 0], table[i, 1], table[i, 2])


@leaf()
def minus(a, b):
    """Difference of two triples."""
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


@leaf()
def along(a, t, b):
    """``a + t b`` of two triples."""
    return (a[0] + t * b[0], a[1] + t * b[1], a[2] + t * b[2])


@leaf()
def blend(table, faces, f, b1, b2):
    """Value of a vertex table (n, 3) inside face f, as a triple."""
    i, j, k = faces[f, 0], faces[f, 1], faces[f, 2]
    b0 = 1.0 - b1 - b2
    return (
        b0 * table[i, 0] + b1 * table[j, 0] + b2 * table[k, 0],
        b0 * table[i, 1] + b1 * table[j, 1] + b2 * table[k, 1],
        b0 * table[i, 2] + b1 * table[j, 2] + b2 * table[k, 2],
    )


@leaf()
def ray_through(eye, column, line):
    """Unit direction of the ray through a sample."""
    return unit(
        (
            eye.first[0] + column * eye.right[0] + line * eye.down[0],
            eye.first[1] + column * eye.right[1] + line * eye.down[1],
            eye.first[2] + column * eye.right[2] + line * eye.down[2],
        )
    )


@leaf()
def meet(mesh, eye, f, ray):
    """Where a ray meets face f: (weight, weight, distance, unit normal).

    Weights are held inside the triangle: a rasteriser may give a sample on the edge to either
    side.
    """
    b1, b2, t, n = meet_plane(mesh, eye, f, ray)
    b1 = min(max(b1, 0.0), 1.0)
    return b1, min(max(b2, 0.0), 1.0 - b1), t, n


@leaf()
def meet_plane(mesh, eye, f, ray):
    """The same on the plane of the face, a little beside it too."""
    a = row(mesh.vertices, mesh.faces[f, 0])
    e1 = minus(row(mesh.vertices, mesh.faces[f, 1]), a)
    e2 = minus(row(mesh.vertices, mesh.faces[f, 2]), a)
    n = cross(e1, e2)
    to = minus(a, row_of(eye.origin))
    slope = dot(n, ray)
    t = dot(n, to) / slope if slope != 0.0 else np.sqrt(dot(to, to))
    p = (t * ray[0] - to[0], t * ray[1] - to[1], t * ray[2] - to[2])
    size = 1.0 / dot(n, n)
    b1 = min(max(dot(cross(p, e2), n) * size, -_BESIDE), 1.0 + _BESIDE)
    b2 = min(max(dot(cross(e1, p), n) * size, -_BESIDE), 1.0 + _BESIDE)
    s = np.sqrt(size)
    return b1, b2, t, (n[0] * s, n[1] * s, n[2] * s)


@leaf()
def row_of(vector):
    """Array (3,) as a triple."""
    return (vector[0], vector[1], vector[2])


@njit(cache=True)
def distances(mesh, eye, ids, out):
    """Distance to the face seen by each sample, and whether its front is seen; inf where none."""
    front = np.zeros(ids.shape, np.bool_)
    for j in range(ids.shape[0]):
        for i in range(ids.shape[1]):
            if ids[j, i] < 0:
                out[j, i] = np.inf
                continue
            ray = ray_through(eye, i, j)
            _, _, t, n = meet(mesh, eye, ids[j, i], ray)
            out[j, i] = t
            front[j, i] = dot(n, ray) < 0.0
    return front


@njit(cache=True)
def covered(ids, faces, around, factor, out):
    """Share of each pixel of ``out`` (h, w) that shows the cover.

    That is one of the first ``faces`` faces, but those from ``around[0]`` on and before
    ``around[1]``.
    """
    for y in range(out.shape[0]):
        for x in range(out.shape[1]):
            count = 0
            for q in range(factor * factor):
                f = ids[y * factor + q // factor, x * factor + q % factor]
                count += 0 <= f < faces and not around[0] <= f < around[1]
            out[y, x] = count / (factor * factor)


@njit(cache=True)
def mark_faces(ids, seen):
    """Whether each face is in a picture, into ``seen`` (m,)."""
    for j in range(ids.shape[0]):
        for i in range(ids.shape[1]):
            if ids[j, i] >= 0:
                seen[ids[j, i]] = True


@njit(cache=True)
def face_numbers(frame, faces, out):
    """Face per sample into ``out`` (h, w), first row at the top, of numbers from 1 in ``frame``.

    ``frame`` (h, w, 4): number in the first channel, not 0 in the last where a face is drawn.
    Returns whether all are whole numbers up to ``faces``.
    """
    good, height = True, out.shape[0]
    for j in range(height):
        for i in range(out.shape[1]):
            number = frame[height - 1 - j, i, 0]
            whole = int(number) if 0.0 <= number <= faces else -1
            good &= whole == number and (frame[height - 1 - j, i, 3] > 0.0) == (whole > 0)
            out[j, i] = whole - 1
    return good


@leaf()
def lift(mesh, f, b1, b2, p):
    """Point moved onto the surface that the vertex normals imply; Hanika 2021.

    Without it the faces of a rounded surface throw shadows on themselves near the terminator.
    """
    x, y, z = p
    weights = (1.0 - b1 - b2, b1, b2)
    for k in range(3):
        n = row(mesh.normals, mesh.faces[f, k])
        below = dot(minus(p, row(mesh.vertices, mesh.faces[f, k])), n)
        if below < 0.0:
            x -= weights[k] * below * n[0]
            y -= weights[k] * below * n[1]
            z -= weights[k] * below * n[2]
    return (x, y, z)


@njit(cache=True)
def facing(mesh, eye, ids, cosine):
    """Cosine of the smooth normal to the view at every sample."""
    for j in range(ids.shape[0]):
        for i in range(ids.shape[1]):
            f = ids[j, i]
            if f < 0:
                continue
            ray = ray_through(eye, i, j)
            b1, b2, _, _ = meet(mesh, eye, f, ray)
            cosine[j, i] = abs(dot(unit(blend(mesh.normals, mesh.faces, f, b1, b2)), ray))


@njit(cache=True)
def paint(mesh, eye, ids, corner, cover_faces, value):
    """Value of every sample of the cover, blended from its face's corners (m, 3).

    ``corner`` belongs to the faces before refinement; child 4 f + k keeps a corner k, the last
    one takes the three middles.
    """
    for j in range(ids.shape[0]):
        for i in range(ids.shape[1]):
            f = ids[j, i]
            if f < 0 or f >= cover_faces:
                continue
            ray = ray_through(eye, i, j)
            b1, b2, _, _ = meet(mesh, eye, f, ray)
            step = cover_faces // len(corner)
            while step > 1:
                b1, b2 = _in_parent(f % 4, b1, b2)
                f //= 4
                step //= 4
            b0 = 1.0 - b1 - b2
            value[j, i] = b0 * corner[f, 0] + b1 * corner[f, 1] + b2 * corner[f, 2]


@leaf()
def _in_parent(child, b1, b2):
    """Weights in the parent face of a point in one of its four children."""
    b0 = 1.0 - b1 - b2
    if child == 0:  # a, ab, ac
        return 0.5 * b1, 0.5 * b2
    if child == 1:  # ab, b, bc
        return 0.5 * b0 + b1 + 0.5 * b2, 0.5 * b2
    if child == 2:  # ac, bc, c
        return 0.5 * b1, 0.5 * b0 + 0.5 * b1 + b2
    return 0.5 * (b0 + b1), 0.5 * (b1 + b2)  # ab, bc, ca
