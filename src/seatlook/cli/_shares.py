"""Shares by name, as --ease and --short take them."""

from __future__ import annotations

from typing import Annotated

from cyclopts import Parameter

from seatlook.errors import InputError

Shares = Annotated[tuple[str, ...], Parameter(negative=())]


def shares(option: str, words: tuple[str, ...]) -> dict[str, float]:
    """Read NAME=2% (or NAME=0.02) into fractions.

    Examples
    --------
    >>> shares("--ease", ("INSERT-BOLSTER_L=4%", "FRONT-SIDE_L=0.02"))
    {'INSERT-BOLSTER_L': 0.04, 'FRONT-SIDE_L': 0.02}
    """
    out = {}
    for word in words:
        name, _, text = word.rpartition("=")
        try:
            value = float(text.removesuffix("%")) / (100 if text.endswith("%") else 1)
        except ValueError:
            name = ""
        if not name:
            raise InputError.single(option, got=repr(word), expected="NAME=2%")
        out[name] = value
    return out
