"""Where a flat panel is strained more than its fabric takes, and where a dart would go."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp
from scipy.sparse.csgraph import dijkstra

from seatlook import mesh
from seatlook.flattening.fabric_sheet import strains_by_grain
from seatlook.flattening.face_map import stretches
from seatlook.flattening.surface import Patch, millimetres
from seatlook.model import Curve, Fabric, FloatArray, IntArray

# 17 N on a strip of 50 mm: what the laminate of a car seat cover takes at 5 %
# (materials/leather-laminate.toml, measured), and about what a fitter pulls with two fingers.
LIMIT_TENSION = 340.0  # [N/m]
LIMIT_STRAIN = 0.05  # where no fabric is given
_SMALLEST_AREA = 1e-4  # [m2]; a smaller place is a matter of the mesh
_LARGEST_GREEN = 0.5


@dataclass(frozen=True, slots=True, kw_only=True)
class Excess:
    """A panel strained more than its fabric takes.

    Parameters
    ----------
    strain : float             the largest there is over its limit: above 0 the form stretches the
                               panel, below 0 there is too much of it
    limit : float              of this strain
    area : float [m2]          of all that is over its limit
    place : (3,) [m]           on the form
    dart : (k, 3) [m]          from the border into the panel: along it a dart would help most
    """

    panel: str
    strain: float
    limit: float
    area: float
    place: FloatArray
    dart: FloatArray

    def __str__(self) -> str:
        amount = f"{100 * abs(self.strain):.1f} %"
        what = f"is stretched by {amount}" if self.strain > 0 else f"has {amount} too much cloth"
        mouth, tip = (millimetres(point) for point in (self.dart[0], self.dart[-1]))
        return (
            f"panel {self.panel} {what} near {millimetres(self.place)} mm, and is over "
            f"{100 * self.limit:.1f} % on {1e4 * self.area:.0f} cm2: cut it, or sew a dart from "
            f"{mouth} to {tip} mm"
        )


def excess_of(
    patch: Patch, flat: FloatArray, fabric: Fabric | None = None, *, allowed: float = 0.0
) -> Excess | None:
    """Return where a flat panel (n, 2) is strained too much, or None.

    Of a fabric the stretch along warp and weft counts, up to where its curve reaches
    ``LIMIT_TENSION``; without one both principal strains, up to ``LIMIT_STRAIN``. Too much cloth
    counts as a stretch does. ``allowed`` is added to the limits, for an ease that is wanted.
    """
    if fabric is None:
        strain = stretches(patch.vertices, patch.faces, flat) - 1
        limit = np.array([LIMIT_STRAIN, LIMIT_STRAIN]) + allowed
    else:
        green = strains_by_grain(patch.vertices, patch.faces, flat)[:, :2]
        strain = np.sqrt(1 + 2 * green) - 1
        limit = np.array([_limit(fabric.warp), _limit(fabric.weft)]) + allowed
    share = np.abs(strain) / limit
    over = np.asarray((share > 1).any(axis=1))
    area = float(mesh.face_areas(patch.vertices, patch.faces)[over].sum())
    if area < _SMALLEST_AREA:
        return None
    face, axis = divmod(int(share.argmax()), 2)
    return Excess(
        panel=patch.name,
        strain=float(strain[face, axis]),
        limit=float(limit[axis]),
        area=area,
        place=patch.vertices[patch.faces[face]].mean(axis=0),
        dart=patch.vertices[_dart(patch, face, over)],
    )


def _limit(curve: Curve) -> float:
    """Return the stretch at which a fabric's curve reaches the tension that it is to take."""
    green = np.linspace(0.0, _LARGEST_GREEN, 5001)
    at = min(int(np.searchsorted(curve.tension(green), LIMIT_TENSION)), len(green) - 1)
    return float(np.sqrt(1 + 2 * green[at]) - 1)


def _dart(patch: Patch, worst: int, over: npt.NDArray[np.bool_]) -> IntArray:
    """Return vertices from the border to the worst face along edges, the shortest way.

    Where the worst face is at the border, the dart begins there and leads to the middle of the
    panel, as far as faces are over their limit.
    """
    depth, back = _roads_from(patch, patch.boundary)
    corners = patch.faces[worst]
    start = int(corners[depth[corners].argmax()])
    if not np.isin(corners, patch.boundary).any():
        return _way(back, start)[::-1]
    mouth = int(corners[depth[corners].argmin()])
    _, ahead = _roads_from(patch, np.array([depth.argmax()]))
    way = _way(ahead, mouth)
    strained = np.isin(way, patch.faces[over])
    return way[: max(2, len(way) if strained.all() else int(np.argmin(strained)))]


def _roads_from(patch: Patch, sources: IntArray) -> tuple[FloatArray, IntArray]:
    """Return each vertex's way [m] to the nearest source along edges, and the next one on it."""
    pairs = mesh.edges(patch.faces)
    length = np.linalg.norm(patch.vertices[pairs[:, 0]] - patch.vertices[pairs[:, 1]], axis=1)
    n = len(patch.vertices)
    roads = sp.csr_array((length, (pairs[:, 0], pairs[:, 1])), shape=(n, n))
    distance, ahead, _ = dijkstra(roads, False, sources, return_predecessors=True, min_only=True)
    return distance, np.asarray(ahead, dtype=np.int64)


def _way(back: IntArray, start: int) -> IntArray:
    """Return the vertices from ``start`` back to the source of a shortest-path tree."""
    way = [start]
    while back[way[-1]] >= 0:
        way.append(int(back[way[-1]]))
    return np.array(way, dtype=np.int64)
