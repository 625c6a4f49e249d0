"""How many words SPH nodes and airbag particles take in a d3plot; nothing of them is read.

The words are those of the LS-DYNA database manual: flags before the nodes, lists behind the rigid
bodies, values behind the deletion flags of a state.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

import numpy.typing as npt

from seatlook.io.lsdyna.d3plot.row import refuse

_NAME_WORDS = 9  # of an airbag variable: its type, and eight letters of its name
_CHAMBERS = 4  # version of the particle data from which chambers are counted
_MOST = 1_000_000  # bags and versions in NPEFG; more is no count


class Particles(NamedTuple):
    """Words of particles in the three places where they stand.

    Parameters
    ----------
    flags : before the nodes of the geometry section
    lists : behind its rigid bodies
    state : in each state
    """

    flags: int
    lists: int
    state: int


def particles(file: Path, words: npt.NDArray[Any], at: int, control: dict[str, int]) -> Particles:
    """Count the words of particles; their flags begin at word ``at`` of the geometry section."""
    sph = _sph(file, words, at, control["nmsph"])
    bags = _airbags(file, words, at + sph.flags, control["npefg"])
    return Particles(*(a + b for a, b in zip(sph, bags, strict=True)))


def _sph(file: Path, words: npt.NDArray[Any], at: int, count: int) -> Particles:
    if not count:
        return Particles(0, 0, 0)
    flags = _counts(file, words, at, 11, "ISPHFG")
    if flags[0] not in (10, 11):
        raise refuse(file, "ISPHFG", f"{flags[0]} flags", "10 or 11")
    # The tenth is negative for true strains; with ten flags there are no history variables.
    values = 1 + sum(flags[1:8]) + abs(flags[8]) + flags[9] + (flags[10] if flags[0] == 11 else 0)
    return Particles(flags[0], 2 * count, count * values)


def _airbags(file: Path, words: npt.NDArray[Any], at: int, npefg: int) -> Particles:
    if not npefg:
        return Particles(0, 0, 0)
    if npefg > _MOST:
        raise refuse(file, "NPEFG", npefg, f"at most {_MOST}")
    version, bags = divmod(npefg, 1000)
    geometry, variables, count, state = _counts(file, words, at, 4, "airbag particles")
    names = _NAME_WORDS * (geometry + variables + state)
    return Particles(
        flags=4 + (version == _CHAMBERS) + names,
        lists=bags * geometry,
        state=bags * state + count * variables,
    )


def _counts(file: Path, words: npt.NDArray[Any], at: int, number: int, what: str) -> list[int]:
    """Read counts that are no larger than the file; only that of SPH strains may be negative."""
    found = [int(word) for word in words[at : at + number]]
    if len(found) < number:
        raise refuse(file, what, f"{len(found)} words", f"{number}", "the file is truncated")
    if any(
        abs(n) > len(words) or (n < 0 and not (number == 11 and k == 8))
        for k, n in enumerate(found[:10])
    ):
        raise refuse(file, what, found, f"counts from 0 to {len(words)}")
    return found
