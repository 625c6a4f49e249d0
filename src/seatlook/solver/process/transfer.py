"""Carry a state from one mesh of a cover to another."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from seatlook.errors import InputError
from seatlook.model import Cover, FloatArray, IntArray

_NEIGHBOURS = 14  # vertices that make a quadratic; six would just do
_NEAR = 0.3  # of the mean squared distance, added where weights are its inverse


def transfer(source: Cover, values: FloatArray, target: Cover) -> FloatArray:
    """Values (n, k) at the vertices of a mesh, at those of another mesh of the same panels.

    Around every vertex a quadratic in the rest coordinates is fitted to its nearest neighbours in
    the same panel, so bent shapes arrive without facets and outlines need not agree.

    Raises
    ------
    InputError   the panels are not the same, or one has too few vertices
    """
    if source.panel_names != target.panel_names:
        raise InputError.single(
            "start",
            got=f"a cover of the panels {', '.join(source.panel_names)}",
            expected=", ".join(target.panel_names),
        )
    out = np.empty((len(target.rest), values.shape[1]))
    for panel, name in enumerate(target.panel_names):
        old, new = _vertices(source, panel), _vertices(target, panel)
        if len(old) < _NEIGHBOURS:
            raise InputError.single(
                "start",
                got=f"{len(old)} vertices in panel {name}",
                expected=f"at least {_NEIGHBOURS}",
            )
        away, near = cKDTree(source.rest[old]).query(target.rest[new], _NEIGHBOURS)
        near = old[near]
        offset = source.rest[near] - target.rest[new][:, None]
        square = np.square(away)
        weight = 1.0 / (square + _NEAR * square.mean(axis=1, keepdims=True))
        share = _constant_term(offset, np.sqrt(weight))
        out[new] = np.einsum("nk,nkc->nc", share, values[near])
    return out


def transfer_peaks(source: Cover, peaks: FloatArray, target: Cover) -> FloatArray:
    """Strains (m, k) that faces have gone through, of the nearest face of the same panel."""
    out = np.empty((len(target.faces), peaks.shape[1]))
    centre, wanted = (c.rest[c.faces].mean(axis=1) for c in (source, target))
    for panel in range(len(target.panel_names)):
        old, new = np.flatnonzero(source.panel == panel), np.flatnonzero(target.panel == panel)
        out[new] = peaks[old[cKDTree(centre[old]).query(wanted[new])[1]]]
    return out


def _vertices(cover: Cover, panel: int) -> IntArray:
    return np.unique(cover.faces[cover.panel == panel])


def _constant_term(offset: FloatArray, root: FloatArray) -> FloatArray:
    """Weights (n, k) that give the value at 0 of the quadratics fitted at ``offset`` (n, k, 2)."""
    size = np.abs(offset).max(axis=(1, 2), keepdims=True)
    a, b = np.moveaxis(offset / size, 2, 0)
    columns = np.stack([np.ones_like(a), a, b, a * a, a * b, b * b], axis=2)
    return np.asarray(np.linalg.pinv(columns * root[:, :, None])[:, 0] * root)
