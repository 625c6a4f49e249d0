"""What lies below a seam: the allowance lifts the cloth beside it, by how the seam is sewn."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from seatlook.mesh.closest import nearest_segments
from seatlook.model import Cover, FloatArray, IntArray, SeamKind, Stitching
from seatlook.pbr.shading.seam import SewnEdges

# Distances [m] from the seam: where one layer of allowance is reached, where it ends, where nothing
# is left of it. Cut 10 mm wide and skived at its edge, by judgement.
_UP, _FLAT, _END = 0.003, 0.0065, 0.0105
# Of a panel that lies over the other: its edge is at the seam.
_LAP_FLAT, _LAP_END = 0.008, 0.012
# Share of a cloth's thickness that its allowance lifts the cloth above it, pressed as it is, with
# bounds [m]; and that two layers lift it, of one.
_LIFT, _LEAST, _MOST, _TWO = 0.8, 0.001, 0.0012, 1.2
# Share of the points of a hook that lie on a seam, from which it is pulled into a trench.
_HOOKED = 0.5
_NEAR = 1e-5  # [m]


@dataclass(frozen=True, slots=True)
class Sides:
    """Both sides of all seams, (2 k,): side a of the first, side b, side a of the second, ...

    ``rows`` of stitches; ``layers`` of allowance; ``lapped``: whether it lies over the other side.
    """

    rows: FloatArray
    layers: FloatArray
    lapped: np.ndarray


def sides_of(cover: Cover) -> Sides:
    """How both sides of all seams of a cover are sewn."""
    rows, layers, lapped = [], [], []
    for stitching in cover.stitchings:
        given = cover.seam_kinds.get(stitching.name)
        if given is None and _is_hooked(cover, stitching):
            rows += [0, 0]
            layers += [0, 0]
            lapped += [False, False]
            continue
        own, other = _STITCHES[(given or SeamKind()).kind]
        first = own, other
        sides = first if given is None or given.side == "a" else first[::-1]
        for side in sides:
            rows.append(side[0])
            layers.append(side[1])
            lapped.append(side[2])
    return Sides(np.array(rows, float), np.array(layers, float), np.array(lapped, bool))


# Kind -> rows, layers, whether it lies over: of the side that is stitched down, and of the other.
_STITCHES = {
    "plain": ((0, 1, False), (0, 1, False)),
    "French": ((1, 1, False), (1, 1, False)),
    "top stitch 1": ((1, 2, False), (0, 0, False)),
    "top stitch 2": ((2, 2, False), (0, 0, False)),
    "lapped": ((1, 1, True), (0, 0, False)),
}


def _is_hooked(cover: Cover, stitching: Stitching) -> bool:
    """Whether a hook pulls a seam."""
    both = np.concatenate([stitching.a.vertices.ravel(), stitching.b.vertices.ravel()])
    for anchor in cover.anchors:
        points = anchor.points.vertices[anchor.points.weights > 0]
        if anchor.kind == "hook" and len(points) and np.isin(points, both).mean() >= _HOOKED:
            return True
    return False


def heights(
    cover: Cover, uv: FloatArray, panel_of: IntArray, distance: FloatArray, edges: SewnEdges
) -> FloatArray:
    """How far (n,) [m] the allowances lift the vertices of the drawn panels.

    Between two seams that are sewn in other ways one goes over into the other by distance. Of a
    cover with a hem the solver has lifted it.

    Parameters
    ----------
    uv : (n, 2) [m]; panel_of : (n,); distance : (n,) [m] from the nearest seam, infinite far away
    """
    out = np.zeros(len(uv))
    if cover.hem is not None:
        return out
    sides = sides_of(cover)
    for panel in np.unique(edges.panel):
        own = edges.panel == panel
        thickness = cover.materials[panel].fabric.thickness
        lift = float(np.clip(_LIFT * thickness, _LEAST, _MOST))
        v = np.flatnonzero((panel_of == panel) & np.isfinite(distance))
        total, weights = np.zeros(len(v)), np.zeros(len(v))
        for side in np.unique(edges.side[own]):
            part = own & (edges.side == side)
            _, _, away = nearest_segments(uv[v], uv[edges.start[part]], uv[edges.end[part]])
            weight = 1.0 / (away + _NEAR) ** 4
            layers = sides.layers[side]
            height = lift * (_TWO if layers > 1 else layers)
            total += weight * height * profile(away, lapped=bool(sides.lapped[side]))
            weights += weight
        out[v] = total / np.maximum(weights, 1e-300)
    return out


def profile(distance: FloatArray, *, lapped: bool = False) -> FloatArray:
    """Share of its height that an allowance has at a distance [m] from the seam.

    Examples
    --------
    >>> profile(np.array([0.0, 0.003, 0.006, 0.0105])).tolist()
    [0.0, 1.0, 1.0, 0.0]
    """
    if lapped:
        return 1.0 - _step((distance - _LAP_FLAT) / (_LAP_END - _LAP_FLAT))
    return _step(distance / _UP) * (1.0 - _step((distance - _FLAT) / (_END - _FLAT)))


def _step(t: FloatArray) -> FloatArray:
    t = np.clip(t, 0.0, 1.0)
    return np.asarray(t * t * (3.0 - 2.0 * t))
