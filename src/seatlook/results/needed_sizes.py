"""Which element size each place of a cover needs, read from a coarser result of it."""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import cKDTree

from seatlook.mesh import edges
from seatlook.model import Cover, FloatArray
from seatlook.results.resolution import CURVATURE_ERROR
from seatlook.solver import foam_wavelength

SMALL = 0.02  # mean W2 below which the tolerance is that of a zone with this mean
GROWTH = 0.25  # change of the element size over the way: neighbours differ by a fifth at most
_SEWN = 1e-9  # m between places that are sewn together; 0 is no edge of a graph


def needed_sizes(cover: Cover, w2: FloatArray, tolerance: float, coarsest: float) -> FloatArray:
    """Element size (n,) [m] at each vertex with which zone means of W2 keep a tolerance.

    Parameters
    ----------
    cover : on foam, meshed coarsely
    w2 : (m,) float64            W2 of its faces at rest
    tolerance : float [1]        relative error of zone means
    coarsest : float [m]         nothing is made larger

    Notes
    -----
    W2 of a wave errs by 3.9 (h / lambda)^2. Where little wrinkles, the error counts against a mean
    of 0.02. W2 is taken as its mean over one wave around a place, since waves of the finer mesh
    will lie elsewhere. Sizes grow by a quarter of the way, along the cover and across its seams.
    """
    wave = _wavelengths(cover)
    local = _mean_nearby(cover, w2, wave)
    error = tolerance / CURVATURE_ERROR * np.maximum(1.0, SMALL / np.maximum(local, 1e-9))
    wanted = np.minimum(wave * np.sqrt(error), coarsest)
    size = np.full(len(cover.rest), coarsest)
    np.minimum.at(size, cover.faces.ravel(), np.repeat(wanted, 3))
    return _graded(cover, size)


def zone_sizes(cover: Cover, w2: FloatArray) -> tuple[dict[str, float], dict[str, float]]:
    """Element size [m] of each zone that has a face, where it wrinkles, and the error of its mean.

    The size is the root mean square over its faces, weighted by area and W2; the error [1] is that
    of waves as short as the fabric makes them, relative to the zone's mean W2.
    """
    square = cover.rest_area * 4.0 / np.sqrt(3.0)
    weight = cover.rest_area * np.maximum(w2, 1e-9)
    error = CURVATURE_ERROR * square / _wavelengths(cover) ** 2
    sizes, errors = {}, {}
    for zone in np.unique(cover.zone):
        own = cover.zone == zone
        name, share = cover.zone_names[zone], weight[own] / weight[own].sum()
        sizes[name] = float(np.sqrt(share @ square[own]))
        errors[name] = float(share @ error[own])
    return sizes, errors


def _wavelengths(cover: Cover) -> FloatArray:
    """Shortest wrinkle (m,) [m] of each face's fabric on the foam."""
    assert cover.foam is not None
    waves = [foam_wavelength(m.fabric, cover.foam.material) for m in cover.materials]
    return np.array(waves)[cover.panel]


def _mean_nearby(cover: Cover, values: FloatArray, reach: FloatArray) -> FloatArray:
    """Mean (m,) by area of face values within ``reach`` (m,) of each face, panel by panel."""
    centre, area = cover.rest[cover.faces].mean(axis=1), cover.rest_area
    result = np.empty(len(values))
    for panel in range(len(cover.panel_names)):
        own = np.flatnonzero(cover.panel == panel)
        tree = cKDTree(centre[own])
        pairs = tree.sparse_distance_matrix(tree, float(reach[own].max()), output_type="coo_matrix")
        near = csr_array((np.ones(pairs.nnz), (pairs.row, pairs.col)), shape=pairs.shape)
        near.setdiag(1.0)
        result[own] = (near @ (area * values)[own]) / (near @ area[own])
    return result


def _graded(cover: Cover, size: FloatArray) -> FloatArray:
    """Limit how fast sizes (n,) grow from vertex to vertex, also across seams."""
    pairs = edges(cover.faces)
    away = np.linalg.norm(cover.rest[pairs[:, 0]] - cover.rest[pairs[:, 1]], axis=1)
    sewn = [
        np.column_stack([s.a.vertices[:, i], s.b.vertices[:, j]])
        for s in cover.stitchings
        for i in (0, 1)
        for j in (0, 1)
    ]
    links = np.concatenate([pairs, *sewn]).astype(np.int64)
    length = np.concatenate([GROWTH * away, np.full(sum(map(len, sewn)), _SEWN)])
    n = len(size)
    # A source besides the vertices, as far from each as its size: the way to it is the least size
    # plus growth of all vertices.
    rows = np.concatenate([links[:, 0], np.full(n, n)])
    columns = np.concatenate([links[:, 1], np.arange(n)])
    weights = np.concatenate([length, size])
    graph = csr_array(coo_array((weights, (rows, columns)), shape=(n + 1, n + 1)))
    return np.asarray(dijkstra(graph, directed=False, indices=[n])[0, :n])
