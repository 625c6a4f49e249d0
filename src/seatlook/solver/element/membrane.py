"""Membrane of a flat sheet: strain from the arcs of its edges, stress from the fabric's curves."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

import numpy as np
from scipy.sparse import bsr_array, csc_array, csr_array, eye_array, kron

from seatlook.model import Fabric, FloatArray, IntArray
from seatlook.solver.element.constitutive import constitutive_tables, typical_stiffness
from seatlook.solver.element.curvature import Curvature
from seatlook.solver.element.edgeslope import Edges, natural_strains, tangent_matrix
from seatlook.solver.element.natural import NaturalShape
from seatlook.solver.element.unloading import Unloading
from seatlook.solver.element.yarn_friction import YarnFriction
from seatlook.solver.kernels import membrane as kernels
from seatlook.solver.kernels.curvature import along_edges

# A triangle's centroid stands a third of its height above an edge.
_CENTROID = 1.0 / 3.0


class Membrane:
    """Membrane energy ``sum A psi(E)`` [J] over all panels.

    The strain of a triangle is that of its three edges, each as long as the arc that the bending
    element's curvature makes of its chord. In the plane this is the constant-strain triangle, so
    the patch test holds on every mesh; bent, a quadratic surface has the strain it should have,
    which spares the false bending stiffness and most of the locking of chords. Along a free edge
    the strain is often a peak, which belongs to the edge and not to the whole triangle: in the row
    along it strains run linearly from the rim to the next row of edges, and each triangle has the
    one at its centroid. What one gains its neighbour loses, so the patch test is kept.

    psi = warp curve (E11) + weft curve (E22) + shear curve (2 E12) + coupling. Stiffness is
    piecewise linear in Green strain, so stress is smooth and energy a cubic. In compression it
    falls to ``compression_ratio`` times its first value over 2e-3 of strain; the coupling
    ``C12 ((1 - c) p(E11) p(E22) + c E11 E22)``, p = e^2 / (e + 2e-3) in tension and 0 else, keeps
    the same share c, so that psi stays convex and c = 1 is the linear orthotropic fabric.
    Fabrics that lose work have a history, see ``Unloading`` and ``YarnFriction``; ``wear`` adds to
    it between steps.

    Parameters
    ----------
    edges : of the flat mesh
    curvature : from ``recover_curvature``
    area : (m,) float64 [m2]
    fabric : (m,) int64                   index into ``fabrics``
    shape : in which there is no strain; the flat mesh if not given
    """

    def __init__(
        self,
        edges: Edges,
        curvature: Curvature,
        area: FloatArray,
        fabric: IntArray,
        fabrics: Sequence[Fabric],
        shape: NaturalShape | None = None,
    ) -> None:
        self._edges, self._area, self._fabric = edges, area, fabric
        self._natural = natural_strains(edges)
        if shape is not None:
            self._natural = np.ascontiguousarray(shape.measure @ self._natural)
        self._count = count = len(curvature.reference)
        self._rows: tuple[IntArray, IntArray, FloatArray] = along_edges(
            count, edges.faces, edges.normal, *curvature.rows
        )
        self._bow_offset = _bow_offset(edges, curvature.offset)
        self._constitutive = constitutive_tables(fabrics)
        self._constants = np.array(
            [[f.poisson * f.weft.stiffness[0], f.compression_ratio] for f in fabrics]
        )
        # None costs nothing: most fabrics go back the way they came.
        self._unloading = self._friction = None
        if any(f.warp_unloading or f.weft_unloading for f in fabrics):
            self._unloading = Unloading(fabric, fabrics, self._constitutive)
        if any(f.shear_hysteresis for f in fabrics):
            self._friction = YarnFriction(fabric, fabrics)
        self._losses = [term for term in (self._unloading, self._friction) if term is not None]
        self._laplacian = self._plane_laplacian(count, fabrics)
        self._bow = np.empty((len(edges.ends), 3))
        self._edge_strain = np.empty(len(edges.ends))
        self._pull = np.empty(len(edges.ends))
        self._E, self._tension = np.empty((len(area), 3)), np.empty((len(area), 3))
        self._pairs, self._share = _along_rims(edges, area)
        self._move = np.empty((len(self._pairs), 3))
        self._strain_at_rest: FloatArray | None = None
        if shape is not None:
            self._deform(shape.positions)
            self._strain_at_rest = self._edge_strain.copy()

    @property
    def peaks(self) -> FloatArray | None:
        """What is remembered of the strains, (m, 2) or (m, 3) [1]; None if nothing is.

        Largest warp and weft strains so far, -inf if never stretched, and where shear has friction
        the shear at which that rests.
        """
        if not self._losses:
            return None
        peaks = np.full((len(self._area), 2), -np.inf)
        if self._unloading is not None:
            peaks = self._unloading.peaks
        if self._friction is None:
            return peaks
        return np.column_stack([peaks, self._friction.rest])

    def wear(self, x: FloatArray) -> None:
        """Take the strains at ``x`` into the history; energy and forces there do not change."""
        if self._losses:
            self._deform(x)
            for term in self._losses:
                term.wear(self._E)

    def remember(self, peaks: FloatArray) -> None:
        """Take over the ``peaks`` of an earlier state of the same mesh."""
        if self._unloading is not None:
            self._unloading.wear(peaks[:, :2])
        if self._friction is not None and peaks.shape[1] > 2:
            self._friction.remember(peaks[:, 2])

    def strain(self, x: FloatArray) -> FloatArray:
        """Return the Green strain (E11, E22, 2 E12) of every triangle, (m, 3) [1]."""
        self._deform(x)
        return self._E.copy()

    def stress(self, x: FloatArray) -> FloatArray:
        """Return the second Piola-Kirchhoff stress (S11, S22, S12), (m, 3) [N/m]."""
        self._deform(x)
        return self._stress()

    def value(self, x: FloatArray, gradient: FloatArray) -> float:
        """Return the energy [J] and add its gradient [N] to ``gradient``."""
        self._deform(x)
        S = self._tension
        energy = kernels.tensions(
            self._E, self._area, self._fabric, *self._constitutive, self._constants, S
        )
        for term in self._losses:
            energy += term.tensions(self._E, self._area, S)
        self._pull_edges(S)
        kernels.forces(
            x, self._pull, self._edges.ends, self._edges.length, *self._rows, self._bow, gradient
        )
        return float(energy)

    def back(self, x: FloatArray, values: FloatArray) -> FloatArray:
        """Return the transposed derivative (n, 3) of ``strain`` at ``x``, of values (m, 3)."""
        self._deform(x)
        self._pull_edges(np.array(values, order="C"))
        out = np.zeros_like(x)
        kernels.forces(
            x, self._pull, self._edges.ends, self._edges.length, *self._rows, self._bow, out
        )
        return out

    def hessian(self, x: FloatArray, *, definite: bool = False) -> csc_array:
        """Second derivative (3n, 3n) [N/m]; ``definite`` keeps the tensile part of the stress."""
        self._deform(x)
        pull = self._pulls(definite)
        unit = np.broadcast_to(np.eye(3), self._natural.shape).copy()
        blocks = self._material(unit)
        begin = np.arange(len(blocks) + 1)
        size = 3 * len(blocks)
        material = bsr_array((blocks, begin[:-1], begin), shape=(size, size))
        coupled = csr_array(self._measure.T @ (material @ self._measure))
        rates = self._rates(x)
        geometric = self._geometric(pull, definite)
        return csc_array(rates.T @ (coupled @ rates) + kron(geometric, eye_array(3)))

    def tangent(self, x: FloatArray, *, definite: bool = False) -> tuple[FloatArray, FloatArray]:
        """Derivatives of the energy [J] by the strains of the edges at ``x``.

        Returns
        -------
        material : (m, 3, 3)   second derivative of each triangle's energy by its edges' strains; at
            a rim without what its neighbours have to do with it
        pull : (e,)            first derivative of all; ``definite`` keeps the tensile stress only
        """
        self._deform(x)
        return self._material(self._natural), self._pulls(definite).copy()

    def stiffness(self) -> csc_array:
        """Scalar stiffness (n, n) [N/m] of plane triangles, warp and weft each with its own."""
        return self._laplacian

    @cached_property
    def _split(self) -> tuple[csr_array, csr_array]:
        """Slope along every edge and its bow as (e, n) matrices of one pattern."""
        begin, nodes, values = self._rows
        bow = csr_array((values, nodes, begin), shape=(len(begin) - 1, self._count))
        return _common(tangent_matrix(self._count, self._edges), bow)

    @cached_property
    def _measure(self) -> csr_array:
        """Strains of all triangles from those of the edges, (3m, e)."""
        m, e = self._edges.of_face.shape[0], len(self._edges.ends)
        rows = np.repeat(np.arange(3 * m), 3)
        columns = np.repeat(self._edges.of_face[:, None], 3, axis=1).ravel()
        own = csr_array((self._natural.ravel(), (rows, columns)), shape=(3 * m, e))
        pairs, share = self._pairs, self._share
        place = np.concatenate([pairs[:, 0], pairs[:, 0], pairs[:, 1], pairs[:, 1]])
        other = np.concatenate([pairs[:, 1], pairs[:, 0], pairs[:, 0], pairs[:, 1]])
        change = np.concatenate([share[:, 0], -share[:, 0], share[:, 1], -share[:, 1]])
        mixed = eye_array(m) + csr_array((change, (place, other)), shape=(m, m))
        return csr_array(kron(mixed, eye_array(3)) @ own)

    def _material(self, natural: FloatArray) -> FloatArray:
        """Second derivative (m, 3, 3) [J] of the energies at hand by what ``natural`` takes."""
        material = np.empty((len(self._area), 3, 3))
        kernels.edge_stiffness(
            self._E,
            natural,
            self._area,
            self._fabric,
            *self._constitutive,
            self._constants,
            material,
        )
        for term in self._losses:
            term.stiffness(self._E, natural, self._area, material)
        return material

    def _pulls(self, definite: bool) -> FloatArray:
        """Pull (e,) [J] of the edges at hand; ``definite`` keeps the tensile stress only."""
        stress = self._stress()
        if definite:
            kernels.clamp(stress)
        stress *= self._area[:, None]
        self._pull_edges(stress)
        return self._pull

    def _pull_edges(self, tension: FloatArray) -> None:
        """Fill the pull of the edges from areas times stresses (m, 3) [J]."""
        kernels.exchange_back(tension, self._pairs, self._share, self._move)
        kernels.pulls(tension, self._edges.of_face, self._natural, self._pull)

    def _rates(self, x: FloatArray) -> csr_array:
        """Derivative (e, 3n) of the edge strains by the positions."""
        edges, (chord, arc) = self._edges, self._split
        along = (x[edges.ends[:, 1]] - x[edges.ends[:, 0]]) / edges.length[:, None]
        bowed = edges.length[:, None] ** 2 / 12.0 * self._bow
        row = np.repeat(np.arange(len(edges.ends)), np.diff(chord.indptr))
        values = along[row] * chord.data[:, None] + bowed[row] * arc.data[:, None]
        columns = 3 * chord.indices[:, None] + np.arange(3)
        shape = (len(edges.ends), x.size)
        return csr_array((values.ravel(), columns.ravel(), 3 * chord.indptr), shape=shape)

    def _geometric(self, pull: FloatArray, definite: bool) -> csr_array:
        """Stiffness (n, n) of the stress at hand; chords and arcs of edges pull like strings."""
        edges, (chord, arc) = self._edges, self._split
        bend = edges.length**2 / 12.0 * (np.maximum(pull, 0.0) if definite else pull)
        strings = chord.T @ chord.multiply(pull[:, None])
        return csr_array(strings + arc.T @ arc.multiply(bend[:, None]))

    def _stress(self) -> FloatArray:
        """Stress (m, 3) [N/m] of the last strains."""
        S = np.asarray(
            kernels.stresses(self._E, self._fabric, *self._constitutive, self._constants)
        )
        for term in self._losses:
            term.stress(self._E, S)
        return S

    def _deform(self, x: FloatArray) -> None:
        edges = self._edges
        kernels.edge_strains(
            x, edges.ends, edges.length, *self._rows, self._bow_offset, self._bow, self._edge_strain
        )
        if self._strain_at_rest is not None:
            self._edge_strain -= self._strain_at_rest
        kernels.strains(self._edge_strain, edges.of_face, self._natural, self._E)
        kernels.exchange(self._E, self._pairs, self._share, self._move)

    def _plane_laplacian(self, count: int, fabrics: Sequence[Fabric]) -> csc_array:
        warp = np.array([typical_stiffness(f.warp) for f in fabrics])[self._fabric]
        weft = np.array([typical_stiffness(f.weft) for f in fabrics])[self._fabric]
        # Stress diag(warp, weft) as a pull on every edge: the geometric stiffness it makes.
        share = self._area[:, None] * (
            self._natural[:, 0] * warp[:, None] + self._natural[:, 1] * weft[:, None]
        )
        of_face = self._edges.of_face.ravel()
        pull = np.bincount(of_face, share.ravel(), minlength=len(self._edges.ends))
        along = tangent_matrix(count, self._edges)
        return csc_array(along.T @ along.multiply(pull[:, None]))


def _along_rims(edges: Edges, area: FloatArray) -> tuple[IntArray, FloatArray]:
    """Pairs (p, 2) of a triangle at a rim and one beside it, and the shares that they exchange.

    Triangles with two free edges, and two beside each other at opposite rims, have no row of edges
    behind the rim; they keep their strain.
    """
    rim = edges.free[edges.of_face].sum(axis=1) == 1
    pairs = edges.faces[~edges.free]
    pairs = np.ascontiguousarray(pairs[rim[pairs].sum(axis=1) == 1])
    # Half for each of two neighbours; of the smaller area, so that no strain overshoots.
    smaller = area[pairs].min(axis=1)[:, None]
    return pairs, 0.5 * _CENTROID * smaller / area[pairs]


def _bow_offset(edges: Edges, offset: FloatArray) -> FloatArray:
    """What clamped slopes add to the second derivative along every edge, (e, 3) [1/m]."""
    t0, t1 = -edges.normal[:, 1], edges.normal[:, 0]
    mean = np.where(edges.free[:, None, None], offset[edges.faces[:, 0]], 0.0)
    inner = ~edges.free
    mean[inner] = offset[edges.faces[inner]].mean(axis=1)
    along = np.stack([t0 * t0, t1 * t1, t0 * t1], axis=1)
    return np.asarray(np.einsum("ec,eci->ei", along, mean))


def _common(first: csr_array, second: csr_array) -> tuple[csr_array, csr_array]:
    """Both matrices on the union of their patterns, zeros stored."""
    ones = [
        csr_array((np.ones(m.nnz), m.indices, m.indptr), shape=m.shape) for m in (first, second)
    ]
    union = csr_array(ones[0] + ones[1])
    union.sort_indices()
    empty = csr_array((np.zeros(union.nnz), union.indices, union.indptr), shape=union.shape)
    place = csr_array((np.arange(1.0, union.nnz + 1), union.indices, union.indptr), union.shape)
    spread = []
    for matrix, mask in zip((first, second), ones, strict=True):
        filled = empty.copy()
        where = csr_array(place.multiply(mask))
        where.sort_indices()
        sorted_matrix = matrix.sorted_indices()
        filled.data[where.data.astype(np.int64) - 1] = sorted_matrix.data
        spread.append(filled)
    return spread[0], spread[1]
