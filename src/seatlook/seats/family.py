"""The family of seats: the one place where a shape is added."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from types import MappingProxyType

from seatlook.errors import InputError, Problem, did_you_mean
from seatlook.seats.backrest import Backrest
from seatlook.seats.box import BoxCushion
from seatlook.seats.cushion import Cushion
from seatlook.seats.drawing import Form
from seatlook.seats.headrest import Headrest
from seatlook.seats.horseshoe import Horseshoe
from seatlook.seats.saddle import Saddle

SCALES = (0.6, 1.6)
BOLSTERS = (0.0, 0.1)  # m


@dataclass(frozen=True, slots=True)
class Shape:
    """A shape of the family.

    Parameters
    ----------
    sized : form of a scale and, where there are bolsters, of their height [m]
    bolster : usual height of the bolsters [m]; None where there are none
    """

    sized: Callable[..., Form]
    bolster: float | None = None


SHAPES: MappingProxyType[str, Shape] = MappingProxyType(
    {
        "cushion": Shape(Cushion.sized, 0.013),
        "horseshoe": Shape(Horseshoe.sized, 0.030),
        "backrest": Shape(Backrest.sized, 0.030),
        "headrest": Shape(Headrest.sized),
        "box": Shape(BoxCushion.sized),
        "saddle": Shape(Saddle.sized),
    }
)


def shaped(name: str, scale: float = 1.0, bolster: float | None = None) -> Form:
    """Return a seat of the family.

    Parameters
    ----------
    name : one of ``SHAPES``
    scale : float [1]              of all lengths but the height of the bolsters
    bolster : float [m], optional  their height over the middle of the insert; a shape without
        bolsters stays the same

    Raises
    ------
    InputError
        No such shape; a scale or height out of bounds.
    """
    problems = []
    if name not in SHAPES:
        problems.append(
            Problem(
                key="shape",
                got=repr(name),
                expected=f"one of {', '.join(SHAPES)}",
                hint=did_you_mean(name, SHAPES),
            )
        )
    if not SCALES[0] <= scale <= SCALES[1]:
        problems.append(
            Problem(key="scale", got=f"{scale:g}", expected="{:g} to {:g}".format(*SCALES))
        )
    if bolster is not None and not BOLSTERS[0] <= bolster <= BOLSTERS[1]:
        low, high = (1e3 * height for height in BOLSTERS)
        problems.append(
            Problem(key="bolster", got=f"{1e3 * bolster:g} mm", expected=f"{low:g} to {high:g} mm")
        )
    if problems:
        raise InputError(problems)
    shape = SHAPES[name]
    if shape.bolster is None:
        return shape.sized(scale)
    return shape.sized(scale, shape.bolster if bolster is None else bolster)
