"""A headrest that stands: a rounded block, covered but for an opening below."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np

from seatlook.model import FloatArray
from seatlook.seats.drawing import Drawing

_TURN = np.linspace(0.0, 2 * np.pi, 2001)


@dataclass(frozen=True, slots=True, kw_only=True)
class Headrest:
    """A superellipsoid ``|x/a|^p + |y/b|^p + |z/c|^p = 1``, cut off below.

    The plane point's distance from the origin is the angle down from the top, times ``c``.
    Front and rear panel are sewn to one strip that runs up one side, over the top and down the
    other; these seams lie where the front and the rear are at equal shares of the depth.

    Parameters
    ----------
    half : half of width, depth and height [m], (3,)
    power : p; 2 is an ellipsoid, larger ones are boxes with round edges
    seam, taper : share of the half depth at which the seams lie; by how much less below
    frame, base : shares of the half height below the middle where the cover and the foam end
    """

    half: tuple[float, float, float]
    power: float
    seam: float
    taper: float
    frame: float
    base: float

    @classmethod
    def sized(cls, scale: float) -> Self:
        """Return the headrest ``scale`` times as large."""
        return cls(
            half=(0.140 * scale, 0.065 * scale, 0.0917 * scale),
            power=3.5,
            seam=0.60,
            taper=0.3,
            frame=0.80,
            base=0.92,
        )

    def position(self, p: FloatArray) -> FloatArray:
        """Map plane points p (k, 2) onto the surface, (k, 3), the foam's base at z = 0."""
        angle = np.linalg.norm(p, axis=1) / self.half[2]
        safe = np.maximum(np.linalg.norm(p, axis=1), np.finfo(float).tiny)
        out = np.sin(angle)[:, None] * p / safe[:, None]
        way = np.column_stack([out, np.cos(angle)])
        size = (np.abs(way) ** self.power).sum(axis=1) ** (-1 / self.power)
        return np.asarray((size[:, None] * way + [0.0, 0.0, self.base]) * self.half)

    def _plane(self, way: FloatArray) -> FloatArray:
        """Map directions (k, 3) from the middle, in shares of the halves, to the plane (k, 2)."""
        across = np.linalg.norm(way[:, :2], axis=1)
        angle = np.arctan2(across, way[:, 2])
        return np.asarray(self.half[2] * (angle / across)[:, None] * way[:, :2])

    def drawing(self) -> Drawing:
        """Draw the two seams, frame and rim."""
        lines = {"frame": self._level(self.frame), "rim": self._level(self.base)}
        for name, side in (("front", -1.0), ("rear", 1.0)):
            seam = self._seam(side)
            lines[f"{name} seam"] = seam
            for end, where in ((0, "left"), (-1, "right")):
                away = np.linalg.norm(lines["rim"] - seam[end], axis=1).argmin()
                lines[f"below {name} {where}"] = np.array([seam[end], lines["rim"][away]])
        low = 0.9 * self.half[2] * np.pi / 2
        return Drawing(
            lines=lines,
            panels={
                "FRONT": np.array([[0.0, -low]]),
                "GUSSET": np.zeros((1, 2)),
                "REAR": np.array([[0.0, low]]),
            },
        )

    def _curve(self, share: float) -> FloatArray:
        """Points (k, 2) of a section at ``share`` of a half, in shares of the other two halves."""
        wave = np.column_stack([np.cos(_TURN), np.sin(_TURN)])
        size = (1 - share**self.power) ** (1 / self.power)
        return np.asarray(size * np.sign(wave) * np.abs(wave) ** (2 / self.power))

    def _level(self, share: float) -> FloatArray:
        """Closed line (k, 2) at a level below the middle."""
        round_ = self._curve(share)
        line = self._plane(np.column_stack([round_, np.full(len(round_), -share)]))
        line[-1] = line[0]
        return line

    def _seam(self, side: float) -> FloatArray:
        """Seam (k, 2) from the frame on the left over the top to that on the right."""
        x, z = np.roll(self._curve(self.seam)[:-1], len(_TURN) // 4, axis=0).T
        y = side * self.seam * (1 - self.taper * np.minimum(z, 0) ** 2)
        way = np.column_stack([x, y, z])
        size = (np.abs(way) ** self.power).sum(axis=1) ** (-1 / self.power)
        return np.asarray(self._plane(way)[size * z >= -self.frame])

    def room(self, p: FloatArray) -> FloatArray:
        """No tie-down, no room for one."""
        return np.zeros(len(p))
