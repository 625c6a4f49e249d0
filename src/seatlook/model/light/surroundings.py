"""What a seat stands on in a picture, and what is seen beyond it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from seatlook.errors import InputError, did_you_mean


@dataclass(frozen=True, slots=True, kw_only=True)
class Surroundings:
    """A floor that goes on for ever, and a valance over the hem and the edge of the foam.

    Parameters
    ----------
    albedo : float     of the floor, grey; it throws light onto the seat from below
    shown : bool       whether the floor is seen, or its place stays transparent
    """

    albedo: float
    shown: bool = True


# By name; "plain" has nothing around the seat. Albedos: judgement.
SURROUNDINGS: Mapping[str, Surroundings | None] = MappingProxyType(
    {
        "plain": None,
        "sweep": Surroundings(albedo=0.4),
        "cabin": Surroundings(albedo=0.1),
        "transparent": Surroundings(albedo=0.4, shown=False),
    }
)


def surroundings_named(name: str) -> Surroundings | None:
    """Return the surroundings of a name, None for ``plain``.

    Raises
    ------
    InputError
        Another name.

    Examples
    --------
    >>> surroundings_named("sweep").albedo, surroundings_named("plain")
    (0.4, None)
    """
    if name not in SURROUNDINGS:
        raise InputError.single(
            "surroundings",
            got=repr(name),
            expected=f"one of {', '.join(SURROUNDINGS)}",
            hint=did_you_mean(name, SURROUNDINGS),
        )
    return SURROUNDINGS[name]
