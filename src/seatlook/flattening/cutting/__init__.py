"""A design surface cut: into panels along lines, and rings open."""

from seatlook.flattening.cutting.lines import cut_along
from seatlook.flattening.cutting.opening import opened

__all__ = ["cut_along", "opened"]
