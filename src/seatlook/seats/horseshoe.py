"""A cushion in a horseshoe: one bolster round sides and rear, two tie-downs, T-junctions."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from seatlook.model import FloatArray
from seatlook.seats.drawing import Drawing
from seatlook.seats.pad import QUARTER, Pad, fading, quarters, swell

_WALLS = quarters("SIDE_L", "REAR", "SIDE_R", "FRONT")
_SHIFT = 70  # thousandths of a quarter's outline from a corner to a bolster's joint


@dataclass(frozen=True, slots=True, kw_only=True)
class Horseshoe(Pad):
    """A cushion whose bolster runs along one side, round the rear and along the other side.

    The insert is three panels. The horseshoe between insert and bolster is tied down under all
    of them, and so is the seam between the middle and the rear panel; that between the front and
    the middle panel lies flush.

    Parameters
    ----------
    bolster : how far the bolster stands over the middle of the insert
    bolster_width : from the horseshoe to where the bolster reaches its level
    pillow : rise of the insert's middle over the tie-downs
    bend : radius of the horseshoe's corners
    tied, flush : where the two seams across the insert lie
    fade, fade_tail : bolster and tie-downs end at this distance before the middle
    crown_x, crown_y : fall of the level at the outline's sides and ends
    """

    bolster: float
    bolster_width: float
    pillow: float
    bend: float
    tied: float
    flush: float
    fade: float
    fade_tail: float
    crown_x: float
    crown_y: float

    @classmethod
    def sized(cls, scale: float, bolster: float) -> Self:
        """Return the cushion ``scale`` times as large; a higher bolster [m] is wider, too."""
        roll, bolster_width = 0.046 * scale, 0.055 * scale + 0.35 * bolster
        depth = 0.46 * scale + bolster_width + roll
        return cls(
            width=2 * (0.135 * scale + bolster_width + roll),
            depth=depth,
            corner_radius=0.085 * scale + 0.3 * bolster,
            front_bow=0.012 * scale,
            height=0.105 * scale,
            roll=roll,
            roll_front=0.056 * scale,
            roll_angle=np.deg2rad(90.0),
            seam_angle=np.deg2rad(48.0),
            slot=0.003,
            frame_height=0.025 * scale,
            bolster=bolster,
            bolster_width=bolster_width,
            pillow=0.020 * scale,
            bend=0.065 * scale,
            tied=0.015 * scale,
            flush=-0.110 * scale,
            fade=depth / 2 - 0.012 * scale,
            fade_tail=0.015 * scale,
            crown_x=0.008 * scale,
            crown_y=0.016 * scale,
        )

    @property
    def arch(self) -> FloatArray:
        """Half width of the horseshoe, and where its rear lies, (2,)."""
        return self.half - self.roll - self.bolster_width

    def outside(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Distance from the horseshoe, negative within it."""
        to = np.stack([np.abs(x), y]) - (self.arch - self.bend).reshape(2, *[1] * np.ndim(x))
        beyond = np.hypot(*np.maximum(to, 0))
        return np.asarray(beyond + np.minimum(to.max(axis=0), 0) - self.bend)

    def top(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Height of the top over the plan, before the edge roll takes it down."""
        a, b = self.half
        level = self.height - self.crown_x * (x / a) ** 2 - self.crown_y * (y / b) ** 2
        away = self.outside(x, y)
        insert = self.pillow * swell(-away / self.bend) * swell(np.abs(y - self.tied) / self.bend)
        bolster = (self.pillow + self.bolster) * swell(away / self.bolster_width)
        return np.asarray(level + np.where(away < 0, insert, bolster) * self._share(y))

    def _share(self, y: FloatArray) -> FloatArray:
        """Share of bolster and tie-downs that is left towards the front."""
        return fading(np.maximum(-y, 0), self.fade, self.fade_tail)

    def room(self, p: FloatArray) -> FloatArray:
        """Extra depth (k,) [m] of the foam below a tie-down at plane points (k, 2)."""
        return self.slot * self._share(p[:, 1])

    def drawing(self) -> Drawing:
        """Draw the horseshoe, two seams across the insert, two joints of the bolster, walls."""
        walls = self.walled(_WALLS)
        (w, rear), bend = self.arch, self.bend
        turn = np.linspace(0, np.pi / 2, 101)
        corner = np.array([w, rear]) - bend + bend * np.column_stack([np.cos(turn), np.sin(turn)])
        left = np.concatenate([[[w, -self.half[1]]], corner])
        seam = walls.lines["seam"]
        joint = np.array([corner[50], seam[QUARTER - _SHIFT]])
        across = np.array([[w, 0.0], [-w, 0.0]])
        lines = {
            "horseshoe": self.on_top(np.concatenate([left, left[::-1] * [-1, 1]])),
            "tied": across + np.array([0.0, self.tied]),
            "flush": across + np.array([0.0, self.flush]),
            "joint left": joint,
            "joint right": joint * [-1, 1],
        }
        side = w + self.bolster_width / 2
        panels = {
            "INSERT_FRONT": [[0.0, self.flush - bend / 4]],
            "INSERT_MIDDLE": [[0.0, (self.flush + self.tied) / 2]],
            "INSERT_REAR": [[0.0, self.tied + bend / 4]],
            "BOLSTER_L": [[side, 0.0]],
            "BOLSTER_R": [[-side, 0.0]],
            "BOLSTER_REAR": [[0.0, rear + self.bolster_width / 2]],
        }
        return replace(
            walls,
            lines={**walls.lines, **lines},
            panels={**{k: np.array(v) for k, v in panels.items()}, **walls.panels},
            wires={"horseshoe": ("horseshoe",), "cross": ("tied",)},
        )
