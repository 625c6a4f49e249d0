"""The family of seats: the one place where a shape is added."""

from __future__ import annotations

from collections.abc import Callable
from types import MappingProxyType

from seatlook.seats.backrest import Backrest
from seatlook.seats.box import BoxCushion
from seatlook.seats.cushion import Cushion
from seatlook.seats.drawing import Form
from seatlook.seats.headrest import Headrest
from seatlook.seats.horseshoe import Horseshoe
from seatlook.seats.saddle import Saddle

# name -> form of a scale and a height of the bolsters [m]
SHAPES: MappingProxyType[str, Callable[[float, float], Form]] = MappingProxyType(
    {
        "cushion": Cushion.sized,
        "horseshoe": Horseshoe.sized,
        "backrest": Backrest.sized,
        "headrest": Headrest.sized,
        "box": BoxCushion.sized,
        "saddle": Saddle.sized,
    }
)
