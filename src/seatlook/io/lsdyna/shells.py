"""Shell results of either format, told apart by their content: such files have no ending."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from seatlook.errors import InputError
from seatlook.files import opened, reader
from seatlook.io.lsdyna.d3plot.reader import read_d3plot
from seatlook.io.lsdyna.deck.reader import read_keyword
from seatlook.model import ShellResult
from seatlook.model.shells import StrainAxes

_EXPECTED = "a d3plot or a keyword deck"


@reader(_EXPECTED)
def read_shells(
    path: Path,
    *,
    parts: Sequence[int | str] | None = None,
    thickness: float | None = None,
    length_unit: str = "mm",
    strain_axes: StrainAxes = "global",
    reference: Path | None = None,
) -> ShellResult:
    """Read a d3plot family, or a keyword deck such as a dynain file.

    Parameters
    ----------
    parts : part numbers or titles; without it all shells
    thickness : float [m]       for files that do not hold it
    length_unit : "mm", "cm", "m" or "inch"
    strain_axes : of a d3plot: "global", or "element" for a run with CMPFLG=1
    reference : of a keyword deck: the same nodes before any load

    Raises
    ------
    InputError
        As ``read_d3plot`` and ``read_keyword``; an option that the format has no use for.
    """
    if _is_binary(path):
        if reference is not None:
            raise InputError.single(
                "reference", got=str(reference), expected="nothing: a d3plot holds its own",
                file=path,
            )  # fmt: skip
        return read_d3plot(
            path, parts=parts, thickness=thickness, length_unit=length_unit, strain_axes=strain_axes
        )
    if strain_axes != "global":
        raise InputError.single(
            "strain_axes", got=repr(strain_axes), file=path,
            expected="nothing: ILOCAL of the deck tells",
        )  # fmt: skip
    return read_keyword(
        path, parts=parts, thickness=thickness, length_unit=length_unit, reference=reference
    )


def _is_binary(path: Path) -> bool:
    with opened(path, expected=_EXPECTED) as stream:
        return b"\0" in stream.read(512)
