"""What indices and measures look at: one solved cover, face by face."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from seatlook.model import Criteria, FloatArray, Solution, WrinkleMap
from seatlook.wrinkle.recovery import low_passed, shape_curvature


class Surface:
    """A solved cover as the indices see it; what is dear is made when first asked for.

    Attributes
    ----------
    solution : Solution
    indices : WrinkleMap                the paper's six
    c_threshold : (m,) float64 [1/m]
    """

    def __init__(
        self,
        solution: Solution,
        indices: WrinkleMap,
        criteria: Criteria,
        *,
        design: FloatArray | None = None,
    ) -> None:
        """Look at a solution.

        Parameters
        ----------
        design : (n, 3) float64 [m]    the shape that was meant; without it the solved one with
            waves below 45 mm removed between seams and hooks
        """
        self.solution, self.indices = solution, indices
        self.c_threshold = criteria.per_face(solution.cover.panel)
        self._design = design

    @property
    def strain_mid(self) -> FloatArray:
        """Green strain (m, 2, 2) of the mid surface in warp/weft axes."""
        return self.solution.strain_mid

    @cached_property
    def net(self) -> FloatArray:
        """Curvature (m, 2, 2) [1/m] of the shape minus that of the shape that was meant.

        Both are fitted to the shapes, so that their errors at panel edges cancel; against the
        strains' curvature they would add wrinkles there.
        """
        cover, x = self.solution.cover, self.solution.positions
        shape = low_passed(cover, x) if self._design is None else self._design
        return np.asarray(shape_curvature(cover, x) - shape_curvature(cover, shape))

    @cached_property
    def membrane(self) -> FloatArray:
        """Stiffness (m, 3, 3) [N/m]: (S11, S22, S12) = D (E11, E22, 2 E12)."""
        cover = self.solution.cover
        return np.stack([m.fabric.membrane_matrix for m in cover.materials])[cover.panel]
