"""Pictures to show a seat with: on a turntable, and a sheet of all its looks and lights."""

from seatlook.chain.showing.sheet import draw_sheet
from seatlook.chain.showing.turntable import Turn, draw_turntable

__all__ = ["Turn", "draw_sheet", "draw_turntable"]
