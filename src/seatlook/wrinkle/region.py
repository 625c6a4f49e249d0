"""Connected places of a map of faces: where they are, how long, how wide, which way they run."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from seatlook.mesh.kinematics import principal_values
from seatlook.model import FloatArray, IntArray, Solution
from seatlook.wrinkle.equations import curvature_tensor
from seatlook.wrinkle.recovery import recover

_SPLIT = 6  # parts of an edge in which a face is looked at: an outline runs through faces


def regions(faces: IntArray, marked: npt.NDArray[np.bool_]) -> IntArray:
    """Number (m,) of the region of each marked face, joined over edges; -1 elsewhere."""
    corners = faces[marked]
    half = np.sort(corners[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    key = half @ np.array([int(faces.max()) + 1, 1])
    order = np.argsort(key, kind="stable")
    same = np.flatnonzero(key[order][1:] == key[order][:-1])
    a, b = order[same] // 3, order[same + 1] // 3
    graph = coo_array((np.ones(len(a), dtype=np.int8), (a, b)), shape=(len(corners), len(corners)))
    region = np.full(len(faces), -1, dtype=np.int64)
    region[marked] = connected_components(graph, directed=False)[1]
    return region


@dataclass(frozen=True, slots=True)
class Extent:
    """How far a region reaches: along it and across it.

    Parameters
    ----------
    along : (2,) float64        unit vector, in rest coordinates
    length : float [m]          of the stretch with the same second moment along it
    width : float [m]           area over length
    """

    along: FloatArray
    length: float
    width: float

    @property
    def across(self) -> FloatArray:
        """The unit vector (2,) across it."""
        return np.array([-self.along[1], self.along[0]])


def extent(solution: Solution, values: FloatArray, faces: IntArray, level: float) -> Extent:
    """Measure the region of ``faces`` in which values (m,) of faces are above a level.

    Its outline runs through faces: values are carried to the vertices and taken as linear between
    them. It runs where the valley does: across the direction of the strongest inward curvature.
    """
    cover = solution.cover
    near = np.zeros(len(cover.rest), dtype=bool)
    near[cover.faces[faces]] = True
    ring = np.flatnonzero(near[cover.faces].any(axis=1))
    near[cover.faces[ring]] = True
    patch = np.flatnonzero(near[cover.faces].any(axis=1))
    vertices, local = np.unique(cover.faces[patch], return_inverse=True)
    local = local.reshape(-1, 3)
    at_vertices = recover(cover.rest[vertices], local, values[patch])
    wanted = local[np.isin(patch, ring)]
    points, weight = _parts(cover.rest[vertices], wanted, at_vertices, level)
    if not len(points):  # so small that the fit passes over it
        points, weight = cover.rest[cover.faces[faces]].mean(axis=1), cover.rest_area[faces]
    along = _along(solution, faces, values[faces] * cover.rest_area[faces])
    place = points @ along
    place = place - weight @ place / weight.sum()
    length = float(np.sqrt(12.0 * (weight @ place**2) / weight.sum()))
    if length == 0.0:
        length = float(np.sqrt(weight.sum()))
    return Extent(along, length, float(weight.sum()) / length)


def _parts(
    rest: FloatArray, faces: IntArray, values: FloatArray, level: float
) -> tuple[FloatArray, FloatArray]:
    """Middles (k, 2) and areas (k,) of the equal parts of faces whose value is above the level."""
    i, j = np.meshgrid(np.arange(_SPLIT), np.arange(_SPLIT))
    low = np.stack([i, j], axis=-1)[i + j < _SPLIT] + 1 / 3
    high = np.stack([i, j], axis=-1)[i + j < _SPLIT - 1] + 2 / 3
    a, b = (np.concatenate([low, high]) / _SPLIT).T
    weights = np.stack([1.0 - a - b, a, b], axis=1)
    corner = rest[faces]
    u, v = corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]
    area = 0.5 * np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / len(weights)
    inside = np.einsum("sc,fc->fs", weights, values[faces]) > level
    points = np.einsum("sc,fcd->fsd", weights, corner)
    return points[inside], np.repeat(area, len(weights)).reshape(inside.shape)[inside]


def _along(solution: Solution, faces: IntArray, weight: FloatArray) -> FloatArray:
    """Unit vector (2,) along the valley: across the mean direction that is bent most inward."""
    bent = np.einsum("f,fij->ij", weight, bending(solution, faces))
    _, axes = np.linalg.eigh(bent)
    return np.asarray(axes[:, 1])


def bending(solution: Solution, faces: IntArray) -> FloatArray:
    """Curvature tensor (k, 2, 2) [1/m] of some faces, from the strains of both sides."""
    return curvature_tensor(
        solution.strain_top[faces],
        solution.strain_bottom[faces],
        solution.cover.thickness[faces],
    )


def valley(solution: Solution, faces: IntArray) -> FloatArray:
    """Smaller principal curvature (k,) [1/m] of some faces; below 0 in a valley."""
    return principal_values(bending(solution, faces))[1]
