"""What fastens a cover: the thread of its seams, and the wires that its hog rings slide along."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from seatlook import mesh
from seatlook.errors import InputError
from seatlook.model._check import FARTHEST, FloatArray, floats, in_range, positive

_ROUNDS = 8  # of Newton's method; each leaves the square of what the one before left


@dataclass(frozen=True, slots=True, kw_only=True)
class Thread:
    """Top stitch on both sides of each seam: two rows of metric size 30 by default, by judgement.

    Parameters
    ----------
    colour : (3,) float64 in [0, 1] or None   linear sRGB; None: the panel's own, a little lighter
    offset : float [m]    of the rows from the seam
    pitch : float [m]     from needle hole to needle hole
    length, width : float [m]   of the part of a stitch that is seen; width 0 for a plain seam
    gauge : float [m]     between the two rows of ``top stitch 2``
    """

    colour: FloatArray | None = None
    offset: float = 0.005
    pitch: float = 0.005
    length: float = 0.0040
    width: float = 0.0009
    gauge: float = 0.006

    def __post_init__(self) -> None:
        if self.colour is not None:
            floats(self, "colour", 3)
            in_range(self, "colour", 0.0, 1.0)
        positive(self, "pitch", "length")
        in_range(self, "offset", 0.0, 0.02)
        in_range(self, "width", 0.0, 0.005)
        in_range(self, "gauge", 0.001, 0.008)
        if self.length > self.pitch:
            raise InputError.single(
                "Thread.length",
                got=f"{1e3 * self.length:g} mm",
                expected=f"at most the pitch, {1e3 * self.pitch:g} mm",
            )


SEAM_KINDS = ("plain", "top stitch 1", "top stitch 2", "French", "lapped")


@dataclass(frozen=True, slots=True, kw_only=True)
class SeamKind:
    """How a seam is sewn, as far as it is seen.

    Parameters
    ----------
    kind : ``plain``: no thread is seen, the allowance lies open to both sides; ``French``: the
        same with a row of top stitch on each; ``top stitch 1`` or ``2``: the allowance is folded
        to one side and stitched down there with one row or two; ``lapped``: one panel lies over
        the other, stitched down with one row
    side : ``a`` or ``b`` of the seam, the one that is stitched down or lies over the other
    """

    kind: str = "French"
    side: str = "a"

    def __post_init__(self) -> None:
        for name, choices in (("kind", SEAM_KINDS), ("side", ("a", "b"))):
            if getattr(self, name) not in choices:
                raise InputError.single(
                    f"SeamKind.{name}",
                    got=repr(getattr(self, name)),
                    expected=f"one of {', '.join(choices)}",
                )


@dataclass(frozen=True, slots=True, kw_only=True)
class Wire:
    """A wire, where each ring is put on it, and how far it may slide.

    Parameters
    ----------
    curve : (k, 3) float64 [m]    a polyline; if its last point is its first, it has no ends
    place : (s,) float64 [m]      along the curve, where the ring is put on
    stops : (s, 2) float64 [m]    along the curve: the ends of the wire, or where others meet it;
                                  infinite where there is none
    """

    curve: FloatArray
    place: FloatArray
    stops: FloatArray

    def __post_init__(self) -> None:
        floats(self, "curve", None, 3, most=FARTHEST)
        floats(self, "place", None)
        floats(self, "stops", len(self.place), 2, finite=False)

    def nearest(self, points: FloatArray) -> FloatArray:
        """Places (s,) [m] of the rings on the wire, next to the points (s, 3) that they hold.

        They depend on the points alone, not on where the rings were before. Beyond a stop a ring
        stays at it.
        """
        low, high = self.stops.T
        place = self.place
        for _ in range(_ROUNDS):
            away = points - mesh.points_at(self.curve, place)
            along = np.einsum("ij,ij->i", away, mesh.directions_at(self.curve, place))
            place = np.clip(place + along, low, high)
        return place
