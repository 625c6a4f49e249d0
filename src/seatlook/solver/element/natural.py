"""A sheet that is curved at rest: its natural shape, seen from its flat mesh."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from seatlook.errors import InputError
from seatlook.model import FloatArray, IntArray
from seatlook.solver.element.curvature import Curvature
from seatlook.solver.element.edgeslope import Edges, natural_strains

# Triangles whose natural area is below this share of the square of their longest edge are none.
_FLAT = 1e-6


@dataclass(frozen=True, slots=True, eq=False)
class NaturalShape:
    """The shape in space in which a sheet is free of stress.

    The flat mesh is a map of that shape. Where the shape can be unrolled the map keeps lengths;
    elsewhere ``measure`` says what a strain on the map is on the shape, and ``connection`` what of
    a second derivative on the map is the map's own bend within the shape.

    Parameters
    ----------
    positions : (n, 3) float64 [m]
    faces : (m, 3) int64
    hats : (m, 3, 2) float64 [1/m]        gradient on the map of 1 at a corner and 0 at the others
    connection : (m, 3, 2) float64 [1/m]  parts of (x,11  x,22  2 x,12) along x,1 and x,2 (twice
        Christoffel's symbol in the last row)
    measure : (m, 3, 3) float64           from (11, 22, 2 x 12) on the map to those on the shape
    stretch : (m,) float64                area on the shape over that on the map
    """

    positions: FloatArray
    faces: IntArray
    hats: FloatArray
    connection: FloatArray
    measure: FloatArray
    stretch: FloatArray

    def covariant(self, curvature: Curvature) -> Curvature:
        """``curvature`` less what lies in the sheet: at rest only the part along the normal stays.

        What is taken away is linear in the positions, so rows stay rows.
        """
        count = len(self.positions)
        triangle = np.repeat(np.arange(len(self.faces)), np.diff(curvature.start))
        key = triangle * count + curvature.nodes
        order = np.argsort(key)
        own = (np.arange(len(self.faces))[:, None] * count + self.faces).ravel()
        place = order[np.searchsorted(key, own, sorter=order)]
        weights = curvature.weights.copy()
        inside = np.einsum("tca,tka->tkc", self.connection, self.hats)
        np.subtract.at(weights, place, inside.reshape(-1, 3))
        return replace(curvature, weights=weights)


def natural_shape(
    positions: FloatArray, rest: FloatArray, faces: IntArray, edges: Edges, plain: Curvature
) -> NaturalShape:
    """Measure the shape ``positions`` (n, 3) [m] of a mesh that is flat in ``rest`` (n, 2) [m].

    Parameters
    ----------
    plain : second derivatives on the flat mesh, with no edge clamped or released

    Raises
    ------
    InputError   positions of another shape, or triangles without area
    """
    positions = np.array(positions, dtype=np.float64, order="C")
    if positions.shape != (len(rest), 3) or not np.isfinite(positions).all():
        raise InputError.single(
            "natural", got=str(positions.shape), expected=f"({len(rest)}, 3) finite positions"
        )
    inverse = np.linalg.inv(np.diff(rest[faces], axis=1))
    # Rows of ``diff`` are corner to corner, so the hats are differences of its inverse's columns.
    step = np.swapaxes(inverse, 1, 2)
    hats = np.stack([-step[:, 0], step[:, 0] - step[:, 1], step[:, 1]], axis=1)
    tangents = np.einsum("tka,tki->tai", hats, positions[faces])
    _check_area(positions[faces])
    second = plain.at(positions)
    metric = tangents @ np.swapaxes(tangents, 1, 2)
    connection = second @ np.swapaxes(tangents, 1, 2) @ np.linalg.inv(metric)
    arcs = _arc_strains(positions, edges, second - connection @ tangents)
    strain = np.einsum("tck,tk->tc", natural_strains(edges), arcs[edges.of_face])
    measure, stretch = _measure(strain)
    return NaturalShape(positions, faces, hats, connection, measure, stretch)


def _check_area(corners: FloatArray) -> None:
    sides = corners - np.roll(corners, 1, axis=1)
    area = 0.5 * np.linalg.norm(np.cross(sides[:, 1], sides[:, 2]), axis=1)
    bad = np.flatnonzero(~(area > _FLAT * (sides**2).sum(axis=2).max(axis=1)))
    if len(bad):
        raise InputError.single(
            "natural", got=f"{len(bad)} triangles without area, first {bad[0]}", expected="none"
        )


def _arc_strains(positions: FloatArray, edges: Edges, second: FloatArray) -> FloatArray:
    """Green strain (e,) of the arcs of all edges on the shape over the edges on the map."""
    other = np.where(edges.free, edges.faces[:, 0], edges.faces[:, 1])
    mean = 0.5 * (second[edges.faces[:, 0]] + second[other])
    t0, t1 = -edges.normal[:, 1], edges.normal[:, 0]
    bow = np.einsum("ec,eci->ei", np.stack([t0 * t0, t1 * t1, t0 * t1], axis=1), mean)
    chord = (positions[edges.ends[:, 1]] - positions[edges.ends[:, 0]]) / edges.length[:, None]
    bent = (edges.length**2 / 12.0) * (bow**2).sum(axis=1)
    return np.asarray(0.5 * ((chord**2).sum(axis=1) + bent - 1.0))


def _measure(strain: FloatArray) -> tuple[FloatArray, FloatArray]:
    """``measure`` and ``stretch`` of a map that the shape strains by (E11, E22, 2 E12), (m, 3).

    The axes of the fabric turn as little as they can: by the square root of the metric.
    """
    a, b, c = 1.0 + 2.0 * strain[:, 0], 1.0 + 2.0 * strain[:, 1], strain[:, 2]
    stretch = np.sqrt(a * b - c * c)
    scale = stretch * np.sqrt(a + b + 2.0 * stretch)
    # The inverse of the metric's root, by Cayley and Hamilton.
    u, v, w = (b + stretch) / scale, (a + stretch) / scale, -c / scale
    rows = [
        [u * u, w * w, u * w],
        [w * w, v * v, w * v],
        [2.0 * u * w, 2.0 * w * v, u * v + w * w],
    ]
    measure = np.stack([np.stack(row, axis=1) for row in rows], axis=1)
    return measure, stretch
