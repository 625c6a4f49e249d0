"""CSV files of curves: any separator, heads or none, every number with its line."""

from __future__ import annotations

import csv
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from seatlook.errors import InputError, Problem, did_you_mean
from seatlook.files import LARGEST_TEXT, kept, read_text, reader
from seatlook.model import FloatArray, IntArray

_SEPARATORS = (";", "\t", ",")
_SHOWN = 30
_BRACKETS = re.compile(r"[\[(][^\])]*[\])]")


@dataclass(frozen=True, slots=True)
class Columns:
    """A file of numbers; cells stay text until a column is asked for.

    Parameters
    ----------
    heads : of the columns; empty where the file has none
    rows : cells of every row of numbers
    lines : of these rows in the file, from 1
    decimal : "." or ","
    """

    file: Path
    heads: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    lines: IntArray
    decimal: str

    def index(self, column: str | int) -> int:
        """Return the place of a column from 0, by its head, with or without unit, or its number.

        Raises
        ------
        InputError
            No such column.
        """
        width = max(len(row) for row in self.rows)
        if isinstance(column, int):
            if 1 <= column <= width:
                return column - 1
            got, expected, hint = f"column {column}", f"1 to {width}", ""
        else:
            bare = [_BRACKETS.sub("", head).strip() for head in self.heads]
            for names in (list(self.heads), bare):
                if column in names:
                    return names.index(column)
            got = f"no column {column!r}"
            expected = f"one of {', '.join(self.heads)}" if self.heads else "a number: no heads"
            hint = did_you_mean(column, self.heads)
        raise InputError.single("column", got=got, expected=expected, file=self.file,
                                line=1, hint=hint)  # fmt: skip

    def name(self, index: int) -> str:
        """Return what a message calls a column."""
        head = f" ({self.heads[index]})" if index < len(self.heads) else ""
        return f"column {index + 1}{head}"

    def head(self, index: int) -> str:
        """Return the head of a column, empty if it has none."""
        return self.heads[index] if index < len(self.heads) else ""

    def numbers(self, index: int) -> FloatArray:
        """Return a column as float64.

        Raises
        ------
        InputError
            A cell that is no finite number, with its line.
        """
        values, problems = np.empty(len(self.rows)), []
        for i, (row, line) in enumerate(zip(self.rows, self.lines.tolist(), strict=True)):
            text = row[index] if index < len(row) else ""
            value = _number(text, self.decimal)
            if value is None:
                problems.append(
                    Problem(
                        key=self.name(index), got=repr(text[:_SHOWN]) if text else "nothing",
                        expected="a finite number", file=self.file, line=line,
                    )
                )  # fmt: skip
            else:
                values[i] = value
        if problems:
            raise InputError(problems[:_SHOWN])
        return values


@reader("a table of numbers, as CSV")
@kept
def read_columns(path: Path) -> Columns:
    """Read a CSV file: heads, if any, then rows of numbers.

    Raises
    ------
    InputError
        No such file, no row of numbers, or text between the numbers, with its line.
    """
    text = read_text(path, at_most=LARGEST_TEXT)
    separator = _separator(text)
    decimal = "," if separator != "," and "," in text and "." not in text else "."
    heads: tuple[str, ...] = ()
    rows: list[tuple[str, ...]] = []
    lines: list[int] = []
    table = csv.reader(text.splitlines(keepends=True), delimiter=separator)
    for cells in table:
        row = tuple(cell.strip() for cell in cells)
        if not any(row) or row[0].startswith("#"):
            continue
        if not rows and not any(_number(cell, decimal) is not None for cell in row):
            heads = row  # the last row before the numbers
            continue
        rows.append(row)
        lines.append(table.line_num)
    if not rows:
        raise InputError.single(
            "file", got="no row of numbers", expected="heads, then rows of numbers", file=path
        )
    return Columns(path, heads, tuple(rows), np.array(lines, dtype=np.int64), decimal)


def _separator(text: str) -> str:
    """The separator of a file: the one that every row of its middle has."""
    lines = [line for line in text.splitlines() if line.strip() and line[0] != "#"][-20:]
    for separator in _SEPARATORS:
        if lines and all(separator in line for line in lines):
            return separator
    return ","


def _number(text: str, decimal: str) -> float | None:
    try:
        value = float(text.replace(decimal, "."))
    except ValueError:
        return None
    return value if np.isfinite(value) else None
