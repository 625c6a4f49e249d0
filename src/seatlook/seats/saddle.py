"""A motorcycle saddle: the seat in one piece, and a skirt."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from seatlook.model import FloatArray
from seatlook.seats.drawing import Drawing
from seatlook.seats.pad import QUARTER, Pad


@dataclass(frozen=True, slots=True, kw_only=True)
class Saddle(Pad):
    """A long pad, narrow at the tank, that dips under the rider and rises behind.

    Parameters
    ----------
    nose : width at the front, as a share of that at the rear
    rise, tank : rise behind the rider, and towards the tank
    crown_x : fall of the level at the outline's sides
    """

    nose: float
    rise: float
    tank: float
    crown_x: float

    @classmethod
    def sized(cls, scale: float) -> Self:
        """Return the saddle ``scale`` times as large."""
        return cls(
            width=0.30 * scale,
            depth=0.66 * scale,
            corner_radius=0.090 * scale,
            front_bow=0.0,
            height=0.125 * scale,
            roll=0.055 * scale,
            roll_front=0.055 * scale,
            roll_angle=np.deg2rad(80.0),
            seam_angle=np.deg2rad(50.0),
            slot=0.0,
            frame_height=0.020 * scale,
            nose=0.62,
            rise=0.035 * scale,
            tank=0.012 * scale,
            crown_x=0.018 * scale,
        )

    def top(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Height of the top over the plan, before the edge roll takes it down."""
        return np.asarray(self.height - self.crown_x * (x / self.half[0]) ** 2 + 0 * y)

    def position(self, p: FloatArray) -> FloatArray:
        """Map plane points p (k, 2) onto the surface, (k, 3): a pad made narrow, then bent."""
        x, y, z = Pad.position(self, p).T
        u = y / self.half[1]
        wide = self.nose + (1 - self.nose) * _step((u + 1.0) / 1.3)
        along = self.rise * _step((u + 0.35) / 1.1) + self.tank * _step((-0.2 - u) / 0.9)
        return np.column_stack([x * wide, y, z * (1 + along / self.height)])

    def drawing(self) -> Drawing:
        """Draw the seam between seat and skirt, and the skirt's closing seam at the rear."""
        rear, front = QUARTER + QUARTER // 2, 3 * QUARTER + QUARTER // 2
        walls = self.walled({"closing": (rear, "SKIRT"), "front": (front, "SKIRT")})
        return replace(
            walls,
            panels={"SEAT": np.zeros((1, 2)), **walls.panels},
            cuts={"edge": "seam", "closing": "closing"},
        )


def _step(share: FloatArray) -> FloatArray:
    """Rise smoothly from 0 at 0 to 1 at 1."""
    t = np.clip(share, 0, 1)
    return np.asarray(t * t * (3 - 2 * t))
