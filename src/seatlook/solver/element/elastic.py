"""All panels of a cover as one elastic sheet: energies, mass, strains, scalar stiffness."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
from scipy.sparse import csc_array

from seatlook.errors import InputError
from seatlook.model import Fabric, FloatArray, Hem, IntArray
from seatlook.solver.element.bending import Bending
from seatlook.solver.element.curvature import Clamps, Curvature, recover_curvature
from seatlook.solver.element.edgeslope import Edges, areas, edges_of, slope_rows
from seatlook.solver.element.hem import Folds
from seatlook.solver.element.membrane import Membrane
from seatlook.solver.element.natural import NaturalShape
from seatlook.solver.element.shell_bending import ShellBending
from seatlook.solver.energy import Energy

BoolArray = npt.NDArray[np.bool_]


class ElasticSheet:
    """The `edgeslope` element over any number of flat, unconnected panels.

    Parameters
    ----------
    rest : (n, 2) float64 [m]     first axis along the warp
    faces : (m, 3) int64          counter-clockwise in ``rest``
    panel : (m,) int64            index into ``fabrics``
    fabrics : one Fabric for each panel
    clamped : (n,) bool           a free edge between two clamped vertices keeps the direction
        across it that its triangle has in ``positions``, (n, 3) [m], the flat sheet if not given
    hem : second layer and folds along the seams

    Raises
    ------
    InvertedElementError   a triangle is turned over or has no area at rest
    InputError             three triangles share an edge, a panel has no fabric, ...
    """

    def __init__(
        self,
        rest: FloatArray,
        faces: IntArray,
        panel: IntArray,
        fabrics: Sequence[Fabric],
        *,
        clamped: BoolArray | None = None,
        positions: FloatArray | None = None,
        hem: Hem | None = None,
    ) -> None:
        rest = np.array(rest, dtype=np.float64, order="C")
        faces = np.array(faces, dtype=np.int64, order="C")
        panel = np.array(panel, dtype=np.int64)
        if len(panel) != len(faces) or not 0 <= panel.min() <= panel.max() < len(fabrics):
            raise InputError.single(
                "panel",
                got=f"{len(panel)} entries for {len(faces)} faces and {len(fabrics)} fabrics",
                expected="one fabric for every face",
            )
        self.faces, self.rest = faces, rest
        self.area = areas(rest, faces)
        self.edges = edges_of(rest, faces)
        self._panel, self._fabrics = panel, tuple(fabrics)
        self.thickness = np.array([f.thickness for f in fabrics])[panel]
        density = np.array([f.density for f in fabrics])[panel]
        stiffness = np.stack([f.bending_matrix for f in fabrics])[panel]
        if hem is not None:
            density, stiffness = density + hem.density, stiffness + hem.bending
        self.bending_stiffness = stiffness
        self._rows = slope_rows(rest, faces, self.edges)
        self.folds = None if hem is None else Folds(hem, self.edges, self._rows)
        self.shape: NaturalShape | None = None
        stiffness = self._recover(stiffness, clamped, positions)
        self.mass = np.bincount(
            faces.ravel(), np.repeat(density * self.area / 3.0, 3), minlength=len(rest)
        )
        parts = (self.edges, self._curvature, self.area)
        self.membrane = Membrane(*parts, panel, self._fabrics, self.shape)
        self.bending = self._bending(*parts, stiffness)
        self._sewn: csc_array | None = None
        if hem is not None and self.folds is not None:
            doubled = Bending(*parts, stiffness * (hem.density > 0.0)[:, None, None])
            self._sewn = csc_array(doubled.stiffness() + self.folds.matrix())

    @property
    def energies(self) -> tuple[Energy, ...]:
        """The terms of the potential, membrane first."""
        own: tuple[Energy, ...] = (self.membrane, self.bending)
        return own if self.folds is None else (*own, self.folds)

    def across(self) -> csc_array:
        """Scalar matrix (n, n) [N/m] of what resists bending: sheet and folds."""
        if self.folds is None:
            return self.bending.stiffness()
        return csc_array(self.bending.stiffness() + self.folds.matrix())

    def stiffness(self, include_bending: bool = False) -> csc_array:
        """Constant scalar matrix (n, n) [N/m] that stands for the sheet in a prefactor.

        Folds are stiff beside ties, so they and what bends with them are always part of it;
        bending elsewhere seldom pays for the entries that it adds.
        """
        if include_bending:
            return csc_array(self.membrane.stiffness() + self.across())
        if self._sewn is not None:
            return csc_array(self.membrane.stiffness() + self._sewn)
        return self.membrane.stiffness()

    def curvatures(self, x: FloatArray) -> FloatArray:
        """Return kappa = -(n . x,ij) of every triangle, (m, 2, 2) [1/m]; a crown is positive."""
        second = self._curvature.at(x)
        p = x[self.faces]
        normal = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
        normal /= np.linalg.norm(normal, axis=1)[:, None]
        return tensors(-np.einsum("tki,ti->tk", second, normal))

    def recovered_curvatures(self, x: FloatArray) -> FloatArray:
        """Return smoother kappa of every triangle, (m, 2, 2) [1/m].

        Averaged over each vertex's triangles and back, which halves the scatter but flattens
        waves; what the same averaging takes from the result is put back twice.
        """
        part = total = self._at_vertices(self.curvatures(x))
        for _ in range(2):
            part = part - self._at_vertices(part[self.faces].mean(axis=1))
            total = total + part
        return np.asarray(total[self.faces].mean(axis=1))

    def curvature_back(self, x: FloatArray, values: FloatArray) -> FloatArray:
        """Transposed derivative (n, 3) of ``recovered_curvatures`` at ``x``.

        Parameters
        ----------
        values : (m, 2, 2) symmetric; its product with the curvatures is what is derived
        """
        part = total = self._from_vertices(values)
        for _ in range(2):
            part = part - self._from_vertices(part)
            total = total + part
        second = self._curvature.at(x)
        p = x[self.faces]
        a, b = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
        cross = np.cross(a, b)
        size = np.linalg.norm(cross, axis=1)[:, None]
        normal = cross / size
        # Of (kappa11, kappa22, 2 kappa12).
        pull = np.stack([total[:, 0, 0], total[:, 1, 1], total[:, 0, 1]], axis=1)
        if isinstance(self.bending, ShellBending):
            pull = np.einsum("tck,tc->tk", self.bending.measure, pull)
        out = self._curvature.back(-pull[:, :, None] * normal[:, None, :])
        turn = -np.einsum("tk,tki->ti", pull, second)
        turn -= np.einsum("ti,ti->t", turn, normal)[:, None] * normal
        turn /= size
        sides = np.cross(b, turn), np.cross(turn, a)
        np.add.at(out, self.faces[:, 1], sides[0])
        np.add.at(out, self.faces[:, 2], sides[1])
        np.subtract.at(out, self.faces[:, 0], sides[0] + sides[1])
        return out

    def strains(self, x: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Green strain on the top, mid and bottom surface, each (m, 2, 2) in warp/weft axes [1].

        Top and bottom differ by the thickness times the recovered curvature.
        """
        x = np.array(x, dtype=np.float64, order="C")
        mid = tensors(self.membrane.strain(x))
        part = 0.5 * self.thickness[:, None, None] * self.recovered_curvatures(x)
        return mid + part, mid, mid - part

    def _at_vertices(self, values: FloatArray) -> FloatArray:
        """Area-weighted mean (n, 2, 2) of the triangles around every vertex."""
        corners, n = self.faces.ravel(), len(self.mass)
        weight = np.repeat(self.area, 3)
        flat = np.repeat(values.reshape(-1, 4), 3, axis=0) * weight[:, None]
        total = np.stack([np.bincount(corners, column, minlength=n) for column in flat.T], axis=1)
        around = np.maximum(np.bincount(corners, weight, minlength=n), np.finfo(float).tiny)
        return np.asarray((total / around[:, None]).reshape(-1, 2, 2))

    def rim_edges(self, mask: BoolArray) -> IntArray:
        """Free edges (k,) between two vertices of ``mask`` (n,)."""
        return np.flatnonzero(self.edges.free & mask[self.edges.ends].all(axis=1))

    def _recover(
        self, stiffness: FloatArray, clamped: BoolArray | None, positions: FloatArray | None
    ) -> FloatArray:
        """Recover second derivatives; return the bending matrices (m, 3, 3) that go with them."""
        clamps = self._clamps(clamped, positions)
        sewn = None if self.folds is None else self.folds.edges
        self._curvature = self._recovered(stiffness, clamps, sewn)
        return stiffness

    def _recovered(
        self, stiffness: FloatArray, clamps: Clamps | None, sewn: IntArray | None
    ) -> Curvature:
        return recover_curvature(
            len(self.rest), self.edges, self._rows, self.area, stiffness, clamps, sewn
        )

    def _bending(
        self, edges: Edges, curvature: Curvature, area: FloatArray, stiffness: FloatArray
    ) -> Bending | ShellBending:
        """The term of the potential that resists bending."""
        return Bending(edges, curvature, area, stiffness)

    def _from_vertices(self, values: FloatArray) -> FloatArray:
        """Transpose of averaging faces (m, 2, 2) at the vertices and these in the faces again."""
        corners, n = self.faces.ravel(), len(self.mass)
        weight = np.repeat(self.area, 3)
        flat = np.repeat(values.reshape(-1, 4) / 3.0, 3, axis=0)
        total = np.stack([np.bincount(corners, column, minlength=n) for column in flat.T], axis=1)
        around = np.maximum(np.bincount(corners, weight, minlength=n), np.finfo(float).tiny)
        share = (total / around[:, None])[self.faces].sum(axis=1)
        return np.asarray((self.area[:, None] * share).reshape(-1, 2, 2))

    def _clamps(self, clamped: BoolArray | None, positions: FloatArray | None) -> Clamps | None:
        """Free edges between clamped vertices, with the slope of their own plane triangle."""
        if clamped is None:
            return None
        held = self.rim_edges(clamped)
        x = np.pad(self.rest, ((0, 0), (0, 1))) if positions is None else np.asarray(positions)
        corners = self.faces[self.edges.faces[held, 0]]
        plane = np.linalg.inv(np.diff(self.rest[corners], axis=1))
        gradient = np.einsum("kia,kac->kic", plane, np.diff(x[corners], axis=1))
        slopes = np.einsum("ki,kic->kc", self.edges.normal[held], gradient)
        return Clamps(edges=held, slopes=slopes, positions=x)


def tensors(components: FloatArray) -> FloatArray:
    """(m, 2, 2) tensors of (11, 22, 2 x 12) components."""
    a, b, c = components.T
    return np.ascontiguousarray(np.stack([a, 0.5 * c, 0.5 * c, b], axis=1).reshape(-1, 2, 2))
