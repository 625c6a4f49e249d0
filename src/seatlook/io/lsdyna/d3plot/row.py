"""The words of one shell in a state of a d3plot file: where thickness and strains stand.

A row has ``layers (6a + b + NEIPS) + 8c + 4d + 12 ISTRN + 18 plastic + 6 thermal`` words: stress
(a), plastic strain (b) and history in every layer, resultants (c), thickness and energy (d),
strains on both surfaces, tensors of plastic and thermal strain. The 18 are three points over the
thickness, whatever the number of layers.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from seatlook.errors import InputError

_STRAINS, _PLASTIC, _THERMAL = 12, 18, 6


def refuse(file: Path, key: str, got: object, expected: str, hint: str = "") -> InputError:
    """Make the error of one problem of ``file``."""
    return InputError.single(key, got=got, expected=expected, file=file, hint=hint)


@dataclass(frozen=True, slots=True)
class _Row:
    """One reading of a row: its words, and those of thickness and strain, -1 for none."""

    words: int
    thickness: int
    strain: int


def shell_row(file: Path, control: Mapping[str, int]) -> tuple[int, int]:
    """Return the words of thickness and strain within a shell's row, -1 where there is none.

    NV2D must be explained to the last word, by one reading only: a file with more in it, or one
    that may be read in two ways, would be split wrongly.

    Raises
    ------
    InputError
        NV2D that no reading explains, or two.
    """
    words = control["nv2d"]
    readings = _readings(control)
    fitting = {(row.thickness, row.strain) for row in readings if row.words == words}
    if len(fitting) > 1:
        raise refuse(
            file, "NV2D", f"{words} words per shell, with or without strains",
            "one reading of a shell's row", "set STRFLG=1 and MAXINT=3 in *DATABASE_EXTENT_BINARY",
        )  # fmt: skip
    if not fitting:
        known = " or ".join(str(w) for w in sorted({row.words for row in readings}))
        raise refuse(
            file, "NV2D", words, f"{known} words per shell",
            "the states hold more than this reader knows",
        )  # fmt: skip
    return fitting.pop()


def _readings(control: Mapping[str, int]) -> list[_Row]:
    """List the rows that the control words allow.

    The digits of IDTDT say which tensors there are. Its fifth digit says that there are strains;
    where it is 0 only the length of the row does, as older releases leave it out. NUMDS below 0
    stands for four points in the plane of a shell, which not every release writes.
    """
    layers = abs(control["maxint"]) % 10000 if control["maxint"] < 0 else control["maxint"]
    stress, plastic, resultants, thickness = (control[f"ioshl{i}"] == 1000 for i in (1, 2, 3, 4))
    idtdt = control["idtdt"]
    tensors = _PLASTIC * (idtdt // 100 % 10 == 1) + _THERMAL * (idtdt // 1000 % 10 == 1)
    rows = []
    for in_plane in (4, 1) if control["numds"] < 0 else (1,):
        at = in_plane * layers * (6 * stress + plastic + control["neips"]) + 8 * resultants
        for strains in (True,) if idtdt // 10000 % 10 == 1 else (False, True):
            words = at + 4 * thickness + _STRAINS * strains + tensors
            rows.append(_Row(words, at if thickness else -1, at + 3 * thickness if strains else -1))
    return rows
