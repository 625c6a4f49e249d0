"""Fabrics that go back from the peak of their strain by another curve than they came."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from seatlook.model import Fabric, FloatArray, IntArray
from seatlook.solver.element.constitutive import unloading_tables
from seatlook.solver.kernels import unloading as kernels


class Unloading:
    """History of every triangle's strain along warp and weft, and what its tension lacks by it.

    The unloading curve, which starts where tension is gone, is shifted to meet the loading curve at
    the peak of the strain; reloading goes up the same way.
    Peaks are raised by ``wear`` between steps only, so within a step there is one potential, C1 at
    the peak; where a peak is raised neither energy nor forces change.

    Parameters
    ----------
    fabric : (m,) int64                   index into ``fabrics``
    loading : tables and counts of the fabrics' curves, from ``constitutive_tables``
    """

    def __init__(
        self, fabric: IntArray, fabrics: Sequence[Fabric], loading: tuple[FloatArray, IntArray]
    ) -> None:
        self._curves = fabric, *loading, *unloading_tables(fabrics)
        # Peak and set [1], loss [J/m2]; without a peak the first strain, slack or not, is new.
        self._history = np.zeros((len(fabric), 2, 3))
        self._history[:, :, 0] = -np.inf
        self._lacking = np.zeros((len(fabric), 2, 3))

    @property
    def peaks(self) -> FloatArray:
        """Largest warp and weft strains so far, (m, 2) [1], -inf if never stretched."""
        return self._history[:, :, 0].copy()

    def wear(self, E: FloatArray) -> None:
        """Take strains (m, 2 or 3) into the history."""
        kernels.wear(np.array(E, order="C"), *self._curves, self._history)

    def tensions(self, E: FloatArray, area: FloatArray, S: FloatArray) -> float:
        """Add what is lacking to S (m, 3) [J], areas times stresses; return its energy [J]."""
        return float(kernels.relieve(self._lack(E), area, S))

    def stress(self, E: FloatArray, S: FloatArray) -> None:
        """Add the lacking stress to S (m, 3) [N/m]."""
        S[:, :2] += self._lack(E)[:, :, 1]

    def stiffness(self, E: FloatArray, natural: FloatArray, area: FloatArray,
                  out: FloatArray) -> None:  # fmt: skip
        """Add the lacking stiffness to that of the edge strains, (m, 3, 3) [J]."""
        kernels.soften(self._lack(E), natural, area, out)

    def _lack(self, E: FloatArray) -> FloatArray:
        kernels.lack(E, *self._curves, self._history, self._lacking)
        return self._lacking
