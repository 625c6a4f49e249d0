"""The demo cushion's shape: a crowned insert between two bolsters."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from seatlook.model import FloatArray
from seatlook.seats.drawing import Drawing
from seatlook.seats.pad import Pad, fading, quarters

_WALLS = quarters("SIDE_L", "REAR", "SIDE_R", "FRONT")


@dataclass(frozen=True, slots=True, kw_only=True)
class Cushion(Pad):
    """A car-seat cushion: crowned insert, two bolsters, waterfall front, walls that tuck under.

    Parameters
    ----------
    tilt : rise of the level towards the front per length
    crown_x, crown_y : fall of the bolsters' level at the outline's sides and ends
    trench, trench_taper : half width of the insert at y = 0; widening per length to the front
    trench_depth : from the bolsters' level to the tie-down trench, deepest at y = 0
    bolster_width : from the trench to where the bolster reaches its level
    pillow : rise of the insert's middle above the trenches
    fade, fade_tail : trench and insert come up to the bolsters' level at this distance from the
        middle, along a parabola and over the tail softly, so that no crease is left where front
        and rear panels are sewn on. With ``crown_y`` the insert stays convex along the seat too:
        a cover under tension would lift off a dish
    """

    width: float = 0.50
    depth: float = 0.55
    corner_radius: float = 0.075
    front_bow: float = 0.012
    height: float = 0.125
    tilt: float = 0.04
    crown_x: float = 0.006
    crown_y: float = 0.026
    trench: float = 0.135
    trench_taper: float = 0.03
    trench_depth: float = 0.034
    bolster_width: float = 0.070
    pillow: float = 0.021
    fade: float = 0.263
    fade_tail: float = 0.015
    roll: float = 0.046
    roll_front: float = 0.060
    roll_angle: float = np.deg2rad(90.0)
    seam_angle: float = np.deg2rad(48.0)
    slot: float = 0.003
    frame_height: float = 0.025

    @classmethod
    def sized(cls, scale: float, bolster: float) -> Self:
        """Return the cushion ``scale`` times as large, bolsters [m] over the insert's middle.

        A higher bolster is wider and falls more towards its ends; at 1 and 13 mm it is the demo's.
        """
        more = bolster - 0.013
        return cls(
            width=0.50 * scale + 0.50 * more,
            depth=0.55 * scale,
            corner_radius=0.075 * scale,
            front_bow=0.012 * scale,
            height=0.112 * scale + bolster,
            crown_x=0.006 * scale,
            crown_y=0.026 * scale + 1.16 * more,
            trench=0.135 * scale - 0.10 * more,
            trench_depth=0.021 * scale + bolster,
            bolster_width=0.070 * scale + 0.35 * more,
            pillow=0.021 * scale,
            fade=0.263 * scale,
            fade_tail=0.015 * scale,
            roll=0.046 * scale,
            roll_front=0.060 * scale,
            frame_height=0.025 * scale,
        )

    def drawing(self) -> Drawing:
        """Draw the trenches and walls."""
        walls = self.walled(_WALLS)
        y = np.linspace(-self.half[1], self.half[1], 401)
        trench = self.on_top(np.column_stack([self.trench_x(y), y]))
        side = self.trench + self.bolster_width / 2
        panels = {"INSERT": [0.0, 0.0], "BOLSTER_L": [side, 0.0], "BOLSTER_R": [-side, 0.0]}
        return replace(
            walls,
            lines={**walls.lines, "trench left": trench, "trench right": trench * [-1, 1]},
            panels={**{k: np.array([v]) for k, v in panels.items()}, **walls.panels},
            wires={"trench_left": ("trench left",), "trench_right": ("trench right",)},
        )

    def room(self, p: FloatArray) -> FloatArray:
        """Extra depth (k,) [m] of the foam below a trench at plane points (k, 2)."""
        return np.asarray(self.slot * self.depth_share(p[:, 1]))

    def trench_x(self, y: FloatArray) -> FloatArray:
        """Distance of the trenches from the middle plane at ``y``."""
        return np.asarray(self.trench - self.trench_taper * y)

    def top(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Height of the top over the plan, before the edge roll takes it down."""
        a, b = self.half
        level = self.height - self.tilt * y - self.crown_x * (x / a) ** 2
        level = level - self.crown_y * (y / b) ** 2
        trench = self.trench_x(y)
        out = np.clip(1 - (np.abs(x) - trench) / self.bolster_width, 0, 1)
        u = np.clip(np.abs(x) / trench, 0, 1)
        # Sixth power: round shoulders, so the insert swells like a pillow between its seams.
        inner = self.trench_depth - self.pillow * (1 - 0.35 * u**2 - 0.65 * u**6)
        carved = np.where(np.abs(x) < trench, inner, self.trench_depth * out**2)
        return np.asarray(level - carved * self.depth_share(y))

    def depth_share(self, y: FloatArray) -> FloatArray:
        """Share of the trench's depth that is left at ``y``: two parabolas with one tangent."""
        return fading(np.abs(y), self.fade, self.fade_tail)
