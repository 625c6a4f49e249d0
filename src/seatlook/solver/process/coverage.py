"""Where the cover is: deep in its foam, below bare foam, or not on it at all.

Forces in balance do not show it: a penalty balances a cover at any depth, and a cover that hangs
beside its foam is at rest.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.spatial import KDTree

from seatlook.mesh import boundary_sides, face_areas, face_normals
from seatlook.mesh.statistics import quantile
from seatlook.mesh.surface import spread
from seatlook.model import Cover, FloatArray, Foam
from seatlook.solver.foam.foundation import Foundation

# Depth [m] -> largest share of the cover. Good covers of a headrest and a pillow have 7 % and 5 %
# of their area deeper than 10 mm; a buried headrest had 45 %, and 23 % deeper than 20 mm.
BURIED = {0.010: 0.15, 0.020: 0.10}
BARE_HEIGHT = 0.020  # m above the cover, from which foam counts as bare
BARE = 0.05  # of the cover's area
UNTOUCHED = 0.95  # of the cover's area
_SPACING = 0.010  # m, of the points at which the foam's surface is looked at


@dataclass(frozen=True, slots=True)
class Coverage:
    """Depth of a cover in its foam, foam above it, and how far it is from it.

    Parameters
    ----------
    area : (m,) float64 [m2]      of the faces at rest
    depth : (m,) float64 [m]      in the untouched foam, below 0 outside
    touching : (m,) float64       share of each face that touches
    bare : (m,) float64 [m2]      foam that lies bare above each face
    height : float [m]            largest of the foam above the cover
    """

    cover: Cover
    area: FloatArray
    depth: FloatArray
    touching: FloatArray
    bare: FloatArray
    height: float

    def figures(self) -> dict[str, float]:
        """Shares of the cover's area, and the gap [m] that 95 % of it do not exceed."""
        return {
            **{
                buried(depth): self._share(np.where(self.depth > depth, 1.0, 0.0))
                for depth in BURIED
            },
            "bare_foam": float(self.bare.sum() / self.area.sum()),
            "untouched": self._share(1.0 - self.touching),
            "gap_p95": quantile(np.abs(self.depth), self.area, 0.95),
        }

    def reasons(self) -> list[str]:
        """Reasons why the foam is not covered, with place and amount; none where it is."""
        figures = self.figures()
        if figures["untouched"] > UNTOUCHED:
            return [self._aloof(1.0 - figures["untouched"])]
        causes = []
        for depth, limit in BURIED.items():
            share = figures[buried(depth)]
            if share > limit:
                causes.append(self._buried(depth, share, limit))
                break
        if figures["bare_foam"] > BARE:
            place = self._most(self.bare)
            causes.append(
                f"{1e4 * self.bare.sum():.3g} cm2 of foam lie bare above the cover (at most "
                f"{_percent(BARE)} of its area), up to {1e3 * self.height:.0f} mm high, most of it "
                f"above panel {place}"
            )
        return causes

    def _aloof(self, share: float) -> str:
        nearest = int(np.argmax(np.where(self.touching > 0.0, np.inf, self.depth)))
        if not self.touching.any():
            return (
                f"the cover does not touch the foam: the nearest place, in panel "
                f"{self._panel(nearest)}, is {max(0.0, -1e3 * self.depth[nearest]):.2g} mm away"
            )
        return (
            f"the cover does not touch the foam but with {_percent(share)} of its area (at least "
            f"{_percent(1.0 - UNTOUCHED)}), in panel {self._most(self.touching * self.area)}"
        )

    def _buried(self, depth: float, share: float, limit: float) -> str:
        deep = np.where(self.depth > depth, self.area, 0.0)
        place = self._most(deep)
        return (
            f"{_percent(share)} of the cover lies more than {1e3 * depth:.0f} mm deep in the foam "
            f"(at most {_percent(limit)}), most of it in panel {place}, down to "
            f"{1e3 * self.depth.max():.0f} mm"
        )

    def _most(self, amount: FloatArray) -> str:
        """Panel with the most of an amount (m,)."""
        sums = np.bincount(self.cover.panel, weights=amount, minlength=len(self.cover.panel_names))
        return self.cover.panel_names[int(np.argmax(sums))]

    def _panel(self, face: int) -> str:
        return self.cover.panel_names[int(self.cover.panel[face])]

    def _share(self, faces: FloatArray) -> float:
        return float((self.area * faces).sum() / self.area.sum())


def buried(depth: float) -> str:
    """Name of the figure of the share that lies deeper than ``depth`` [m]."""
    return f"buried_{1e3 * depth:.0f}mm"


def coverage(cover: Cover, x: FloatArray, foundation: Foundation) -> Coverage:
    """Measure where a cover at positions ``x`` (n, 3) [m] is; contact as at the last update."""
    places, areas = _surface(foundation.foam)
    touching = (foundation.contact.force > 0.0).astype(float)
    distance, _ = foundation.contact.field.at(x)
    far = ~np.isfinite(distance)
    if far.any():
        distance[far] = KDTree(places).query(x[far])[0]
    depth = 0.5 * cover.thickness - distance[cover.faces].mean(axis=1)
    bare, height = _bare(cover, x, places, areas)
    return Coverage(cover, cover.rest_area, depth, touching[cover.faces].mean(axis=1), bare, height)


def _bare(
    cover: Cover, x: FloatArray, places: FloatArray, areas: FloatArray
) -> tuple[FloatArray, float]:
    """Foam [m2] above each face's visible side by more than ``BARE_HEIGHT``, its height [m].

    Foam beyond a free edge is nobody's to cover: there the nearest face is one at that edge.
    """
    middle = x[cover.faces].mean(axis=1)
    nearest = np.asarray(KDTree(middle).query(places)[1])
    normal = face_normals(x, cover.faces)
    height = np.einsum("ij,ij->i", places - middle[nearest], normal[nearest])
    above = (height > BARE_HEIGHT) & _inner(cover)[nearest]
    bare = np.bincount(nearest[above], weights=areas[above], minlength=len(cover.faces))
    return bare.astype(float), float(height[above].max(initial=0.0))


def _inner(cover: Cover) -> npt.NDArray[np.bool_]:
    """Faces (m,) without a vertex at a border of a panel that no seam holds."""
    free = np.zeros(len(cover.rest), dtype=bool)
    face, first = np.divmod(boundary_sides(cover.faces), 3)
    for corner in (first, (first + 1) % 3):
        free[cover.faces[face, corner]] = True
    for seam in cover.stitchings:
        for side in (seam.a, seam.b):
            free[side.vertices[side.weights > 0.0]] = False
    return np.asarray(~free[cover.faces].any(axis=1))


def _surface(foam: Foam) -> tuple[FloatArray, FloatArray]:
    """Points (k, 3) [m] all over the foam and the area [m2] each stands for."""
    places, face = spread(foam.vertices, foam.faces, _SPACING)
    area = face_areas(foam.vertices, foam.faces) / np.bincount(face, minlength=len(foam.faces))
    return places, area[face]


def _percent(share: float) -> str:
    return f"{100 * share:.3g} %"
