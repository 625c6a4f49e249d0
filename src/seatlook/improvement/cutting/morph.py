"""A fixed mesh that follows its outline: panels of another cut without another mesh."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.sparse.linalg import SuperLU, splu

from seatlook.errors import InvertedElementError
from seatlook.improvement.cutting.outline import Outline
from seatlook.model import Cover, FloatArray, Pattern
from seatlook.wrinkle.recovery import laplacian

# Of its area, that a triangle must keep: a thinner one would make the result worse than a new mesh.
_LEAST_AREA = 0.3


class Morph:
    """Moves the inside of every panel's mesh with its outline.

    Each coordinate of the way is harmonic in the panel, so it is smooth, nowhere larger than on
    the outline, and the same for every amount: twice the change moves everything twice as far.

    Parameters
    ----------
    cover : its ``uv`` is where panels are moved from
    """

    def __init__(self, cover: Cover, pattern: Pattern, outlines: Sequence[Outline]) -> None:
        self.cover, self.outlines = cover, outlines
        self._warp = np.stack([p.grain / np.hypot(*p.grain) for p in pattern.panels])
        self._solvers: dict[int, tuple[np.ndarray, np.ndarray, SuperLU, object]] = {}

    def spread(self, panel: int, way: FloatArray) -> FloatArray:
        """Spread the way (r, 2) [m] of an outline's vertices over its panel, (n, 2) [m]."""
        rim = self.outlines[panel].vertices
        free, _, factor, known = self._solver(panel)
        out = np.zeros_like(self.cover.uv)
        out[rim] = way
        out[free] = factor.solve(-(known @ way))  # type: ignore[operator]
        return out

    def moved(self, way: FloatArray) -> Cover:
        """Return the cover with the panels' material points moved by ``way`` (n, 2) [m].

        Raises
        ------
        InvertedElementError
            The mesh cannot follow: a triangle would turn over or lose most of its area.
        """
        cover = self.cover
        changed = replace(cover, uv=cover.uv + way, rest=cover.rest + self.along_grain(way))
        share = changed.rest_area / cover.rest_area
        worst = int(np.argmin(share))
        if share[worst] < _LEAST_AREA:
            raise InvertedElementError(
                f"the mesh of panel {cover.panel_names[cover.panel[worst]]} cannot follow a change "
                f"of {1e3 * np.linalg.norm(way, axis=1).max():.1f} mm: a triangle keeps "
                f"{100 * share[worst]:.0f} % of its area; solve it on a new mesh"
            )
        return changed

    def along_grain(self, way: FloatArray) -> FloatArray:
        """Turn pattern coordinates (n, 2) so that the first axis runs along the warp."""
        owner = np.zeros(len(way), dtype=np.int64)
        owner[self.cover.faces] = self.cover.panel[:, None]
        warp = self._warp[owner]
        weft = np.column_stack([-warp[:, 1], warp[:, 0]])
        return np.column_stack([(way * warp).sum(axis=1), (way * weft).sum(axis=1)])

    def _solver(self, panel: int) -> tuple[np.ndarray, np.ndarray, SuperLU, object]:
        if panel not in self._solvers:
            cover, rim = self.cover, self.outlines[panel].vertices
            faces = cover.faces[cover.panel == panel]
            matrix, _ = laplacian(cover.rest, faces, len(cover.rest))
            free = np.setdiff1d(np.unique(faces), rim)
            rows = matrix.tocsr()[free]
            self._solvers[panel] = free, rim, splu(rows[:, free].tocsc()), rows[:, rim]
        return self._solvers[panel]
