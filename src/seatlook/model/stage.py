"""Stages of the making: stretches of process time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import Literal

from seatlook.errors import InputError

Ramp = Literal["linear", "smooth"]
RAMPS: tuple[Ramp, ...] = ("linear", "smooth")


SHORTEST, LONGEST = 1e-4, 1e4  # [s] of process time, in which a stage is ramped


@dataclass(frozen=True, slots=True, kw_only=True)
class Stage:
    """A stretch of process time [s] in which some ties are ramped from 0 to full.

    Parameters
    ----------
    ramp : "linear", or "smooth": slow at both ends, ``3 s^2 - 2 s^3`` of the time's share s
    group : name of a group of stages that is kept, drawn and done again as one
    seams : names of the seams that close in it; those that no stage names close in the first
    """

    name: str
    start: float
    end: float
    ramp: Ramp = "linear"
    group: str | None = None
    seams: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        length, bounds = self.end - self.start, f"{SHORTEST:g} to {LONGEST:g} s in between"
        for good, expected in (
            (0 <= self.start < self.end, "0 <= start < end"),
            (length >= SHORTEST and self.end <= LONGEST, bounds),
        ):
            if not good:
                got = f"start {self.start}, end {self.end}"
                raise InputError.single(f"stage {self.name}", got=got, expected=expected)
        if self.ramp not in RAMPS:
            raise InputError.single(
                f"stage {self.name}.ramp", got=repr(self.ramp), expected=" or ".join(RAMPS)
            )

    @property
    def unit(self) -> str:
        """What it is kept and drawn as: its group, or itself."""
        return self.group or self.name


def stage_units(stages: Sequence[Stage]) -> list[str]:
    """Names of groups, and of stages without one, in the order in which they begin.

    Raises
    ------
    InputError
        Two stages have one name, or another stage begins between two of a group.

    Examples
    --------
    >>> stage_units([Stage(name="a", start=0.0, end=1.0, group="sew"),
    ...              Stage(name="pull", start=1.0, end=3.0),
    ...              Stage(name="b", start=0.5, end=2.0, group="sew")])
    ['sew', 'pull']
    """
    order = sorted(stages, key=lambda stage: stage.start)
    names = [stage.name for stage in stages]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise InputError.single("stage", got=f"{twice[0]!r} twice", expected="different names")
    units = [unit for unit, _ in groupby(order, key=lambda stage: stage.unit)]
    torn = [unit for unit in units if units.count(unit) > 1]
    if torn:
        last = units.index(torn[0], units.index(torn[0]) + 1)
        raise InputError.single(
            f"group {torn[0]}",
            got=f"{units[last - 1]!r} beginning between its stages",
            expected="stages that begin one after the other",
        )
    return units
