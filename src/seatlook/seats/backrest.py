"""A backrest that stands: two wings, and a lumbar seam that is tied down along a curve."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from seatlook.model import FloatArray
from seatlook.seats.drawing import Drawing
from seatlook.seats.pad import Pad, fading, quarters, swell

_WALLS = quarters("SIDE_L", "TOP", "SIDE_R", "BOTTOM")


@dataclass(frozen=True, slots=True, kw_only=True)
class Backrest(Pad):
    """A pad that is set upright: its plan is the view from the front, its base the back.

    The wings rise beside a waisted insert. The seams along them are tied down, and so is one
    across the insert, which sags like a smile between upper back and lumbar.

    Parameters
    ----------
    bolster : how far the wings stand over the middle of the insert
    bolster_width : from a wing's seam to where the wing reaches its level
    pillow : rise of the insert's middle over the tie-downs
    waist, spread : half width of the insert in the middle; how much wider it is at the ends
    tied, sag : height of the curved tie-down's ends, and how far its middle hangs below
    shoulder : reach of the insert's rise beside a tie-down
    fade, fade_tail : wings and tie-downs end at this distance from the middle
    crown_x, crown_y : fall of the level at the outline's sides and ends
    recline : angle to the upright
    """

    bolster: float
    bolster_width: float
    pillow: float
    waist: float
    spread: float
    tied: float
    sag: float
    shoulder: float
    fade: float
    fade_tail: float
    crown_x: float
    crown_y: float
    recline: float

    @classmethod
    def sized(cls, scale: float, bolster: float) -> Self:
        """Return the backrest ``scale`` times as large; a higher wing [m] is wider, too."""
        roll, bolster_width = 0.045 * scale, 0.060 * scale + 0.35 * bolster
        return cls(
            width=2 * (0.140 * scale + bolster_width + roll),
            depth=0.62 * scale,
            corner_radius=0.095 * scale,
            front_bow=0.0,
            height=0.095 * scale,
            roll=roll,
            roll_front=roll,
            roll_angle=np.deg2rad(92.0),
            seam_angle=np.deg2rad(48.0),
            slot=0.003,
            frame_height=0.020 * scale,
            bolster=bolster,
            bolster_width=bolster_width,
            pillow=0.018 * scale,
            waist=0.125 * scale,
            spread=0.025 * scale,
            tied=-0.035 * scale,
            sag=0.045 * scale,
            shoulder=0.070 * scale,
            fade=0.298 * scale,
            fade_tail=0.015 * scale,
            crown_x=0.008 * scale,
            crown_y=0.020 * scale,
            recline=np.deg2rad(18.0),
        )

    def seam_x(self, y: FloatArray) -> FloatArray:
        """Distance of the wings' seams from the middle plane."""
        return np.asarray(self.waist + self.spread * (y / self.half[1]) ** 2)

    def seam_y(self, x: FloatArray) -> FloatArray:
        """Height of the tie-down across the insert."""
        return np.asarray(self.tied - self.sag * (1 - (x / self.waist) ** 2))

    def top(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Height of the front over the back, before the edge roll takes it down."""
        a, b = self.half
        level = self.height - self.crown_x * (x / a) ** 2 - self.crown_y * (y / b) ** 2
        away = np.abs(x) - self.seam_x(y)
        insert = swell(-away / self.shoulder) * swell(np.abs(y - self.seam_y(x)) / self.shoulder)
        wing = (self.pillow + self.bolster) * swell(away / self.bolster_width)
        return np.asarray(level + np.where(away < 0, self.pillow * insert, wing) * self._share(y))

    def _share(self, y: FloatArray) -> FloatArray:
        """Share of wings and tie-downs that is left towards top and bottom."""
        return fading(np.abs(y), self.fade, self.fade_tail)

    def room(self, p: FloatArray) -> FloatArray:
        """Extra depth (k,) [m] of the foam below a tie-down at plane points (k, 2)."""
        return self.slot * self._share(p[:, 1])

    def position(self, p: FloatArray) -> FloatArray:
        """Map plane points p (k, 2) onto the surface, (k, 3), set upright and leant back."""
        x, y, z = Pad.position(self, p).T
        c, s = np.cos(self.recline), np.sin(self.recline)
        y = y + self.half[1]
        return np.column_stack([x, s * y - c * z, c * y + s * z])

    def drawing(self) -> Drawing:
        """Draw the wings' seams, the tie-down across, walls."""
        walls = self.walled(_WALLS)
        y = np.linspace(-self.half[1], self.half[1], 401)
        left = self.on_top(np.column_stack([self.seam_x(y), y]))
        end = left[np.abs(left[:, 1] - self.tied).argmin()]
        x = np.linspace(end[0], -end[0], 201)
        lines = {
            "wing left": left,
            "wing right": left * [-1, 1],
            "lumbar": np.column_stack([x, self.seam_y(x)]),
        }
        wing, b = self.waist + self.bolster_width / 2, self.half[1]
        panels = {
            "INSERT_LOWER": [[0.0, (self.tied - self.sag - b / 2) / 2 - b / 8]],
            "INSERT_UPPER": [[0.0, b / 4]],
            "WING_L": [[wing, 0.0]],
            "WING_R": [[-wing, 0.0]],
        }
        return replace(
            walls,
            lines={**walls.lines, **lines},
            panels={**{k: np.array(v) for k, v in panels.items()}, **walls.panels},
            wires={
                "wing_left": ("wing left",),
                "wing_right": ("wing right",),
                "lumbar": ("lumbar",),
            },
        )
