"""Fabrics whose shear loses work to friction between yarns."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from seatlook.model import Fabric, FloatArray, Hysteresis, IntArray
from seatlook.solver.kernels import yarn_friction as kernels


class YarnFriction:
    """Friction of every triangle's shear, on top of the elastic curve.

    A spring that slips at half the width of the loop. Where it rests changes by ``wear`` between
    steps only, so within a step there is one potential; where it is changed neither energy nor
    forces are. Small loops and turns on the way lose what they lose in the cloth.

    Parameters
    ----------
    fabric : (m,) int64                   index into ``fabrics``
    """

    def __init__(self, fabric: IntArray, fabrics: Sequence[Fabric]) -> None:
        self._fabric = fabric
        self._constants = np.array([friction_constants(f.shear_hysteresis) for f in fabrics])
        # Shear at which friction rests [1], and loss [J/m2].
        self._history = np.zeros((len(fabric), 2))
        self._rubbing = np.zeros((len(fabric), 3))

    @property
    def rest(self) -> FloatArray:
        """Shear 2 E12 at which friction rests, (m,) [1]."""
        return self._history[:, 0].copy()

    def remember(self, rest: FloatArray) -> None:
        """Take over where friction rests, (m,)."""
        self._history[:, 0] = rest

    def wear(self, E: FloatArray) -> None:
        """Take strains (m, 3) into the history."""
        kernels.wear(E, self._fabric, self._constants, self._history)

    def tensions(self, E: FloatArray, area: FloatArray, S: FloatArray) -> float:
        """Add friction to S (m, 3) [J], areas times stresses; return its energy [J]."""
        return float(kernels.load(self._rub(E), area, S))

    def stress(self, E: FloatArray, S: FloatArray) -> None:
        """Add friction to the stress S (m, 3) [N/m]."""
        S[:, 2] += self._rub(E)[:, 1]

    def stiffness(self, E: FloatArray, natural: FloatArray, area: FloatArray,
                  out: FloatArray) -> None:  # fmt: skip
        """Add its stiffness to that of the edge strains, (m, 3, 3) [J]."""
        kernels.stiffen(self._rub(E), natural, area, out)

    def _rub(self, E: FloatArray) -> FloatArray:
        kernels.friction(E, self._fabric, self._constants, self._history, self._rubbing)
        return self._rubbing


def friction_constants(hysteresis: Hysteresis | None) -> tuple[float, float, float]:
    """Half the width, half its growth, and the spring before slip [N/m]; zeros for none."""
    if hysteresis is None:
        return 0.0, 0.0, 0.0
    half = 0.5 * hysteresis.width
    return half, 0.5 * hysteresis.growth, half / hysteresis.strain
