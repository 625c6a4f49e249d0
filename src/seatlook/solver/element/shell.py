"""A bare sheet of one fabric: perhaps curved at rest, perhaps turned by moments at its edges."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy.sparse import csr_array

from seatlook.model import Fabric, FloatArray, IntArray
from seatlook.solver.element.bending import Bending
from seatlook.solver.element.curvature import Clamps, Curvature, released
from seatlook.solver.element.edgeslope import Edges
from seatlook.solver.element.elastic import ElasticSheet, tensors
from seatlook.solver.element.natural import natural_shape
from seatlook.solver.element.shell_bending import ShellBending

BoolArray = npt.NDArray[np.bool_]


class Shell(ElasticSheet):
    """An ``ElasticSheet`` with a natural shape, and free edges that pass on moments.

    Parameters
    ----------
    rest : (n, 2) float64 [m]; faces : (m, 3) int64; fabric : of the whole sheet
    natural : (n, 3) float64 [m]  shape in space without stress; the flat sheet if not given
    turned : (n,) bool            a free edge between two of these passes on a moment
    clamped, positions : as for ``ElasticSheet``; with a natural shape clamped edges keep the
        direction that the shape has there

    Raises
    ------
    InvertedElementError, InputError   as ``ElasticSheet``, or the natural shape is none
    """

    def __init__(
        self,
        rest: FloatArray,
        faces: IntArray,
        fabric: Fabric,
        *,
        natural: FloatArray | None = None,
        turned: BoolArray | None = None,
        clamped: BoolArray | None = None,
        positions: FloatArray | None = None,
    ) -> None:
        self._natural, self._turned = natural, turned
        panel = np.zeros(len(faces), dtype=np.int64)
        super().__init__(rest, faces, panel, [fabric], clamped=clamped, positions=positions)

    def curvatures(self, x: FloatArray) -> FloatArray:
        """Return by how much kappa is more than at rest, (m, 2, 2) [1/m]; a crown is positive."""
        if not isinstance(self.bending, ShellBending):
            return super().curvatures(x)
        return tensors(-self.bending.change(x))

    def slopes_across(self, edges: IntArray) -> csr_array:
        """Matrix (k, n) [1/m] from positions to the slopes across ``edges`` (k,)."""
        index = (self._rows.weights, self._rows.nodes, self._rows.start)
        whole = csr_array(index, shape=(len(self.edges.ends), len(self.rest)))
        return csr_array(whole[edges])

    def _recover(
        self, stiffness: FloatArray, clamped: BoolArray | None, positions: FloatArray | None
    ) -> FloatArray:
        bearing = np.zeros(0, dtype=np.int64)
        if self._turned is not None:
            bearing = self.rim_edges(self._turned)
        if self._natural is None:
            self._curvature = self._recovered(stiffness, self._clamps(clamped, positions), bearing)
            return stiffness
        every = np.flatnonzero(self.edges.free)
        plain = self._recovered(stiffness, None, every)
        shape = natural_shape(self._natural, self.rest, self.faces, self.edges, plain)
        held = np.zeros(0, dtype=np.int64) if clamped is None else self.rim_edges(clamped)
        clamps = Clamps(held, self.slopes_across(held) @ shape.positions, shape.positions)
        within = shape.covariant(self._recovered(stiffness, clamps, every))
        on_map = np.swapaxes(shape.measure, 1, 2) @ stiffness @ shape.measure
        loose = self.edges.free.copy()
        loose[held] = loose[bearing] = False
        self._curvature = released(within, self.edges, on_map, loose)
        self.shape, self.area = shape, self.area * shape.stretch
        return np.asarray(on_map)

    def _bending(
        self, edges: Edges, curvature: Curvature, area: FloatArray, stiffness: FloatArray
    ) -> Bending | ShellBending:
        if self.shape is None:
            return super()._bending(edges, curvature, area, stiffness)
        return ShellBending(edges, curvature, area, stiffness, self.shape)
