"""The thread of the seams, as it is seen."""

from __future__ import annotations

from dataclasses import dataclass

from seatlook.errors import InputError
from seatlook.model._check import FloatArray, floats, in_range, positive


@dataclass(frozen=True, slots=True, kw_only=True)
class Thread:
    """Top stitch on both sides of each seam: two rows of metric size 30 by default, by judgement.

    Parameters
    ----------
    colour : (3,) float64 in [0, 1] or None   linear sRGB; None: the panel's own, a little lighter
    offset : float [m]    of the rows from the seam
    pitch : float [m]     from needle hole to needle hole
    length, width : float [m]   of the part of a stitch that is seen; width 0 for a plain seam
    """

    colour: FloatArray | None = None
    offset: float = 0.005
    pitch: float = 0.005
    length: float = 0.0040
    width: float = 0.0009

    def __post_init__(self) -> None:
        if self.colour is not None:
            floats(self, "colour", 3)
            in_range(self, "colour", 0.0, 1.0)
        positive(self, "pitch", "length")
        in_range(self, "offset", 0.0, 0.02)
        in_range(self, "width", 0.0, 0.005)
        if self.length > self.pitch:
            raise InputError.single(
                "Thread.length",
                got=f"{1e3 * self.length:g} mm",
                expected=f"at most the pitch, {1e3 * self.pitch:g} mm",
            )
