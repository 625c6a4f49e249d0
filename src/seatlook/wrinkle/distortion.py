"""How a texture drawn on the pattern is distorted on the finished cover."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from seatlook.mesh.kinematics import deformation_gradient
from seatlook.mesh.statistics import quantile
from seatlook.model import FloatArray, Solution


@dataclass(frozen=True, slots=True, kw_only=True)
class Distortion:
    """Texture distortion per face, from pattern to finished shape.

    Parameters
    ----------
    stretch_along, stretch_across : (m,) [1]   length along warp and weft over that of the pattern,
        minus 1
    shear : (m,) [rad]       how far the angle between warp and weft is below a right angle
    grain_drift : (m,) [rad] angle, counter-clockwise seen from outside, from the panel's mean warp
        direction to the warp here; nan where the mean direction stands on the surface
    """

    stretch_along: FloatArray
    stretch_across: FloatArray
    shear: FloatArray
    grain_drift: FloatArray


# name -> field; each becomes a map and three figures per zone
DISTORTIONS: dict[str, Callable[[Distortion], FloatArray]] = {
    "stretch_along": lambda d: d.stretch_along,
    "stretch_across": lambda d: d.stretch_across,
    "shear_deg": lambda d: np.degrees(d.shear),
    "grain_drift_deg": lambda d: np.degrees(d.grain_drift),
}

_STANDING = 0.2  # shortest projection of the mean direction that still is a direction


@dataclass(frozen=True, slots=True, kw_only=True)
class DistortionRow:
    """One measure in one zone: mean, and the 5th and 95th percentile, weighted by rest area."""

    zone: str
    measure: str
    mean: float
    p05: float
    p95: float


def distortion(solution: Solution) -> Distortion:
    """Measure stretch, shear and drift of the grain on every face."""
    cover = solution.cover
    F = deformation_gradient(cover.rest, solution.positions, cover.faces)
    warp, weft = F[:, :, 0], F[:, :, 1]
    along, across = np.linalg.norm(warp, axis=1), np.linalg.norm(weft, axis=1)
    cosine = np.einsum("md,md->m", warp, weft) / (along * across)
    normal = np.cross(warp, weft)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    return Distortion(
        stretch_along=along - 1.0,
        stretch_across=across - 1.0,
        shear=np.arcsin(np.clip(cosine, -1.0, 1.0)),
        grain_drift=_drift(solution, warp / along[:, None], normal),
    )


def _drift(solution: Solution, warp: FloatArray, normal: FloatArray) -> FloatArray:
    """Angle from the panel's mean warp direction, laid onto each face, to its warp."""
    cover = solution.cover
    panels = len(cover.panel_names)
    weighted = warp * cover.rest_area[:, None]
    total = np.stack([np.bincount(cover.panel, c, panels) for c in weighted.T], axis=1)
    size = np.maximum(np.linalg.norm(total, axis=1, keepdims=True), 1e-300)
    here = (total / size)[cover.panel]
    flat = here - np.einsum("md,md->m", here, normal)[:, None] * normal
    turn = np.einsum("md,md->m", np.cross(flat, warp), normal)
    angle = np.arctan2(turn, np.einsum("md,md->m", flat, warp))
    return np.where(np.linalg.norm(flat, axis=1) > _STANDING, angle, np.nan)


def distortion_table(solution: Solution, fields: Distortion) -> tuple[DistortionRow, ...]:
    """Summarise each measure zone by zone; faces without a grain direction are left out."""
    cover = solution.cover
    area = cover.rest_area
    rows = []
    for i, zone in enumerate(cover.zone_names):
        for name, field in DISTORTIONS.items():
            values = field(fields)
            inside = (cover.zone == i) & np.isfinite(values)
            if not inside.any():
                continue
            v, w = values[inside], area[inside]
            rows.append(
                DistortionRow(
                    zone=zone,
                    measure=name,
                    mean=float(v @ w / w.sum()),
                    p05=quantile(v, w, 0.05),
                    p95=quantile(v, w, 0.95),
                )
            )
    return tuple(rows)
