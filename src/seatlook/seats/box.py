"""A box cushion: a crowned top with a piped edge, and a boxing strip all round."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from seatlook.model import FloatArray
from seatlook.seats.drawing import Drawing
from seatlook.seats.pad import QUARTER, Pad


@dataclass(frozen=True, slots=True, kw_only=True)
class BoxCushion(Pad):
    """A square cushion with narrow edges; the piping runs along the middle of the edge.

    The boxing strip is one piece, a ring that is closed by one seam.

    Parameters
    ----------
    crown : fall of the level at the outline's sides and ends
    """

    crown: float

    @classmethod
    def sized(cls, scale: float) -> Self:
        """Return the cushion ``scale`` times as large."""
        return cls(
            width=0.52 * scale,
            depth=0.50 * scale,
            corner_radius=0.055 * scale,
            front_bow=0.0,
            height=0.130 * scale,
            roll=0.018 * scale,
            roll_front=0.018 * scale,
            roll_angle=np.deg2rad(90.0),
            seam_angle=np.deg2rad(45.0),
            slot=0.0,
            frame_height=0.015 * scale,
            crown=0.018 * scale,
        )

    def top(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Height of the top over the plan, before the edge roll takes it down."""
        a, b = self.half
        return np.asarray(self.height - self.crown * ((x / a) ** 2 + (y / b) ** 2))

    def drawing(self) -> Drawing:
        """Draw the piping, and the boxing strip's closing seam in the middle of the rear."""
        rear, front = QUARTER + QUARTER // 2, 3 * QUARTER + QUARTER // 2
        walls = self.walled({"closing": (rear, "BOXING"), "front": (front, "BOXING")})
        return replace(
            walls,
            panels={"TOP": np.zeros((1, 2)), **walls.panels},
            cuts={"piping": "seam", "closing": "closing"},
        )
