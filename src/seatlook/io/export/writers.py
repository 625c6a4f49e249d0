"""Exports of a solved cover for other programs; the result file stays the truth."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from seatlook.errors import InputError
from seatlook.io.export.csv import write_csv
from seatlook.io.export.glb import write_glb
from seatlook.io.export.result import write_result
from seatlook.io.export.vtp import write_vtp
from seatlook.io.lsdyna.dynain import write_dynain
from seatlook.io.schema import shown
from seatlook.model import Field, Solution

# A new export is one writer here.
WRITERS: dict[str, Callable[[Solution, Sequence[Field], Path], None]] = {
    ".vtp": write_vtp,
    ".csv": write_csv,
    ".glb": write_glb,
    # A dynain file has no place for indices; its reader computes them from the strains.
    ".k": lambda solution, fields, path: write_dynain(solution, path),
    ".radioss.k": lambda solution, fields, path: write_dynain(solution, path, strain_columns=16),
    # Of shells from elsewhere, to be drawn and scored as a cover.
    ".npz": lambda solution, fields, path: write_result(solution, path),
}


def export_cover(solution: Solution, fields: Sequence[Field], path: Path) -> None:
    """Write a solved cover with some fields in the format that the path's ending names.

    Parameters
    ----------
    fields : of its faces, such as ``Assessment.fields``; their names are the same in all formats

    Raises
    ------
    InputError
        There is no such format, or the fields are of another cover.
    """
    endings = [ending for ending in WRITERS if path.name.lower().endswith(ending)]
    if not endings:
        expected = f"one of {', '.join(WRITERS)}"
        raise InputError.single("file", got=shown(path.suffix), expected=expected, file=path)
    count = len(solution.cover.faces)
    for field in fields:
        if len(field.values) != count:
            raise InputError.single(
                f"field {field.name}", got=f"{len(field.values)} faces", expected=str(count)
            )
    WRITERS[max(endings, key=len)](solution, fields, path)
