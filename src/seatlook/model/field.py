"""A value per face, with what a reader must know about it."""

from __future__ import annotations

from dataclasses import dataclass

from seatlook.model._check import FloatArray, floats


@dataclass(frozen=True, slots=True, kw_only=True)
class Field:
    """One value per face of a cover, as files for other programs carry it.

    Parameters
    ----------
    name : in every file
    unit : "1" for a number
    meaning : one sentence
    values : (m,) float64 [unit]
    """

    name: str
    unit: str
    meaning: str
    values: FloatArray

    def __post_init__(self) -> None:
        floats(self, "values", None)
